// Mirrors core/src/kernel/take.rs (take): the next batch is the top of the stack, as much of it as is safe.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read> stack: array<Surface>;
@group(0) @binding(2) var<storage, read_write> control: Control;

const GROUP: u32 = 64u;

// Index of the first surface of the batch.
var<workgroup> base: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
    let count = control.stack;
    let lowest = select(0u, count - limits.batch, count > limits.batch);
    if lane == 0u {
        atomicStore(&base, lowest);
    }
    workgroupBarrier();
    let safe = is_safe(count, count - lowest);
    for (var index = lowest + lane; index < select(count, 0u, safe); index += GROUP) {
        atomicMax(&base, least_base(index, level(stack[index])));
    }
    workgroupBarrier();
    if lane == 0u {
        control = take(control, atomicLoad(&base));
    }
}

fn take(before: Control, first: u32) -> Control {
    var after = before;
    after.taken = before.stack - first;
    after.base = first;
    after.low = select(before.low, first, first < before.low);
    after.waiting = before.waiting + before.fresh;
    after.fresh = 0u;
    return after;
}

fn is_safe(count: u32, taken: u32) -> bool {
    return count + taken + limits.levels <= limits.stack_room + 2u;
}

fn least_base(index: u32, level: u32) -> u32 {
    let needed = index + limits.levels - level;
    let free = limits.stack_room - index;
    let least = select(0u, needed - free, needed > free);
    return select(least, index + 1u, least > index);
}
