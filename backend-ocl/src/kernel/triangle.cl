// Mirrors core/src/kernel/triangle.rs: coverage by integer edge functions, depth by exact weights.

// A snapped vertex as seen from a sample.
typedef struct {
    long x;
    long y;
    float w;
} Corner;

static int centre(int pixel) {
    return pixel * SUBPIXELS + SUBPIXELS / 2;
}

static Corner new_corner(Vertex vertex, int column, int row) {
    const Corner corner = {vertex.x - centre(column), vertex.y - centre(row), vertex.w};
    return corner;
}

static long edge(Corner a, Corner b) {
    return a.x * b.y - a.y * b.x;
}

static long magnitude(long x) {
    return x < 0 ? -x : x;
}

// Does a sample on the right of the edge belong to it, or one on it, if it is a top or left edge?
static bool owns_side(Corner from, Corner to, long value) {
    const long dx = to.x - from.x, dy = to.y - from.y;
    return value > 0 || (value == 0 && (dy < 0 || (dy == 0 && dx > 0)));
}

static bool owns_border(Corner a, Corner b, Corner c, long ea, long eb, long ec) {
    const long area = ea + eb + ec;
    if (area > 0) {
        return owns_side(b, c, ea) && owns_side(c, a, eb) && owns_side(a, b, ec);
    }
    return area != 0 && owns_side(c, b, -ea) && owns_side(a, c, -eb) && owns_side(b, a, -ec);
}

// Edge values are those opposite each corner.
static bool owns(Corner a, Corner b, Corner c, long ea, long eb, long ec) {
    if (ea != 0 && eb != 0 && ec != 0) {
        return (ea > 0) == (eb > 0) && (eb > 0) == (ec > 0);
    }
    return owns_border(a, b, c, ea, eb, ec);
}

static float depth(uint zero, float a, float b, float c, long ea, long eb, long ec) {
    const long area = magnitude(ea + eb + ec);
    const uint zeros = (uint)clz(area);
    const uint spare = zeros < 40u ? 40u - zeros : 0u;
    const float share = recip(number((int)(area >> spare)));
    const float weight_b = mul(number((int)(magnitude(eb) >> spare)), share);
    const float weight_c = mul(number((int)(magnitude(ec) >> spare)), share);
    const float w = add(a, add(mul(weight_b, sub(b, a)), mul(weight_c, sub(c, a))));
    return clamp(w, min(min(a, b), c), max(max(a, b), c));
}

// 1 / distance at the centre of a pixel, or 0 if the triangle does not own that sample.
static float sample_triangle(uint zero, Vertex va, Vertex vb, Vertex vc, int column, int row) {
    const Corner a = new_corner(va, column, row);
    const Corner b = new_corner(vb, column, row);
    const Corner c = new_corner(vc, column, row);
    const long ea = edge(b, c), eb = edge(c, a), ec = edge(a, b);
    return owns(a, b, c, ea, eb, ec) ? depth(zero, a.w, b.w, c.w, ea, eb, ec) : 0.0f;
}

static long signed_area(Vertex a, Vertex b, Vertex c) {
    const long bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    return bx * cy - by * cx;
}

static int2 pixels_between(int low, int high) {
    const int half_pixel = SUBPIXELS / 2;
    return (int2)((low + half_pixel - 1) >> SUBPIXEL_BITS, ((high - half_pixel) >> SUBPIXEL_BITS) + 1);
}
