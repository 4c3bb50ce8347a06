// Mirrors core/src/accel/query.rs (`seen`): how many leaves of each block a frustum sees.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_see(__global const AccelFrame *accel_frame, __global const Node *nodes, __global const Frustum *frusta,
                     __global uint *counts) {
    __local uint all;
    const uint block = get_group_id(0), lane = get_local_id(0);
    if (lane == 0u) {
        all = 0u;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (sees_own(accel_frame, nodes, frusta, block, lane)) {
        atomic_inc(&all);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0u) {
        counts[block] = all;
    }
}
