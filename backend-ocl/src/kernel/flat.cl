// Mirrors core/src/kernel/flat.rs: how far triangles can be, on screen, from the part of a patch that they stand for.

static float3 point_of(const Net *net, uint l) {
    return (float3)(net->x[l], net->y[l], net->z[l]);
}

// `length` in core, which is a function of OpenCL's that may not be called here.
static float length_of(uint zero, float square) {
    return sqrt(add(square, LENGTH_TINY));
}

// How far before the eye a point is; if the mesh is to be whole, as if the eye had turned to it.
static float before_of(__constant Frame *frame, float3 point) {
    const uint zero = frame->zero;
    const float before = neg(point.z);
    return (frame->flags & FLAG_WHOLE) == 0u ? before : max(before, mul(largest3(point), frame->around));
}

// Squared length on screen, times the distance, of a small step at a point.
static float seen_step(__constant Frame *frame, float near, float3 at, float3 way) {
    const uint zero = frame->zero;
    if (frame->flags & FLAG_WHOLE) {
        return mul(mul(frame->focal, frame->focal), dot3(way, way));
    }
    const float scale = mul(frame->focal, recip(max(neg(at.z), near)));
    const float x = clamp(mul(at.x, scale), neg(frame->centre_x), frame->centre_x);
    const float y = clamp(mul(at.y, scale), neg(frame->centre_y), frame->centre_y);
    const float3 there = (float3)(add(mul(way.x, frame->focal), mul(x, way.z)),
                                  add(mul(way.y, frame->focal), mul(y, way.z)), 0.0f);
    return dot3(there, there);
}

// Squared length of a second difference; the same from either end.
static float bend(__constant Frame *frame, float near, float3 a, float3 b, float3 c) {
    const uint zero = frame->zero;
    const float3 way = (float3)(add(sub(a.x, b.x), sub(c.x, b.x)), add(sub(a.y, b.y), sub(c.y, b.y)),
                                add(sub(a.z, b.z), sub(c.z, b.z)));
    return seen_step(frame, near, b, way);
}

// Squared length of a difference of differences, of the square of control points that begins with number `l`.
static float twist(__constant Frame *frame, float near, const Net *part, uint l) {
    const uint zero = frame->zero;
    const float3 a = point_of(part, l), b = point_of(part, l + 1u);
    const float3 c = point_of(part, l + 4u), d = point_of(part, l + 5u);
    const float3 way = (float3)(sub(add(a.x, d.x), add(b.x, c.x)), sub(add(a.y, d.y), add(b.y, c.y)),
                                sub(add(a.z, d.z), add(b.z, c.z)));
    return seen_step(frame, near, a, way);
}

// The largest of the squared second differences in one direction, `step` control points from one to the next, `row`
// between lines.
static float most_bent(__constant Frame *frame, float near, const Net *part, uint step, uint row) {
    float most = 0.0f;
    for (uint k = 0u; k < 8u; k++) {
        const uint l = k / 2u * row + k % 2u * step;
        const float3 first = point_of(part, l), last = point_of(part, l + 2u * step);
        most = max(most, bend(frame, near, first, point_of(part, l + step), last));
    }
    return most;
}

static float most_twisted(__constant Frame *frame, float near, const Net *part) {
    float most = 0.0f;
    for (uint k = 0u; k < 9u; k++) {
        most = max(most, twist(frame, near, part, 4u * (k / 3u) + k % 3u));
    }
    return most;
}

// How far a part of a patch is from triangles in it.
static float part_flatness(__constant Frame *frame, float near, const Net *part) {
    const uint zero = frame->zero;
    float before = before_of(frame, point_of(part, 0u));
    for (uint l = 1u; l < 16u; l++) {
        before = min(before, before_of(frame, point_of(part, l)));
    }
    const float bent_u = length_of(zero, most_bent(frame, near, part, 4u, 1u));
    const float bent_v = length_of(zero, most_bent(frame, near, part, 1u, 4u));
    const float twisted = length_of(zero, most_twisted(frame, near, part));
    const float all = add(mul(0.75f, add(bent_u, bent_v)), mul(2.25f, twisted));
    return mul(all, recip(max(before, near)));
}

// How far a line is from its chord.
static float line_flatness(__constant Frame *frame, float near, const float3 *line) {
    const uint zero = frame->zero;
    const float bent = max(bend(frame, near, line[0], line[1], line[2]), bend(frame, near, line[1], line[2], line[3]));
    float before = before_of(frame, line[0]);
    for (uint k = 1u; k < 4u; k++) {
        before = min(before, before_of(frame, line[k]));
    }
    return mul(mul(0.75f, length_of(zero, bent)), recip(max(before, near)));
}

// How far a side, given the control points of what it is a side of, is from its chord.
static float side_flatness(__constant Frame *frame, float near, const Net *part, uint side) {
    float3 line[4];
    for (uint k = 0u; k < 4u; k++) {
        line[k] = point_of(part, side_point(side, k));
    }
    return line_flatness(frame, near, line);
}

// How many times as flat as a surface a line must be of which a piece 2^bits units long is looked at.
static float strictness_of(uint zero, uint bits) {
    return add(1.0f, mul(LINE_SHARE, number((int)bits)));
}

// The range around three vertices.
static uint4 around(uint2 a, uint2 b, uint2 c) {
    return (uint4)(lesser_of(lesser_of(a.x, b.x), c.x), greater_of(greater_of(a.x, b.x), c.x),
                   lesser_of(lesser_of(a.y, b.y), c.y), greater_of(greater_of(a.y, b.y), c.y));
}
