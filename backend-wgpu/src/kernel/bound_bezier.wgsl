// Mirrors core/src/kernel/bound.rs: what of it concerns Bezier patches only that have their sides for themselves and are
// not displaced, no two objects the same ones, in our own profile, by size, seen by a camera. Most scenes need no more, and
// a software device would run the rest for nothing.

fn bound_any(surface: Surface) -> Verdict {
    return bound(surface);
}

fn is_whole() -> bool {
    return false;
}

fn is_flat() -> bool {
    return false;
}

fn is_displaced() -> bool {
    return false;
}

fn measured_from() -> f32 {
    return frame.near;
}

// Position of a vertex by itself.
fn position_any(hull: Hull, u: u32, v: u32) -> vec3<f32> {
    return position_at(hull.whole, u, v);
}

fn measured_point(point: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(point_on_screen(frame.near, point), 0.0);
}

// Lengths on screen of a hull whose control points are measured to be at `points`.
fn lengths_of(surface: Surface, hull: Hull, points: Net) -> Lengths {
    return lengths_of_polygons(polygons_u(points), polygons_v(points));
}

// Where a corner is that has strayed.
fn stray_at(point: vec3<f32>) -> Strays {
    let seen = point_on_screen(frame.near, point);
    let distance = neg(point.z);
    return Strays(Reach(seen.x, seen.x), Reach(seen.y, seen.y), Reach(distance, distance), true);
}

fn wobble_of(points: Net, spread: f32, nearest: f32) -> f32 {
    return 0.0;
}

fn by_extents(surface: Surface, extents: vec2<f32>) -> u32 {
    return by_size(surface, extents);
}

fn most_splits() -> u32 {
    return MAX_SPLITS;
}

fn stays_live(surface: Surface, side: u32) -> bool {
    return false;
}
