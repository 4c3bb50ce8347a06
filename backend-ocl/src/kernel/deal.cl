// Mirrors core/src/kernel/deal.rs: all surfaces that LOCAL's groups have left are dealt out anew, around the table,
// the lowest of all stacks first. A column of work-groups a group; each work-item has an entry of its stack, a root and
// a draw.

// Place of an entry of a group's stack in the order in which all are dealt.
static uint rank(__global const Group *groups, uint count, uint group, uint entry) {
    uint before = 0u;
    for (uint other = 0u; other < count; other++) {
        const uint held = groups[other].held;
        before += lesser_of(held, entry) + (other < group && held > entry ? 1u : 0u);
    }
    return before;
}

// Where the surface of this rank lies when it has been dealt: above the roots of its group.
static uint dealt_to(__global const Group *groups, uint count, uint rank) {
    const uint group = rank % count;
    return group * groups[group].room + rank / count + groups[group].roots;
}

static void deal(__global const Control *control, __global const uint *roots, __global const Group *groups, uint count,
                 __global const Surface *stack, __global const Draw *fresh, __global Surface *dealt,
                 __global Draw *draws, uint index, uint entry) {
    __global const Group *group = groups + index;
    const uint place = index * group->room + entry;
    if (entry < group->held) {
        dealt[dealt_to(groups, count, rank(groups, count, index, entry))] = stack[place];
    }
    if (entry < group->roots) {
        dealt[place] = root(patch_of(control, roots, group->next_root - 1u - entry));
    }
    if (entry < group->draws) {
        draws[control->waiting + group->first_draw + entry] = fresh[index * LOCAL_DRAWS + entry];
    }
}

__kernel void stage_deal(__global const Control *control, __global const uint *roots, __global const Group *groups,
                         __global const Surface *stack, __global const Draw *fresh,
                         __global Surface *dealt, __global Draw *draws) {
    const uint index = get_group_id(0), entry = get_group_id(1) * GROUP + get_local_id(0);
    if (control->overflow == 0u) {
        deal(control, roots, groups, get_num_groups(0), stack, fresh, dealt, draws, index, entry);
    }
}
