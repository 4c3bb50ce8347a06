// Mirrors core/src/tess/corner.rs: corners and outer edges of a patch, and the share that each corner has in a point.

// Where the normals of a patch begin among its points.
#define NORMALS 4u

// The corners at which an outer edge begins and ends, on its way around the patch.
static uint2 ends(__constant TessFrame *frame, uint edge) {
    if (frame->domain == TESS_TRIANGLES) {
        return (uint2)((edge + 1u) % 3u, (edge + 2u) % 3u);
    }
    return (uint2)((edge + 3u) % 4u, edge);
}

// Number of corners, and of outer edges.
static uint corner_count(__constant TessFrame *frame) {
    return frame->domain == TESS_TRIANGLES ? 3u : 4u;
}

// Is a point on an outer edge?
static bool is_on_edge(__constant TessFrame *frame, uint3 coordinates, uint edge) {
    const uint along_u = edge == 0u ? coordinates.x : coordinates.y;
    if (frame->domain == TESS_TRIANGLES) {
        return (edge == 2u ? coordinates.z : along_u) == 0u;
    }
    const uint along_v = edge == 2u ? coordinates.x : coordinates.y;
    return edge < 2u ? along_u == 0u : along_v == TESS_UNIT;
}

// Coordinates as floats: exact.
static float3 shares(uint zero, uint3 coordinates) {
    const float unit = 0x1p-16f;
    return (float3)(mul(number((int)coordinates.x), unit), mul(number((int)coordinates.y), unit),
                    mul(number((int)coordinates.z), unit));
}

// How much of each corner is in a point. On an outer edge this is exact, and 0 for the corners across.
static float4 weights_of(__constant TessFrame *frame, uint3 coordinates) {
    const uint zero = frame->zero;
    const float3 at = shares(zero, coordinates);
    if (frame->domain == TESS_TRIANGLES) {
        return (float4)(at.x, at.y, at.z, 0.0f);
    }
    const float s = sub(1.0f, at.x), t = sub(1.0f, at.y);
    return (float4)(mul(s, t), mul(at.x, t), mul(at.x, at.y), mul(s, at.y));
}

// One of four numbers.
static float element(float4 all, uint index) {
    const float low = index == 0u ? all.x : all.y, high = index == 2u ? all.z : all.w;
    return index < 2u ? low : high;
}

// A point of a patch, by its index.
static float3 patch_point(__global const TessPatch *patch, uint index) {
    return flush3(vload3(index, patch->points));
}

// The normal at a corner.
static float3 patch_normal(__global const TessPatch *patch, uint corner) {
    return patch_point(patch, NORMALS + corner);
}

// Which of the 16 points of a Bézier patch a corner is.
static uint bezier_corner(uint corner) {
    const bool u = corner == 1u || corner == 2u, v = corner > 1u;
    return (u ? 12u : 0u) + (v ? 3u : 0u);
}

// A corner of a patch, wherever it is among its points.
static float3 patch_corner(__constant TessFrame *frame, __global const TessPatch *patch, uint index) {
    return patch_point(patch, frame->evaluation == TESS_BEZIER ? bezier_corner(index) : index);
}
