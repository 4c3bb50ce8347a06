// Mirrors core/src/kernel/take.rs (take) and core/src/schedule/adaptive.rs: the next batch is the top of the
// stack, as much of it as is safe.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read> stack: array<Surface>;
@group(0) @binding(2) var<storage, read_write> control: Control;

const GROUP: u32 = 64u;

// Index of the first surface of the batch.
var<workgroup> base: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
    let count = control.stack;
    let first = select(0u, count - limits.batch, count > limits.batch);
    if lane == 0u {
        atomicStore(&base, first);
    }
    workgroupBarrier();
    let safe = is_safe(count, count - first);
    for (var entry = first + lane; entry < select(count, 0u, safe); entry += GROUP) {
        atomicMax(&base, lowest(entry, level(stack[entry])));
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
    return taken + limits.levels <= limits.stack_room - count + 2u;
}

fn lowest(entry: u32, level: u32) -> u32 {
    let needed = entry + limits.levels - level;
    let left = select(0u, limits.stack_room - needed, limits.stack_room > needed);
    let least = select(0u, entry - left, entry > left);
    return select(least, 0u, level + 1u >= limits.levels);
}
