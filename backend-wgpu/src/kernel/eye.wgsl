// Mirrors core/src/patch/net.rs (point_to_eye) and core/src/kernel/displace.rs (normal_to_eye): the matrices that move
// points and normals from an object's space to eye space, a row at a time.

fn row_to_eye(object: u32, k: u32) -> vec4<f32> {
    return vec4<f32>(
        objects[object].to_eye[4u * k],
        objects[object].to_eye[4u * k + 1u],
        objects[object].to_eye[4u * k + 2u],
        objects[object].to_eye[4u * k + 3u],
    );
}

fn normal_row_to_eye(object: u32, k: u32) -> vec3<f32> {
    return vec3<f32>(
        objects[object].normal_to_eye[3u * k],
        objects[object].normal_to_eye[3u * k + 1u],
        objects[object].normal_to_eye[3u * k + 2u],
    );
}
