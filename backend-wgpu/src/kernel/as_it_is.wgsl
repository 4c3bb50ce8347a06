// Mirrors core/src/kernel/mesh.rs (AS_IT_IS, NORMALS_AS_THEY_ARE): points and normals stay in the space of their
// object. What stands in the place of `eye.wgsl`.

// A row of numbers that no compiler knows: so they are summed as any others, which turns -0 into 0.
fn row_to_eye(object: u32, k: u32) -> vec4<f32> {
    return vec4<f32>(normal_row_to_eye(object, k), one_if(false));
}

fn normal_row_to_eye(object: u32, k: u32) -> vec3<f32> {
    return vec3<f32>(one_if(k == 0u), one_if(k == 1u), one_if(k == 2u));
}

fn one_if(is_own: bool) -> f32 {
    return exactly(select(0.0, 1.0, is_own));
}
