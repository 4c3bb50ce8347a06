// Mirrors core/src/accel/query.rs (`seen`): which leaves of each block a frustum sees, in their order.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_fill(__global const AccelFrame *accel_frame, __global const Node *nodes, __global const Frustum *frusta,
                      __global const uint *counts, __global uint *seen) {
    __local uint are_seen[GROUP];
    const uint block = get_group_id(0), lane = get_local_id(0);
    const bool is_own = sees_own(accel_frame, nodes, frusta, block, lane);
    are_seen[lane] = is_own ? 1u : 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (is_own) {
        uint place = counts[block];
        for (uint other = 0u; other < lane; other++) {
            place += are_seen[other];
        }
        seen[place] = nodes[accel_frame->count - 1u + leaf_of(accel_frame, block, lane)].first;
    }
}
