// Mirrors core/src/kernel/take.rs (flush): the draws that have been diced are forgotten.

// `flush` in core, which is a number's here.
static Control flush_draws(Control control) {
    control.waiting = 0u;
    control.fresh = 0u;
    return control;
}

__kernel void stage_flush(__global Control *control) {
    if (get_global_id(0) == 0) {
        *control = flush_draws(*control);
    }
}
