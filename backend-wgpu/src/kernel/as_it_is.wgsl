// Mirrors core/src/kernel/mesh.rs (AS_IT_IS): control points stay in the space of their object. What stands in the
// place of `eye.wgsl`.

// One coordinate (0, 1, 2) of control point `l`: the same sum, which turns -0 into 0, of numbers that no compiler
// knows.
fn transformed(patch_id: u32, k: u32, l: u32) -> f32 {
    let row = vec4<f32>(one_if(k == 0u), one_if(k == 1u), one_if(k == 2u), one_if(false));
    return row_of_matrix(row, control_point(patch_id, l));
}

fn one_if(is_own: bool) -> f32 {
    return exactly(select(0.0, 1.0, is_own));
}
