// No mirror in core: the next chunk of draws and its boxes, a work-group a block.

// The end of the chunk that starts here.
static uint clamped(uint waiting, uint start) {
    const uint end = waiting > start + CHUNK ? start + CHUNK : waiting;
    return end < start ? start : end;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void arrange_draw(__global const Control *control, __global const Draw *draws, __global uint *grids,
                  uint chunk) {
    __local Extents extents;
    const uint lane = get_local_id(0), block = get_group_id(0);
    const uint start = chunk * CHUNK, end = clamped(control->waiting + control->fresh, start);
    const uint item = start + block * BLOCK + lane;
    if (lane == 0u) {
        extents = nothing();
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < end) {
        const uint columns = draws[item].columns, rows = draws[item].rows;
        include(&extents, columns & 0xffffu, rows & 0xffffu);
        include(&extents, columns >> 16, rows >> 16);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane != 0u) {
        return;
    }
    // Of an empty block, a box that nothing touches.
    const bool is_empty = start + block * BLOCK >= end;
    grids[BOXES + 2u * block] = is_empty ? 0u : (uint)extents.low_x | (uint)extents.high_x << 16;
    grids[BOXES + 2u * block + 1u] = is_empty ? 0u : (uint)extents.low_y | (uint)extents.high_y << 16;
    if (block == 0u) {
        grids[HEAD_START] = start;
        grids[HEAD_COUNT] = end - start;
        grids[HEAD_KINDS] = 0u;
        grids[HEAD_KINDS + 1u] = 0u;
    }
}
