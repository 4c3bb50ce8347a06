// Mirrors core/src/kernel/flat.rs: how far triangles can be, on screen, from the part of a patch that they stand for.

// How far a part of a patch, given its control points, is from triangles in it.
fn part_flatness(part: Net) -> f32 {
    var bent_u = 0.0;
    var bent_v = 0.0;
    var twisted = 0.0;
    var nearest = before_eye(net_point(part, 0u));
    for (var i = 0u; i < 4u; i++) {
        for (var j = 0u; j < 4u; j++) {
            let at = 4u * i + j;
            let a = net_point(part, at);
            nearest = min(nearest, before_eye(a));
            if i < 2u {
                bent_u = max(bent_u, bend(a, net_point(part, at + 4u), net_point(part, at + 8u)));
            }
            if j < 2u {
                bent_v = max(bent_v, bend(a, net_point(part, at + 1u), net_point(part, at + 2u)));
            }
            if i < 3u && j < 3u {
                let b = net_point(part, at + 1u);
                twisted = max(twisted, twist(a, b, net_point(part, at + 4u), net_point(part, at + 5u)));
            }
        }
    }
    let bent = mul(0.75, add(length_of(bent_u), length_of(bent_v)));
    return mul(add(bent, mul(2.25, length_of(twisted))), recip(max(nearest, measured_from())));
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
    let bent = max(bend(a, b, c), bend(b, c, d));
    let nearest = min(min(before_eye(a), before_eye(d)), min(before_eye(b), before_eye(c)));
    return mul(mul(0.75, length_of(bent)), recip(max(nearest, measured_from())));
}

// How many times as flat as a surface a line must be of which a piece 2^bits units long is looked at.
fn strictness(bits: u32) -> f32 {
    return add(1.0, mul(LINE_SHARE, float(i32(bits))));
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

// Squared length on screen, times the distance, of a small step at a point.
fn step_seen(at: vec3<f32>, way: vec3<f32>) -> f32 {
    if is_whole() {
        return mul(mul(frame.focal, frame.focal), dot3(way, way));
    }
    let scale = mul(frame.focal, recip(max(neg(at.z), measured_from())));
    let x = clamp(mul(at.x, scale), neg(frame.centre_x), frame.centre_x);
    let y = clamp(mul(at.y, scale), neg(frame.centre_y), frame.centre_y);
    let on_screen = vec3<f32>(
        add(mul(way.x, frame.focal), mul(x, way.z)), add(mul(way.y, frame.focal), mul(y, way.z)), 0.0);
    return dot3(on_screen, on_screen);
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

// Squared length of a second difference; the same from either end.
fn bend(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> f32 {
    return step_seen(b, add3(difference(a, b), difference(c, b)));
}

// Squared length of a difference of differences.
fn twist(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> f32 {
    return step_seen(a, difference(add3(a, d), add3(b, c)));
}

fn length_of(square: f32) -> f32 {
    return sqrt(add(square, LENGTH_TINY));
}
