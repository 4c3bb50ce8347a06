// No mirror in core: what stands in the place of `dice_gregory.wgsl` and `seam_gregory.wgsl` where all patches are Bezier patches.

fn prepare_faces(patch_id: u32, lane: u32) {
}

fn evaluate_any(surface: Surface, row: u32, column: u32) -> Evaluated {
    return evaluate(row, column);
}

fn position_any(u: u32, v: u32) -> vec3<f32> {
    return position_at(u, v);
}

fn longest_any(border: Border) -> u32 {
    return longest_chord(border);
}

fn are_in_reach(border: Border, low: vec3<f32>, high: vec3<f32>) -> bool {
    return true;
}
