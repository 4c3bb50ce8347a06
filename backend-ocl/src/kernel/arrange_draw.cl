// No mirror in core: the next chunk of draws.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void arrange_draw(__global const Control *control, __global uint *grids, uint chunk) {
    const uint start = chunk * CHUNK;
    if (get_local_id(0) == 0u) {
        grids[HEAD_START] = start;
        grids[HEAD_COUNT] = lesser_of(saturating_sub(control->waiting + control->fresh, start), CHUNK);
        grids[HEAD_KINDS] = 0u;
        grids[HEAD_KINDS + 1u] = 0u;
    }
}
