// Mirrors core/src/patch/bezier.rs: Bernstein weights and blossoms of cubic Bezier curves.

fn param(t: u32) -> f32 {
    return mul(float(i32(t)), PARAM_STEP);
}

fn cubic(t: f32) -> vec4<f32> {
    let s = sub(1.0, t);
    let ss = mul(s, s);
    let tt = mul(t, t);
    return vec4<f32>(mul(ss, s), mul(3.0, mul(ss, t)), mul(3.0, mul(tt, s)), mul(tt, t));
}

fn cubic_slope(t: f32) -> vec3<f32> {
    let s = sub(1.0, t);
    return vec3<f32>(mul(3.0, mul(s, s)), mul(6.0, mul(s, t)), mul(3.0, mul(t, t)));
}

fn blend4(w: vec4<f32>, c: vec4<f32>) -> f32 {
    return add(add(mul(w.x, c.x), mul(w.w, c.w)), add(mul(w.y, c.y), mul(w.z, c.z)));
}

fn blend3(w: vec3<f32>, c: vec3<f32>) -> f32 {
    return add(add(mul(w.x, c.x), mul(w.z, c.z)), mul(w.y, c.y));
}

// Weights of the old control points in new control point 0, 1, 2 and 3 of the part between two parameters.
struct Blossom {
    rows: array<vec4<f32>, 4>,
}

fn blossom(from_t: u32, to_t: u32) -> Blossom {
    let a = param(from_t);
    let b = param(to_t);
    let s = sub(1.0, a);
    let r = sub(1.0, b);
    let sr = mul(s, r);
    let sb = mul(s, b);
    let ar = mul(a, r);
    let ab = mul(a, b);
    let mixed = add(sb, ar);
    var out: Blossom;
    out.rows[0] = cubic(a);
    out.rows[1] = vec4<f32>(
        mul(s, sr), add(mul(s, mixed), mul(a, sr)), add(mul(a, mixed), mul(s, ab)), mul(a, ab));
    out.rows[2] = vec4<f32>(
        mul(r, sr), add(mul(r, mixed), mul(b, sr)), add(mul(b, mixed), mul(r, ab)), mul(b, ab));
    out.rows[3] = cubic(b);
    return out;
}
