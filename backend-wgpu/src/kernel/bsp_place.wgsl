// Mirrors core/src/accel/bsp/cells.rs: the places of cells, far to near. Whoever includes it has `bsp_frame`.

fn far_to_near(axis: u32, slab: u32) -> u32 {
    let eye_slab = bsp_frame.eye_slabs[axis];
    return select(eye_slab + (bsp_frame.slabs[axis] - 1u - slab), slab, slab < eye_slab);
}

fn place_of(cell: u32) -> u32 {
    let rows = bsp_frame.slabs[1];
    let columns = bsp_frame.slabs[2];
    let row = cell / columns;
    let place = far_to_near(0u, row / rows) * rows + far_to_near(1u, row % rows);
    return place * columns + far_to_near(2u, cell % columns);
}
