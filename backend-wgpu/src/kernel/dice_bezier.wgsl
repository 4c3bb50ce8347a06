// No mirror in core: what stands in the place of `dice_gregory.wgsl` where all patches are Bezier patches.

fn prepare_faces(patch_id: u32, lane: u32) {
}

fn evaluate_any(draw: Draw, row: u32, column: u32) -> Evaluated {
    return evaluate_bezier(draw, row, column);
}
