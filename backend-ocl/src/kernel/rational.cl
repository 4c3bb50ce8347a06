// Mirrors core/src/patch/rational.rs: patches whose control points have weights. A record behind all patches holds them,
// as x.

static bool is_rational(__global const Patch *patch) {
    return patch->faces != 0u && (patch->kind & KIND_RATIONAL) != 0u;
}

// One coordinate of the control points of a part of a patch, times their weights.
static void weighted_part(uint zero, const float *c, __global const Patch *record, const float4 *along_u,
                          const float4 *along_v, float *part) {
    float all[16], rows[16];
    for (uint l = 0u; l < 16u; l++) {
        all[l] = mul(c[l], record->x[l]);
    }
    combine_u(zero, all, along_u, rows);
    combine_v(zero, rows, along_v, part);
}

// The weights of the control points of a part of a patch.
static void weights_of_part(uint zero, __global const Patch *record, const float4 *along_u, const float4 *along_v,
                            float *weights) {
    float all[16], rows[16];
    for (uint l = 0u; l < 16u; l++) {
        all[l] = record->x[l];
    }
    combine_u(zero, all, along_u, rows);
    combine_v(zero, rows, along_v, weights);
}

// Control points, not multiplied by their weights, of a part of a patch; `Weights::between` in core.
static void rational_part(uint zero, const Net *net, __global const Patch *record, uint4 range, Net *part) {
    float4 along_u[4], along_v[4];
    float weights[16];
    blossom(zero, range.x, range.y, along_u);
    blossom(zero, range.z, range.w, along_v);
    weighted_part(zero, net->x, record, along_u, along_v, part->x);
    weighted_part(zero, net->y, record, along_u, along_v, part->y);
    weighted_part(zero, net->z, record, along_u, along_v, part->z);
    weights_of_part(zero, record, along_u, along_v, weights);
    for (uint l = 0u; l < 16u; l++) {
        const float scale = recip(weights[l]);
        part->x[l] = mul(part->x[l], scale);
        part->y[l] = mul(part->y[l], scale);
        part->z[l] = mul(part->z[l], scale);
    }
}

// A point of a patch by itself, as `Weights::evaluate` in core finds it.
static float3 rational_point(uint zero, const Net *net, __global const Patch *record, uint2 at) {
    const float4 row = cubic(zero, param(zero, at.y)), column = cubic(zero, param(zero, at.x));
    float4 x, y, z, w;
    for (uint i = 0u; i < 4u; i++) {
        const float4 weights = vload4(i, record->x);
        x[i] = blend4(zero, row, mul4(zero, vload4(i, net->x), weights));
        y[i] = blend4(zero, row, mul4(zero, vload4(i, net->y), weights));
        z[i] = blend4(zero, row, mul4(zero, vload4(i, net->z), weights));
        w[i] = blend4(zero, row, weights);
    }
    const float3 point = (float3)(blend4(zero, column, x), blend4(zero, column, y), blend4(zero, column, z));
    return scale3(point, recip(blend4(zero, column, w)));
}
