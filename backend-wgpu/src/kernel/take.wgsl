// Mirrors core/src/kernel/take.rs (take) and core/src/schedule/adaptive.rs: the next batch is the top of the
// stack, as much of it as is safe, and then roots. All invocations of a group take part; where the stack lies, and
// so the level of an entry, is for the kernels to say (`level_at`).

const GROUP: u32 = 64u;

// Index of the first surface of the batch that lies on the stack; roots before it.
var<workgroup> base: atomic<u32>;
var<workgroup> root_count: atomic<u32>;

fn take(before: Control, limits: Limits, lane: u32) -> Control {
    let count = before.stack;
    let first = saturating_sub(count, limits.batch);
    let wanted = umin(limits.patches - before.next_root, saturating_sub(limits.batch, count));
    let safe = is_safe(count + wanted, count - first + wanted, limits);
    if lane == 0u {
        atomicStore(&base, first);
        atomicStore(&root_count, select(umin(wanted, roots_above_none(limits)), wanted, safe));
    }
    workgroupBarrier();
    for (var entry = first + lane; entry < select(count, 0u, safe); entry += GROUP) {
        let entry_level = level_at(entry);
        atomicMax(&base, lowest(entry, entry_level, limits));
        atomicMin(&root_count, roots_below(entry, entry_level, limits));
    }
    workgroupBarrier();
    let lowest_base = atomicLoad(&base);
    return with_batch(before, lowest_base, select(atomicLoad(&root_count), 0u, lowest_base > 0u));
}

fn with_batch(before: Control, first: u32, taken_roots: u32) -> Control {
    var after = before;
    after.taken = taken_roots + before.stack - first;
    after.roots = taken_roots;
    after.base = first;
    after.next_root = before.next_root + taken_roots;
    after.waiting = before.waiting + before.fresh;
    after.fresh = 0u;
    return after;
}

fn is_safe(count: u32, taken: u32, limits: Limits) -> bool {
    return saturating_sub(taken + limits.levels, 2u) <= saturating_sub(limits.stack_room, count);
}

fn is_never_split(level: u32, limits: Limits) -> bool {
    return level + 1u >= limits.levels;
}

fn lowest(entry: u32, level: u32, limits: Limits) -> u32 {
    let left = saturating_sub(saturating_sub(limits.stack_room, entry), limits.levels - level);
    return select(saturating_sub(entry, left), 0u, is_never_split(level, limits));
}

fn roots_below(entry: u32, level: u32, limits: Limits) -> u32 {
    let most = saturating_sub(saturating_sub(limits.stack_room, limits.levels - level) / 2u, entry);
    return select(most, 0xffffffffu, is_never_split(level, limits));
}

fn roots_above_none(limits: Limits) -> u32 {
    let below = roots_below(0u, 0u, limits);
    return select(below + 1u, below, below == 0xffffffffu);
}
