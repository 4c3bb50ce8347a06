// Mirrors core/src/accel/nearest.rs: how far a point is from a box and from a triangle, squared.

// Differences of coordinates are no larger.
const POINT_FAR: f32 = 268435456.0;

fn begin(probe: Probe) {
    origin = vec3<f32>(probe.origin[0], probe.origin[1], probe.origin[2]);
    limit = probe.far;
}

// How far it is beside a box along one axis.
fn beside(at: f32, low: f32, high: f32) -> f32 {
    return max(max(between(at, low, POINT_FAR), between(high, at, POINT_FAR)), 0.0);
}

// How far away a node's box is, and how far is too far.
fn enter(node: u32) -> vec2<f32> {
    let d = vec3<f32>(
        beside(origin.x, nodes[node].low[0], nodes[node].high[0]),
        beside(origin.y, nodes[node].low[1], nodes[node].high[1]),
        beside(origin.z, nodes[node].low[2], nodes[node].high[2]),
    );
    return vec2<f32>(dot3(d, d), limit);
}

// Is the origin on the inner side of an edge?
fn is_inside(normal: vec3<f32>, start: vec3<f32>, edge: vec3<f32>) -> bool {
    return flush(dot3(flush3(cross3(normal, edge)), start)) <= 0.0;
}

// The square of how far the origin is from a line.
fn to_line(start: vec3<f32>, edge: vec3<f32>) -> f32 {
    let square = flush(dot3(edge, edge));
    if square == 0.0 {
        return dot3(start, start);
    }
    let share = clamp(mul(neg(flush(dot3(start, edge))), recip(square)), 0.0, 1.0);
    let nearest = flush3(add3(start, scale3(edge, flush(share))));
    return dot3(nearest, nearest);
}

fn to_triangle(triangle: u32) -> f32 {
    let a = offset_to(origin, corner_of(triangle, 0u), POINT_FAR);
    let b = offset_to(origin, corner_of(triangle, 1u), POINT_FAR);
    let c = offset_to(origin, corner_of(triangle, 2u), POINT_FAR);
    let ab = offset_to(a, b, POINT_FAR);
    let bc = offset_to(b, c, POINT_FAR);
    let ca = offset_to(c, a, POINT_FAR);
    let normal = flush3(cross3(ab, bc));
    let size = flush(dot3(normal, normal));
    if size > 0.0 && is_inside(normal, a, ab) && is_inside(normal, b, bc) && is_inside(normal, c, ca) {
        let height = flush(mul(flush(dot3(normal, a)), rsqrt(size)));
        return mul(height, height);
    }
    return min(min(to_line(a, ab), to_line(b, bc)), to_line(c, ca));
}

// No triangle is nearer than its box; -1 if it is too far.
fn distance_to(triangle: u32, span: vec2<f32>) -> f32 {
    let distance = max(to_triangle(triangle), span.x);
    return select(neg(1.0), distance, distance <= span.y);
}
