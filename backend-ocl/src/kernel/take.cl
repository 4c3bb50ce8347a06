// Mirrors core/src/kernel/take.rs: the next batch is the top of the stack, as much of it as is safe; drawn
// surfaces are forgotten.

static Control take(Control control, uint base) {
    control.taken = control.stack - base;
    control.base = base;
    control.low = base < control.low ? base : control.low;
    control.waiting += control.fresh;
    control.fresh = 0u;
    return control;
}

static bool is_safe(__global const Limits *limits, uint count, uint taken) {
    return count + taken + limits->levels <= limits->stack_room + 2u;
}

static uint least_base(__global const Limits *limits, uint index, uint entry_level) {
    const uint needed = index + limits->levels - entry_level, free_above = limits->stack_room - index;
    const uint least = needed > free_above ? needed - free_above : 0u;
    return least > index ? index + 1u : least;
}

// `flush` in core, which is a number's here.
static Control flush_draws(Control control) {
    control.waiting = 0u;
    control.fresh = 0u;
    return control;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_take(__global const Limits *limits, __global const Surface *stack, __global Control *control) {
    __local uint base;
    const uint lane = get_local_id(0), count = control->stack;
    const uint lowest = count > limits->batch ? count - limits->batch : 0u;
    if (lane == 0u) {
        base = lowest;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (!is_safe(limits, count, count - lowest)) {
        for (uint index = lowest + lane; index < count; index += GROUP) {
            atomic_max(&base, least_base(limits, index, level(stack[index])));
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0u) {
        *control = take(*control, base);
    }
}

__kernel void stage_flush(__global Control *control) {
    if (get_global_id(0) == 0) {
        *control = flush_draws(*control);
    }
}
