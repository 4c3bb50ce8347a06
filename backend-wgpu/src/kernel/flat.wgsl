// Mirrors core/src/kernel/flat.rs: how far a surface is, on screen, from the one micropolygon that would be drawn for it.

// How far a surface, given the control points of it or of more than it, is from its two triangles, and its sides from
// their chords; `is_cut`: measured as if it were at the near plane, and turned to the eye.
fn flatness(is_cut: bool, part: Net) -> Lengths {
    let low_first = net_corner(part, 0u);
    let low_last = net_corner(part, 3u);
    let high_first = net_corner(part, 12u);
    let high_last = net_corner(part, 15u);
    var off: array<f32, 16>;
    var most = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let a = raised(low_first, high_first, i);
        let b = raised(low_last, high_last, i);
        for (var j = 0u; j < 4u; j++) {
            let l = 4u * i + j;
            off[l] = distance_seen(is_cut, net_corner(part, l), raised(a, b, j));
            most = max(most, off[l]);
        }
    }
    let sides = vec4<f32>(
        mul(LINE_SHARE, max(off[4], off[8])),
        mul(LINE_SHARE, max(off[7], off[11])),
        mul(LINE_SHARE, max(off[1], off[2])),
        mul(LINE_SHARE, max(off[13], off[14])),
    );
    // The two triangles are farthest from the bilinear patch in its middle.
    let ridge = midpoint(low_first, high_last);
    let other = midpoint(low_last, high_first);
    let whole = add(most, distance_seen(is_cut, ridge, midpoint(ridge, other)));
    return with_own_sides(Lengths(whole, whole, sides), sides);
}

// How far a line is from its chord.
fn line_flatness(line: Line) -> f32 {
    var points = line.points;
    let from_b = distance_seen(false, points[1], raised(points[0], points[3], 1u));
    let from_c = distance_seen(false, points[2], raised(points[0], points[3], 2u));
    return mul(LINE_SHARE, max(from_b, from_c));
}

// How far a line inside a Gregory patch is from its chord, from five points of it, a quarter of it apart.
fn chord_flatness(line: array<vec3<f32>, 5>) -> f32 {
    let half = midpoint(line[0], line[4]);
    let from_b = distance_seen(false, line[1], midpoint(line[0], half));
    let from_d = distance_seen(false, line[3], midpoint(line[4], half));
    let most = max(max(from_b, from_d), distance_seen(false, line[2], half));
    return mul(LINE_SHARE, add(most, mul(most, QUARTER)));
}

// What of a surface has to be flat: all that its vertices enclose, those too that have strayed from it.
fn enclosed(surface: Surface) -> vec4<u32> {
    var range = range_of(surface);
    for (var corner = 0u; corner < 4u; corner++) {
        let at = corner_at(surface, corner);
        range.x = select(range.x, at.x, at.x < range.x);
        range.z = select(range.z, at.y, at.y < range.z);
    }
    return range;
}

fn net_corner(net: Net, l: u32) -> vec3<f32> {
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

// Distance of two points on screen.
fn distance_seen(is_cut: bool, a: vec3<f32>, b: vec3<f32>) -> f32 {
    return distance_of(point_seen(is_cut, a), point_seen(is_cut, b));
}

fn point_seen(is_cut: bool, point: vec3<f32>) -> vec3<f32> {
    if is_cut {
        return point_if_cut(point);
    }
    return measured_point(point);
}
