// Mirrors core/src/kernel/split.rs (split): split for the batch in flight.

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
        split(control, batch[item], verdicts[item], slots[item]);
    }
}

fn put_surface(place: u32, surface: Surface) {
    stack[place] = surface;
}

fn put_draw(place: u32, draw: Draw) {
    draws[place] = draw;
}
