// Mirrors core/src/kernel/dice.rs: a drawn surface becomes a grid of vertices, each a pure function of patch
// and dyadic parameter. A work-group dices one grid; its work-items share out curves, then vertices.
#define SIDE (MAX_RATE + 1u)
#define VERTICES (SIDE * SIDE)

// How one border of a grid is closed; the ends of `chord` count only where `has_chord` is not 0.
typedef struct {
    uint longest;
    uint has_chord;
    float3 chord[2];
} Seam;

// Vertices of a diced surface: row r, column c at index r · stride + c.
typedef struct {
    Net net;
    uint stride;
    // Does a micropolygon face the eye?
    uint facing;
    // Sides of the box around the control points.
    float sides[3];
    // The curves v = constant of all rows: control points and derivatives across, by row and coordinate.
    float point[SIDE][3][4];
    float across[SIDE][3][4];
    int x[VERTICES];
    int y[VERTICES];
    float w[VERTICES];
    float colour[3][VERTICES];
    Seam seams[4];
} Grid;

// The curve v = constant of a patch: control points and derivatives across, a coordinate each.
typedef struct {
    float4 point[3];
    float4 across[3];
} IsoCurve;

static __local const float *coordinate(__local const Net *net, uint k) {
    return k == 0u ? net->x : k == 1u ? net->y : net->z;
}

// Control point `i` of the curve in one coordinate, by the weights at its v.
static float curve_point(uint zero, __local const float *p, float4 cubic_v) {
    return blend4(zero, cubic_v, (float4)(p[0], p[1], p[2], p[3]));
}

static float curve_across(uint zero, __local const float *p, float3 slope_v) {
    return blend3(zero, slope_v, (float3)(sub(p[1], p[0]), sub(p[2], p[1]), sub(p[3], p[2])));
}

static float3 along(uint zero, float4 point) {
    return (float3)(sub(point.y, point.x), sub(point.z, point.y), sub(point.w, point.z));
}

static IsoCurve iso_curve(uint zero, __local const Net *net, uint v) {
    const float t = param(zero, v);
    const float4 cubic_v = cubic(zero, t);
    const float3 slope_v = cubic_slope(zero, t);
    IsoCurve curve;
    for (uint k = 0u; k < 3u; k++) {
        __local const float *c = coordinate(net, k);
        curve.point[k] = (float4)(curve_point(zero, c, cubic_v), curve_point(zero, c + 4, cubic_v),
                                  curve_point(zero, c + 8, cubic_v), curve_point(zero, c + 12, cubic_v));
        curve.across[k] = (float4)(curve_across(zero, c, slope_v), curve_across(zero, c + 4, slope_v),
                                   curve_across(zero, c + 8, slope_v), curve_across(zero, c + 12, slope_v));
    }
    return curve;
}

static float3 blend_point(uint zero, const IsoCurve *curve, float4 weights) {
    return (float3)(blend4(zero, weights, curve->point[0]), blend4(zero, weights, curve->point[1]),
                    blend4(zero, weights, curve->point[2]));
}

static float3 blend_along(uint zero, const IsoCurve *curve, float3 slope) {
    return (float3)(blend3(zero, slope, along(zero, curve->point[0])),
                    blend3(zero, slope, along(zero, curve->point[1])),
                    blend3(zero, slope, along(zero, curve->point[2])));
}

static float3 blend_across(uint zero, const IsoCurve *curve, float4 weights) {
    return (float3)(blend4(zero, weights, curve->across[0]), blend4(zero, weights, curve->across[1]),
                    blend4(zero, weights, curve->across[2]));
}

static float3 position_at(uint zero, __local const Net *net, uint u, uint v) {
    const IsoCurve curve = iso_curve(zero, net, v);
    return blend_point(zero, &curve, cubic(zero, param(zero, u)));
}

// Side `k` of the box around the control points.
static float side(uint zero, __local const Net *net, uint k) {
    __local const float *c = coordinate(net, k);
    float own[16];
    for (uint l = 0u; l < 16u; l++) {
        own[l] = c[l];
    }
    return sub(fold_max(own), fold_min(own));
}

static float3 unit_normal(uint zero, float3 du, float3 dv, float flat) {
    const float long_u = largest3(du), long_v = largest3(dv);
    const float3 normal = cross3(scale3(du, unit_scale(long_u)), scale3(dv, unit_scale(long_v)));
    const float square = dot3(normal, normal);
    const bool sound = long_u > flat && long_v > flat && square > PARALLEL;
    const float scale = sound ? rsqrt(max(square, PARALLEL)) : 0.0f;
    return scale3(normal, scale);
}

static uint inward(uint t) {
    return t - t / 64u + PARAM_ONE / 128u;
}

static float3 net_chord(uint zero, __local const Net *net, uint a, uint b) {
    return (float3)(sub(net->x[b], net->x[a]), sub(net->y[b], net->y[a]), sub(net->z[b], net->z[a]));
}

static float3 normal_nearby(uint zero, __local const Net *net, uint u, uint v, float flat) {
    const IsoCurve curve = iso_curve(zero, net, inward(v));
    const float t = param(zero, inward(u));
    const float3 du = blend_along(zero, &curve, cubic_slope(zero, t));
    const float3 dv = blend_across(zero, &curve, cubic(zero, t));
    const float3 nearby = unit_normal(zero, du, dv, flat);
    if (largest3(nearby) > 0.5f) {
        return nearby;
    }
    const float3 diagonal =
        unit_normal(zero, net_chord(zero, net, 0u, 15u), net_chord(zero, net, 12u, 3u), 0.0f);
    return largest3(diagonal) > 0.5f ? diagonal : (float3)(0.0f, 0.0f, 1.0f);
}

// Moves the patch to eye space, a coordinate a work-item.
static void dice_net(uint zero, __global const Patch *patch, __global const Object *object,
                     __local Grid *grid, uint lane) {
    if (lane < 48u) {
        const uint k = lane / 16u, l = lane % 16u;
        const float c = transformed(zero, patch, object->to_eye + 4u * k, l);
        __local float *all = k == 0u ? grid->net.x : k == 1u ? grid->net.y : grid->net.z;
        all[l] = c;
    }
}

// Control points of the curves of all rows, and what of the net is needed but once.
static void dice_curves(__constant Frame *frame, Surface surface, __local Grid *grid, uint lane) {
    const uint zero = frame->zero;
    const uint step = v_size(surface) / frame->rate;
    for (uint place = lane; place < 12u * (frame->rate + 1u); place += GROUP) {
        const uint row = place / 12u, k = place % 12u / 4u, i = place % 4u;
        const float t = param(zero, surface.v + row * step);
        __local const float *p = coordinate(&grid->net, k) + 4u * i;
        grid->point[row][k][i] = curve_point(zero, p, cubic(zero, t));
        grid->across[row][k][i] = curve_across(zero, p, cubic_slope(zero, t));
    }
    if (lane < 3u) {
        grid->sides[lane] = side(zero, &grid->net, lane);
    }
    if (lane == 0u) {
        grid->stride = frame->rate + 1u;
        grid->facing = 0u;
    }
}

static IsoCurve grid_curve(__local const Grid *grid, uint row) {
    IsoCurve curve;
    for (uint k = 0u; k < 3u; k++) {
        curve.point[k] = vload4(0, grid->point[row][k]);
        curve.across[k] = vload4(0, grid->across[row][k]);
    }
    return curve;
}

// Position and unit normal of one vertex; its snapped place goes into the grid.
static void dice_vertex(__constant Frame *frame, Surface surface, __local Grid *grid, uint at,
                        float3 *position, float3 *normal) {
    const uint zero = frame->zero;
    const float flat = mul(max(max(grid->sides[0], grid->sides[1]), grid->sides[2]), FLAT);
    const uint row = at / grid->stride, column = at % grid->stride;
    const uint u = surface.u + column * (u_size(surface) / frame->rate);
    const uint v = surface.v + row * (v_size(surface) / frame->rate);
    const IsoCurve curve = grid_curve(grid, row);
    const float t = param(zero, u);
    const float4 weights = cubic(zero, t);
    *position = blend_point(zero, &curve, weights);
    const float3 du = blend_along(zero, &curve, cubic_slope(zero, t));
    *normal = unit_normal(zero, du, blend_across(zero, &curve, weights), flat);
    if (largest3(*normal) < 0.5f) {
        *normal = normal_nearby(zero, &grid->net, u, v, flat);
    }
    const Vertex vertex = project(frame, *position);
    grid->x[at] = vertex.x;
    grid->y[at] = vertex.y;
    grid->w[at] = vertex.w;
}
