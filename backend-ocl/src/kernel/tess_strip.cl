// Mirrors core/src/tess/strip.rs: the triangles between two rows of vertices, each by its index alone.

// Marks on half a ruler.
#define MARKS 32u

// Not triangles but the segments of the outside.
#define STRIP_LINE 0u
// The outside has two segments more than the inside.
#define STRIP_REGULAR 1u
// Both sides are divided as they like: vertices come in the order of the marks of a ruler.
#define STRIP_BETWEEN 2u
// Both sides have as many segments, and the inside runs the other way.
#define STRIP_ROW 3u
// The same where there is a square in the middle of a row along v: its diagonal runs the other way.
#define STRIP_COLUMN 4u
// A patch that is a single square.
#define STRIP_SQUARE 5u
// A single triangle.
#define STRIP_TRIANGLE 6u

// A row of vertices: index of the first one, from one index to the next modulo 2^32, segments, index of the last one.
typedef struct {
    uint first;
    uint step;
    uint length;
    uint end;
} Run;

// A strip of triangles between two rows of vertices.
typedef struct {
    // Index of its first triangle, and how many it has.
    uint first;
    uint count;
    // The ring that the inside is of; of isolines, which line.
    uint ring;
    // The side of the rings.
    uint side;
    Run outside;
    Run inside;
    // How its triangles are laid.
    uint kind;
    // Marks on half of the outside and of the inside, if it is STRIP_BETWEEN.
    uint2 marks;
} Strip;

static Run new_run(uint first, uint step, uint length, uint end) {
    const Run run = {first, step, length, end};
    return run;
}

static Strip new_strip(uint first, uint ring, uint side, Run outside, Run inside) {
    const Strip strip = {first, 0u, ring, side, outside, inside, STRIP_LINE, (uint2)(0u, 0u)};
    return strip;
}

static Strip line_of(uint line, uint count, uint vertex) {
    const Run outside = new_run(vertex, 1u, count, vertex + count), none = new_run(0u, 0u, 0u, 0u);
    Strip strip = new_strip(line * count, line, 0u, outside, none);
    strip.count = count;
    return strip;
}

static Strip regular(Strip strip) {
    strip.count = 2u * strip.inside.length + 2u;
    strip.kind = STRIP_REGULAR;
    return strip;
}

static Strip between(Strip strip, const Division *outside, const Division *inside) {
    strip.count = strip.outside.length + strip.inside.length;
    strip.kind = STRIP_BETWEEN;
    strip.marks = (uint2)(marks_of(outside), marks_of(inside));
    return strip;
}

static Strip row(Strip strip, bool is_whole, bool is_alike) {
    const uint kind = is_alike ? STRIP_ROW : STRIP_COLUMN;
    strip.kind = is_whole ? STRIP_SQUARE : kind;
    return strip;
}

// Index of a vertex of a row.
static uint vertex(const Run *run, uint at) {
    return at >= run->length ? run->end : run->first + run->step * at;
}

// Diagonals run from the ends of the outside towards the middle of the inside. At both ends a quadrilateral is but half
// there.
static uint3 regular_triangle(const Strip *strip, uint index) {
    const Run *inside = &strip->inside;
    const uint quad = (index + 1u) / 2u;
    const bool is_second = index % 2u == 0u;
    const uint a = vertex(&strip->outside, quad), b = vertex(&strip->outside, quad + 1u);
    if (index + 1u == strip->count) {
        return (uint3)(a, b, inside->end);
    }
    const uint d = vertex(inside, quad);
    if (quad <= (inside->length + 1u) / 2u) {
        return is_second ? (uint3)(a, b, d) : (uint3)(a, d, vertex(inside, quad - 1u));
    }
    const uint c = vertex(inside, quad - 1u);
    return is_second ? (uint3)(c, b, d) : (uint3)(c, a, b);
}

// Corners of a square of a row, counter-clockwise from the start of its outside.
static uint4 square(const Strip *strip, uint index) {
    const Run *outside = &strip->outside, *inside = &strip->inside;
    const uint back = inside->length - index;
    return (uint4)(vertex(outside, index), vertex(outside, index + 1u), vertex(inside, back - 1u),
                   vertex(inside, back));
}

// All diagonals run the same way.
static uint3 row_triangle(const Strip *strip, uint index) {
    const uint4 at = square(strip, index / 2u);
    return index % 2u == 0u ? (uint3)(at.w, at.x, at.y) : (uint3)(at.w, at.y, at.z);
}

// All diagonals but the one in the middle run the same way.
static uint3 column_triangle(const Strip *strip, uint index) {
    const uint4 at = square(strip, index / 2u);
    const bool is_first = index % 2u == 0u;
    if (index / 2u == strip->inside.length / 2u) {
        return is_first ? (uint3)(at.x, at.z, at.w) : (uint3)(at.x, at.y, at.z);
    }
    return is_first ? (uint3)(at.x, at.y, at.w) : (uint3)(at.w, at.y, at.z);
}

// How many of the first `marks` marks lie before mark `end` of half a ruler: first comes the one at its start, then that
// in its middle, then those in the middle between these, and so on, each time from the start on.
static uint marks_before(uint end, uint marks) {
    if (marks == 0u || end == 0u) {
        return 0u;
    }
    const uint whole = highest_bit(marks);
    const uint rest = marks - whole;
    const uint apart = MARKS / whole;
    return 1u + (end - 1u) / apart + lesser_of((end - 1u + apart / 2u) / apart, rest);
}

// The same without the one at the start.
static uint inner_marks_before(uint end, uint marks) {
    return saturating_sub(marks_before(end, marks), 1u);
}

// Step `index` of the first half: at which vertices both sides are, and whether the outside goes on. `step` in core,
// which is a built-in function here.
static uint3 step_of(const Strip *strip, uint index) {
    const uint outer = strip->marks.x, inner = strip->marks.y;
    // The mark before which no more than `index` steps are taken.
    uint mark = 0u;
    for (uint bit = MARKS / 2u; bit > 0u; bit >>= 1) {
        if (marks_before(mark + bit, outer) + inner_marks_before(mark + bit, inner) <= index) {
            mark += bit;
        }
    }
    const uint out = marks_before(mark, outer), inn = inner_marks_before(mark, inner);
    // At a mark of both, the inside goes on first.
    const uint inside_goes_on = inner_marks_before(mark + 1u, inner) - inn;
    const bool is_outside = index - out - inn >= inside_goes_on;
    return (uint3)(out, is_outside ? inn + inside_goes_on : inn, is_outside ? 1u : 0u);
}

static uint3 advance(const Strip *strip, uint out, uint inn, bool is_outside) {
    const Run *outside = &strip->outside, *inside = &strip->inside;
    if (is_outside) {
        return (uint3)(vertex(outside, out), vertex(outside, out + 1u), vertex(inside, inn));
    }
    return (uint3)(vertex(inside, inn), vertex(outside, out), vertex(inside, inn + 1u));
}

// What is between the first half and the other one.
static uint3 middle_between(const Strip *strip, uint middle) {
    const Run *outside = &strip->outside, *inside = &strip->inside;
    const uint outer = strip->marks.x, inn = saturating_sub(strip->marks.y, 1u);
    const bool is_inside_odd = inside->length % 2u == 1u;
    if (outside->length % 2u == 0u || (is_inside_odd && middle == 0u)) {
        return advance(strip, outer, inn, false);
    }
    return (uint3)(vertex(inside, is_inside_odd ? inn + 1u : inn), vertex(outside, outer), vertex(outside, outer + 1u));
}

// The first half of the triangles as they come, the other half mirrored, and what is between them.
static uint3 triangle_between(const Strip *strip, uint index) {
    // On the inside the corner is no mark, as the ring there is two segments shorter.
    const uint first_half = strip->marks.x + saturating_sub(strip->marks.y, 1u);
    if (index < first_half) {
        const uint3 at = step_of(strip, index);
        return advance(strip, at.x, at.y, at.z != 0u);
    }
    if (index + first_half < strip->count) {
        return middle_between(strip, index - first_half);
    }
    const uint3 at = step_of(strip, strip->count - 1u - index);
    const uint out = strip->outside.length - 1u - at.x, inn = strip->inside.length - (1u + at.y);
    return at.z != 0u ? advance(strip, out, inn + 1u, true) : advance(strip, out + 1u, inn, false);
}

// Vertices of a triangle of the strip, counted from its first one, counter-clockwise in (u, v); of a line, two and the
// second once more.
static uint3 triangle(const Strip *strip, uint index) {
    const Run *outside = &strip->outside, *inside = &strip->inside;
    switch (strip->kind) {
    case STRIP_REGULAR: return regular_triangle(strip, index);
    case STRIP_BETWEEN: return triangle_between(strip, index);
    case STRIP_ROW: return row_triangle(strip, index);
    case STRIP_COLUMN: return column_triangle(strip, index);
    case STRIP_LINE: return (uint3)(vertex(outside, index), vertex(outside, index + 1u), vertex(outside, index + 1u));
    case STRIP_SQUARE:
        return index == 0u ? (uint3)(outside->first, vertex(outside, 1u), vertex(inside, 1u))
                           : (uint3)(vertex(outside, 1u), inside->first, vertex(inside, 1u));
    default: return (uint3)(outside->first, inside->first, inside->end);
    }
}
