// Mirrors `sample_quad` of core/src/kernel/sample.rs for grids that are small and whole.

static bool owns_near(Corner a, Corner b, Corner c, int ea, int eb, int ec) {
    return owns(a, b, c, int_sign(ea), int_sign(eb), int_sign(ec), int_sign(ea + eb + ec));
}

// 1 / distance from the edges of the triangle that owns the sample.
static float depth_near(uint zero, float a, float b, float c, int ea, int eb, int ec) {
    const uint whole = magnitude(ea + eb + ec);
    const uint spare = spare_bits(32u + clz(whole));
    return depth(zero, a, b, c, whole >> spare, magnitude(eb) >> spare, magnitude(ec) >> spare);
}

// 1 / distance at the centre of a pixel if one of the quad's two triangles, a b c and a c d, owns it; of two
// that overlap, the nearer; 0 if there is none.
static float sample_quad(uint zero, Vertex va, Vertex vb, Vertex vc, Vertex vd, int column, int row) {
    const Corner a = new_corner(va, column, row);
    const Corner b = new_corner(vb, column, row);
    const Corner c = new_corner(vc, column, row);
    const Corner d = new_corner(vd, column, row);
    const int ab = edge(a, b), bc = edge(b, c), ca = edge(c, a), cd = edge(c, d), da = edge(d, a);
    float w = 0.0f;
    if (owns_near(a, b, c, bc, ca, ab)) {
        w = depth_near(zero, a.w, b.w, c.w, bc, ca, ab);
    }
    if (owns_near(a, c, d, cd, da, -ca)) {
        w = max(w, depth_near(zero, a.w, c.w, d.w, cd, da, -ca));
    }
    return w;
}

static void sample_near(Sampler *s, uint base, Quad quad, uint key) {
    const Vertex a = vertex_at(s->frame, s->grids, base, quad.a);
    const Vertex b = vertex_at(s->frame, s->grids, base, quad.b);
    const Vertex c = vertex_at(s->frame, s->grids, base, quad.c);
    const Vertex d = vertex_at(s->frame, s->grids, base, quad.d);
    const int4 pixels = pixels_of_quad(s->box, a, b, c, d);
    for (int y = pixels.z; y < pixels.w; y++) {
        for (int x = pixels.x; x < pixels.y; x++) {
            const float w = sample_quad(s->frame->zero, a, b, c, d, x, y);
            if (w > 0.0f) {
                put(s, x, y, w, key);
            }
        }
    }
}
