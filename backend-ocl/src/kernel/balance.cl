// Mirrors core/src/kernel/balance.rs: LOCAL's groups are counted, and told what each will have in its next round.
// One work-group; each of its work-items has an unbroken run of the groups.

// Counts of some groups together: held, draws, processed, culled, limited, peak, micropolygons.
typedef uint8 Totals;

static uint share(uint total, uint index, uint players) {
    return (total + players - 1u - index) / players;
}

static uint share_before(uint total, uint index, uint players) {
    return index * (total / players) + lesser_of(index, total % players);
}

// Of the groups from `from` on before `to`.
static Totals totals_of(__global const Group *groups, uint from, uint to) {
    Totals all = (Totals)(0u);
    for (uint index = from; index < to; index++) {
        __global const Group *group = groups + index;
        all += (Totals)(group->held, group->draws, group->processed, group->culled, group->limited,
                        group->peak, group->micropolygons, 0u);
    }
    return all;
}

// Sum of the first `count` entries.
static Totals sum_totals(__local const Totals *all, uint count) {
    Totals total = (Totals)(0u);
    for (uint index = 0u; index < count; index++) {
        total += all[index];
    }
    return total;
}

static uint roots_given(__global const Limits *limits, uint held, uint waiting) {
    const uint dealt = share(held, 0u, limits->groups);
    const uint wanted = saturating_sub(LOCAL_BATCH, dealt);
    const uint room = saturating_sub(limits->stack_room + 1u, limits->levels + dealt);
    return lesser_of(waiting, lesser_of(wanted, room) * limits->groups);
}

static uint batches_for(__global const Limits *limits, uint surfaces) {
    const uint width = LOCAL_BATCH * limits->groups;
    return lesser_of(greater_of((surfaces + width - 1u) / width, 1u), LOCAL_BATCHES);
}

// `counted` in core, which is a verdict's here.
static Control counted_groups(Control control, __global const Limits *limits, Totals all) {
    const uint held = all.s0, draws = all.s1, peak = all.s5;
    const uint roots = roots_given(limits, held, limits->patches - control.next_root);
    control.stack = held + roots;
    control.taken = all.s2;
    control.roots = roots;
    control.base = 0u;
    control.next_root += roots;
    control.waiting += control.fresh;
    control.fresh = draws;
    control.peak = greater_of(peak, control.peak);
    control.processed += all.s2;
    control.culled += all.s3;
    control.drawn += draws;
    control.limited += all.s4;
    control.micropolygons += all.s6;
    control.overflow = saturating_sub(control.waiting + draws, limits->draw_room);
    return control;
}

static void arrange(__global Group *group, uint index, Control after, __global const Limits *limits,
                    uint draws_before) {
    const uint roots = share(after.roots, index, limits->groups);
    const uint first_root = after.next_root - after.roots + share_before(after.roots, index, limits->groups);
    group->stack = share(after.stack - after.roots, index, limits->groups) + roots;
    group->roots = roots;
    group->next_root = first_root + roots;
    group->batches = batches_for(limits, after.stack);
    group->room = limits->stack_room;
    group->first_draw = draws_before;
    if (after.next_root == after.roots) {
        group->load = 0u;
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_balance(__global const Limits *limits, __global Group *groups, __global Control *control) {
    __local Totals totals[GROUP];
    const uint lane = get_local_id(0), count = limits->groups;
    const uint from = run_start(lane, count), to = run_start(lane + 1u, count);
    totals[lane] = totals_of(groups, from, to);
    barrier(CLK_LOCAL_MEM_FENCE);
    const Control after = counted_groups(*control, limits, sum_totals(totals, GROUP));
    uint draws_before = sum_totals(totals, lane).s1;
    for (uint index = from; index < to; index++) {
        arrange(groups + index, index, after, limits, draws_before);
        draws_before += groups[index].draws;
    }
    // Nobody writes the counts before all have read them.
    barrier(CLK_GLOBAL_MEM_FENCE);
    if (lane == 0u) {
        *control = after;
    }
}
