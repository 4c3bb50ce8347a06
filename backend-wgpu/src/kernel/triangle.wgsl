// Mirrors core/src/kernel/triangle.rs: coverage by integer edge functions, depth by exact weights; where samples lie is in
// `site.wgsl`.
//
// Edge functions need 64-bit integers, which WGSL has not: they are pairs of words (`wide.wgsl`). Where all corners lie
// within 64 pixels of the sample they fit 32 bits, which gives the same answers faster.

// A snapped vertex as seen from a sample.
struct Corner {
    x: i32,
    y: i32,
    w: f32,
}

fn corner(vertex: Vertex, at: vec2<i32>) -> Corner {
    return Corner(vertex.x - at.x, vertex.y - at.y, vertex.w);
}

// What a triangle shows at a sample: 1 / distance, 0 if it does not own it; shares of the second and the third corner.
struct Hit {
    w: f32,
    for_b: f32,
    for_c: f32,
}

const NO_HIT: Hit = Hit(0.0, 0.0, 0.0);

fn wide_edge(a: Corner, b: Corner) -> Wide {
    return wide_sub(wide_mul(a.x, b.y), wide_mul(a.y, b.x));
}

fn edge(a: Corner, b: Corner) -> i32 {
    return a.x * b.y - a.y * b.x;
}

fn int_sign(a: i32) -> i32 {
    return select(select(0, 1, a > 0), -1, a < 0);
}

// `edges` are the signs of the values of the edges opposite the corners, `area` that of their sum.
fn owns(a: Corner, b: Corner, c: Corner, edges: vec3<i32>, area: i32) -> bool {
    if edges.x != 0 && edges.y != 0 && edges.z != 0 {
        return edges.x == edges.y && edges.y == edges.z;
    }
    return area != 0
        && owns_border(b, c, edges.x, area)
        && owns_border(c, a, edges.y, area)
        && owns_border(a, b, edges.z, area);
}

fn owns_border(before: Corner, after: Corner, edge_sign: i32, area: i32) -> bool {
    let value = edge_sign * area;
    let dx = (after.x - before.x) * area;
    let dy = (after.y - before.y) * area;
    return value > 0 || (value == 0 && (dy < 0 || (dy == 0 && dx > 0)));
}

// From area and weights that fit 24 bits.
fn hit(w: vec3<f32>, area: u32, for_b: u32, for_c: u32) -> Hit {
    let share = recip(float(i32(area)));
    let share_b = mul(float(i32(for_b)), share);
    let share_c = mul(float(i32(for_c)), share);
    return Hit(weighted(w, share_b, share_c), share_b, share_c);
}

// A value of three corners at a place inside the triangle, given the shares of the second and the third.
fn weighted(value: vec3<f32>, for_b: f32, for_c: f32) -> f32 {
    let a = value.x;
    let mean = add(a, add(mul(for_b, sub(value.y, a)), mul(for_c, sub(value.z, a))));
    return clamp(mean, min(min(a, value.y), value.z), max(max(a, value.y), value.z));
}

// Bits by which an area must be shifted to fit a float's mantissa, from its leading zeros in 64 bits.
fn spare_bits(leading_zeros: u32) -> u32 {
    return select(40u - leading_zeros, 0u, leading_zeros > 40u);
}

fn near(a: Corner) -> bool {
    return (magnitude(a.x) | magnitude(a.y)) < 16384u;
}

fn sample_triangle(a: Vertex, b: Vertex, c: Vertex, at: vec2<i32>) -> Hit {
    let p = corner(a, at);
    let q = corner(b, at);
    let r = corner(c, at);
    if near(p) && near(q) && near(r) {
        return sample_near(p, q, r);
    }
    return sample_wide(p, q, r);
}

fn sample_near(a: Corner, b: Corner, c: Corner) -> Hit {
    let ea = edge(b, c);
    let eb = edge(c, a);
    let ec = edge(a, b);
    let area = ea + eb + ec;
    if !owns(a, b, c, vec3<i32>(int_sign(ea), int_sign(eb), int_sign(ec)), int_sign(area)) {
        return NO_HIT;
    }
    let whole = magnitude(area);
    let spare = spare_bits(32u + countLeadingZeros(whole));
    let w = vec3<f32>(a.w, b.w, c.w);
    return hit(w, whole >> spare, magnitude(eb) >> spare, magnitude(ec) >> spare);
}

fn sample_wide(a: Corner, b: Corner, c: Corner) -> Hit {
    let ea = wide_edge(b, c);
    let eb = wide_edge(c, a);
    let ec = wide_edge(a, b);
    let area = wide_add(wide_add(ea, eb), ec);
    let signs = vec3<i32>(wide_sign(ea), wide_sign(eb), wide_sign(ec));
    if !owns(a, b, c, signs, wide_sign(area)) {
        return NO_HIT;
    }
    let whole = wide_abs(area);
    let spare = spare_bits(wide_leading_zeros(whole));
    let w = vec3<f32>(a.w, b.w, c.w);
    return hit(
        w,
        wide_shifted(whole, spare),
        wide_shifted(wide_abs(eb), spare),
        wide_shifted(wide_abs(ec), spare),
    );
}

// Sign of the area of a triangle on screen: -1 if it runs anticlockwise.
fn signed_area(a: Vertex, b: Vertex, c: Vertex) -> i32 {
    let to_b = Corner(b.x - a.x, b.y - a.y, 0.0);
    let to_c = Corner(c.x - a.x, c.y - a.y, 0.0);
    return wide_sign(wide_edge(to_b, to_c));
}
