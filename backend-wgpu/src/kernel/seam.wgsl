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

// What `longest_chord` found: steps, and the chord's range if `has_chord` is not 0.
struct Chord {
    longest: u32,
    has_chord: u32,
    low: u32,
    high: u32,
}

fn seam(surface: Surface, border: u32) {
    let along_u = border < 2u;
    let size_u = u_size(surface);
    let size_v = v_size(surface);
    let u = surface.u + select(border - 2u, 0u, along_u) * size_u;
    let v = surface.v + select(0u, border, along_u) * size_v;
    var found: Chord;
    if along_u {
        found = longest_chord(border_along_u(v), u, size_u);
    } else {
        found = longest_chord(border_along_v(u), v, size_v);
    }
    seam_longest[border] = found.longest;
    seam_chord[border] = found.has_chord;
    if found.has_chord != 0u {
        seam_ends[2u * border] = project(position_at(select(u, found.low, along_u), select(found.low, v, along_u)));
        seam_ends[2u * border + 1u] =
            project(position_at(select(u, found.high, along_u), select(found.high, v, along_u)));
    }
}

fn border_along_u(v: u32) -> Curve {
    let weights = cubic(param(v));
    return Curve(curve_point(0u, weights), curve_point(1u, weights), curve_point(2u, weights));
}

fn border_along_v(u: u32) -> Curve {
    let weights = cubic(param(u));
    return Curve(curve_along_v(0u, weights), curve_along_v(1u, weights), curve_along_v(2u, weights));
}

// Control points of the curve u = constant, one coordinate.
fn curve_along_v(k: u32, weights: vec4<f32>) -> vec4<f32> {
    let a = net_row(k, 0u);
    let b = net_row(k, 1u);
    let c = net_row(k, 2u);
    let d = net_row(k, 3u);
    return vec4<f32>(
        blend4(weights, vec4<f32>(a.x, b.x, c.x, d.x)),
        blend4(weights, vec4<f32>(a.y, b.y, c.y, d.y)),
        blend4(weights, vec4<f32>(a.z, b.z, c.z, d.z)),
        blend4(weights, vec4<f32>(a.w, b.w, c.w, d.w)),
    );
}

fn longest_chord(curve: Curve, start: u32, size: u32) -> Chord {
    var longest = 1u;
    var ancestor = 2u * size;
    while ancestor <= PARAM_ONE && may_be_drawn(curve, start & ~(ancestor - 1u), ancestor) {
        longest *= 2u;
        ancestor *= 2u;
    }
    let end = start + size;
    let half = end & (0u - end);
    let steps = 2u * half / (size / frame.rate);
    let inside = end != PARAM_ONE && steps > frame.rate && steps <= longest;
    if inside {
        return Chord(longest, 1u, end - half, end + half);
    }
    return Chord(longest, 0u, 0u, 0u);
}

fn may_be_drawn(curve: Curve, start: u32, size: u32) -> bool {
    var weights = blossom(start, start + size);
    var length = 0.0;
    var nearer = false;
    var before = vec2<f32>(0.0, 0.0);
    for (var k = 0u; k < 4u; k++) {
        let w = weights.rows[k];
        let point = vec3<f32>(blend4(w, curve.x), blend4(w, curve.y), blend4(w, curve.z));
        nearer = nearer || neg(point.z) < frame.near;
        let seen = perspective(point);
        let here =
            vec2<f32>(clamp(seen.x, neg(FAR_OFF), FAR_OFF), clamp(seen.y, neg(FAR_OFF), FAR_OFF));
        if k > 0u {
            length = add(length, distance_between(before, here));
        }
        before = here;
    }
    return !nearer && length <= mul(frame.bound, SEAM_ALLOWANCE);
}

fn distance_between(a: vec2<f32>, b: vec2<f32>) -> f32 {
    let dx = sub(b.x, a.x);
    let dy = sub(b.y, a.y);
    return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));
}
