// Mirrors core/src/kernel/take.rs (take, put_listed): take for the one stack of all schedulers but LOCAL.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read> roots: array<u32>;
@group(0) @binding(2) var<storage, read> stack: array<Surface>;
@group(0) @binding(3) var<storage, read_write> batch: array<Surface>;
@group(0) @binding(4) var<storage, read_write> control: Control;

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
    let after = take(control, limits, lane);
    if after.listed != 0u {
        for (var item = lane; item < after.roots; item += GROUP) {
            batch[item] = root(roots[after.next_root - 1u - item]);
        }
    }
    if lane == 0u {
        control = after;
    }
}

fn level_at(entry: u32) -> u32 {
    return level(stack[entry]);
}
