// Mirrors core/src/kernel/project.rs: perspective projection and the snap to fixed point.

struct Vertex {
    x: i32,
    y: i32,
    w: f32,
}

// Pixels right of and below the optical axis, and 1 / distance, of a point that is `near` away or farther, or taken to
// be.
fn perspective(near: f32, point: vec3<f32>) -> vec3<f32> {
    let w = recip(max(neg(point.z), near));
    let scale = mul(frame.focal, w);
    return vec3<f32>(mul(point.x, scale), mul(neg(point.y), scale), w);
}

fn project(point: vec3<f32>) -> Vertex {
    let seen = perspective(frame.near, point);
    let visible = neg(point.z) >= frame.near && abs(seen.x) <= GUARD_BAND && abs(seen.y) <= GUARD_BAND;
    return snapped(vec3<f32>(seen.x, seen.y, select(0.0, seen.z, visible)));
}

fn project_clipped(point: vec3<f32>) -> Vertex {
    return snapped(perspective(frame.near, point));
}

fn snapped(seen: vec3<f32>) -> Vertex {
    let half_pixel = SUBPIXELS / 2;
    return Vertex(
        snap(seen.x) + i32(frame.width) * half_pixel,
        snap(seen.y) + i32(frame.height) * half_pixel,
        seen.z,
    );
}

fn snap(pixels: f32) -> i32 {
    return round(mul(clamp(pixels, neg(GUARD_BAND), GUARD_BAND), float(SUBPIXELS)));
}
