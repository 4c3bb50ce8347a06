// Mirrors core/src/accel/ray.rs (`between`, `offset`): differences of coordinates that are neither too small nor too large.

fn between(start: f32, end: f32, most: f32) -> f32 {
    return clamp(flush(sub(flush(end), flush(start))), neg(most), most);
}

fn offset_to(start: vec3<f32>, end: vec3<f32>, most: f32) -> vec3<f32> {
    return vec3<f32>(between(start.x, end.x, most), between(start.y, end.y, most), between(start.z, end.z, most));
}

fn corner_of(triangle: u32, corner: u32) -> vec3<f32> {
    let at = 3u * corner;
    return vec3<f32>(
        triangles[triangle].corners[at],
        triangles[triangle].corners[at + 1u],
        triangles[triangle].corners[at + 2u],
    );
}
