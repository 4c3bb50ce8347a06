// Mirrors core/src/kernel/seam.rs: slivers that close the gap where a border meets a coarser one.

// One border of a surface: along it one parameter is fixed, and the other runs through a range.
typedef struct {
    bool along_u;
    uint at; // the parameter that is fixed
    uint start;
    uint size;
} Border;

// Borders v = low, v = high, u = low and u = high.
static Border border_of(Surface surface, uint number) {
    const uint size_u = u_size(surface), size_v = v_size(surface);
    const uint high = number & 1u;
    if (number < 2u) {
        const Border border = {true, surface.v + high * size_v, surface.u, size_u};
        return border;
    }
    const Border border = {false, surface.u + high * size_u, surface.v, size_v};
    return border;
}

// The same border of the surface of this size that contains it.
static Border ancestor(Border border, uint size) {
    border.start &= ~(size - 1u);
    border.size = size;
    return border;
}

// The parameters u and v where the one that runs is `t`.
static uint2 place_on(Border border, uint t) {
    return border.along_u ? (uint2)(t, border.at) : (uint2)(border.at, t);
}

// Control points of a curve along u or along v, one coordinate, from the rows of a net.
static float4 border_curve(uint zero, Border border, float4 a, float4 b, float4 c, float4 d) {
    const float4 weights = cubic(zero, param(zero, border.at));
    if (border.along_u) {
        return (float4)(blend4(zero, weights, a), blend4(zero, weights, b), blend4(zero, weights, c),
                        blend4(zero, weights, d));
    }
    return (float4)(
        blend4(zero, weights, (float4)(a.x, b.x, c.x, d.x)), blend4(zero, weights, (float4)(a.y, b.y, c.y, d.y)),
        blend4(zero, weights, (float4)(a.z, b.z, c.z, d.z)), blend4(zero, weights, (float4)(a.w, b.w, c.w, d.w)));
}

// Control points of the part of such a curve that is the border.
static void part_of(uint zero, Border border, const float4 *curve, float4 *part) {
    float4 weights[4];
    blossom(zero, border.start, border.start + border.size, weights);
    for (uint k = 0u; k < 3u; k++) {
        part[k] = (float4)(blend4(zero, weights[0], curve[k]), blend4(zero, weights[1], curve[k]),
                           blend4(zero, weights[2], curve[k]), blend4(zero, weights[3], curve[k]));
    }
}

static bool is_short(__constant Frame *frame, const float4 *part) {
    const uint zero = frame->zero;
    float x[4], y[4];
    for (uint k = 0u; k < 4u; k++) {
        const float3 seen = perspective(
            frame, (float3)(component(part[0], k), component(part[1], k), component(part[2], k)));
        x[k] = clamp(seen.x, neg(FAR_OFF), FAR_OFF);
        y[k] = clamp(seen.y, neg(FAR_OFF), FAR_OFF);
    }
    float length = 0.0f;
    for (uint k = 0u; k < 3u; k++) {
        length = add(length, segment(zero, x, y, k, k + 1u));
    }
    return length <= mul(frame->bound, SEAM_ALLOWANCE);
}

static bool may_be_drawn(__constant Frame *frame, const float4 *part) {
    bool nearer = false;
    for (uint k = 0u; k < 4u; k++) {
        nearer |= neg(component(part[2], k)) < frame->near;
    }
    return !nearer && is_short(frame, part);
}

static uint longest_chord(__constant Frame *frame, __local const float *net, Border border) {
    const uint zero = frame->zero;
    float4 curve[3], part[3];
    for (uint k = 0u; k < 3u; k++) {
        __local const float *c = coordinate(net, k);
        curve[k] = border_curve(zero, border, vload4(0, c), vload4(1, c), vload4(2, c), vload4(3, c));
    }
    uint longest = 1u;
    for (uint size = 2u * border.size; size <= PARAM_ONE; size *= 2u) {
        part_of(zero, ancestor(border, size), curve, part);
        if (!may_be_drawn(frame, part)) {
            break;
        }
        longest *= 2u;
    }
    return longest;
}

// Half of the chord that has the border's end in its middle, or 0.
static uint chord_beyond(__constant Frame *frame, Border border, uint longest) {
    const uint end = border.start + border.size;
    const uint half_chord = end & (0u - end);
    const uint steps = 2u * half_chord / (border.size / frame->rate);
    const bool inside = end != PARAM_ONE && steps > frame->rate && steps <= longest;
    return inside ? half_chord : 0u;
}
