// Mirrors core/src/tess/surface.rs: where a point of a patch is and how it faces there.

// A patch as it is evaluated: what all its points need.
typedef struct {
    // Corners; for PN triangles two points and a normal an edge besides.
    float3 corners[4];
    float3 normals[4];
    // Of edge k, from corner k + 1 to corner k + 2: the point next to the first at 2 k, and next to the last.
    float3 next[6];
    // The point in the middle of a PN triangle.
    float3 centre;
    // Normals in the middle of edges.
    float3 bends[3];
} TessSurface;

// A point, and its normal.
typedef struct {
    float3 position;
    float3 normal;
} TessPoint;

static TessPoint new_tess_point(float3 position, float3 normal) {
    const TessPoint point = {position, normal};
    return point;
}

static float3 minus(uint zero, float3 a, float3 b) {
    return (float3)(sub(a.x, b.x), sub(a.y, b.y), sub(a.z, b.z));
}

// A vector made one long; zero stays zero.
static float3 unit(uint zero, float3 a) {
    const float square = dot3(a, a);
    return square > SHADE_TINY ? flush3(scale3(a, rsqrt(square))) : (float3)(0.0f, 0.0f, 0.0f);
}

// Of four vectors; where two of them are zero it does not matter which.
static float3 total(uint zero, const float3 *points) {
    return add3(add3(points[0], points[1]), add3(points[2], points[3]));
}

// Corners times their shares; `sum` in core.
static float3 weighted_sum(uint zero, float4 weights, const float3 *points) {
    const float3 scaled[4] = {scale3(points[0], weights.x), scale3(points[1], weights.y),
                              scale3(points[2], weights.z), scale3(points[3], weights.w)};
    return flush3(total(zero, scaled));
}

// The control point next to corner `p`, whose normal is `n`, towards corner `q`: a third of the way, in the tangent plane.
static float3 next_to(uint zero, float3 p, float3 n, float3 q) {
    const float height = flush(dot3(flush3(minus(zero, q, p)), n));
    const float3 flat = add3(add3(p, p), q);
    return flush3(scale3(minus(zero, flat, scale3(n, height)), THIRD));
}

// The normal in the middle of an edge: those at its ends together, mirrored on the plane across the edge.
static float3 bent(uint zero, float3 p, float3 m, float3 q, float3 n) {
    const float3 along = flush3(minus(zero, q, p)), both = add3(m, n);
    const float turned = mul(2.0f, mul(flush(dot3(along, both)), recip(add(dot3(along, along), LENGTH_TINY))));
    return unit(zero, flush3(minus(zero, both, scale3(along, flush(turned)))));
}

// The control points of a PN triangle (Vlachos et al. 2001, sec. 3).
static void bend(uint zero, TessSurface *surface) {
    float3 all = (float3)(0.0f, 0.0f, 0.0f);
    for (uint edge = 0u; edge < 3u; edge++) {
        const uint a = (edge + 1u) % 3u, b = (edge + 2u) % 3u;
        const float3 p = surface->corners[a], q = surface->corners[b];
        const float3 m = surface->normals[a], n = surface->normals[b];
        const float3 first = next_to(zero, p, m, q), last = next_to(zero, q, n, p);
        surface->next[2u * edge] = first;
        surface->next[2u * edge + 1u] = last;
        surface->bends[edge] = bent(zero, p, m, q, n);
        all = add3(all, add3(first, last));
    }
    const float3 corners = add3(add3(surface->corners[0], surface->corners[1]), surface->corners[2]);
    // The mean of the six, and half of its way from the mean of the corners.
    surface->centre = flush3(add3(scale3(all, 0.25f), scale3(corners, -0x1.555556p-3f)));
}

// Of a patch.
static TessSurface new_tess_surface(__constant TessFrame *frame, __global const TessPatch *patch) {
    TessSurface surface;
    for (uint corner = 0u; corner < 4u; corner++) {
        const bool is_there = corner < corner_count(frame);
        surface.corners[corner] = is_there ? patch_point(patch, corner) : (float3)(0.0f, 0.0f, 0.0f);
        surface.normals[corner] = is_there ? patch_normal(patch, corner) : (float3)(0.0f, 0.0f, 0.0f);
    }
    if (frame->evaluation == TESS_PN) {
        bend(frame->zero, &surface);
    }
    return surface;
}

// Cubic points and quadratic normals.
static TessPoint pn(uint zero, const TessSurface *surface, float3 at) {
    const float t[3] = {at.x, at.y, at.z};
    const float squares[3] = {mul(at.x, at.x), mul(at.y, at.y), mul(at.z, at.z)};
    const float4 cubes = (float4)(mul(squares[0], at.x), mul(squares[1], at.y), mul(squares[2], at.z), 0.0f);
    const float3 none = (float3)(0.0f, 0.0f, 0.0f);
    float3 edges[4] = {none, none, none, none}, bends[4] = {none, none, none, none};
    for (uint edge = 0u; edge < 3u; edge++) {
        const uint a = (edge + 1u) % 3u, b = (edge + 2u) % 3u;
        const float near = mul(squares[a], t[b]), far = mul(squares[b], t[a]);
        const float3 p = surface->next[2u * edge], q = surface->next[2u * edge + 1u];
        edges[edge] = scale3(add3(scale3(p, near), scale3(q, far)), 3.0f);
        bends[edge] = scale3(surface->bends[edge], mul(t[a], t[b]));
    }
    const float3 points = add3(weighted_sum(zero, cubes, surface->corners), total(zero, edges));
    const float3 point = add3(points, scale3(surface->centre, mul(6.0f, mul(mul(at.x, at.y), at.z))));
    const float4 shares = (float4)(squares[0], squares[1], squares[2], 0.0f);
    const float3 normal = add3(weighted_sum(zero, shares, surface->normals), total(zero, bends));
    return new_tess_point(flush3(point), unit(zero, flush3(normal)));
}

// Between the flat point and the mean of where the tangent planes at the corners have it.
static float3 phong(uint zero, const TessSurface *surface, float share, float4 weights) {
    const float3 flat = weighted_sum(zero, weights, surface->corners);
    float3 lifts[4];
    for (uint corner = 0u; corner < 4u; corner++) {
        const float3 n = surface->normals[corner];
        const float height = flush(dot3(flush3(minus(zero, surface->corners[corner], flat)), n));
        lifts[corner] = scale3(n, mul(height, element(weights, corner)));
    }
    return flush3(add3(flat, scale3(flush3(total(zero, lifts)), share)));
}

// Control points 4 i to 4 i + 3 of a patch along an axis.
static float4 control_row(__global const TessPatch *patch, uint i, uint axis) {
    __global const float *points = patch->points + 12u * i + axis;
    return (float4)(flush(points[0]), flush(points[3]), flush(points[6]), flush(points[9]));
}

static float3 steps_between(uint zero, float4 c) {
    return (float3)(sub(c.y, c.x), sub(c.z, c.y), sub(c.w, c.z));
}

// A point of a bicubic patch, and the normal of its tangents.
static TessPoint bezier(uint zero, __global const TessPatch *patch, float3 t) {
    const float4 wu = cubic(zero, t.x), wv = cubic(zero, t.y);
    const float3 su = cubic_slope(zero, t.x), sv = cubic_slope(zero, t.y);
    float place[3], along_u[3], along_v[3];
    for (uint axis = 0u; axis < 3u; axis++) {
        float rows[4], slopes[4];
        for (uint i = 0u; i < 4u; i++) {
            const float4 c = control_row(patch, i, axis);
            rows[i] = blend4(zero, wv, c);
            slopes[i] = blend3(zero, sv, steps_between(zero, c));
        }
        const float4 across = vload4(0, rows);
        place[axis] = blend4(zero, wu, across);
        along_u[axis] = blend3(zero, su, steps_between(zero, across));
        along_v[axis] = blend4(zero, wu, vload4(0, slopes));
    }
    const float3 normal = cross3(flush3(vload3(0, along_u)), flush3(vload3(0, along_v)));
    return new_tess_point(flush3(vload3(0, place)), unit(zero, flush3(normal)));
}

// A point and its normal; `at` in core.
static TessPoint surface_at(__constant TessFrame *frame, __global const TessPatch *patch, const TessSurface *surface,
                            uint3 coordinates) {
    const uint zero = frame->zero;
    const float4 weights = weights_of(frame, coordinates);
    const float3 at = shares(zero, coordinates);
    switch (frame->evaluation) {
    case TESS_COORDINATES: return new_tess_point(at, (float3)(0.0f, 0.0f, 0.0f));
    case TESS_BEZIER: return bezier(zero, patch, at);
    case TESS_PN: return pn(zero, surface, at);
    default: break;
    }
    const float3 normal = unit(zero, weighted_sum(zero, weights, surface->normals));
    if (frame->evaluation == TESS_PHONG) {
        return new_tess_point(phong(zero, surface, frame->phong, weights), normal);
    }
    return new_tess_point(weighted_sum(zero, weights, surface->corners), normal);
}
