// Mirrors core/src/accel/sort.rs (`scatter`): keys to their places. One work-group a block; those of a run come behind those of
// the runs before, so that equal digits stay in order.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_scatter(__global const AccelFrame *accel_frame, __global const SortKey *keys, __global const uint *counts,
                         __global SortKey *sorted) {
    __local uint places[SORT_DIGITS * GROUP];
    const uint lane = get_local_id(0);
    count_run(accel_frame, keys, lane, places);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane < SORT_DIGITS) {
        uint before = counts[lane * sort_blocks(accel_frame) + get_group_id(0)];
        for (uint run = 0u; run < GROUP; run++) {
            const uint here = places[lane * GROUP + run];
            places[lane * GROUP + run] = before;
            before += here;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint from = sort_run(accel_frame, lane), to = sort_run(accel_frame, lane + 1u);
    for (uint index = from; index < to; index++) {
        __local uint *place = places + digit_of(keys + index, accel_frame->shift) * GROUP + lane;
        sorted[*place] = keys[index];
        *place += 1u;
    }
}
