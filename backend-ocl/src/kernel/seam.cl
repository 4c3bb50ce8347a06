// Mirrors core/src/kernel/seam.rs: slivers that close the gap where a border meets a coarser one.

static bool may_be_drawn(__constant Frame *frame, const float4 *curve, uint start, uint size) {
    const uint zero = frame->zero;
    float4 weights[4];
    float x[4], y[4];
    bool nearer = false;
    blossom(zero, start, start + size, weights);
    for (uint k = 0u; k < 4u; k++) {
        const float3 point = (float3)(blend4(zero, weights[k], curve[0]), blend4(zero, weights[k], curve[1]),
                                      blend4(zero, weights[k], curve[2]));
        nearer = nearer || neg(point.z) < frame->near;
        const float3 seen = perspective(frame, point);
        x[k] = clamp(seen.x, neg(FAR_OFF), FAR_OFF);
        y[k] = clamp(seen.y, neg(FAR_OFF), FAR_OFF);
    }
    float length = 0.0f;
    for (uint k = 0u; k < 3u; k++) {
        length = add(length, segment(zero, x, y, k, k + 1u));
    }
    return !nearer && length <= mul(frame->bound, SEAM_ALLOWANCE);
}

// The longest chord, and half of the chord that has the border's end in its middle, or 0.
static uint2 longest_chord(__constant Frame *frame, const float4 *curve, uint start, uint size) {
    uint longest = 1u, ancestor = 2u * size;
    while (ancestor <= PARAM_ONE && may_be_drawn(frame, curve, start & ~(ancestor - 1u), ancestor)) {
        longest *= 2u;
        ancestor *= 2u;
    }
    const uint end = start + size;
    const uint half_chord = end & (0u - end);
    const uint steps = 2u * half_chord / (size / frame->rate);
    const bool inside = end != PARAM_ONE && steps > frame->rate && steps <= longest;
    return (uint2)(longest, inside ? half_chord : 0u);
}

static Seam seam_along_u(__constant Frame *frame, __local const float *net, uint u, uint size, uint v) {
    const uint zero = frame->zero;
    const float4 weights = cubic(zero, param(zero, v));
    float4 curve[3];
    for (uint k = 0u; k < 3u; k++) {
        curve[k] = curve_point(zero, coordinate(net, k), weights);
    }
    const uint2 found = longest_chord(frame, curve, u, size);
    const uint end = u + size;
    const Seam seam = {found.x, found.y, {(uint2)(end - found.y, v), (uint2)(end + found.y, v)}};
    return seam;
}

static float4 column_of(__local const float *c, uint j) {
    return (float4)(c[j], c[4u + j], c[8u + j], c[12u + j]);
}

static Seam seam_along_v(__constant Frame *frame, __local const float *net, uint u, uint v, uint size) {
    const uint zero = frame->zero;
    const float4 weights = cubic(zero, param(zero, u));
    float4 curve[3];
    for (uint k = 0u; k < 3u; k++) {
        __local const float *c = coordinate(net, k);
        curve[k] = (float4)(blend4(zero, weights, column_of(c, 0u)), blend4(zero, weights, column_of(c, 1u)),
                            blend4(zero, weights, column_of(c, 2u)), blend4(zero, weights, column_of(c, 3u)));
    }
    const uint2 found = longest_chord(frame, curve, v, size);
    const uint end = v + size;
    const Seam seam = {found.x, found.y, {(uint2)(u, end - found.y), (uint2)(u, end + found.y)}};
    return seam;
}

// The seam along one of the borders v = low, v = high, u = low and u = high.
static Seam seam_of(__constant Frame *frame, __local const float *net, Surface surface, uint border) {
    const uint size_u = u_size(surface), size_v = v_size(surface);
    const uint high = border & 1u;
    if (border < 2u) {
        return seam_along_u(frame, net, surface.u, size_u, surface.v + high * size_v);
    }
    return seam_along_v(frame, net, surface.u + high * size_u, surface.v, size_v);
}
