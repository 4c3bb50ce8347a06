// Mirrors core/src/kernel/dice_rational.rs and `Weights::evaluate` of core/src/patch/rational.rs: a vertex of a rational
// patch.

// Row `i` of coordinate `k` of the control points, times their weights; the fourth coordinate is the weights themselves.
static float4 weighted_row(uint zero, __local const Source *source, uint k, uint i) {
    const float4 weights = vload4(i, source->more);
    return k == 3u ? weights : mul4(zero, vload4(i, coordinate(source->net, k)), weights);
}

// Coordinate `k` of a point and of its derivatives along u and along v, none divided by its weight.
static float3 rational_coordinate(uint zero, __local const Source *source, uint k, float u, float v) {
    const float4 cubic_u = cubic(zero, u), cubic_v = cubic(zero, v);
    const float3 slope_u = cubic_slope(zero, u), slope_v = cubic_slope(zero, v);
    const float4 row0 = weighted_row(zero, source, k, 0u), row1 = weighted_row(zero, source, k, 1u);
    const float4 row2 = weighted_row(zero, source, k, 2u), row3 = weighted_row(zero, source, k, 3u);
    const float4 curve = (float4)(blend4(zero, cubic_v, row0), blend4(zero, cubic_v, row1),
                                  blend4(zero, cubic_v, row2), blend4(zero, cubic_v, row3));
    const float4 across =
        (float4)(blend3(zero, slope_v, along(zero, row0)), blend3(zero, slope_v, along(zero, row1)),
                 blend3(zero, slope_v, along(zero, row2)), blend3(zero, slope_v, along(zero, row3)));
    return (float3)(blend4(zero, cubic_u, curve), blend3(zero, slope_u, along(zero, curve)),
                    blend4(zero, cubic_u, across));
}

// The derivative of a quotient that is `at`, given those of numerator and denominator and 1 / denominator.
static float3 quotient(uint zero, float3 at, float3 slope, float slope_below, float scale) {
    const float3 moved = scale3(at, slope_below);
    const float3 rest = (float3)(sub(slope.x, moved.x), sub(slope.y, moved.y), sub(slope.z, moved.z));
    return scale3(rest, scale);
}

// Position at a parameter, and the derivatives there along u and along v.
static void evaluate_rational(uint zero, __local const Source *source, uint2 at, float3 *position, float3 *du,
                              float3 *dv) {
    const float u = param(zero, at.x), v = param(zero, at.y);
    const float3 x = rational_coordinate(zero, source, 0u, u, v), y = rational_coordinate(zero, source, 1u, u, v);
    const float3 z = rational_coordinate(zero, source, 2u, u, v), w = rational_coordinate(zero, source, 3u, u, v);
    const float scale = recip(w.x);
    *position = scale3((float3)(x.x, y.x, z.x), scale);
    *du = quotient(zero, *position, (float3)(x.y, y.y, z.y), w.y, scale);
    *dv = quotient(zero, *position, (float3)(x.z, y.z, z.z), w.z, scale);
}
