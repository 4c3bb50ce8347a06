// Mirrors core/src/kernel/flat.rs: how far a surface is, on screen, from the one micropolygon that would be drawn for it.

// How far a part of a patch, given its control points, is from its two triangles, whatever its sides are.
fn part_flatness(part: Net) -> f32 {
    let a = net_point(part, 0u);
    let b = net_point(part, 3u);
    let c = net_point(part, 12u);
    let d = net_point(part, 15u);
    var most = 0.0;
    var nearest = before_eye(a);
    for (var l = 0u; l < 16u; l++) {
        let point = net_point(part, l);
        let even = raised(raised(a, c, l / 4u), raised(b, d, l / 4u), l % 4u);
        most = max(most, apart(point, even));
        nearest = min(nearest, before_eye(point));
    }
    // The two triangles are farthest from the bilinear patch in its middle.
    let ridge = midpoint(a, d);
    let twist = apart(ridge, midpoint(ridge, midpoint(b, c)));
    return mul(add(most, twist), pixels_at(max(nearest, measured_from())));
}

// The control points of a side of a part of a patch.
fn side_line(part: Net, side: u32) -> Line {
    var line: Line;
    line.points[0] = point_of_side(part, side, vec4<u32>(0u, 3u, 0u, 12u));
    line.points[1] = point_of_side(part, side, vec4<u32>(4u, 7u, 1u, 13u));
    line.points[2] = point_of_side(part, side, vec4<u32>(8u, 11u, 2u, 14u));
    line.points[3] = point_of_side(part, side, vec4<u32>(12u, 15u, 3u, 15u));
    return line;
}

// One of four points, a side each; chosen rather than indexed, since what lies in registers has no index.
fn point_of_side(part: Net, side: u32, at: vec4<u32>) -> vec3<f32> {
    let is_last = (side & 1u) != 0u;
    let along_u = select(net_point(part, at.x), net_point(part, at.y), is_last);
    let along_v = select(net_point(part, at.z), net_point(part, at.w), is_last);
    return select(along_v, along_u, side < 2u);
}

// How far a line is from its chord.
fn line_flatness(line: Line) -> f32 {
    let a = line.points[0];
    let b = line.points[1];
    let c = line.points[2];
    let d = line.points[3];
    let most = max(apart(b, raised(a, d, 1u)), apart(c, raised(a, d, 2u)));
    let nearest = min(min(before_eye(a), before_eye(d)), min(before_eye(b), before_eye(c)));
    return mul(most, pixels_at(max(nearest, measured_from())));
}

// How many times as flat as a surface a line must be of which a piece 2^bits units long is looked at.
fn strictness(bits: u32) -> f32 {
    return add(2.0, mul(LINE_SHARE, float(i32(bits))));
}

// The range around three vertices.
fn range_around(a: vec2<u32>, b: vec2<u32>, c: vec2<u32>) -> vec4<u32> {
    let low = lower(a, lower(b, c));
    let high = higher(a, higher(b, c));
    return vec4<u32>(low.x, high.x, low.y, high.y);
}

fn lower(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return select(b, a, a < b);
}

fn higher(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return select(b, a, a > b);
}

// Pixels that a length of 1 has at most in the image, so far before the eye, whichever way it lies.
fn pixels_at(before: f32) -> f32 {
    let corner = vec3<f32>(frame.focal, frame.centre_x, frame.centre_y);
    return mul(sqrt(dot3(corner, corner)), recip(before));
}

// How far before the eye a point is; if the mesh is to be whole, as if the eye had turned to it.
fn before_eye(point: vec3<f32>) -> f32 {
    let before = neg(point.z);
    if !is_whole() {
        return before;
    }
    return max(before, mul(largest3(point), frame.around));
}

fn net_point(net: Net, l: u32) -> vec3<f32> {
    return vec3<f32>(net.x[l], net.y[l], net.z[l]);
}

// Control point k of four on the line between two points.
fn raised(a: vec3<f32>, b: vec3<f32>, k: u32) -> vec3<f32> {
    let near_end = select(a, b, k > 1u);
    let far_end = select(b, a, k > 1u);
    let third = vec3<f32>(
        between_thirds(near_end.x, far_end.x),
        between_thirds(near_end.y, far_end.y),
        between_thirds(near_end.z, far_end.z),
    );
    return select(third, near_end, k == 0u || k == 3u);
}

// A third of the way from one number to another.
fn between_thirds(a: f32, b: f32) -> f32 {
    return mul(add(add(a, a), b), THIRD);
}

fn midpoint(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return scale3(add3(a, b), 0.5);
}

// Distance of two points in eye space.
fn apart(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return distance_of(a, b);
}
