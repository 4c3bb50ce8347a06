// Mirrors core/src/accel/sort.rs (`scan`): sums of the counts before each. One work-group; each of its work-items has an
// unbroken run of them.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_scan(__global const AccelFrame *accel_frame, __global uint *counts) {
    __local uint sums[GROUP];
    const uint lane = get_local_id(0), count = accel_frame->counts;
    const uint from = run_start(lane, count), to = run_start(lane + 1u, count);
    uint own = 0u;
    for (uint index = from; index < to; index++) {
        own += counts[index];
    }
    sums[lane] = own;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint before = 0u;
    for (uint other = 0u; other < lane; other++) {
        before += sums[other];
    }
    for (uint index = from; index < to; index++) {
        const uint here = counts[index];
        counts[index] = before;
        before += here;
    }
    if (lane == GROUP - 1u) {
        counts[count] = before;
    }
}
