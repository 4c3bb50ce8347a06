// Mirrors core/src/patch/net.rs: sixteen control points in eye space, index 4·i + j with i along u.
typedef struct {
    float x[16];
    float y[16];
    float z[16];
} Net;

// A transform: a row a coordinate.
typedef struct {
    float4 x;
    float4 y;
    float4 z;
} Transform;

static Transform to_eye_of(__global const Object *object) {
    const Transform transform = {vload4(0, object->to_eye), vload4(1, object->to_eye), vload4(2, object->to_eye)};
    return transform;
}

static float4 row_of(Transform transform, uint k) {
    return k == 0u ? transform.x : (k == 1u ? transform.y : transform.z);
}

// One coordinate of a point that is moved by a transform, given the row of it.
static float row_of_matrix(uint zero, float4 row, float3 point) {
    return add(add(add(mul(row.x, point.x), mul(row.y, point.y)), mul(row.z, point.z)), row.w);
}

// A point, moved by the transform of its object, or by another.
static float3 point_to_eye(uint zero, Transform transform, float3 point) {
    return (float3)(row_of_matrix(zero, transform.x, point), row_of_matrix(zero, transform.y, point),
                    row_of_matrix(zero, transform.z, point));
}

// Coordinate `k` of control point `l`, in the space of its object.
static float in_object_space(__global const Patch *patch, uint k, uint l) {
    return k == 0u ? patch->x[l] : (k == 1u ? patch->y[l] : patch->z[l]);
}

// One coordinate of control point `l`, by its row of the transform.
static float transformed(uint zero, __global const Patch *patch, float4 row, uint l) {
    return row_of_matrix(zero, row, (float3)(patch->x[l], patch->y[l], patch->z[l]));
}

static void in_eye_space(uint zero, __global const Patch *patch, __global const Object *object, Net *net) {
    const Transform to_eye = to_eye_of(object);
    for (uint l = 0u; l < 16u; l++) {
        net->x[l] = transformed(zero, patch, to_eye.x, l);
        net->y[l] = transformed(zero, patch, to_eye.y, l);
        net->z[l] = transformed(zero, patch, to_eye.z, l);
    }
}

// All sixteen numbers reduced to the largest in a fixed tree.
static float fold_max(const float *all) {
    float lanes[16];
    for (uint l = 0u; l < 16u; l++) {
        lanes[l] = all[l];
    }
    for (uint width = 8u; width > 0u; width /= 2u) {
        for (uint l = 0u; l < width; l++) {
            lanes[l] = max(lanes[l], lanes[l + width]);
        }
    }
    return lanes[0];
}

// All sixteen numbers reduced to the smallest in a fixed tree.
static float fold_min(const float *all) {
    float lanes[16];
    for (uint l = 0u; l < 16u; l++) {
        lanes[l] = all[l];
    }
    for (uint width = 8u; width > 0u; width /= 2u) {
        for (uint l = 0u; l < width; l++) {
            lanes[l] = min(lanes[l], lanes[l + width]);
        }
    }
    return lanes[0];
}

static float extent(const Net *net) {
    float largest[16];
    for (uint l = 0u; l < 16u; l++) {
        largest[l] = max(max(abs(net->x[l]), abs(net->y[l])), abs(net->z[l]));
    }
    return fold_max(largest);
}

static void combine_u(uint zero, const float *c, const float4 *weights, float *out) {
    for (uint k = 0u; k < 4u; k++) {
        for (uint j = 0u; j < 4u; j++) {
            out[4u * k + j] = blend4(zero, weights[k], (float4)(c[j], c[4u + j], c[8u + j], c[12u + j]));
        }
    }
}

static void combine_v(uint zero, const float *c, const float4 *weights, float *out) {
    for (uint i = 0u; i < 4u; i++) {
        const float4 p = vload4(i, c);
        for (uint l = 0u; l < 4u; l++) {
            out[4u * i + l] = blend4(zero, weights[l], p);
        }
    }
}

// The low and the high end of a surface's u, then those of its v.
static uint4 range_of(Surface surface) {
    return (uint4)(surface.u, surface.u + u_size(surface), surface.v, surface.v + v_size(surface));
}

// The control points of a range; `Net::between` in core.
static void part_between(uint zero, const Net *net, uint4 range, Net *part) {
    float4 along_u[4], along_v[4];
    float rows[16];
    blossom(zero, range.x, range.y, along_u);
    blossom(zero, range.z, range.w, along_v);
    combine_u(zero, net->x, along_u, rows);
    combine_v(zero, rows, along_v, part->x);
    combine_u(zero, net->y, along_u, rows);
    combine_v(zero, rows, along_v, part->y);
    combine_u(zero, net->z, along_u, rows);
    combine_v(zero, rows, along_v, part->z);
}

// A point of a Bézier patch by itself, as core/src/kernel/dice.rs finds it.
static float3 position_at(uint zero, const Net *net, uint2 at) {
    const float4 row = cubic(zero, param(zero, at.y)), weights = cubic(zero, param(zero, at.x));
    float4 x, y, z;
    for (uint i = 0u; i < 4u; i++) {
        x[i] = blend4(zero, row, vload4(i, net->x));
        y[i] = blend4(zero, row, vload4(i, net->y));
        z[i] = blend4(zero, row, vload4(i, net->z));
    }
    return (float3)(blend4(zero, weights, x), blend4(zero, weights, y), blend4(zero, weights, z));
}
