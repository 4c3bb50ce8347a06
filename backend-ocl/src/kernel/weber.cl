// Mirrors core/src/kernel/weber.rs: the verdict on a surface as Weber's program reaches it.

static uint weber_split(Surface surface, bool along_u) {
    if (along_u) {
        return u_level(surface) < WEBER_SPLITS ? SPLIT_U : CULL;
    }
    return v_level(surface) < WEBER_SPLITS ? SPLIT_V : CULL;
}

// Is a range of one coordinate more than the margin outside of the image, `half_size` pixels to either side?
static bool is_beside(uint zero, float2 range, float2 scale, float focal, float half_size) {
    const float low = mul(mul(range.x, range.x < 0.0f ? scale.x : scale.y), focal);
    const float high = mul(mul(range.y, range.y > 0.0f ? scale.x : scale.y), focal);
    const float last = sub(add(half_size, half_size), 1.0f);
    return add(low, half_size) > add(last, WEBER_MARGIN) || add(high, half_size) < neg(WEBER_MARGIN);
}

static bool is_outside(__constant Frame *frame, float3 low, float3 high) {
    const uint zero = frame->zero;
    const float nearest = neg(high.z), farthest = neg(low.z);
    if (farthest < frame->near || nearest > WEBER_FAR) {
        return true;
    }
    const float2 scale = (float2)(recip(max(frame->near, nearest)), recip(farthest));
    return is_beside(zero, (float2)(low.x, high.x), scale, frame->focal, frame->centre_x)
        || is_beside(zero, (float2)(low.y, high.y), scale, frame->focal, frame->centre_y);
}

static float2 weber_on_screen(__constant Frame *frame, float3 point) {
    const uint zero = frame->zero;
    const float size = recip(max(abs(point.z), WEBER_TINY));
    const float scale = mul(frame->focal, point.z > 0.0f ? neg(size) : size);
    return (float2)(clamp(mul(point.x, scale), neg(WEBER_FAR_OFF), WEBER_FAR_OFF),
                    clamp(mul(point.y, scale), neg(WEBER_FAR_OFF), WEBER_FAR_OFF));
}

static float weber_segment(uint zero, float2 a, float2 b) {
    const float dx = sub(b.x, a.x), dy = sub(b.y, a.y);
    return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));
}

static float polyline(uint zero, float2 a, float2 b, float2 c) {
    return add(weber_segment(zero, a, b), weber_segment(zero, b, c));
}

// Lengths of the longest polylines along u and along v.
static float2 weber_lengths(__constant Frame *frame, const float3 *points) {
    const uint zero = frame->zero;
    float2 seen[9];
    for (uint k = 0u; k < 9u; k++) {
        seen[k] = weber_on_screen(frame, points[k]);
    }
    float along_u = 0.0f, along_v = 0.0f;
    for (uint k = 0u; k < 3u; k++) {
        along_u = max(along_u, polyline(zero, seen[k], seen[3u + k], seen[6u + k]));
        along_v = max(along_v, polyline(zero, seen[3u * k], seen[3u * k + 1u], seen[3u * k + 2u]));
    }
    return (float2)(along_u, along_v);
}

static uint weber_code(__constant Frame *frame, Net *net, const Faces *faces, bool is_gregory, Surface surface) {
    const uint zero = frame->zero;
    if (level(surface) + 1u >= frame->levels) {
        return CULL;
    }
    float3 points[9];
    for (uint k = 0u; k < 9u; k++) {
        const uint u = surface.u + k / 3u * (u_size(surface) / 2u);
        points[k] = point_at(frame, net, faces, is_gregory, u, surface.v + k % 3u * (v_size(surface) / 2u));
    }
    float3 low = points[0], high = points[0];
    for (uint k = 0u; k < 9u; k++) {
        const float3 p = points[k];
        low = (float3)(min(low.x, p.x), min(low.y, p.y), min(low.z, p.z));
        high = (float3)(max(high.x, p.x), max(high.y, p.y), max(high.z, p.z));
    }
    if (is_outside(frame, low, high)) {
        return CULL;
    }
    if (low.z < mul(0.1f, frame->near) && high.z > frame->near) {
        return weber_split(surface, u_size(surface) < v_size(surface));
    }
    const float2 lengths = weber_lengths(frame, points);
    if (max(lengths.x, lengths.y) <= frame->bound) {
        return u_level(surface) <= MAX_SPLITS && v_level(surface) <= MAX_SPLITS ? DRAW : CULL;
    }
    return weber_split(surface, lengths.x > lengths.y);
}
