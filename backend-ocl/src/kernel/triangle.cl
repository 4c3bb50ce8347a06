// Mirrors core/src/kernel/triangle.rs: coverage by integer edge functions, depth by exact weights.
//
// Edge functions need 64-bit integers. Where all corners lie within 64 pixels of the sample they fit 32 bits,
// which gives the same answers faster.

// What a triangle shows at a sample that it owns: 1 / distance, and the shares of the second and the third corner.
// No 1 / distance: it does not own it.
typedef struct {
    float w;
    float for_b;
    float for_c;
} Hit;

// A snapped vertex as seen from a sample.
typedef struct {
    int x;
    int y;
    float w;
} Corner;

// `vertex` as seen from a sample, which is at a place in snapped units.
static Corner new_corner(Vertex vertex, int2 site) {
    const Corner corner = {vertex.x - site.x, vertex.y - site.y, vertex.w};
    return corner;
}

static long wide_edge(Corner a, Corner b) {
    return (long)a.x * b.y - (long)a.y * b.x;
}

static int edge(Corner a, Corner b) {
    return a.x * b.y - a.y * b.x;
}

static ulong wide_magnitude(long a) {
    return a < 0 ? -a : a;
}

static uint magnitude(int a) {
    return a < 0 ? -a : a;
}

// -1, 0 or 1.
static int wide_sign(long a) {
    return a < 0 ? -1 : a > 0;
}

static int int_sign(int a) {
    return a < 0 ? -1 : a > 0;
}

static bool owns_border(Corner before, Corner after, int edge_sign, int area) {
    const int value = edge_sign * area;
    const int dx = (after.x - before.x) * area, dy = (after.y - before.y) * area;
    return value > 0 || (value == 0 && (dy < 0 || (dy == 0 && dx > 0)));
}

// `ea`, `eb` and `ec` are the signs of the values of the edges opposite the corners, `area` that of their sum.
static bool owns(Corner a, Corner b, Corner c, int ea, int eb, int ec, int area) {
    if (ea != 0 && eb != 0 && ec != 0) {
        return ea == eb && eb == ec;
    }
    return area != 0 && owns_border(b, c, ea, area) && owns_border(c, a, eb, area)
        && owns_border(a, b, ec, area);
}

// A value of three corners at a place inside the triangle, given the shares of the second and the third.
static float weighted(uint zero, float a, float b, float c, float for_b, float for_c) {
    const float value = add(a, add(mul(for_b, sub(b, a)), mul(for_c, sub(c, a))));
    return clamp(value, min(min(a, b), c), max(max(a, b), c));
}

// From area and weights that fit 24 bits.
static Hit hit(uint zero, Corner a, Corner b, Corner c, uint area, uint weight_b, uint weight_c) {
    const float share = recip(number((int)area));
    const float for_b = mul(number((int)weight_b), share), for_c = mul(number((int)weight_c), share);
    const Hit found = {weighted(zero, a.w, b.w, c.w, for_b, for_c), for_b, for_c};
    return found;
}

// Bits by which an area must be shifted to fit a float's mantissa, from its leading zeros in 64 bits.
static uint spare_bits(uint leading_zeros) {
    return leading_zeros < 40u ? 40u - leading_zeros : 0u;
}

static Hit sample_triangle(uint zero, Vertex va, Vertex vb, Vertex vc, int2 site) {
    const Corner a = new_corner(va, site), b = new_corner(vb, site), c = new_corner(vc, site);
    const long ea = wide_edge(b, c), eb = wide_edge(c, a), ec = wide_edge(a, b);
    const long area = ea + eb + ec;
    if (!owns(a, b, c, wide_sign(ea), wide_sign(eb), wide_sign(ec), wide_sign(area))) {
        const Hit none = {0.0f, 0.0f, 0.0f};
        return none;
    }
    const ulong whole = wide_magnitude(area);
    const uint spare = spare_bits((uint)clz(whole));
    return hit(zero, a, b, c, (uint)(whole >> spare), (uint)(wide_magnitude(eb) >> spare),
               (uint)(wide_magnitude(ec) >> spare));
}

// Sign of the area of a triangle on screen: -1 if it runs anticlockwise.
static int signed_area(Vertex a, Vertex b, Vertex c) {
    const Corner to_b = {b.x - a.x, b.y - a.y, 0.0f};
    const Corner to_c = {c.x - a.x, c.y - a.y, 0.0f};
    return wide_sign(wide_edge(to_b, to_c));
}

// Where the sample in this column and row is.
static int2 site(__constant Frame *frame, int column, int row) {
    const int mask = (1 << frame->pattern_bits) - 1;
    const int index = (row & mask) << frame->pattern_bits | (column & mask);
    return (int2)((column << frame->pitch_bits) + frame->sample_x[index],
                  (row << frame->pitch_bits) + frame->sample_y[index]);
}

// First column (or row) of samples that need not be before `low`, and one past the last that need not be after `high`.
static int2 samples_between(__constant Frame *frame, int low, int high) {
    const int field = (1 << frame->pitch_bits) - 1;
    return (int2)((low - frame->most_offset + field) >> frame->pitch_bits,
                  ((high - frame->least_offset) >> frame->pitch_bits) + 1);
}
