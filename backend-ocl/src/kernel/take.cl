// Mirrors core/src/kernel/take.rs: the next batch is the top of the stack; drawn surfaces are forgotten.

static Control take(Control control, uint batch) {
    control.taken = control.stack < batch ? control.stack : batch;
    control.base = control.stack - control.taken;
    control.low = control.base < control.low ? control.base : control.low;
    control.waiting += control.fresh;
    control.fresh = 0u;
    return control;
}

// `flush` in core, which is a number's here.
static Control flush_draws(Control control) {
    control.waiting = 0u;
    control.fresh = 0u;
    return control;
}

__kernel void stage_take(__global const Limits *limits, __global Control *control) {
    if (get_global_id(0) == 0) {
        *control = take(*control, limits->batch);
    }
}

__kernel void stage_flush(__global Control *control) {
    if (get_global_id(0) == 0) {
        *control = flush_draws(*control);
    }
}
