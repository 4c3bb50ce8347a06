// Mirrors core/src/accel/bsp/cells.rs: how many pieces the cells have, far to near. One work-item a cell.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_bsp_cells(__global const BspFrame *bsp_frame, __global const uint *first_pieces, __global uint *counts) {
    const uint cell = get_global_id(0);
    if (cell < bsp_frame->cells) {
        counts[place_of(bsp_frame, cell)] = first_pieces[cell + 1u] - first_pieces[cell];
    }
}
