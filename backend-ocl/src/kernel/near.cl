// Mirrors `sample_quad` of core/src/kernel/sample.rs for grids that are small and whole.

static bool owns_near(Corner a, Corner b, Corner c, int ea, int eb, int ec) {
    return owns(a, b, c, int_sign(ea), int_sign(eb), int_sign(ec), int_sign(ea + eb + ec));
}

// 1 / distance from the edges of the triangle that owns the sample.
static float depth_near(uint zero, Corner a, Corner b, Corner c, int ea, int eb, int ec) {
    const uint whole = magnitude(ea + eb + ec);
    const uint spare = spare_bits(32u + clz(whole));
    return hit(zero, a, b, c, whole >> spare, magnitude(eb) >> spare, magnitude(ec) >> spare).w;
}

// 1 / distance at a sample if one of the quad's two triangles, a b c and a c d, owns it; of two that overlap, the
// nearer; 0 if there is none.
static float depth_of_quad(uint zero, Corners quad, int2 site) {
    const Corner a = new_corner(quad.a, site), b = new_corner(quad.b, site);
    const Corner c = new_corner(quad.c, site), d = new_corner(quad.d, site);
    const int ab = edge(a, b), bc = edge(b, c), ca = edge(c, a), cd = edge(c, d), da = edge(d, a);
    float w = 0.0f;
    if (owns_near(a, b, c, bc, ca, ab)) {
        w = depth_near(zero, a, b, c, bc, ca, ab);
    }
    if (owns_near(a, c, d, cd, da, -ca)) {
        w = max(w, depth_near(zero, a, c, d, cd, da, -ca));
    }
    return w;
}

static void sample_near(Sampler *s, Corners quad, uint key) {
    const int4 samples = samples_of_quad(s, quad);
    for (int y = samples.z; y < samples.w; y++) {
        for (int x = samples.x; x < samples.y; x++) {
            const float w = depth_of_quad(s->frame->zero, quad, site(s->frame, x, y));
            if (w > 0.0f) {
                put(s, x, y, w, key);
            }
        }
    }
}
