// Mirrors core/src/accel/sort.rs (`count`): how many keys of a block have which digit. One work-group a block.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_count(__global const AccelFrame *accel_frame, __global const SortKey *keys, __global uint *counts) {
    __local uint own[SORT_DIGITS * GROUP];
    const uint lane = get_local_id(0);
    count_run(accel_frame, keys, lane, own);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane < SORT_DIGITS) {
        uint all = 0u;
        for (uint run = 0u; run < GROUP; run++) {
            all += own[lane * GROUP + run];
        }
        counts[lane * sort_blocks(accel_frame) + get_group_id(0)] = all;
    }
}
