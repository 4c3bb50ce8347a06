// Mirrors core/src/kernel/seam.rs: how the borders of a grid are closed where they meet coarser ones.

// Per border (v = low, v = high, u = low, u = high): longest chord of a neighbour, in steps.
var<workgroup> seam_longest: array<u32, 4>;
// Is there a chord whose middle is the border's upper corner, and its two ends on screen.
var<workgroup> seam_chord: array<u32, 4>;
var<workgroup> seam_ends: array<Vertex, 8>;

// Control points of a border curve, a coordinate each.
struct Curve {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

// One border of a surface: along it one parameter is fixed, and the other runs through a range.
struct Border {
    along_u: bool,
    // The parameter that is fixed.
    at: u32,
    start: u32,
    size: u32,
}

fn seam(surface: Surface, number: u32) {
    let border = border_of(surface, number);
    let longest = longest_any(border);
    let half = chord_beyond(border, longest);
    seam_longest[number] = longest;
    seam_chord[number] = 0u;
    if half != 0u {
        let end = border.start + border.size;
        let low = chord_point(border, end - half);
        let high = chord_point(border, end + half);
        seam_ends[2u * number] = project(low);
        seam_ends[2u * number + 1u] = project(high);
        seam_chord[number] = select(0u, 1u, are_in_reach(border, low, high));
    }
}

fn border_of(surface: Surface, number: u32) -> Border {
    let size_u = u_size(surface);
    let size_v = v_size(surface);
    if number < 2u {
        return Border(true, surface.v + number * size_v, surface.u, size_u);
    }
    return Border(false, surface.u + (number - 2u) * size_u, surface.v, size_v);
}

// The same border of the surface of this size that contains it.
fn ancestor(border: Border, size: u32) -> Border {
    return Border(border.along_u, border.at, border.start & ~(size - 1u), size);
}

fn chord_point(border: Border, t: u32) -> vec3<f32> {
    return position_any(select(border.at, t, border.along_u), select(t, border.at, border.along_u));
}

// The curve of the net that a border lies on.
fn border_curve(border: Border) -> Curve {
    let weights = cubic(param(border.at));
    if border.along_u {
        return Curve(curve_point(0u, weights), curve_point(1u, weights), curve_point(2u, weights));
    }
    return Curve(curve_along_v(0u, weights), curve_along_v(1u, weights), curve_along_v(2u, weights));
}

// Control points of the curve u = constant, one coordinate.
fn curve_along_v(k: u32, weights: vec4<f32>) -> vec4<f32> {
    return blend_columns(weights, net_row(k, 0u), net_row(k, 1u), net_row(k, 2u), net_row(k, 3u));
}

fn blend_columns(weights: vec4<f32>, a: vec4<f32>, b: vec4<f32>, c: vec4<f32>, d: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(
        blend4(weights, vec4<f32>(a.x, b.x, c.x, d.x)),
        blend4(weights, vec4<f32>(a.y, b.y, c.y, d.y)),
        blend4(weights, vec4<f32>(a.z, b.z, c.z, d.z)),
        blend4(weights, vec4<f32>(a.w, b.w, c.w, d.w)),
    );
}

// Control points of the part of such a curve that is the border.
fn part_of(border: Border, curve: Curve) -> Curve {
    let weights = blossom(border.start, border.start + border.size);
    return Curve(part_along(weights, curve.x), part_along(weights, curve.y), part_along(weights, curve.z));
}

fn part_along(weights: Blossom, c: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(
        blend4(weights.rows[0], c),
        blend4(weights.rows[1], c),
        blend4(weights.rows[2], c),
        blend4(weights.rows[3], c),
    );
}

// Half of the chord that has the border's end in its middle, or 0.
fn chord_beyond(border: Border, longest: u32) -> u32 {
    let end = border.start + border.size;
    let half = end & (0u - end);
    let steps = 2u * half / (border.size / frame.rate);
    let inside = end != PARAM_ONE && steps > frame.rate && steps <= longest;
    return select(0u, half, inside);
}

fn longest_chord(border: Border) -> u32 {
    let curve = border_curve(border);
    var longest = 1u;
    var size = 2u * border.size;
    while size <= PARAM_ONE && may_be_drawn(part_of(ancestor(border, size), curve)) {
        longest *= 2u;
        size *= 2u;
    }
    return longest;
}

fn may_be_drawn(part: Curve) -> bool {
    var nearer = false;
    for (var k = 0u; k < 4u; k++) {
        nearer = nearer || neg(part.z[k]) < frame.near;
    }
    return !nearer && is_short(part);
}

fn is_short(part: Curve) -> bool {
    let a = seen_at(part.x.x, part.y.x, part.z.x);
    let b = seen_at(part.x.y, part.y.y, part.z.y);
    let c = seen_at(part.x.z, part.y.z, part.z.z);
    let d = seen_at(part.x.w, part.y.w, part.z.w);
    let length = add(add(add(0.0, distance_between(a, b)), distance_between(b, c)), distance_between(c, d));
    return length <= mul(frame.bound, SEAM_ALLOWANCE);
}

fn seen_at(x: f32, y: f32, z: f32) -> vec2<f32> {
    let seen = perspective(vec3<f32>(x, y, z));
    return vec2<f32>(clamp(seen.x, neg(FAR_OFF), FAR_OFF), clamp(seen.y, neg(FAR_OFF), FAR_OFF));
}

fn distance_between(a: vec2<f32>, b: vec2<f32>) -> f32 {
    let dx = sub(b.x, a.x);
    let dy = sub(b.y, a.y);
    return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));
}
