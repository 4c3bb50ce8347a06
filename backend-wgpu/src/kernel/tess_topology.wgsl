// Mirrors core/src/tess/topology.rs: which vertices and primitives a divided patch has, and what each of them is by its index
// alone.
//
// The kernel says where `topology` is: an invocation's own, or shared by those that work on the same patch.

// Halvings that find one of at most 64 rings.
const RING_BITS: u32 = 6u;
// Two thirds in units of 2^-16, as Direct3D has it.
const TWO_THIRDS: u32 = 0xaaaau;

// How a patch is divided.
struct Topology {
    // Sides of the domain; isolines have none.
    sides: u32,
    // Segments of the inner divisions on all sides together.
    around: u32,
    // Vertices on the outer edges.
    border: u32,
    // Rings inside the outermost one.
    rings: u32,
    // Divisions of the outer edges, then along u and along v.
    lines: array<Division, 6>,
}

// A row of vertices on one side of a ring, from a corner to the next one, which belongs to the next side.
struct Side {
    // Index of its first vertex.
    first: u32,
    // How many vertices are its own.
    count: u32,
    // Which ring; of isolines, which line.
    ring: u32,
    // Which side of the ring.
    side: u32,
}

// Where the vertices of a side are: on a line, along a division.
struct Row {
    // Which of the divisions.
    line: u32,
    // Point of the division at which the first vertex is.
    first: u32,
    is_forward: bool,
    side: u32,
    // How far the line is from the edge of the domain that has this side.
    depth: u32,
    // How much earlier the line begins and ends, on a triangle.
    inset: u32,
    sides: u32,
}

// Which converted level divides line `number` of six: a triangle has the last one twice.
fn level_of(number: u32) -> u32 {
    return select(number, 4u, number == 5u && tess_frame.domain == TESS_TRIANGLES);
}

// One of the six; with `measure`, what core has as `new`.
fn divide(number: u32, level: u32) {
    topology.lines[number] = division(level);
}

// What can be said when all six are there.
fn measure() {
    topology.sides = select(3u, 4u, tess_frame.domain == TESS_QUADS);
    topology.around = 0u;
    topology.border = 0u;
    for (var side = 0u; side < topology.sides; side++) {
        topology.border += outer_segments(side);
        topology.around += along_segments(side);
    }
    topology.rings = least() / 2u;
}

fn is_isolines() -> bool {
    return tess_frame.domain == TESS_ISOLINES;
}

fn outer_segments(side: u32) -> u32 {
    return segments_of(topology.lines[side]);
}

// Is the patch dropped?
fn is_dropped() -> bool {
    return outer_segments(0u) == 0u;
}

// Number of vertices.
fn vertex_count() -> u32 {
    if is_dropped() {
        return 0u;
    }
    if is_isolines() {
        return outer_segments(0u) * (outer_segments(1u) + 1u);
    }
    if is_whole() {
        return topology.border;
    }
    if ends_in_line() {
        return ring_start(topology.rings) + line() + 1u;
    }
    return ring_start(topology.rings + 1u);
}

// Number of triangles, or of lines.
fn primitive_count() -> u32 {
    if is_isolines() {
        return outer_segments(0u) * outer_segments(1u);
    }
    if is_dropped() {
        return 0u;
    }
    return strips_start(topology.rings + 1u) + middle();
}

// The side that has a vertex.
fn side_of(vertex: u32) -> Side {
    if is_isolines() {
        let count = outer_segments(1u) + 1u;
        let ring = vertex / count;
        return Side(ring * count, count, ring, 0u);
    }
    let ring = ring_of(vertex);
    var found = first_side(ring);
    while vertex - found.first >= found.count {
        let next = found.side + 1u;
        found = Side(found.first + found.count, segments(ring, next), ring, next);
    }
    return found;
}

// Where the vertices of a side are.
fn row_of(of_vertex: Side) -> Row {
    let ring = of_vertex.ring;
    if is_isolines() {
        return Row(1u, 0u, true, 1u, place(topology.lines[0], ring), 0u, 4u);
    }
    // A square that is not divided begins at (0, 0), one side on.
    let side = select(of_vertex.side, (of_vertex.side + 1u) % 4u, is_whole() && topology.sides == 4u);
    let line = select(along(side), side, ring == 0u);
    // Sides 1 and 2 of quads, and 1 of triangles, run in the direction of their coordinate.
    let is_forward = side == 1u || (side == 2u && topology.sides == 4u);
    let first = select(segments_of(topology.lines[line]) - ring, ring, is_forward);
    var depth = 0u;
    if ring > 0u {
        depth = place(topology.lines[along(side + 1u)], ring);
    }
    if topology.sides == 4u {
        return Row(line, first, is_forward, side, depth, 0u, 4u);
    }
    // Rings of a triangle are as far from its edges as from each other.
    depth = (depth * TWO_THIRDS + TESS_HALF) >> 16u;
    return Row(line, first, is_forward, side, depth, (depth + 1u) / 2u, 3u);
}

// Coordinates of a vertex, counted from the first of the side, in units of 2^-16; they add up to 1 on triangles, and there is no
// third one on quadrilaterals and isolines.
fn coordinates_of(row: Row, index: u32) -> vec3<u32> {
    let point = select(row.first - index, row.first + index, row.is_forward);
    let at = place(topology.lines[row.line], point) - row.inset;
    let depth = row.depth;
    if row.sides == 3u {
        let rest = TESS_UNIT - at - depth;
        switch row.side {
            case 0u: { return vec3<u32>(depth, at, rest); }
            case 1u: { return vec3<u32>(at, depth, rest); }
            default: { return vec3<u32>(at, rest, depth); }
        }
    }
    switch row.side {
        case 0u: { return vec3<u32>(depth, at, 0u); }
        case 1u: { return vec3<u32>(at, depth, 0u); }
        case 2u: { return vec3<u32>(TESS_UNIT - depth, at, 0u); }
        default: { return vec3<u32>(at, TESS_UNIT - depth, 0u); }
    }
}

// The strip that has a triangle: found by its count, then made.
fn strip_of(triangle: u32) -> Strip {
    if is_isolines() {
        return line_strip(triangle / outer_segments(1u));
    }
    let ring = ring_of_strip(triangle);
    var first = strips_start(ring);
    var side = 0u;
    while ring <= topology.rings && triangle - first >= strip_count(ring, side) {
        first += strip_count(ring, side);
        side++;
    }
    return strip(ring, side, first);
}

// Triangles between a side of a ring and the ring around it.
fn strip_count(ring: u32, side: u32) -> u32 {
    return segments(ring - 1u, side) + segments(ring, side);
}

// One of the isolines.
fn line_strip(number: u32) -> Strip {
    let count = outer_segments(1u);
    return lines_of(number, count, number * (count + 1u));
}

// The strip between a side of a ring and the ring around it; behind the last ring, what is in the middle.
fn strip(ring: u32, side: u32, first: u32) -> Strip {
    if ring > topology.rings {
        return middle_strip(first);
    }
    let outside = run(ring - 1u, side);
    let inside = run(ring, side);
    if ring == 1u {
        return between(first, outside, inside, topology.lines[side], topology.lines[along(side)]);
    }
    return regular(first, outside, inside);
}

// What the last ring encloses, if anything: a triangle, or a row of squares.
fn middle_strip(first: u32) -> Strip {
    let is_triangle = topology.sides == 3u;
    let near_side = select(line_side(), 0u, is_triangle);
    let outside = run(topology.rings, near_side);
    let inside = run(topology.rings, near_side + select(2u, 1u, is_triangle));
    if is_triangle {
        return triangle_in_the_middle(first, middle(), outside, inside);
    }
    return row(first, middle(), outside, inside, is_whole(), near_side > 0u || line() % 2u == 0u);
}

// The vertices of one side of a ring, both corners among them.
fn run(ring: u32, side: u32) -> Run {
    let start = ring_start(ring);
    let length = segments(ring, side);
    if is_line(ring) {
        return run_on_line(start, side, length);
    }
    var first = start;
    for (var before = 0u; before < side; before++) {
        first += segments(ring, before);
    }
    return Run(first, 1u, length, select(first + length, start, side + 1u == topology.sides));
}

// A ring of two sides that lie on each other, and two that are its ends.
fn run_on_line(start: u32, side: u32, length: u32) -> Run {
    let end = start + line();
    let way = select((side - line_side()) % 4u, 0u, topology.sides == 3u);
    switch way {
        case 0u: { return Run(start, 1u, length, start + length); }
        case 1u: { return Run(end, 0u, length, end); }
        case 2u: { return Run(end, 0xffffffffu, length, start); }
        default: { return Run(start, 0u, length, start); }
    }
}

// Is the patch not divided at all?
fn is_whole() -> bool {
    return topology.rings == 0u;
}

// Segments of the inner division that has fewer.
fn least() -> u32 {
    let u = segments_of(topology.lines[4]);
    let v = segments_of(topology.lines[5]);
    return select(v, u, u < v);
}

// Is the last ring a point or a line?
fn ends_in_line() -> bool {
    return least() % 2u == 0u;
}

// Is it this ring?
fn is_line(ring: u32) -> bool {
    return ring == topology.rings && ring > 0u && ends_in_line();
}

// Segments of the longer sides of the last ring.
fn line() -> u32 {
    let both = segments_of(topology.lines[4]) + segments_of(topology.lines[5]);
    return both - least() - 2u * topology.rings;
}

// The side along which the vertices of the line in the middle are numbered.
fn line_side() -> u32 {
    return select(0u, 1u, segments_of(topology.lines[4]) > segments_of(topology.lines[5]));
}

// Primitives that the last ring encloses.
fn middle() -> u32 {
    if ends_in_line() {
        return 0u;
    }
    return select(2u * line(), 1u, topology.sides == 3u);
}

// Which is the inner division along a side.
fn along(side: u32) -> u32 {
    return select(4u, 5u, (side & 1u) == 0u);
}

fn along_segments(side: u32) -> u32 {
    return segments_of(topology.lines[along(side)]);
}

// Segments of a side of a ring.
fn segments(ring: u32, side: u32) -> u32 {
    if ring == 0u {
        return outer_segments(side);
    }
    return along_segments(side) - 2u * ring;
}

// Index of the first vertex of a ring.
fn ring_start(ring: u32) -> u32 {
    if ring == 0u {
        return 0u;
    }
    return topology.border + (ring - 1u) * (topology.around - topology.sides * ring);
}

// Index of the first triangle between a ring and the one around it.
fn strips_start(ring: u32) -> u32 {
    if ring < 2u {
        return 0u;
    }
    let first_strips = topology.border + topology.around - 2u * topology.sides;
    return first_strips + 2u * (ring - 2u) * (topology.around - topology.sides * ring);
}

fn first_side(ring: u32) -> Side {
    let first = ring_start(ring);
    if is_line(ring) {
        return Side(first, line() + 1u, ring, line_side());
    }
    return Side(first, segments(ring, 0u), ring, 0u);
}

// The ring that has a vertex.
fn ring_of(vertex: u32) -> u32 {
    var ring = 0u;
    for (var bit = 1u << (RING_BITS - 1u); bit > 0u; bit /= 2u) {
        if ring + bit <= topology.rings && ring_start(ring + bit) <= vertex {
            ring += bit;
        }
    }
    return ring;
}

// The ring that has a triangle between it and the one around it; the one behind the last ring for what is in the middle.
fn ring_of_strip(triangle: u32) -> u32 {
    var ring = 1u;
    for (var bit = 1u << (RING_BITS - 1u); bit > 0u; bit /= 2u) {
        if ring + bit <= topology.rings + 1u && strips_start(ring + bit) <= triangle {
            ring += bit;
        }
    }
    return ring;
}
