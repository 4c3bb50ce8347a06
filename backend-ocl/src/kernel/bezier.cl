// Mirrors core/src/patch/bezier.rs: Bernstein weights and blossoms of cubic Bézier curves.

static float param(uint zero, uint t) {
    return mul(number((int)t), PARAM_STEP);
}

static float4 cubic(uint zero, float t) {
    const float s = sub(1.0f, t);
    const float ss = mul(s, s), tt = mul(t, t);
    return (float4)(mul(ss, s), mul(3.0f, mul(ss, t)), mul(3.0f, mul(tt, s)), mul(tt, t));
}

static float3 cubic_slope(uint zero, float t) {
    const float s = sub(1.0f, t);
    return (float3)(mul(3.0f, mul(s, s)), mul(6.0f, mul(s, t)), mul(3.0f, mul(t, t)));
}

static float blend4(uint zero, float4 w, float4 c) {
    return add(add(mul(w.x, c.x), mul(w.w, c.w)), add(mul(w.y, c.y), mul(w.z, c.z)));
}

static float blend3(uint zero, float3 w, float3 c) {
    return add(add(mul(w.x, c.x), mul(w.z, c.z)), mul(w.y, c.y));
}

// Four rows of weights into `rows`.
static void blossom(uint zero, uint from, uint to, float4 *rows) {
    const float a = param(zero, from), b = param(zero, to);
    const float s = sub(1.0f, a), r = sub(1.0f, b);
    const float sr = mul(s, r), sb = mul(s, b), ar = mul(a, r), ab = mul(a, b);
    const float mixed = add(sb, ar);
    rows[0] = cubic(zero, a);
    rows[1] = (float4)(mul(s, sr), add(mul(s, mixed), mul(a, sr)), add(mul(a, mixed), mul(s, ab)), mul(a, ab));
    rows[2] = (float4)(mul(r, sr), add(mul(r, mixed), mul(b, sr)), add(mul(b, mixed), mul(r, ab)), mul(b, ab));
    rows[3] = cubic(zero, b);
}
