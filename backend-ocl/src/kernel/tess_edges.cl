// Mirrors core/src/tess/control.rs: built-in control: the level of an edge depends on nothing but the edge, the same from
// either end.

static float3 flushed_minus(uint zero, float3 a, float3 b) {
    return flush3(add3(a, (float3)(neg(b.x), neg(b.y), neg(b.z))));
}

// Length of a vector, never 0; `length` in core, which is a built-in function here.
static float vector_length(uint zero, float3 a) {
    return sqrt(add(dot3(a, a), LENGTH_TINY));
}

// How long an edge is, or the legs of its control points.
static float edge_length(__constant TessFrame *frame, __global const TessPatch *patch, uint2 corners) {
    const uint zero = frame->zero;
    const float3 a = patch_corner(frame, patch, corners.x), d = patch_corner(frame, patch, corners.y);
    if (frame->evaluation != TESS_BEZIER) {
        return vector_length(zero, flushed_minus(zero, d, a));
    }
    const uint first = bezier_corner(corners.x), last = bezier_corner(corners.y);
    const float3 b = patch_point(patch, (2u * first + last) / 3u), c = patch_point(patch, (first + 2u * last) / 3u);
    return add(add(vector_length(zero, flushed_minus(zero, b, a)), vector_length(zero, flushed_minus(zero, d, c))),
               vector_length(zero, flushed_minus(zero, c, b)));
}

// Level of an outer edge: never below 1, so that no patch is dropped.
static float edge_level(__constant TessFrame *frame, __global const TessPatch *patch, uint edge) {
    const uint zero = frame->zero;
    const uint2 at = ends(frame, edge);
    const float3 both = add3(patch_corner(frame, patch, at.x), patch_corner(frame, patch, at.y));
    const float3 apart = flushed_minus(zero, scale3(both, 0.5f), vload3(0, frame->eye));
    const float near = mul(frame->factor, recip(vector_length(zero, apart)));
    return max(frame->control == TESS_LENGTH ? mul(near, edge_length(frame, patch, at)) : near, 1.0f);
}

static TessLevels constant_levels(__constant TessFrame *frame) {
    TessLevels levels;
    for (uint k = 0u; k < 4u; k++) {
        levels.outer[k] = frame->outer[k];
    }
    levels.inner[0] = frame->inner[0];
    levels.inner[1] = frame->inner[1];
    return levels;
}

// Levels of a patch; not for TESS_GIVEN, where patches have levels of their own. `levels_of` in core.
static TessLevels levels_by_frame(__constant TessFrame *frame, __global const TessPatch *patch) {
    if (frame->control == TESS_CONSTANT) {
        return constant_levels(frame);
    }
    float edges[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    for (uint edge = 0u; edge < corner_count(frame); edge++) {
        edges[edge] = edge_level(frame, patch, edge);
    }
    const float across = max(edges[0], edges[2]), along = max(edges[1], edges[3]);
    if (frame->domain == TESS_ISOLINES) {
        const TessLevels levels = {{across, along, 1.0f, 1.0f}, {1.0f, 1.0f}};
        return levels;
    }
    const bool is_triangle = frame->domain == TESS_TRIANGLES;
    const TessLevels levels = {{edges[0], edges[1], edges[2], edges[3]},
                               {is_triangle ? max(across, edges[1]) : along, is_triangle ? 1.0f : across}};
    return levels;
}
