// Mirrors core/src/kernel/shade.rs: a colour a vertex. Ambient and diffuse light and a highlight, two-sided.

static float3 unit(uint zero, float3 a) {
    return scale3(a, rsqrt(max(dot3(a, a), SHADE_TINY)));
}

static float3 towards_eye(uint zero, float3 away, float3 normal) {
    return scale3(normal, dot3(normal, away) > 0.0f ? -1.0f : 1.0f);
}

static float3 direction(uint zero, __constant float *light, float3 point) {
    const float3 p = scale3(point, light[3]);
    return unit(zero, (float3)(sub(light[0], p.x), sub(light[1], p.y), sub(light[2], p.z)));
}

// Diffuse light and highlight of one light.
static float2 lit(__constant Frame *frame, uint gloss, uint light, float3 point, float3 to_eye, float3 normal) {
    const uint zero = frame->zero;
    const float3 to_light = direction(zero, frame->light_vector + 4u * light, point);
    const float3 halfway = unit(zero, add3(to_light, to_eye));
    const float diffuse = max(dot3(normal, to_light), 0.0f);
    float highlight = diffuse > 0.0f ? max(dot3(normal, halfway), 0.0f) : 0.0f;
    for (uint times = 0u; times < gloss; times++) {
        highlight = flush(mul(highlight, highlight));
    }
    return (float2)(diffuse, highlight);
}

// One channel of the light that is reflected, added to what there is.
static float reflect_channel(__constant Frame *frame, __global const Object *object, uint light, uint k,
                             float2 lit, float colour) {
    const uint zero = frame->zero;
    const float reflected = add(mul(object->colour[k], lit.x), mul(object->specular, lit.y));
    return add(colour, mul(reflected, frame->light_colour[3u * light + k]));
}

// Linear RGB of a vertex.
static float3 shade(__constant Frame *frame, __global const Object *object, float3 point, float3 normal) {
    const uint zero = frame->zero;
    const float3 away = unit(zero, point);
    const float3 to_eye = scale3(away, neg(1.0f));
    const float3 facing = towards_eye(zero, away, normal);
    float3 colour = (float3)(mul(frame->ambient[0], object->colour[0]), mul(frame->ambient[1], object->colour[1]),
                             mul(frame->ambient[2], object->colour[2]));
    for (uint light = 0u; light < frame->light_count; light++) {
        const float2 both = lit(frame, object->gloss, light, point, to_eye, facing);
        colour.x = reflect_channel(frame, object, light, 0u, both, colour.x);
        colour.y = reflect_channel(frame, object, light, 1u, both, colour.y);
        colour.z = reflect_channel(frame, object, light, 2u, both, colour.z);
    }
    return colour;
}
