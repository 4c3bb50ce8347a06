// Mirrors parts of core/src/kernel/bound.rs: where points are for measuring lengths, and how far apart.

static float2 point_on_screen(__constant Frame *frame, float near, float3 point) {
    const float3 seen = perspective(frame, near, point);
    return (float2)(clamp(seen.x, neg(FAR_OFF), FAR_OFF), clamp(seen.y, neg(FAR_OFF), FAR_OFF));
}

// Where a point is for measuring lengths: on screen; or on a sheet of pixels that surrounds the eye.
static float3 measured_point(__constant Frame *frame, float near, float3 point) {
    const uint zero = frame->zero;
    if ((frame->flags & FLAG_WHOLE) == 0u) {
        const float2 seen = point_on_screen(frame, near, point);
        return (float3)(seen.x, seen.y, 0.0f);
    }
    const float before = max(neg(point.z), mul(largest3(point), frame->around));
    return scale3(point, mul(frame->focal, recip(max(before, near))));
}

// Where it is as if all were at the near plane, and turned to the eye.
static float3 point_if_cut(__constant Frame *frame, float near, float3 point) {
    const uint zero = frame->zero;
    const float3 there = scale3(point, mul(frame->focal, recip(near)));
    return (float3)(clamp(there.x, neg(FAR_OFF), FAR_OFF), clamp(there.y, neg(FAR_OFF), FAR_OFF),
                    clamp(there.z, neg(FAR_OFF), FAR_OFF));
}

// `distance` in core, which is a function of OpenCL's that may not be called here.
static float distance_of(uint zero, float3 a, float3 b) {
    const float dx = sub(b.x, a.x), dy = sub(b.y, a.y), dz = sub(b.z, a.z);
    return sqrt(add(add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz)), LENGTH_TINY));
}
