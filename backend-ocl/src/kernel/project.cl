// Mirrors core/src/kernel/project.rs: perspective projection and the snap to fixed point.
typedef struct {
    int x;
    int y;
    float w;
} Vertex;

// Pixel offsets right of and below the optical axis, and 1 / distance, of a point no nearer than `near`, or taken to be.
static float3 perspective(__constant Frame *frame, float near, float3 point) {
    const uint zero = frame->zero;
    const float w = recip(max(neg(point.z), near));
    const float scale = mul(frame->focal, w);
    return (float3)(mul(point.x, scale), mul(neg(point.y), scale), w);
}

static int snap(uint zero, float pixels) {
    return round(mul(clamp(pixels, neg(GUARD_BAND), GUARD_BAND), number(SUBPIXELS)));
}

static Vertex snapped(__constant Frame *frame, float3 seen) {
    const uint zero = frame->zero;
    const int half_pixel = SUBPIXELS / 2;
    const Vertex vertex = {snap(zero, seen.x) + (int)frame->width * half_pixel,
                           snap(zero, seen.y) + (int)frame->height * half_pixel, seen.z};
    return vertex;
}

static Vertex project(__constant Frame *frame, float3 point) {
    const float3 seen = perspective(frame, frame->near, point);
    const bool visible =
        neg(point.z) >= frame->near && abs(seen.x) <= GUARD_BAND && abs(seen.y) <= GUARD_BAND;
    Vertex vertex = snapped(frame, seen);
    vertex.w = visible ? seen.z : 0.0f;
    return vertex;
}

static Vertex project_clipped(__constant Frame *frame, float3 point) {
    return snapped(frame, perspective(frame, frame->near, point));
}
