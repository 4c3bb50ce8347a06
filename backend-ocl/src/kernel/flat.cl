// Mirrors core/src/kernel/flat.rs: how far a surface is, on screen, from the one micropolygon that would be drawn for it,
// and its sides from their chords.

// From where distances are measured: what is nearer than `near` as if it were this far away; or is all measured as if it
// were as near as that, and turned to the eye?
typedef struct {
    __constant Frame *frame;
    float near;
    bool is_cut;
} View;

// `between` in core: distance of two points on screen.
static float off_by(View view, float3 a, float3 b) {
    const uint zero = view.frame->zero;
    if (view.is_cut) {
        return distance_of(zero, point_if_cut(view.frame, view.near, a), point_if_cut(view.frame, view.near, b));
    }
    return distance_of(zero, measured_point(view.frame, view.near, a), measured_point(view.frame, view.near, b));
}

// A third of the way from one number to another; `between_thirds` in core.
static float third(uint zero, float a, float b) {
    return mul(add(add(a, a), b), THIRD);
}

static float3 third3(uint zero, float3 a, float3 b) {
    return (float3)(third(zero, a.x, b.x), third(zero, a.y, b.y), third(zero, a.z, b.z));
}

// The middle between two points.
static float3 midway(uint zero, float3 a, float3 b) {
    return scale3(add3(a, b), 0.5f);
}

// One coordinate of the bilinear patch through the corners, as a bicubic one.
static void raised(uint zero, const float *c, float *out) {
    for (uint j = 0u; j < 4u; j += 3u) {
        out[j] = c[j];
        out[4u + j] = third(zero, c[j], c[12u + j]);
        out[8u + j] = third(zero, c[12u + j], c[j]);
        out[12u + j] = c[12u + j];
    }
    for (uint i = 0u; i < 4u; i++) {
        const float a = out[4u * i], b = out[4u * i + 3u];
        out[4u * i + 1u] = third(zero, a, b);
        out[4u * i + 2u] = third(zero, b, a);
    }
}

static float3 point_of(const Net *net, uint l) {
    return (float3)(net->x[l], net->y[l], net->z[l]);
}

// How far the two triangles are from the bilinear patch: it is farthest from them in its middle.
static float twist(View view, const Net *part) {
    const uint zero = view.frame->zero;
    const float3 ridge = midway(zero, point_of(part, 0u), point_of(part, 15u));
    const float3 other = midway(zero, point_of(part, 3u), point_of(part, 12u));
    return off_by(view, ridge, midway(zero, ridge, other));
}

// How far a surface, given the control points of it or of more than it, is from its two triangles, and its sides from
// their chords.
static float flatness(View view, const Net *part, float *sides) {
    const uint zero = view.frame->zero;
    Net even;
    raised(zero, part->x, even.x);
    raised(zero, part->y, even.y);
    raised(zero, part->z, even.z);
    float off[16], most = 0.0f;
    for (uint l = 0u; l < 16u; l++) {
        off[l] = off_by(view, point_of(part, l), point_of(&even, l));
        most = max(most, off[l]);
    }
    for (uint side = 0u; side < 4u; side++) {
        sides[side] = mul(LINE_SHARE, max(off[side_point(side, 1u)], off[side_point(side, 2u)]));
    }
    return add(most, twist(view, part));
}

// How far a line is from its chord.
static float line_flatness(View view, const float3 *line) {
    const uint zero = view.frame->zero;
    const float first = off_by(view, line[1], third3(zero, line[0], line[3]));
    return mul(LINE_SHARE, max(first, off_by(view, line[2], third3(zero, line[3], line[0]))));
}

// The same of a line inside a Gregory patch, from five points of it. Between them it may be a little farther.
static float chord_flatness(View view, const float3 *points) {
    const uint zero = view.frame->zero;
    const float3 centre = midway(zero, points[0], points[4]);
    const float outer = max(off_by(view, points[1], midway(zero, points[0], centre)),
                            off_by(view, points[3], midway(zero, points[4], centre)));
    const float most = max(outer, off_by(view, points[2], centre));
    return mul(LINE_SHARE, add(most, mul(most, QUARTER)));
}

// What of a patch has to be flat for a surface whose corners have strayed: all that they enclose.
static uint4 enclosed(Surface surface) {
    const uint2 a = corner(surface, 0u), b = corner(surface, 1u), c = corner(surface, 2u), d = corner(surface, 3u);
    return (uint4)(lesser_of(lesser_of(a.x, b.x), lesser_of(c.x, d.x)),
                   greater_of(greater_of(a.x, b.x), greater_of(c.x, d.x)),
                   lesser_of(lesser_of(a.y, b.y), lesser_of(c.y, d.y)),
                   greater_of(greater_of(a.y, b.y), greater_of(c.y, d.y)));
}
