// Mirrors core/src/accel/nearest.rs: how far a point is from a box and from a triangle, squared.

// Differences of coordinates are no larger.
#define POINT_FAR 268435456.0f

// How far it is beside a box along one axis.
static float beside(uint zero, float at, float low, float high) {
    return max(max(between(zero, at, low, POINT_FAR), between(zero, high, at, POINT_FAR)), 0.0f);
}

static float to_box(uint zero, float3 point, __global const Node *node) {
    const float3 d = (float3)(beside(zero, point.x, node->low[0], node->high[0]),
                              beside(zero, point.y, node->low[1], node->high[1]),
                              beside(zero, point.z, node->low[2], node->high[2]));
    return dot3(d, d);
}

// Is the origin on the inner side of an edge?
static bool is_inside(uint zero, float3 normal, float3 start, float3 edge) {
    return flush(dot3(flush3(cross3(normal, edge)), start)) <= 0.0f;
}

// The square of how far the origin is from a line.
static float to_line(uint zero, float3 start, float3 edge) {
    const float square = flush(dot3(edge, edge));
    if (square == 0.0f) {
        return dot3(start, start);
    }
    const float share = clamp(mul(neg(flush(dot3(start, edge))), recip(square)), 0.0f, 1.0f);
    const float3 nearest = flush3(add3(start, scale3(edge, flush(share))));
    return dot3(nearest, nearest);
}

static float to_triangle(uint zero, float3 point, __global const Triangle *triangle) {
    const float3 a = offset_to(zero, point, corner_of(triangle, 0u), POINT_FAR);
    const float3 b = offset_to(zero, point, corner_of(triangle, 1u), POINT_FAR);
    const float3 c = offset_to(zero, point, corner_of(triangle, 2u), POINT_FAR);
    const float3 ab = offset_to(zero, a, b, POINT_FAR), bc = offset_to(zero, b, c, POINT_FAR);
    const float3 ca = offset_to(zero, c, a, POINT_FAR);
    const float3 normal = flush3(cross3(ab, bc));
    const float size = flush(dot3(normal, normal));
    if (size > 0.0f && is_inside(zero, normal, a, ab) && is_inside(zero, normal, b, bc) &&
        is_inside(zero, normal, c, ca)) {
        const float height = flush(mul(flush(dot3(normal, a)), rsqrt(size)));
        return mul(height, height);
    }
    return min(min(to_line(zero, a, ab), to_line(zero, b, bc)), to_line(zero, c, ca));
}
