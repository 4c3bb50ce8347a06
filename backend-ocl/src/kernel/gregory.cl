// Mirrors core/src/patch/gregory.rs: bicubic nets whose four inner points depend on u and v.

// The eight face points in eye space: those of the borders of constant u, then those of constant v.
typedef struct {
    float x[8];
    float y[8];
    float z[8];
} Faces;

// Where inner point `m` stands in a net.
static uint inner(uint m) {
    return 5u + m % 2u + 4u * (m / 2u);
}

static void faces_in_eye_space(uint zero, __global const Patch *record, __global const Object *object,
                               Faces *faces) {
    const Transform to_eye = to_eye_of(object);
    for (uint l = 0u; l < 8u; l++) {
        faces->x[l] = transformed(zero, record, to_eye.x, l);
        faces->y[l] = transformed(zero, record, to_eye.y, l);
        faces->z[l] = transformed(zero, record, to_eye.z, l);
    }
}

static float faces_extent(const Faces *faces) {
    float largest = 0.0f;
    for (uint face = 0u; face < 8u; face++) {
        largest = max(largest, max(max(abs(faces->x[face]), abs(faces->y[face])), abs(faces->z[face])));
    }
    return largest;
}

static float3 difference(uint zero, const Faces *faces, uint m) {
    return (float3)(sub(faces->x[m], faces->x[4u + m]), sub(faces->y[m], faces->y[4u + m]),
                    sub(faces->z[m], faces->z[4u + m]));
}

// Puts inner point `m`, at this share, into a net.
static void put_inner(uint zero, const Faces *faces, Net *net, uint m, float share) {
    const float3 moved = scale3(difference(zero, faces, m), share);
    net->x[inner(m)] = add(faces->x[4u + m], moved.x);
    net->y[inner(m)] = add(faces->y[4u + m], moved.y);
    net->z[inner(m)] = add(faces->z[4u + m], moved.z);
}

// Distances of the low and high end of a range from the end 0 or 1 of its parameter.
static float2 ends(uint zero, uint2 range, uint end) {
    if (end == 0u) {
        return (float2)(param(zero, range.x), param(zero, range.y));
    }
    return (float2)(param(zero, PARAM_ONE - range.x), param(zero, PARAM_ONE - range.y));
}

// The smaller of the two first.
static float2 distances(uint zero, uint2 range, uint end) {
    const float2 both = ends(zero, range, end);
    return end == 0u ? both : both.yx;
}

// Largest inner Bernstein weight in a range of distances, or a little more.
static float inner_weight(uint zero, float2 range) {
    const float rest = sub(1.0f, range.x);
    return min(INNER_MOST, mul(mul(3.0f, range.y), mul(rest, rest)));
}

static float share_at(uint zero, float a, float b) {
    return mul(b, recip(max(add(a, b), PARAM_STEP)));
}

// The middle of all shares at distances in two ranges.
static float middle(uint zero, float2 a, float2 b) {
    return mul(0.5f, add(share_at(zero, a.y, b.x), share_at(zero, a.x, b.y)));
}

// The middles of all shares on a surface, given by its range, into the net of the whole patch; gives how far the surface
// can be from that net's.
static float centre_inner(uint zero, const Faces *faces, Net *net, uint4 range, bool exchanged) {
    const uint2 along_u = range.xy, along_v = range.zw;
    const uint2 first = exchanged ? along_v : along_u, second = exchanged ? along_u : along_v;
    float spread = 0.0f;
    for (uint m = 0u; m < 4u; m++) {
        const float2 a = distances(zero, first, m / 2u), b = distances(zero, second, m % 2u);
        const float low = share_at(zero, a.y, b.x), high = share_at(zero, a.x, b.y);
        put_inner(zero, faces, net, m, middle(zero, a, b));
        const float weight = mul(inner_weight(zero, distances(zero, along_u, m / 2u)),
                                 inner_weight(zero, distances(zero, along_v, m % 2u)));
        const float half_range = mul(0.5f, sub(high, low));
        spread = add(spread, mul(mul(half_range, weight), largest3(difference(zero, faces, m))));
    }
    return spread;
}

static float between(uint zero, float low, float high, float t) {
    return add(low, mul(sub(high, low), t));
}

// One of the four components.
static float component(float4 all, uint k) {
    return k < 2u ? (k == 0u ? all.x : all.y) : (k == 2u ? all.z : all.w);
}

// Moves the control points of a surface to where the shares at its corners, and between them, take them.
static void follow(uint zero, const Faces *faces, Net *part, uint4 range, bool exchanged) {
    const uint2 along_u = range.xy, along_v = range.zw;
    const uint2 first = exchanged ? along_v : along_u, second = exchanged ? along_u : along_v;
    float4 weights_u[4], weights_v[4];
    blossom(zero, range.x, range.y, weights_u);
    blossom(zero, range.z, range.w, weights_v);
    for (uint m = 0u; m < 4u; m++) {
        const float2 a = ends(zero, first, m / 2u), b = ends(zero, second, m % 2u);
        const float3 from = difference(zero, faces, m);
        const float fixed_share =
            middle(zero, distances(zero, first, m / 2u), distances(zero, second, m % 2u));
        const float4 corners = (float4)(share_at(zero, a.x, b.x), share_at(zero, a.x, b.y),
                                        share_at(zero, a.y, b.x), share_at(zero, a.y, b.y));
        for (uint l = 0u; l < 16u; l++) {
            const float over_u = mul(number((int)(l / 4u)), THIRD), over_v = mul(number((int)(l % 4u)), THIRD);
            const float s = exchanged ? over_v : over_u, t = exchanged ? over_u : over_v;
            const float here = between(zero, between(zero, corners.x, corners.y, t),
                                       between(zero, corners.z, corners.w, t), s);
            const float weight = mul(component(weights_u[l / 4u], inner(m) / 4u),
                                     component(weights_v[l % 4u], inner(m) % 4u));
            const float3 moved = scale3(from, mul(weight, sub(here, fixed_share)));
            part->x[l] = add(part->x[l], moved.x);
            part->y[l] = add(part->y[l], moved.y);
            part->z[l] = add(part->z[l], moved.z);
        }
    }
}

// How inner point `m` is blended at a parameter: share of the face point of the border of constant u, and how
// it changes along u and along v.
static float3 blend_at(uint zero, uint m, float u, float v) {
    const bool high_u = m / 2u != 0u, high_v = m % 2u != 0u;
    const float a = high_u ? sub(1.0f, u) : u, b = high_v ? sub(1.0f, v) : v;
    const float scale = recip(max(add(a, b), PARAM_STEP));
    const float share = mul(b, scale);
    const float along_a = neg(mul(share, scale)), along_b = mul(mul(a, scale), scale);
    return (float3)(share, high_u ? neg(along_a) : along_a, high_v ? neg(along_b) : along_b);
}

// The blend as Weber's program has it: with u and v exchanged.
static float3 weber_blend_at(uint zero, uint m, float u, float v) {
    return blend_at(zero, m, v, u).xzy;
}

// The blend by the rules of the frame's profile; `blends_at` in core/src/kernel/dice_gregory.rs.
static float3 blend_here(__constant Frame *frame, uint m, float u, float v) {
    return frame->flags & FLAG_WEBER ? weber_blend_at(frame->zero, m, u, v) : blend_at(frame->zero, m, u, v);
}

// A point of a patch by itself, as `position_at` and `evaluate_gregory` in core find it; not of a rational one. The inner
// points of a Gregory patch are put into its net, which is then of no more use but for other points.
static float3 point_at(__constant Frame *frame, Net *net, const Faces *faces, bool is_gregory, uint u, uint v) {
    const uint zero = frame->zero;
    if (is_gregory) {
        for (uint m = 0u; m < 4u; m++) {
            put_inner(zero, faces, net, m, blend_here(frame, m, param(zero, u), param(zero, v)).x);
        }
    }
    return position_at(zero, net, (uint2)(u, v));
}
