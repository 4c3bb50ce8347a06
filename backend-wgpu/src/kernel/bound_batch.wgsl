// Mirrors core/src/kernel/bound.rs: bound for the batch in flight.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> control: Control;
@group(0) @binding(4) var<storage, read> stack: array<Surface>;
@group(0) @binding(5) var<storage, read_write> batch: array<Surface>;
@group(0) @binding(6) var<storage, read_write> verdicts: array<Verdict>;
@group(0) @binding(7) var<storage, read> patches_more: array<Patch>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let item = item_index(group, lane);
    if item >= control.taken {
        return;
    }
    let surface = member(item);
    batch[item] = surface;
    verdicts[item] = bound_any(surface);
}

// Mirrors core/src/kernel/take.rs (member): roots first, the first patch last, as if they had lain on the stack.
fn member(item: u32) -> Surface {
    if item < control.roots {
        if control.listed != 0u {
            return batch[item]; // where take has put it
        }
        return root(control.next_root - 1u - item);
    }
    return stack[control.base + item - control.roots];
}
