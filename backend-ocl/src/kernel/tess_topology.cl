// Mirrors core/src/tess/topology.rs: which vertices and primitives a divided patch has, and what each of them is by its
// index alone.

// Twice as many rings as there can be: halvings that find one begin with this half.
#define MOST_RINGS 64u
// Two thirds in units of 2^-16, as Direct3D has it.
#define TWO_THIRDS 0xaaaau

// How a patch is divided.
typedef struct {
    uint domain;
    // Sides of the domain; isolines have none.
    uint sides;
    // Divisions of the outer edges.
    Division outer[4];
    // Divisions along u and along v.
    Division inner[2];
    // Segments of the inner divisions on all sides together.
    uint around;
    // Vertices on the outer edges.
    uint border;
    // Rings inside the outermost one.
    uint rings;
} Topology;

// A row of vertices on one side of a ring, from a corner to the next one, which belongs to the next side.
typedef struct {
    // Index of its first vertex, and how many are its own.
    uint first;
    uint count;
    // Which ring; of isolines, which line.
    uint ring;
    // Which side of the ring.
    uint side;
} Side;

static Side new_side(uint first, uint count, uint ring, uint side) {
    const Side found = {first, count, ring, side};
    return found;
}

// The inner division along a side.
static const Division *along(const Topology *topology, uint side) {
    return topology->inner + ((side & 1u) == 0u ? 1u : 0u);
}

// Segments of the inner division that has fewer.
static uint least_of(const Topology *topology) {
    return lesser_of(segments_of(topology->inner), segments_of(topology->inner + 1));
}

// Of a patch whose levels are converted.
static Topology new_topology(__constant TessFrame *frame, const uint *levels) {
    Topology topology;
    topology.domain = frame->domain;
    topology.sides = frame->domain == TESS_QUADS ? 4u : 3u;
    for (uint side = 0u; side < 4u; side++) {
        topology.outer[side] = new_division(levels[side]);
    }
    topology.inner[0] = new_division(levels[4]);
    topology.inner[1] = new_division(levels[topology.sides == 3u ? 4 : 5]);
    topology.around = 0u;
    topology.border = 0u;
    topology.rings = 0u;
    for (uint side = 0u; side < topology.sides; side++) {
        topology.border += segments_of(topology.outer + side);
        topology.around += segments_of(along(&topology, side));
    }
    topology.rings = least_of(&topology) / 2u;
    return topology;
}

// Is the patch not divided at all?
static bool is_whole(const Topology *topology) {
    return topology->rings == 0u;
}

// Is the last ring a point or a line?
static bool ends_in_line(const Topology *topology) {
    return least_of(topology) % 2u == 0u;
}

// Is it this ring?
static bool is_line(const Topology *topology, uint ring) {
    return ring == topology->rings && ring > 0u && ends_in_line(topology);
}

// Segments of the longer sides of the last ring.
static uint line_length(const Topology *topology) {
    return segments_of(topology->inner) + segments_of(topology->inner + 1) - least_of(topology)
           - 2u * topology->rings;
}

// The side along which the vertices of the line in the middle are numbered.
static uint line_side(const Topology *topology) {
    return segments_of(topology->inner) > segments_of(topology->inner + 1) ? 1u : 0u;
}

// Primitives that the last ring encloses.
static uint middle_count(const Topology *topology) {
    if (ends_in_line(topology)) {
        return 0u;
    }
    return topology->sides == 3u ? 1u : 2u * line_length(topology);
}

// Segments of a side of a ring.
static uint side_segments(const Topology *topology, uint ring, uint side) {
    return ring == 0u ? segments_of(topology->outer + side) : segments_of(along(topology, side)) - 2u * ring;
}

// Index of the first vertex of a ring.
static uint ring_start(const Topology *topology, uint ring) {
    return ring == 0u ? 0u : topology->border + (ring - 1u) * (topology->around - topology->sides * ring);
}

// Index of the first triangle between a ring and the one around it.
static uint strips_start(const Topology *topology, uint ring) {
    if (ring < 2u) {
        return 0u;
    }
    const uint sides = topology->sides;
    return topology->border + topology->around - 2u * sides + 2u * (ring - 2u) * (topology->around - sides * ring);
}

// Number of vertices.
static uint vertex_count(const Topology *topology) {
    const uint lines = segments_of(topology->outer);
    if (lines == 0u) {
        return 0u;
    }
    if (topology->domain == TESS_ISOLINES) {
        return lines * (segments_of(topology->outer + 1) + 1u);
    }
    if (is_whole(topology)) {
        return topology->border;
    }
    if (ends_in_line(topology)) {
        return ring_start(topology, topology->rings) + line_length(topology) + 1u;
    }
    return ring_start(topology, topology->rings + 1u);
}

// Number of triangles, or of lines.
static uint primitive_count(const Topology *topology) {
    const uint lines = segments_of(topology->outer);
    if (topology->domain == TESS_ISOLINES) {
        return lines * segments_of(topology->outer + 1);
    }
    return lines == 0u ? 0u : strips_start(topology, topology->rings + 1u) + middle_count(topology);
}

static Side first_side(const Topology *topology, uint ring) {
    const uint first = ring_start(topology, ring);
    if (is_line(topology, ring)) {
        return new_side(first, line_length(topology) + 1u, ring, line_side(topology));
    }
    return new_side(first, side_segments(topology, ring, 0u), ring, 0u);
}

// The side after a side of the same ring; `next_side` in core goes on to the next ring, too.
static Side next_side(const Topology *topology, Side side) {
    const uint next = side.side + 1u;
    return new_side(side.first + side.count, side_segments(topology, side.ring, next), side.ring, next);
}

// The ring that has a vertex.
static uint ring_of(const Topology *topology, uint index) {
    uint ring = 0u;
    for (uint bit = MOST_RINGS / 2u; bit > 0u; bit >>= 1) {
        if (ring + bit <= topology->rings && ring_start(topology, ring + bit) <= index) {
            ring += bit;
        }
    }
    return ring;
}

// The side that has a vertex.
static Side side_of(const Topology *topology, uint index) {
    if (topology->domain == TESS_ISOLINES) {
        const uint count = segments_of(topology->outer + 1) + 1u;
        const uint line = index / count;
        return new_side(line * count, count, line, 0u);
    }
    Side found = first_side(topology, ring_of(topology, index));
    while (index - found.first >= found.count) {
        found = next_side(topology, found);
    }
    return found;
}

// Where the vertices of a side are: on a line, along a division.
typedef struct {
    const Division *division;
    // Point of the division at which the first vertex is.
    uint first;
    bool is_forward;
    uint side;
    // How far the line is from the edge of the domain that has this side.
    uint depth;
    // How much earlier the line begins and ends, on a triangle.
    uint inset;
    uint sides;
} Row;

static Row row_of(const Topology *topology, Side of_vertex) {
    const uint ring = of_vertex.ring;
    if (topology->domain == TESS_ISOLINES) {
        const Row row = {topology->outer + 1, 0u, true, 1u, place_of(topology->outer, ring), 0u, 4u};
        return row;
    }
    // A square that is not divided begins at (0, 0), one side on.
    const bool is_square = is_whole(topology) && topology->sides == 4u;
    const uint side = is_square ? (of_vertex.side + 1u) % 4u : of_vertex.side;
    const Division *division = ring == 0u ? topology->outer + side : along(topology, side);
    // Sides 1 and 2 of quads, and 1 of triangles, run in the direction of their coordinate.
    const bool is_forward = side == 1u || (side == 2u && topology->sides == 4u);
    const uint first = is_forward ? ring : segments_of(division) - ring;
    const uint depth = ring == 0u ? 0u : place_of(along(topology, side + 1u), ring);
    // Rings of a triangle are as far from its edges as from each other.
    const uint less = topology->sides == 3u ? (depth * TWO_THIRDS + TESS_HALF) >> 16 : depth;
    const uint inset = topology->sides == 3u ? (less + 1u) / 2u : 0u;
    const Row row = {division, first, is_forward, side, less, inset, topology->sides};
    return row;
}

// Coordinates of a vertex, counted from the first of the side, in units of 2^-16; they add up to 1 on triangles, and there is
// no third one on quadrilaterals and isolines.
static uint3 coordinates_of(Row row, uint index) {
    const uint point = row.is_forward ? row.first + index : row.first - index;
    const uint place = place_of(row.division, point) - row.inset, depth = row.depth;
    if (row.sides == 3u) {
        const uint rest = TESS_UNIT - place - depth;
        const uint3 others = row.side == 1u ? (uint3)(place, depth, rest) : (uint3)(place, rest, depth);
        return row.side == 0u ? (uint3)(depth, place, rest) : others;
    }
    const uint far = row.side < 2u ? depth : TESS_UNIT - depth;
    return row.side % 2u == 0u ? (uint3)(far, place, 0u) : (uint3)(place, far, 0u);
}

// A ring of two sides that lie on each other, and two that are its ends.
static Run run_on_line(const Topology *topology, uint start, uint side, uint length) {
    const uint end = start + line_length(topology);
    const uint place = topology->sides == 3u ? 0u : (side - line_side(topology)) % 4u;
    switch (place) {
    case 0u: return new_run(start, 1u, length, start + length);
    case 1u: return new_run(end, 0u, length, end);
    case 2u: return new_run(end, 0xffffffffu, length, start);
    default: return new_run(start, 0u, length, start);
    }
}

// The vertices of one side of a ring, both corners among them; `run` in core.
static Run run_of(const Topology *topology, uint ring, uint side) {
    const uint start = ring_start(topology, ring), length = side_segments(topology, ring, side);
    if (is_line(topology, ring)) {
        return run_on_line(topology, start, side, length);
    }
    uint first = start;
    for (uint before = 0u; before < side; before++) {
        first += side_segments(topology, ring, before);
    }
    return new_run(first, 1u, length, side + 1u == topology->sides ? start : first + length);
}

// What the last ring encloses, if anything: a triangle, or a row of squares.
static Strip middle_strip(const Topology *topology, uint first) {
    const uint rings = topology->rings, near = topology->sides == 3u ? 0u : line_side(topology);
    const Run outside = run_of(topology, rings, near);
    const Run inside = run_of(topology, rings, topology->sides == 3u ? 1u : near + 2u);
    Strip strip = new_strip(first, rings + 1u, topology->sides - 1u, outside, inside);
    strip.count = middle_count(topology);
    if (topology->sides == 3u) {
        strip.kind = STRIP_TRIANGLE;
        return strip;
    }
    return row(strip, is_whole(topology), near > 0u || line_length(topology) % 2u == 0u);
}

// The strip between a side of a ring and the ring around it; behind the last ring, what is in the middle.
static Strip strip_between(const Topology *topology, uint ring, uint side, uint first) {
    if (ring > topology->rings) {
        return middle_strip(topology, first);
    }
    const Run outside = run_of(topology, ring - 1u, side), inside = run_of(topology, ring, side);
    const Strip strip = new_strip(first, ring, side, outside, inside);
    return ring == 1u ? between(strip, topology->outer + side, along(topology, side)) : regular(strip);
}

// The strip after a strip of the same ring; `next_strip` in core goes on to the next ring, too.
static Strip next_strip(const Topology *topology, const Strip *strip) {
    return strip_between(topology, strip->ring, strip->side + 1u, strip->first + strip->count);
}

// The ring that has a triangle between it and the one around it; the one behind the last ring for what is in the
// middle.
static uint ring_of_strip(const Topology *topology, uint index) {
    uint ring = 1u;
    for (uint bit = MOST_RINGS / 2u; bit > 0u; bit >>= 1) {
        if (ring + bit <= topology->rings + 1u && strips_start(topology, ring + bit) <= index) {
            ring += bit;
        }
    }
    return ring;
}

// The strip that has a triangle.
static Strip strip_of(const Topology *topology, uint index) {
    if (topology->domain == TESS_ISOLINES) {
        const uint count = segments_of(topology->outer + 1);
        const uint line = index / count;
        return line_of(line, count, line * (count + 1u));
    }
    const uint ring = ring_of_strip(topology, index);
    Strip found = strip_between(topology, ring, 0u, strips_start(topology, ring));
    while (index - found.first >= found.count) {
        found = next_strip(topology, &found);
    }
    return found;
}
