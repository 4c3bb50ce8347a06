// Mirrors core/src/kernel/take.rs and core/src/schedule/adaptive.rs: the next batch is the top of the stack, as
// much of it as is safe, and then roots.

static Control take(Control control, uint base, uint roots) {
    control.taken = roots + control.stack - base;
    control.roots = roots;
    control.base = base;
    control.next_root += roots;
    control.waiting += control.fresh;
    control.fresh = 0u;
    return control;
}

// The patch that is root number `number`.
static uint patch_of(__global const Control *control, __global const uint *roots, uint number) {
    return control->listed == 0u ? number : roots[number];
}

// Surface number `item` of the batch, where `put` may lie: roots first, the first one last, as if they had lain on the
// stack.
static Surface member(__global const Control *control, __global const Surface *stack, __global const Surface *put,
                      uint item) {
    if (item < control->roots) {
        return control->listed == 0u ? root(control->next_root - 1u - item) : put[item];
    }
    return stack[control->base + item - control->roots];
}

static bool is_safe(uint count, uint taken, uint levels, uint capacity) {
    return saturating_sub(taken + levels, 2u) <= saturating_sub(capacity, count);
}

static bool is_never_split(uint entry_level, uint levels) {
    return entry_level + 1u >= levels;
}

static uint lowest(uint entry, uint entry_level, uint levels, uint capacity) {
    if (is_never_split(entry_level, levels)) {
        return 0u;
    }
    const uint left = saturating_sub(saturating_sub(capacity, entry), levels - entry_level);
    return saturating_sub(entry, left);
}

static uint roots_below(uint entry, uint entry_level, uint levels, uint capacity) {
    if (is_never_split(entry_level, levels)) {
        return UINT_MAX;
    }
    return saturating_sub(saturating_sub(capacity, levels - entry_level) / 2u, entry);
}

static uint roots_above_none(uint levels, uint capacity) {
    const uint below = roots_below(0u, 0u, levels, capacity);
    return below == UINT_MAX ? below : below + 1u;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_take(__global const Limits *limits, __global const uint *roots, __global const Surface *stack,
                __global Surface *batch, __global Control *control) {
    __local uint base, most;
    const uint lane = get_local_id(0), count = control->stack;
    const uint levels = limits->levels, capacity = limits->stack_room;
    const uint first = saturating_sub(count, limits->batch);
    const uint wanted = lesser_of(limits->patches - control->next_root, saturating_sub(limits->batch, count));
    const bool safe = is_safe(count + wanted, count - first + wanted, levels, capacity);
    if (lane == 0u) {
        base = first;
        most = safe ? wanted : lesser_of(wanted, roots_above_none(levels, capacity));
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (!safe) {
        for (uint entry = first + lane; entry < count; entry += GROUP) {
            const uint entry_level = level(stack[entry]);
            atomic_max(&base, lowest(entry, entry_level, levels, capacity));
            atomic_min(&most, roots_below(entry, entry_level, levels, capacity));
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const Control after = take(*control, base, base > 0u ? 0u : most);
    // `bound` finds the batch's roots there.
    for (uint item = lane; after.listed != 0u && item < after.roots; item += GROUP) {
        batch[item] = root(patch_of(control, roots, after.next_root - 1u - item));
    }
    // Nobody writes the counts before all have read them.
    barrier(CLK_GLOBAL_MEM_FENCE);
    if (lane == 0u) {
        *control = after;
    }
}
