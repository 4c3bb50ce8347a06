// Mirrors core/src/kernel/take.rs and core/src/schedule/adaptive.rs: the next batch is the top of the stack, as
// much of it as is safe.

static Control take(Control control, uint base) {
    control.taken = control.stack - base;
    control.base = base;
    control.low = base < control.low ? base : control.low;
    control.waiting += control.fresh;
    control.fresh = 0u;
    return control;
}

static bool is_safe(__global const Limits *limits, uint count, uint taken) {
    return taken + limits->levels <= limits->stack_room - count + 2u;
}

static uint lowest(__global const Limits *limits, uint entry, uint entry_level) {
    if (entry_level + 1u >= limits->levels) {
        return 0u;
    }
    const uint needed = entry + limits->levels - entry_level;
    const uint left = limits->stack_room > needed ? limits->stack_room - needed : 0u;
    return entry > left ? entry - left : 0u;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_take(__global const Limits *limits, __global const Surface *stack, __global Control *control) {
    __local uint base;
    const uint lane = get_local_id(0), count = control->stack;
    const uint first = count > limits->batch ? count - limits->batch : 0u;
    if (lane == 0u) {
        base = first;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (!is_safe(limits, count, count - first)) {
        for (uint entry = first + lane; entry < count; entry += GROUP) {
            atomic_max(&base, lowest(limits, entry, level(stack[entry])));
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0u) {
        *control = take(*control, base);
    }
}
