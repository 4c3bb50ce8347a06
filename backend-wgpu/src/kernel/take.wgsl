// Mirrors core/src/kernel/take.rs (take) and core/src/schedule/adaptive.rs: the next batch is the top of the
// stack, as much of it as is safe, and then roots.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read> stack: array<Surface>;
@group(0) @binding(2) var<storage, read_write> control: Control;

const GROUP: u32 = 64u;

// Index of the first surface of the batch that lies on the stack; roots before it.
var<workgroup> base: atomic<u32>;
var<workgroup> roots: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
    let count = control.stack;
    let first = saturating_sub(count, limits.batch);
    let wanted = umin(limits.patches - control.next_root, saturating_sub(limits.batch, count));
    let safe = is_safe(count + wanted, count - first + wanted);
    if lane == 0u {
        atomicStore(&base, first);
        atomicStore(&roots, select(umin(wanted, roots_above_none()), wanted, safe));
    }
    workgroupBarrier();
    for (var entry = first + lane; entry < select(count, 0u, safe); entry += GROUP) {
        let entry_level = level(stack[entry]);
        atomicMax(&base, lowest(entry, entry_level));
        atomicMin(&roots, roots_below(entry, entry_level));
    }
    workgroupBarrier();
    if lane == 0u {
        let lowest_base = atomicLoad(&base);
        control = take(control, lowest_base, select(atomicLoad(&roots), 0u, lowest_base > 0u));
    }
}

fn take(before: Control, first: u32, taken_roots: u32) -> Control {
    var after = before;
    after.taken = taken_roots + before.stack - first;
    after.roots = taken_roots;
    after.base = first;
    after.next_root = before.next_root + taken_roots;
    after.waiting = before.waiting + before.fresh;
    after.fresh = 0u;
    return after;
}

fn is_safe(count: u32, taken: u32) -> bool {
    return saturating_sub(taken + limits.levels, 2u) <= saturating_sub(limits.stack_room, count);
}

fn is_never_split(level: u32) -> bool {
    return level + 1u >= limits.levels;
}

fn lowest(entry: u32, level: u32) -> u32 {
    let left = saturating_sub(saturating_sub(limits.stack_room, entry), limits.levels - level);
    return select(saturating_sub(entry, left), 0u, is_never_split(level));
}

fn roots_below(entry: u32, level: u32) -> u32 {
    let most = saturating_sub(saturating_sub(limits.stack_room, limits.levels - level) / 2u, entry);
    return select(most, 0xffffffffu, is_never_split(level));
}

fn roots_above_none() -> u32 {
    let below = roots_below(0u, 0u);
    return select(below + 1u, below, below == 0xffffffffu);
}
