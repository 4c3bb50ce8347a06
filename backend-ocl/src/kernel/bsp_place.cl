// Mirrors core/src/accel/bsp/cells.rs: the places of cells, far to near.

static uint far_to_near(__global const BspFrame *frame, uint axis, uint slab) {
    const uint eye_slab = frame->eye_slabs[axis];
    return slab < eye_slab ? slab : eye_slab + (frame->slabs[axis] - 1u - slab);
}

static uint place_of(__global const BspFrame *frame, uint cell) {
    const uint rows = frame->slabs[1], columns = frame->slabs[2];
    const uint row = cell / columns;
    const uint place = far_to_near(frame, 0u, row / rows) * rows + far_to_near(frame, 1u, row % rows);
    return place * columns + far_to_near(frame, 2u, cell % columns);
}
