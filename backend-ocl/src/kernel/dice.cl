// Mirrors core/src/kernel/dice.rs: a drawn surface becomes a grid of vertices, each a pure function of patch
// and dyadic parameter. A work-group dices one grid; its work-items share out curves, then vertices.
#define SIDE (MAX_RATE + 1u)
// For functions that are called from several places and always with the same local memory: where that makes its
// address a constant in them, PoCL 3.1 loses it.
#define INLINED static __attribute__((always_inline))

// What a patch is evaluated from; of an object that is displaced in its own space, else transformed.
typedef struct {
    // Control net: coordinate k of control point l at 16 k + l.
    float net[48];
    // What it has besides, if anything: HAS_…
    uint has;
    // Face points of a Gregory patch: coordinate k of point l at 8 k + l. Weights of a rational patch.
    float more[24];
    // Tangents no longer than this have vanished.
    float flat_length;
} Source;

#define HAS_NOTHING 0u
#define HAS_FACES 1u
#define HAS_WEIGHTS 2u

// A draw's own patch, and that of each word about its owners.
#define SOURCES (1u + WORDS)
// The same without the words about corners.
#define SIDE_SOURCES (1u + 4u)

// What all vertices of a grid share.
typedef struct {
    // Parameters of columns and rows, where the grid is regular.
    uint column_u[SIDE];
    uint row_v[SIDE];
    // Weights of each column: four of the position, three of the derivative.
    float4 column_cubic[SIDE];
    float3 column_slope[SIDE];
    // Control points and derivatives across of each row's iso-curve: coordinate k of row r at 3 r + k.
    float4 row_point[3u * SIDE];
    float4 row_across[3u * SIDE];
    // More than the first has only an object that is displaced, or a patch with sides that are halves of others'.
    Source sources[SOURCES];
} Grid;

// The curve v = constant of a patch: control points and derivatives across, a coordinate each.
typedef struct {
    float4 point[3];
    float4 across[3];
} IsoCurve;

// Coordinate `k` of the control points.
static __local const float *coordinate(__local const float *net, uint k) {
    return net + 16u * k;
}

// Differences of neighbouring control points.
static float3 along(uint zero, float4 point) {
    return (float3)(sub(point.y, point.x), sub(point.z, point.y), sub(point.w, point.z));
}

// Control points of the curve v = constant, one coordinate.
static float4 curve_point(uint zero, __local const float *c, float4 weights) {
    return (float4)(blend4(zero, weights, vload4(0, c)), blend4(zero, weights, vload4(1, c)),
                    blend4(zero, weights, vload4(2, c)), blend4(zero, weights, vload4(3, c)));
}

// Derivatives across that curve at its control points, one coordinate.
static float4 curve_across(uint zero, __local const float *c, float3 weights) {
    return (float4)(blend3(zero, weights, along(zero, vload4(0, c))),
                    blend3(zero, weights, along(zero, vload4(1, c))),
                    blend3(zero, weights, along(zero, vload4(2, c))),
                    blend3(zero, weights, along(zero, vload4(3, c))));
}

INLINED IsoCurve iso_curve(uint zero, __local const float *net, uint v) {
    const float t = param(zero, v);
    const float4 cubic_v = cubic(zero, t);
    const float3 slope_v = cubic_slope(zero, t);
    IsoCurve curve;
    for (uint k = 0u; k < 3u; k++) {
        curve.point[k] = curve_point(zero, coordinate(net, k), cubic_v);
        curve.across[k] = curve_across(zero, coordinate(net, k), slope_v);
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

// Side `k` of the box around the control points.
static float side(uint zero, __local const float *net, uint k) {
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
    return flush3(scale3(normal, scale));
}

static uint inward(uint t) {
    return t - t / 64u + PARAM_ONE / 128u;
}

static float3 net_chord(uint zero, __local const float *net, uint a, uint b) {
    return (float3)(sub(net[b], net[a]), sub(net[16u + b], net[16u + a]), sub(net[32u + b], net[32u + a]));
}

static float3 normal_nearby(uint zero, __local const float *net, uint u, uint v, float flat) {
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

// Largest side of the box around the control points.
static float size(uint zero, __local const float *net) {
    return max(max(side(zero, net, 0u), side(zero, net, 1u)), side(zero, net, 2u));
}

static void prepare_column(uint zero, Draw draw, __local Grid *grid, uint column) {
    const uint u = column_at(draw, column);
    const float t = param(zero, u);
    grid->column_u[column] = u;
    grid->column_cubic[column] = cubic(zero, t);
    grid->column_slope[column] = cubic_slope(zero, t);
}

// The curve in row `row`, one coordinate.
static void prepare_row(uint zero, __local Grid *grid, uint task) {
    const float t = param(zero, grid->row_v[task / 3u]);
    __local const float *c = coordinate(grid->sources[0].net, task % 3u);
    grid->row_point[task] = curve_point(zero, c, cubic(zero, t));
    grid->row_across[task] = curve_across(zero, c, cubic_slope(zero, t));
}

static bool is_displaced(__global const Object *object) {
    return object->reach > 0.0f;
}

// Coordinate `k` of control point `l`, where it is evaluated.
static float placed(uint zero, bool stays, Transform transform, __global const Patch *patch, uint k, uint l) {
    return stays ? in_object_space(patch, k, l) : transformed(zero, patch, row_of(transform, k), l);
}

INLINED void prepare_source(uint zero, bool stays, Transform transform, __global const Patch *patch,
                            __global const Patch *record, __local Source *source, uint lane) {
    if (lane < 48u) {
        source->net[lane] = placed(zero, stays, transform, patch, lane / 16u, lane % 16u);
    }
    const uint has = patch->faces == 0u ? HAS_NOTHING : is_rational(patch) ? HAS_WEIGHTS : HAS_FACES;
    if (lane < 24u) {
        source->more[lane] = has == HAS_WEIGHTS ? record->x[lane % 16u]
                                                : placed(zero, stays, transform, record, lane / 8u, lane % 8u);
    }
    if (lane == GROUP - 1u) {
        source->has = has;
    }
}

// How many sources a grid of a patch has.
static uint sources_of(bool stays, __global const Patch *patch) {
    return stays ? SOURCES : has_halves(patch) ? SIDE_SOURCES : 1u;
}

// Fills in what all vertices share: the sources, the columns' weights, then the rows' curves. A barrier must follow.
INLINED void prepare(uint zero, Transform transform, __global const Object *object, __global const Patch *patches,
                     uint own_record, Draw draw, __local Grid *grid, uint lane) {
    __global const Patch *own = patches + own_record;
    const bool stays = is_displaced(object);
    const uint sources = sources_of(stays, own);
    for (uint slot = 0u; slot < sources; slot++) {
        __global const Patch *patch =
            patches + (slot == 0u ? own_record : patch_in(own->owners[slot - 1u], own_record));
        prepare_source(zero, stays, transform, patch, patches + patch->faces, &grid->sources[slot], lane);
    }
    for (uint column = lane; column <= rate_u(draw); column += GROUP) {
        prepare_column(zero, draw, grid, column);
    }
    for (uint row = GROUP - 1u - lane; row <= rate_v(draw); row += GROUP) {
        grid->row_v[row] = row_at(draw, row);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint task = lane; task < 3u * (rate_v(draw) + 1u); task += GROUP) {
        prepare_row(zero, grid, task);
    }
    const uint slot = GROUP - 1u - lane;
    if (slot < sources) {
        grid->sources[slot].flat_length = mul(size(zero, grid->sources[slot].net), FLAT);
    }
}

// u and v of a vertex: on a border, one of the border's own.
static uint2 vertex_of(Draw draw, __local const Grid *grid, uint row, uint column) {
    const uint any = draw.borders[0] | draw.borders[1] | draw.borders[2] | draw.borders[3];
    const bool inside = row > 0u && row < rate_v(draw) && column > 0u && column < rate_u(draw);
    return inside || any == 0u ? (uint2)(grid->column_u[column], grid->row_v[row])
                               : vertex_on_border(draw, row, column);
}

static IsoCurve grid_curve(__local const Grid *grid, uint row) {
    IsoCurve curve;
    for (uint k = 0u; k < 3u; k++) {
        curve.point[k] = grid->row_point[3u * row + k];
        curve.across[k] = grid->row_across[3u * row + k];
    }
    return curve;
}

// Position of a vertex where the grid is regular, and the derivatives there along u and along v.
static void evaluate(uint zero, __local const Grid *grid, uint row, uint column, float3 *position, float3 *du,
                     float3 *dv) {
    const IsoCurve curve = grid_curve(grid, row);
    const float4 weights = grid->column_cubic[column];
    *position = blend_point(zero, &curve, weights);
    *du = blend_along(zero, &curve, grid->column_slope[column]);
    *dv = blend_across(zero, &curve, weights);
}

// The same of a vertex that has an iso-curve of its own.
static void evaluate_moved(uint zero, __local const Source *source, uint2 at, float3 *position, float3 *du,
                           float3 *dv) {
    const IsoCurve curve = iso_curve(zero, source->net, at.y);
    const float t = param(zero, at.x);
    const float4 weights = cubic(zero, t);
    *position = blend_point(zero, &curve, weights);
    *du = blend_along(zero, &curve, cubic_slope(zero, t));
    *dv = blend_across(zero, &curve, weights);
}

// The unit normal of a vertex, or one from nearby where it vanishes.
static float3 normal_of(uint zero, __local const Source *source, uint2 at, float3 du, float3 dv) {
    const float flat = source->flat_length;
    const float3 normal = unit_normal(zero, du, dv, flat);
    return largest3(normal) < 0.5f ? normal_nearby(zero, source->net, at.x, at.y, flat) : normal;
}
