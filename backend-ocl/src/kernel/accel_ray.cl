// Mirrors core/src/accel/ray.rs: where a ray is in a box, and where it hits a triangle.

// Rounding errors of a place along the ray stay below this share of it.
#define RAY_ROUNDING (1.0f / 1048576.0f)
// Nothing is taken to be farther away along an axis.
#define RAY_FAR 1099511627776.0f
// Directions whose components are smaller than this are taken for parallel to a side.
#define RAY_PARALLEL (1.0f / RAY_FAR)

// A ray, or a point: then its far end is the square of how far to look.
typedef struct {
    float3 origin;
    float3 direction;
    // 1 / direction; 0 along axes that the ray is parallel to.
    float3 steps;
    float far;
    bool is_ray;
} Search;

static float ray_step(uint zero, float x) {
    return abs(x) < RAY_PARALLEL ? 0.0f : recip(x);
}

static Search search_of(uint zero, __global const Probe *probe, bool is_ray) {
    Search search;
    search.origin = flush3((float3)(probe->origin[0], probe->origin[1], probe->origin[2]));
    search.direction = flush3((float3)(probe->direction[0], probe->direction[1], probe->direction[2]));
    const float3 d = search.direction;
    search.steps = (float3)(ray_step(zero, d.x), ray_step(zero, d.y), ray_step(zero, d.z));
    search.far = probe->far;
    search.is_ray = is_ray;
    return search;
}

// From one coordinate to another, `most` at most.
static float between(uint zero, float from, float to, float most) {
    return clamp(flush(sub(flush(to), flush(from))), neg(most), most);
}

static float3 offset_to(uint zero, float3 from, float3 to, float most) {
    return (float3)(between(zero, from.x, to.x, most), between(zero, from.y, to.y, most),
                    between(zero, from.z, to.z, most));
}

// What of a span is between two sides of a box.
static float2 cut(uint zero, float2 span, float origin, float step, float low, float high) {
    const float to_low = between(zero, origin, low, RAY_FAR), to_high = between(zero, origin, high, RAY_FAR);
    if (step == 0.0f) {
        return to_low <= 0.0f && to_high >= 0.0f ? span : (float2)(1.0f, 0.0f);
    }
    const float a = mul(to_low, step), b = mul(to_high, step);
    const float near = min(a, b), far = max(a, b);
    return (float2)(max(span.x, sub(near, mul(abs(near), RAY_ROUNDING))),
                    min(span.y, add(far, mul(abs(far), RAY_ROUNDING))));
}

// Between which places a ray may be in a node's box; the first is larger than the second if it is not.
static float2 within(uint zero, const Search *ray, __global const Node *node) {
    float2 span = (float2)(0.0f, ray->far);
    span = cut(zero, span, ray->origin.x, ray->steps.x, node->low[0], node->high[0]);
    span = cut(zero, span, ray->origin.y, ray->steps.y, node->low[1], node->high[1]);
    return cut(zero, span, ray->origin.z, ray->steps.z, node->low[2], node->high[2]);
}

static float3 corner_of(__global const Triangle *triangle, uint corner) {
    __global const float *at = triangle->corners + 3u * corner;
    return (float3)(at[0], at[1], at[2]);
}

// Where the ray hits a triangle, from either side; false if it does not.
static bool hit(uint zero, const Search *ray, __global const Triangle *triangle, float *t) {
    const float3 a = corner_of(triangle, 0u), b = corner_of(triangle, 1u), c = corner_of(triangle, 2u);
    const float3 along = offset_to(zero, a, b, RAY_FAR), across = offset_to(zero, a, c, RAY_FAR);
    const float3 from = offset_to(zero, a, ray->origin, RAY_FAR);
    const float3 p = flush3(cross3(ray->direction, across));
    const float signed_size = flush(dot3(along, p));
    const float sign = signed_size < 0.0f ? neg(1.0f) : 1.0f;
    const float size = mul(signed_size, sign);
    const float u = mul(flush(dot3(from, p)), sign);
    const float3 q = flush3(cross3(from, along));
    const float v = mul(flush(dot3(ray->direction, q)), sign);
    if (size == 0.0f || u < 0.0f || v < 0.0f || add(u, v) > size) {
        return false;
    }
    *t = mul(mul(flush(dot3(across, q)), sign), recip(size));
    return true;
}
