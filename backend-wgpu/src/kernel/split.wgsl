// Mirrors core/src/kernel/split.rs: children stay where their parent was; the rest is to be drawn.

@group(0) @binding(0) var<storage, read> control: Control;
@group(0) @binding(1) var<storage, read> batch: array<Surface>;
@group(0) @binding(2) var<storage, read> verdicts: array<Verdict>;
@group(0) @binding(3) var<storage, read> slots: array<Slot>;
@group(0) @binding(4) var<storage, read_write> stack: array<Surface>;
@group(0) @binding(5) var<storage, read_write> draws: array<Draw>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = item_index(group, lane);
    if item < control.taken && control.overflow == 0u {
        split(batch[item], verdicts[item], slots[item]);
    }
}

fn split(surface: Surface, verdict: Verdict, slot: Slot) {
    let place = control.base + 2u * slot.splits;
    switch verdict.code {
        case CULL: {}
        case SPLIT_U: {
            stack[place] = half_u(surface, 0u);
            stack[place + 1u] = half_u(surface, 1u);
        }
        case SPLIT_V: {
            stack[place] = half_v(surface, 0u);
            stack[place + 1u] = half_v(surface, 1u);
        }
        default: {
            draws[control.waiting + slot.draws] = Draw(
                surface.patch_id, surface.u, surface.v, surface.shape, verdict.columns, verdict.rows);
        }
    }
}
