// Mirrors core/src/kernel/scan.rs: count, prefix sum, places. One work-group; each of its work-items counts
// an unbroken run of the batch, so outputs keep their order.

// Surfaces split, drawn, and drawn because they may not be split; micropolygons of those that are drawn.
static Counts counted(Verdict verdict) {
    const bool limited = verdict.code == DRAW_LIMITED;
    const bool drawn = verdict.code == DRAW || limited;
    const uint2 rates = rates_of(verdict);
    return (Counts)(verdict.code != CULL && !drawn ? 1u : 0u, drawn ? 1u : 0u, limited ? 1u : 0u,
                    drawn ? rates.x * rates.y : 0u);
}

static Control commit(Control control, Counts all, uint stack_room, uint draw_room) {
    const uint splits = all.x, draws = all.y;
    const uint stack = control.base + 2u * splits;
    const uint excess_stack = saturating_sub(stack, stack_room);
    const uint excess_draws = saturating_sub(control.waiting + draws, draw_room);
    control.stack = stack;
    control.peak = stack > control.peak ? stack : control.peak;
    control.fresh = draws;
    control.processed += control.taken;
    control.culled += control.taken - draws - splits;
    control.drawn += draws;
    control.limited += all.z;
    control.micropolygons += all.w;
    control.overflow = excess_stack > excess_draws ? excess_stack : excess_draws;
    return control;
}

static void scan(__global const Verdict *verdicts, __global Slot *slots, uint from, uint to, Counts before) {
    for (uint index = from; index < to; index++) {
        const Slot slot = {before.x, before.y};
        slots[index] = slot;
        before += counted(verdicts[index]);
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_scan(__global const Limits *limits, __global const Verdict *verdicts, __global Slot *slots,
                __global Control *control) {
    __local Counts counts[GROUP];
    const uint lane = get_local_id(0);
    const uint taken = control->taken;
    const uint from = run_start(lane, taken), to = run_start(lane + 1u, taken);
    Counts own = (Counts)(0u);
    for (uint index = from; index < to; index++) {
        own += counted(verdicts[index]);
    }
    counts[lane] = own;
    barrier(CLK_LOCAL_MEM_FENCE);
    scan(verdicts, slots, from, to, sum(counts, lane));
    if (lane == 0u) {
        *control = commit(*control, sum(counts, GROUP), limits->stack_room, limits->draw_room);
    }
}
