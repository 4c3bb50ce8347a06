// Mirrors core/src/kernel/seed.rs: one root surface a patch; the first patch lies on top of the stack.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read_write> stack: array<Surface>;
@group(0) @binding(2) var<storage, read_write> control: Control;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = item_index(group, lane);
    if item == 0u {
        control = start(limits.patches);
    }
    if item < limits.patches {
        stack[item] = seed(item, limits.patches);
    }
}

fn seed(position: u32, patch_count: u32) -> Surface {
    return Surface(patch_count - 1u - position, 0u, 0u, 0u);
}

fn start(patch_count: u32) -> Control {
    var control: Control;
    control.stack = patch_count;
    control.peak = patch_count;
    control.low = patch_count;
    return control;
}
