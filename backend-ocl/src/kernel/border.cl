// Mirrors core/src/border.rs: which vertices lie on the four sides of a surface, so that whoever shares a side has
// the same ones. All of it is integers.
//
// Sides by number: v = low, v = high, u = low, u = high; the first two run along u. Corner 2·j + i is at the low (0)
// or high (1) end i of u and j of v.

// How a side is divided: steps of the piece of its line that it lies in, 0 = the side is live; and the piece is
// 2^bits units long.
typedef struct {
    uint steps;
    uint bits;
} Side;

static uint packed_side(Side side) {
    return side.steps | side.bits << 5;
}

static Side unpacked_side(uint word) {
    const Side side = {word & FIVE_BITS, (word >> 5) & FIVE_BITS};
    return side;
}

// The corners at which a side starts and ends.
static uint2 corners_of(uint side) {
    const uint first = side < 2u ? 2u * side : side - 2u;
    return (uint2)(first, side < 2u ? first + 1u : first + 2u);
}

// Where step `index` of `steps` ends in a piece 2^bits long; the same places from either end.
static uint place(uint index, uint steps, uint bits) {
    const uint fine = lesser_of(bits, PLACE_BITS), rest = bits - fine;
    if (2u * index <= steps) {
        return ((index << fine) / steps) << rest;
    }
    return (1u << bits) - ((((steps - index) << fine) / steps) << rest);
}

// A corner that has strayed, packed.
static uint stray(uint clear_u, uint clear_v, uint along, uint step, uint steps) {
    return clear_u | clear_v << 5 | along << 10 | step << 11 | steps << 16;
}

// Where a strayed corner is that seems to be at `seems`.
static uint2 astray(uint word, uint2 seems) {
    const uint bits_u = word & FIVE_BITS, bits_v = (word >> 5) & FIVE_BITS;
    const uint2 at = (uint2)(seems.x >> bits_u << bits_u, seems.y >> bits_v << bits_v);
    const uint step = (word >> 11) & FIVE_BITS, steps = word >> 16;
    if (steps == 0u) {
        return at;
    }
    const bool is_v = ((word >> 10) & 1u) != 0u;
    const uint more = place(step, steps, is_v ? bits_v : bits_u);
    return is_v ? (uint2)(at.x, at.y + more) : (uint2)(at.x + more, at.y);
}

static Side side_of(Surface surface, uint side) {
    return unpacked_side(surface.borders[side]);
}

static bool keeps_its_corners(Surface surface) {
    const uint any = surface.borders[0] | surface.borders[1] | surface.borders[2] | surface.borders[3];
    return any >> CORNER_SHIFT == 0u;
}

static bool has_strayed(Surface surface, uint number) {
    return surface.borders[number] >> CORNER_SHIFT != 0u;
}

// u and v of a corner, if it has not strayed.
static uint2 seeming_corner(Surface surface, uint number) {
    return (uint2)(number % 2u == 0u ? surface.u : surface.u + u_size(surface),
                   number < 2u ? surface.v : surface.v + v_size(surface));
}

// u and v of the vertex at a corner.
static uint2 corner(Surface surface, uint number) {
    return astray(surface.borders[number] >> CORNER_SHIFT, seeming_corner(surface, number));
}

// Where a side begins along its line, and the log2 of its length.
static uint2 extent_of(Surface surface, uint side) {
    return side < 2u ? (uint2)(surface.u, PARAM_BITS - u_level(surface))
                     : (uint2)(surface.v, PARAM_BITS - v_level(surface));
}

// Steps that a grid needs along a side, so that it can have all of the side's vertices.
static uint steps_needed(Surface surface, uint number) {
    const Side side = side_of(surface, number);
    const uint halved = side.bits - extent_of(surface, number).y;
    return side.steps == 0u ? 0u : (side.steps + (1u << halved) - 1u) >> halved;
}

static uint2 on_side(Surface surface, uint side, uint along) {
    switch (side) {
    case 0u: return (uint2)(along, surface.v);
    case 1u: return (uint2)(along, surface.v + v_size(surface));
    case 2u: return (uint2)(surface.u, along);
    default: return (uint2)(surface.u + u_size(surface), along);
    }
}

// u and v of the vertex with which step `index` of `rate` along a side ends: one of the side's own.
static uint2 border_vertex(Surface surface, uint number, uint index, uint rate) {
    const uint2 ends = corners_of(number);
    if (index == 0u || index == rate) {
        return corner(surface, index == 0u ? ends.x : ends.y);
    }
    const uint start = extent_of(surface, number).x, own_bits = extent_of(surface, number).y;
    const Side side = side_of(surface, number);
    const uint steps = side.steps, bits = side.bits;
    if (steps == 0u) {
        return on_side(surface, number, start + place(index, rate, own_bits));
    }
    // The piece's vertices at or before both ends, and one between them: the grid has no fewer steps, so each of them
    // is chosen.
    const uint halved = bits - own_bits;
    const uint before = (start & ((1u << bits) - 1u)) >> own_bits;
    const uint low = (before * steps) >> halved, high = ((before + 1u) * steps) >> halved;
    const uint step = low + (2u * index * (high - low) + rate) / (2u * rate);
    if (step <= low || step >= high) {
        return corner(surface, step <= low ? ends.x : ends.y);
    }
    return on_side(surface, number, (start >> bits << bits) + place(step, steps, bits));
}

// The word of the corner that a split makes in the middle of a side.
static uint middle_corner(Surface surface, uint number) {
    const Side side = side_of(surface, number);
    const uint steps = side.steps, bits = side.bits;
    if (steps == 0u) {
        return 0u; // the middle of a live side is a vertex
    }
    const uint start = extent_of(surface, number).x, own_bits = extent_of(surface, number).y;
    const uint along = number / 2u;
    const uint from = start & ((1u << bits) - 1u), before = from + (1u << own_bits) / 2u;
    const uint step = (before * steps) >> bits;
    if (step << bits > from * steps) {
        if (place(step, steps, bits) == before) {
            return 0u;
        }
        return stray(along == 0u ? bits : 0u, along == 0u ? 0u : bits, along, step, steps);
    }
    // No vertex since the side's start, so that is where it is: back to it, and wherever that has strayed.
    const uint word = surface.borders[corners_of(number).x] >> CORNER_SHIFT;
    const uint cleared = (word >> (5u * along)) & FIVE_BITS;
    return word + (saturating_sub(own_bits, cleared) << (5u * along));
}

// Packed sides and rates.
static Verdict with_packed(Verdict verdict, const Side *sides, uint2 rates) {
    verdict.along_u =
        packed_side(sides[0]) | packed_side(sides[1]) << CORNER_SHIFT | rates.x << (2u * CORNER_SHIFT);
    verdict.along_v =
        packed_side(sides[2]) | packed_side(sides[3]) << CORNER_SHIFT | rates.y << (2u * CORNER_SHIFT);
    return verdict;
}

// Micropolygons along u and along v; of drawn surfaces only.
static uint2 rates_of(Verdict verdict) {
    return (uint2)(verdict.along_u >> (2u * CORNER_SHIFT), verdict.along_v >> (2u * CORNER_SHIFT));
}

static uint replaced(uint word, uint side) {
    return (word & ~SIDE_MASK) | (side & SIDE_MASK);
}

// The surface with its sides as `bound` found them to be divided.
static Surface divided(Surface surface, Verdict verdict) {
    surface.borders[0] = replaced(surface.borders[0], verdict.along_u);
    surface.borders[1] = replaced(surface.borders[1], verdict.along_u >> CORNER_SHIFT);
    surface.borders[2] = replaced(surface.borders[2], verdict.along_v);
    surface.borders[3] = replaced(surface.borders[3], verdict.along_v >> CORNER_SHIFT);
    return surface;
}

static uint with_corner(uint word, uint corner) {
    return (word & SIDE_MASK) | corner << CORNER_SHIFT;
}

// The halves of a surface. The line between them is new, and live.
static Halves halves_of(Surface surface, Verdict verdict) {
    const Surface whole = divided(surface, verdict);
    const bool is_u = verdict.code == SPLIT_U;
    Halves halves = is_u ? halves_u(whole) : halves_v(whole);
    // The two sides that are halved; the others each half has for itself.
    const uint halved = is_u ? 0u : 2u, own = is_u ? 2u : 0u;
    halves.low.borders[own + 1u] &= ~SIDE_MASK;
    halves.high.borders[own] &= ~SIDE_MASK;
    for (uint end = 0u; end < 2u; end++) {
        const uint middle = middle_corner(whole, halved + end);
        const uint2 ends = corners_of(halved + end);
        halves.low.borders[ends.y] = with_corner(halves.low.borders[ends.y], middle);
        halves.high.borders[ends.x] = with_corner(halves.high.borders[ends.x], middle);
    }
    return halves;
}

static uint rate_u(Draw draw) {
    return (draw.shape >> RATE_U_SHIFT) & FIVE_BITS;
}

static uint rate_v(Draw draw) {
    return (draw.shape >> RATE_V_SHIFT) & FIVE_BITS;
}

// u of a column of vertices inside the grid, where it is regular.
static uint column_at(Draw draw, uint column) {
    return draw.u + place(column, rate_u(draw), PARAM_BITS - u_level(surface_of(draw)));
}

// v of a row of vertices inside the grid.
static uint row_at(Draw draw, uint row) {
    return draw.v + place(row, rate_v(draw), PARAM_BITS - v_level(surface_of(draw)));
}

// u and v of a vertex on the border of the grid: one of the border's own.
static uint2 vertex_on_border(Draw draw, uint row, uint column) {
    const Surface surface = surface_of(draw);
    const bool along_u = row == 0u || row == rate_v(draw);
    const uint side = along_u ? (row == 0u ? 0u : 1u) : (column == 0u ? 2u : 3u);
    return border_vertex(surface, side, along_u ? column : row, along_u ? rate_u(draw) : rate_v(draw));
}

// `Draw::new` of core/src/surface.rs: the surface to be drawn and the pixels `verdict` allows it.
static Draw new_draw(Surface surface, Verdict verdict) {
    const Surface whole = divided(surface, verdict);
    const uint2 rates = rates_of(verdict);
    const Draw draw = {whole.patch_id,
                       whole.u,
                       whole.v,
                       whole.shape | rates.x << RATE_U_SHIFT | rates.y << RATE_V_SHIFT,
                       {whole.borders[0], whole.borders[1], whole.borders[2], whole.borders[3]},
                       verdict.columns,
                       verdict.rows};
    return draw;
}
