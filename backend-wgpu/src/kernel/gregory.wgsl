// Mirrors core/src/patch/gregory.rs: bicubic nets whose four inner points depend on u and v.

// The eight face points in eye space: those of the borders of constant u, then those of constant v.
struct Faces {
    points: array<vec3<f32>, 8>,
}

// How an inner point is blended: share of the face point of the border of constant u, and how it changes.
struct Blend {
    share: f32,
    along_u: f32,
    along_v: f32,
}

// Where inner point `m` stands in a net.
fn inner(m: u32) -> u32 {
    return 5u + m % 2u + 4u * (m / 2u);
}

fn faces_in_eye_space(record: u32, object: u32) -> Faces {
    var faces: Faces;
    for (var l = 0u; l < 8u; l++) {
        faces.points[l] = point_to_eye(object, control_point(record, l));
    }
    return faces;
}

fn faces_extent(all: Faces) -> f32 {
    var faces = all;
    var largest = 0.0;
    for (var l = 0u; l < 8u; l++) {
        largest = max(largest, largest3(faces.points[l]));
    }
    return largest;
}

// From the face point of the border of constant v to the other, at an inner point.
fn difference(of_u: vec3<f32>, of_v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(sub(of_u.x, of_v.x), sub(of_u.y, of_v.y), sub(of_u.z, of_v.z));
}

// An inner point at a share.
fn inner_point(of_u: vec3<f32>, of_v: vec3<f32>, share: f32) -> vec3<f32> {
    return add3(of_v, scale3(difference(of_u, of_v), share));
}

// Distances of the low and high end of a range from the end 0 or 1 of its parameter.
fn ends(range: vec2<u32>, end: u32) -> vec2<f32> {
    if end == 0u {
        return vec2<f32>(param(range.x), param(range.y));
    }
    return vec2<f32>(param(PARAM_ONE - range.x), param(PARAM_ONE - range.y));
}

// The smaller of the two first.
fn distances(range: vec2<u32>, end: u32) -> vec2<f32> {
    let both = ends(range, end);
    return select(both.yx, both, end == 0u);
}

// Largest inner Bernstein weight in a range of distances, or a little more.
fn inner_weight(range: vec2<f32>) -> f32 {
    let rest = sub(1.0, range.x);
    return min(INNER_MOST, mul(mul(3.0, range.y), mul(rest, rest)));
}

fn share_at(a: f32, b: f32) -> f32 {
    return mul(b, recip(max(add(a, b), PARAM_STEP)));
}

// The middle of all shares at distances in two ranges.
fn middle(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return mul(0.5, add(share_at(a.y, b.x), share_at(a.x, b.y)));
}

// A net, and how far the surface can be from the one that it controls.
struct Centred {
    net: Net,
    spread: f32,
}

// The middles of all shares in a range, in the net of the whole patch.
fn centre_inner(all: Faces, whole: Net, range: vec4<u32>, exchanged: bool) -> Centred {
    let along_u = range.xy;
    let along_v = range.zw;
    let first = select(along_u, along_v, exchanged);
    let second = select(along_v, along_u, exchanged);
    var faces = all;
    var out = Centred(whole, 0.0);
    for (var m = 0u; m < 4u; m++) {
        let a = distances(first, m / 2u);
        let b = distances(second, m % 2u);
        let low = share_at(a.y, b.x);
        let high = share_at(a.x, b.y);
        let point = inner_point(faces.points[m], faces.points[4u + m], middle(a, b));
        out.net.x[inner(m)] = point.x;
        out.net.y[inner(m)] = point.y;
        out.net.z[inner(m)] = point.z;
        let weight =
            mul(inner_weight(distances(along_u, m / 2u)), inner_weight(distances(along_v, m % 2u)));
        let half = mul(0.5, sub(high, low));
        let size = largest3(difference(faces.points[m], faces.points[4u + m]));
        out.spread = add(out.spread, mul(mul(half, weight), size));
    }
    return out;
}

fn between(low: f32, high: f32, t: f32) -> f32 {
    return add(low, mul(sub(high, low), t));
}

// Moves the control points of a surface to where the shares at its corners, and between them, take them.
fn follow(all: Faces, from_part: Net, range: vec4<u32>, exchanged: bool) -> Net {
    let along_u = range.xy;
    let along_v = range.zw;
    let first = select(along_u, along_v, exchanged);
    let second = select(along_v, along_u, exchanged);
    var weights_u = blossom(range.x, range.y);
    var weights_v = blossom(range.z, range.w);
    var faces = all;
    var part = from_part;
    for (var m = 0u; m < 4u; m++) {
        let a = ends(first, m / 2u);
        let b = ends(second, m % 2u);
        let away = difference(faces.points[m], faces.points[4u + m]);
        let fixed = middle(distances(first, m / 2u), distances(second, m % 2u));
        let at00 = share_at(a.x, b.x);
        let at01 = share_at(a.x, b.y);
        let at10 = share_at(a.y, b.x);
        let at11 = share_at(a.y, b.y);
        for (var l = 0u; l < 16u; l++) {
            let over_u = mul(float(i32(l / 4u)), THIRD);
            let over_v = mul(float(i32(l % 4u)), THIRD);
            let s = select(over_u, over_v, exchanged);
            let t = select(over_v, over_u, exchanged);
            let here = between(between(at00, at01, t), between(at10, at11, t), s);
            let weight = mul(weights_u.rows[l / 4u][inner(m) / 4u], weights_v.rows[l % 4u][inner(m) % 4u]);
            let moved = scale3(away, mul(weight, sub(here, fixed)));
            part.x[l] = add(part.x[l], moved.x);
            part.y[l] = add(part.y[l], moved.y);
            part.z[l] = add(part.z[l], moved.z);
        }
    }
    return part;
}

// The blend of inner point `m` at a parameter.
fn blend_at(m: u32, u: f32, v: f32) -> Blend {
    let high_u = m / 2u != 0u;
    let high_v = m % 2u != 0u;
    let a = select(u, sub(1.0, u), high_u);
    let b = select(v, sub(1.0, v), high_v);
    let scale = recip(max(add(a, b), PARAM_STEP));
    let share = mul(b, scale);
    let along_a = neg(mul(share, scale));
    let along_b = mul(mul(a, scale), scale);
    return Blend(share, select(along_a, neg(along_a), high_u), select(along_b, neg(along_b), high_v));
}

// The blend as Weber's program has it: with u and v exchanged.
fn weber_blend_at(m: u32, u: f32, v: f32) -> Blend {
    let blend = blend_at(m, v, u);
    return Blend(blend.share, blend.along_v, blend.along_u);
}

// The blend by the rules of the frame's profile.
fn blend_here(m: u32, u: f32, v: f32) -> Blend {
    if (frame.flags & FLAG_WEBER) != 0u {
        return weber_blend_at(m, u, v);
    }
    return blend_at(m, u, v);
}

// The net that the patch has at one parameter.
fn net_at(all: Faces, whole: Net, u: u32, v: u32) -> Net {
    var faces = all;
    var net = whole;
    for (var m = 0u; m < 4u; m++) {
        let point = inner_point(faces.points[m], faces.points[4u + m], blend_here(m, param(u), param(v)).share);
        net.x[inner(m)] = point.x;
        net.y[inner(m)] = point.y;
        net.z[inner(m)] = point.z;
    }
    return net;
}
