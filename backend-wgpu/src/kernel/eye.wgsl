// Mirrors core/src/patch/net.rs (transformed): control points in eye space.

// One eye-space coordinate (0, 1, 2) of control point `l`.
fn transformed(patch_id: u32, k: u32, l: u32) -> f32 {
    let object = object_of(patch_id);
    let row = vec4<f32>(
        objects[object].to_eye[4u * k],
        objects[object].to_eye[4u * k + 1u],
        objects[object].to_eye[4u * k + 2u],
        objects[object].to_eye[4u * k + 3u],
    );
    return row_of_matrix(row, control_point(patch_id, l));
}
