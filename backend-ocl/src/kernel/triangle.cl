// Mirrors core/src/kernel/triangle.rs: coverage by integer edge functions, depth by exact weights.
//
// Edge functions need 64-bit integers. Where all corners lie within 64 pixels of the sample they fit 32 bits,
// which gives the same answers faster.

// A snapped vertex as seen from a sample.
typedef struct {
    int x;
    int y;
    float w;
} Corner;

static int centre(int pixel) {
    return pixel * SUBPIXELS + SUBPIXELS / 2;
}

static Corner new_corner(Vertex vertex, int column, int row) {
    const Corner corner = {vertex.x - centre(column), vertex.y - centre(row), vertex.w};
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

// 1 / distance from area and weights that fit 24 bits.
static float depth(uint zero, float a, float b, float c, uint area, uint for_b, uint for_c) {
    const float share = recip(number((int)area));
    const float weight_b = mul(number((int)for_b), share);
    const float weight_c = mul(number((int)for_c), share);
    const float w = add(a, add(mul(weight_b, sub(b, a)), mul(weight_c, sub(c, a))));
    return clamp(w, min(min(a, b), c), max(max(a, b), c));
}

// Bits by which an area must be shifted to fit a float's mantissa, from its leading zeros in 64 bits.
static uint spare_bits(uint leading_zeros) {
    return leading_zeros < 40u ? 40u - leading_zeros : 0u;
}

// 1 / distance at the centre of a pixel, or 0 if the triangle does not own that sample.
static float sample_triangle(uint zero, Vertex va, Vertex vb, Vertex vc, int column, int row) {
    const Corner a = new_corner(va, column, row);
    const Corner b = new_corner(vb, column, row);
    const Corner c = new_corner(vc, column, row);
    const long ea = wide_edge(b, c), eb = wide_edge(c, a), ec = wide_edge(a, b);
    const long area = ea + eb + ec;
    if (!owns(a, b, c, wide_sign(ea), wide_sign(eb), wide_sign(ec), wide_sign(area))) {
        return 0.0f;
    }
    const ulong whole = wide_magnitude(area);
    const uint spare = spare_bits((uint)clz(whole));
    return depth(zero, a.w, b.w, c.w, (uint)(whole >> spare), (uint)(wide_magnitude(eb) >> spare),
                 (uint)(wide_magnitude(ec) >> spare));
}

// Sign of the area of a triangle on screen: -1 if it runs anticlockwise.
static int signed_area(Vertex a, Vertex b, Vertex c) {
    const Corner to_b = {b.x - a.x, b.y - a.y, 0.0f};
    const Corner to_c = {c.x - a.x, c.y - a.y, 0.0f};
    return wide_sign(wide_edge(to_b, to_c));
}

// First pixel whose centre is not before `low`, and one past the last whose centre is not after `high`.
static int2 pixels_between(int low, int high) {
    const int half_pixel = SUBPIXELS / 2;
    return (int2)((low + half_pixel - 1) >> SUBPIXEL_BITS, ((high - half_pixel) >> SUBPIXEL_BITS) + 1);
}
