// Mirrors core/src/tess/strip.rs: the triangles between two rows of vertices, each by its index alone.

// Halvings that find one of at most 32 marks.
const MARK_BITS: u32 = 5u;
// Marks on half a ruler.
const MARKS: u32 = 1u << MARK_BITS;

// Not triangles but the segments of the outside.
const STRIP_LINE: u32 = 0u;
// The outside has two segments more than the inside.
const STRIP_REGULAR: u32 = 1u;
// Both sides are divided as they like: vertices come in the order of the marks of a ruler.
const STRIP_BETWEEN: u32 = 2u;
// Both sides have as many segments, and the inside runs the other way.
const STRIP_ROW: u32 = 3u;
// The same where there is a square in the middle of a row along v: its diagonal runs the other way.
const STRIP_COLUMN: u32 = 4u;
// A patch that is a single square.
const STRIP_SQUARE: u32 = 5u;
// A single triangle.
const STRIP_TRIANGLE: u32 = 6u;

// A row of vertices.
struct Run {
    // Index of its first vertex.
    first: u32,
    // From one index to the next, modulo 2^32.
    step: u32,
    // Segments.
    length: u32,
    // Index of its last vertex.
    end: u32,
}

// A strip of triangles between two rows of vertices.
struct Strip {
    // Index of its first triangle.
    first: u32,
    // How many it has.
    count: u32,
    // The row outside.
    outside: Run,
    // The row inside.
    inside: Run,
    // How its triangles are laid.
    kind: u32,
    // Marks on half of the outside and of the inside, if it is STRIP_BETWEEN.
    marks: vec2<u32>,
}

// A step of the first half of a strip: at which vertices both sides are, and whether the outside goes on.
struct Step {
    outside: u32,
    inside: u32,
    is_outside: bool,
}

// Index of a vertex of a row.
fn vertex(on: Run, at: u32) -> u32 {
    return select(on.first + on.step * at, on.end, at >= on.length);
}

fn lines_of(number: u32, count: u32, first_vertex: u32) -> Strip {
    let outside = Run(first_vertex, 1u, count, first_vertex + count);
    return Strip(number * count, count, outside, Run(0u, 0u, 0u, 0u), STRIP_LINE, vec2<u32>(0u, 0u));
}

fn regular(first: u32, outside: Run, inside: Run) -> Strip {
    return Strip(first, 2u * inside.length + 2u, outside, inside, STRIP_REGULAR, vec2<u32>(0u, 0u));
}

fn between(first: u32, outside: Run, inside: Run, outer: Division, inner: Division) -> Strip {
    let count = outside.length + inside.length;
    let marks = vec2<u32>(marks_of(outer), marks_of(inner));
    return Strip(first, count, outside, inside, STRIP_BETWEEN, marks);
}

fn row(first: u32, count: u32, outside: Run, inside: Run, is_whole: bool, is_alike: bool) -> Strip {
    let kind = select(select(STRIP_COLUMN, STRIP_ROW, is_alike), STRIP_SQUARE, is_whole);
    return Strip(first, count, outside, inside, kind, vec2<u32>(0u, 0u));
}

fn triangle_in_the_middle(first: u32, count: u32, outside: Run, inside: Run) -> Strip {
    return Strip(first, count, outside, inside, STRIP_TRIANGLE, vec2<u32>(0u, 0u));
}

// Vertices of a triangle of a strip, counted from its first one, counter-clockwise in (u, v); of a line, two and the second
// once more.
fn triangle(it: Strip, index: u32) -> vec3<u32> {
    let a = vertex(it.outside, index);
    let b = vertex(it.outside, index + 1u);
    switch it.kind {
        case STRIP_REGULAR: { return regular_triangle(it, index); }
        case STRIP_BETWEEN: { return triangle_between(it, index); }
        case STRIP_ROW: { return row_triangle(it, index); }
        case STRIP_COLUMN: { return column_triangle(it, index); }
        case STRIP_SQUARE: { return vec3<u32>(a, select(b, it.inside.first, index == 1u), vertex(it.inside, 1u)); }
        case STRIP_TRIANGLE: { return vec3<u32>(it.outside.first, it.inside.first, it.inside.end); }
        default: { return vec3<u32>(a, b, b); }
    }
}

// Diagonals run from the ends of the outside towards the middle of the inside. At both ends a quadrilateral is but half
// there.
fn regular_triangle(it: Strip, index: u32) -> vec3<u32> {
    let quad = (index + 1u) / 2u;
    let is_second = index % 2u == 0u;
    let a = vertex(it.outside, quad);
    let b = vertex(it.outside, quad + 1u);
    if index + 1u == it.count {
        return vec3<u32>(a, b, it.inside.end);
    }
    let c = vertex(it.inside, quad - 1u);
    let d = vertex(it.inside, quad);
    if quad <= (it.inside.length + 1u) / 2u {
        return select(vec3<u32>(a, d, c), vec3<u32>(a, b, d), is_second);
    }
    return select(vec3<u32>(c, a, b), vec3<u32>(c, b, d), is_second);
}

// All diagonals run the same way.
fn row_triangle(it: Strip, index: u32) -> vec3<u32> {
    let corners = square(it, index / 2u);
    return select(corners.wyz, corners.wxy, index % 2u == 0u);
}

// All diagonals but the one in the middle run the same way.
fn column_triangle(it: Strip, index: u32) -> vec3<u32> {
    let corners = square(it, index / 2u);
    let is_first = index % 2u == 0u;
    if index / 2u == it.inside.length / 2u {
        return select(corners.xyz, corners.xzw, is_first);
    }
    return select(corners.wyz, corners.xyw, is_first);
}

// Corners of a square of a row, counter-clockwise from the start of its outside.
fn square(it: Strip, index: u32) -> vec4<u32> {
    let back = it.inside.length - index;
    return vec4<u32>(
        vertex(it.outside, index),
        vertex(it.outside, index + 1u),
        vertex(it.inside, back - 1u),
        vertex(it.inside, back),
    );
}

// The first half of the triangles as they come, the other half mirrored, and what is between them.
fn triangle_between(it: Strip, index: u32) -> vec3<u32> {
    // On the inside the corner is no mark, as the ring there is two segments shorter.
    let inner = saturating_sub(it.marks.y, 1u);
    let half = it.marks.x + inner;
    if index < half {
        return advance(it, step(it, index));
    }
    if index + half >= it.count {
        return advance(it, mirrored(it, step(it, it.count - 1u - index)));
    }
    let is_outside_odd = it.outside.length % 2u == 1u;
    let is_inside_odd = it.inside.length % 2u == 1u;
    if is_outside_odd && (index > half || !is_inside_odd) {
        let inn = vertex(it.inside, select(inner, inner + 1u, is_inside_odd));
        return vec3<u32>(inn, vertex(it.outside, it.marks.x), vertex(it.outside, it.marks.x + 1u));
    }
    return advance(it, Step(it.marks.x, inner, false));
}

// The step of the second half that is the mirror image of one of the first.
fn mirrored(it: Strip, first: Step) -> Step {
    let outside = it.outside.length - 1u - first.outside;
    let inside = it.inside.length - 1u - first.inside;
    if first.is_outside {
        return Step(outside, inside + 1u, true);
    }
    return Step(outside + 1u, inside, false);
}

fn advance(it: Strip, by: Step) -> vec3<u32> {
    let out = vertex(it.outside, by.outside);
    let inn = vertex(it.inside, by.inside);
    if by.is_outside {
        return vec3<u32>(out, vertex(it.outside, by.outside + 1u), inn);
    }
    return vec3<u32>(inn, out, vertex(it.inside, by.inside + 1u));
}

// Step `index` of the first half.
fn step(it: Strip, index: u32) -> Step {
    let outer = it.marks.x;
    let inner = it.marks.y;
    // The mark before which no more than `index` steps are taken.
    var mark = 0u;
    for (var bit = MARKS / 2u; bit > 0u; bit /= 2u) {
        if marks_before(mark + bit, outer) + inner_marks_before(mark + bit, inner) <= index {
            mark += bit;
        }
    }
    let out = marks_before(mark, outer);
    let inn = inner_marks_before(mark, inner);
    // At a mark of both, the inside goes on first.
    let inside_goes_on = inner_marks_before(mark + 1u, inner) - inn;
    let is_outside = index - out - inn >= inside_goes_on;
    return Step(out, select(inn, inn + inside_goes_on, is_outside), is_outside);
}

// How many of the first `marks` marks lie before mark `end` of half a ruler: first comes the one at its start, then that in
// its middle, then those in the middle between these, and so on, each time from the start on.
fn marks_before(end: u32, marks: u32) -> u32 {
    if marks == 0u || end == 0u {
        return 0u;
    }
    let whole = highest_bit(marks);
    let rest = marks - whole;
    let apart = MARKS / whole;
    let halfway = (end - 1u + apart / 2u) / apart;
    return 1u + (end - 1u) / apart + select(rest, halfway, halfway < rest);
}

// The same without the one at the start.
fn inner_marks_before(end: u32, marks: u32) -> u32 {
    return saturating_sub(marks_before(end, marks), 1u);
}
