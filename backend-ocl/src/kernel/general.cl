// Mirrors `micropolygon`, `clipped` and `triangle` of core/src/kernel/sample.rs: any grid whatever.

// One quad, as the triangles a b c and a c d.
static void micropolygon(Sampler *s, Vertex a, Vertex b, Vertex c, Vertex d, uint key) {
    const uint zero = s->frame->zero;
    const int4 pixels = pixels_of_quad(s->box, a, b, c, d);
    for (int y = pixels.z; y < pixels.w; y++) {
        for (int x = pixels.x; x < pixels.y; x++) {
            const float w = max(sample_triangle(zero, a, b, c, x, y), sample_triangle(zero, a, c, d, x, y));
            if (w > 0.0f) {
                put(s, x, y, w, key);
            }
        }
    }
}

static void triangle(Sampler *s, Vertex a, Vertex b, Vertex c, uint key) {
    const int4 pixels = pixels_of_quad(s->box, a, b, c, c);
    for (int y = pixels.z; y < pixels.w; y++) {
        for (int x = pixels.x; x < pixels.y; x++) {
            const float w = sample_triangle(s->frame->zero, a, b, c, x, y);
            if (w > 0.0f) {
                put(s, x, y, w, key);
            }
        }
    }
}

// Clips a triangle and samples what is left of it, as a fan.
static void clipped(Sampler *s, float3 a, float3 b, float3 c, uint key) {
    Polygon polygon;
    clip(s->frame, a, b, c, &polygon);
    for (uint k = 2u; k < polygon.count; k++) {
        triangle(s, project_clipped(s->frame, polygon.corners[0]),
                 project_clipped(s->frame, polygon.corners[k - 1u]),
                 project_clipped(s->frame, polygon.corners[k]), key);
    }
}

static void sample_general(Sampler *s, uint base, Quad quad, uint key) {
    const Vertex a = vertex_at(s->frame, s->grids, base, quad.a);
    const Vertex b = vertex_at(s->frame, s->grids, base, quad.b);
    const Vertex c = vertex_at(s->frame, s->grids, base, quad.c);
    const Vertex d = vertex_at(s->frame, s->grids, base, quad.d);
    if (a.w > 0.0f && b.w > 0.0f && c.w > 0.0f && d.w > 0.0f) {
        micropolygon(s, a, b, c, d, key);
    } else {
        const float3 from_a = space_at(s->frame, s->grids, base, quad.a, 0u);
        const float3 to_c = space_at(s->frame, s->grids, base, quad.c, 0u);
        clipped(s, from_a, space_at(s->frame, s->grids, base, quad.b, 0u), to_c, key);
        clipped(s, from_a, to_c, space_at(s->frame, s->grids, base, quad.d, 0u), key);
    }
}
