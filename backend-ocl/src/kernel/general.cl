// Mirrors `micropolygon`, `clipped` and `triangle` of core/src/kernel/sample.rs: any grid whatever.

// One quad, as the triangles a b c and a c d.
static void micropolygon(Sampler *s, Corners quad, uint key) {
    const int4 samples = samples_of_quad(s, quad);
    for (int y = samples.z; y < samples.w; y++) {
        for (int x = samples.x; x < samples.y; x++) {
            bool second;
            const float w = sample_quad(s->frame->zero, quad, site(s->frame, x, y), &second).w;
            if (w > 0.0f) {
                put(s, x, y, w, key);
            }
        }
    }
}

static void triangle(Sampler *s, Vertex a, Vertex b, Vertex c, uint key) {
    const Corners all = {a, b, c, c};
    const int4 samples = samples_of_quad(s, all);
    for (int y = samples.z; y < samples.w; y++) {
        for (int x = samples.x; x < samples.y; x++) {
            const float w = sample_triangle(s->frame->zero, a, b, c, site(s->frame, x, y)).w;
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

static void sample_general(Sampler *s, uint base, Quad quad, Corners corners, uint key) {
    if (is_whole(corners)) {
        micropolygon(s, corners, key);
        return;
    }
    const float3 from_a = space_at(s->frame, s->grids, base, quad.a, 0u);
    const float3 to_c = space_at(s->frame, s->grids, base, quad.c, 0u);
    clipped(s, from_a, space_at(s->frame, s->grids, base, quad.b, 0u), to_c, key);
    clipped(s, from_a, to_c, space_at(s->frame, s->grids, base, quad.d, 0u), key);
}

// Micropolygon `number` of draw `index` of the chunk, by the way that suits its grid.
static void sample_one(Sampler *s, uint kind, uint index, uint number, uint slot) {
    const uint base = grid_base(s->frame, index);
    const uint rate = rates_in(s->grids[flags_place(index)]).x;
    const Place place = new_place(number % rate, number / rate);
    const Quad quad = quad_of(rate, place);
    const Corners corners = corners_at(s, base, quad);
    const uint key = slot << CELL_BITS | cell_of(place);
    if (kind == KIND_NEAR) {
        sample_near(s, corners, key);
    } else {
        sample_general(s, base, quad, corners, key);
    }
}
