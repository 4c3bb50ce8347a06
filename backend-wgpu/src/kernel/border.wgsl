// Mirrors core/src/border.rs: which vertices lie on the four sides of a surface, so that whoever shares a side has
// the same ones.

// How a side is divided: steps of the whole piece of the line that it lies in, 0 = it is live; the piece is 2^bits
// units long.
struct Side {
    steps: u32,
    bits: u32,
}

fn packed(side: Side) -> u32 {
    return side.steps | (side.bits << 5u);
}

fn unpacked(word: u32) -> Side {
    return Side(word & FIVE_BITS, (word >> 5u) & FIVE_BITS);
}

// A number of a side or corner; chosen rather than indexed, since what lies in registers has no index.
fn chosen(all: vec4<u32>, index: u32) -> u32 {
    let halves = select(all.xy, all.zw, (index & 2u) != 0u);
    return select(halves.x, halves.y, (index & 1u) != 0u);
}

fn border_words(surface: Surface) -> vec4<u32> {
    let words = surface.borders;
    return vec4<u32>(words[0], words[1], words[2], words[3]);
}

fn sides_of(surface: Surface) -> vec4<u32> {
    return border_words(surface) & vec4<u32>(SIDE_MASK);
}

fn corners_of(surface: Surface) -> vec4<u32> {
    return border_words(surface) >> vec4<u32>(CORNER_SHIFT);
}

// Packed sides and corners as the words of a surface.
fn joined_words(sides: vec4<u32>, corners: vec4<u32>) -> array<u32, 4> {
    let words = sides | (corners << vec4<u32>(CORNER_SHIFT));
    return array<u32, 4>(words.x, words.y, words.z, words.w);
}

// The corner at which a side starts, and that at which it ends.
fn first_corner(side: u32) -> u32 {
    return select(side - 2u, 2u * side, side < 2u);
}

fn last_corner(side: u32) -> u32 {
    return select(side, 2u * side + 1u, side < 2u);
}

// Where step `index` of `steps` ends in a piece 2^bits long: the same places if counted from the other end.
fn place(index: u32, steps: u32, bits: u32) -> u32 {
    let fine = select(PLACE_BITS, bits, bits < PLACE_BITS);
    let is_low = 2u * index <= steps;
    let from_end = ((select(steps - index, index, is_low) << fine) / steps) << (bits - fine);
    return select((1u << bits) - from_end, from_end, is_low);
}

// The word of a corner that has strayed to step `step` of `steps` of a piece of the line along u (0) or v (1).
fn stray(bits: u32, along: u32, step: u32, steps: u32) -> u32 {
    return (bits << (5u * along)) | (along << 10u) | (step << 11u) | (steps << 16u);
}

// Where a strayed corner is that seems to be at `seems`.
fn astray(word: u32, seems: vec2<u32>) -> vec2<u32> {
    let bits = vec2<u32>(word & FIVE_BITS, (word >> 5u) & FIVE_BITS);
    let at = (seems >> bits) << bits;
    let is_v = ((word >> 10u) & 1u) != 0u;
    let steps = word >> 16u;
    if steps == 0u {
        return at;
    }
    let more = place((word >> 11u) & FIVE_BITS, steps, select(bits.x, bits.y, is_v));
    return at + select(vec2<u32>(more, 0u), vec2<u32>(0u, more), is_v);
}

fn side_of(surface: Surface, side: u32) -> Side {
    return unpacked(chosen(border_words(surface), side));
}

// A bit each for corners that have strayed.
fn strayed_corners(surface: Surface) -> u32 {
    let bits = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), corners_of(surface) != vec4<u32>(0u));
    return bits.x | bits.y | bits.z | bits.w;
}

// u and v of the vertex at a corner.
fn corner_at(surface: Surface, corner: u32) -> vec2<u32> {
    return astray(chosen(corners_of(surface), corner), seeming_corner(surface, corner));
}

// u and v of a corner, if it has not strayed.
fn seeming_corner(surface: Surface, corner: u32) -> vec2<u32> {
    let u = surface.u + select(0u, u_size(surface), (corner & 1u) != 0u);
    let v = surface.v + select(0u, v_size(surface), (corner & 2u) != 0u);
    return vec2<u32>(u, v);
}

// Where a side begins along its line, and the log2 of its length.
struct Extent {
    start: u32,
    bits: u32,
}

fn extent_of(surface: Surface, side: u32) -> Extent {
    if side < 2u {
        return Extent(surface.u, PARAM_BITS - u_level(surface));
    }
    return Extent(surface.v, PARAM_BITS - v_level(surface));
}

fn steps_needed(surface: Surface, number: u32) -> u32 {
    let side = side_of(surface, number);
    if side.steps == 0u {
        return 0u;
    }
    let halved = side.bits - extent_of(surface, number).bits;
    return (side.steps + (1u << halved) - 1u) >> halved;
}

// u and v of the vertex with which step `index` of `rate` along a side ends: the nearest of the side's own.
fn border_vertex(surface: Surface, number: u32, index: u32, rate: u32) -> vec2<u32> {
    let own = extent_of(surface, number);
    let side = side_of(surface, number);
    let is_live = side.steps == 0u;
    // The piece's vertices at or before both ends, and one between them: the grid has no fewer steps, so each of them
    // is chosen. A live side is a piece of its own, with a vertex a step.
    let bits = select(side.bits, own.bits, is_live);
    let steps = select(side.steps, rate, is_live);
    let halved = bits - own.bits;
    let before = (own.start & ((1u << bits) - 1u)) >> own.bits;
    let low = (before * steps) >> halved;
    let high = ((before + 1u) * steps) >> halved;
    let step = low + (2u * index * (high - low) + rate) / (2u * rate);
    let is_first = index == 0u || step <= low;
    if is_first || index == rate || step >= high {
        return corner_at(surface, select(last_corner(number), first_corner(number), is_first));
    }
    return on_side(surface, number, ((own.start >> bits) << bits) + place(step, steps, bits));
}

fn on_side(surface: Surface, side: u32, along: u32) -> vec2<u32> {
    let is_high = (side & 1u) != 0u;
    if side < 2u {
        return vec2<u32>(along, surface.v + select(0u, v_size(surface), is_high));
    }
    return vec2<u32>(surface.u + select(0u, u_size(surface), is_high), along);
}

// The word of the corner that a split makes in the middle of a side.
fn middle_corner(surface: Surface, number: u32) -> u32 {
    let side = side_of(surface, number);
    if side.steps == 0u {
        return 0u; // the middle of a live side is a vertex
    }
    let own = extent_of(surface, number);
    let along = number / 2u;
    let start = own.start & ((1u << side.bits) - 1u);
    let before = start + (1u << own.bits) / 2u;
    let step = (before * side.steps) >> side.bits;
    if (step << side.bits) > start * side.steps {
        let is_there = place(step, side.steps, side.bits) == before;
        return select(stray(side.bits, along, step, side.steps), 0u, is_there);
    }
    // No vertex since the side's start, so that is where it is: back to it, and wherever that has strayed.
    let word = chosen(corners_of(surface), first_corner(number));
    let cleared = (word >> (5u * along)) & FIVE_BITS;
    let more = select(0u, own.bits - cleared, own.bits > cleared);
    return word + (more << (5u * along));
}

// All sides of a verdict, packed.
fn verdict_sides(verdict: Verdict) -> vec4<u32> {
    let words = vec2<u32>(verdict.along_u, verdict.along_v);
    return vec4<u32>(words, words >> vec2<u32>(CORNER_SHIFT)).xzyw & vec4<u32>(SIDE_MASK);
}

// The surface with its sides as `bound` found them to be divided.
fn divided(surface: Surface, verdict: Verdict) -> Surface {
    let words = joined_words(verdict_sides(verdict), corners_of(surface));
    return Surface(surface.patch_id, surface.u, surface.v, surface.shape, words);
}

struct Halves {
    low: Surface,
    high: Surface,
}

// The two halves of a surface; the line between them is new, and live.
fn halves(surface: Surface, verdict: Verdict) -> Halves {
    let whole = divided(surface, verdict);
    let s = sides_of(whole);
    let c = corners_of(whole);
    if verdict.code == SPLIT_U {
        let middle = vec2<u32>(middle_corner(whole, 0u), middle_corner(whole, 1u));
        var low = half_u(whole, 0u);
        var high = half_u(whole, 1u);
        low.borders = joined_words(vec4<u32>(s.xyz, 0u), vec4<u32>(c.x, middle.x, c.z, middle.y));
        high.borders = joined_words(vec4<u32>(s.xy, 0u, s.w), vec4<u32>(middle.x, c.y, middle.y, c.w));
        return Halves(low, high);
    }
    let middle = vec2<u32>(middle_corner(whole, 2u), middle_corner(whole, 3u));
    var low = half_v(whole, 0u);
    var high = half_v(whole, 1u);
    low.borders = joined_words(vec4<u32>(s.x, 0u, s.zw), vec4<u32>(c.xy, middle));
    high.borders = joined_words(vec4<u32>(0u, s.yzw), vec4<u32>(middle, c.zw));
    return Halves(low, high);
}

fn with_sides(verdict: Verdict, sides: vec4<u32>, rates: vec2<u32>) -> Verdict {
    let words = sides.xz | (sides.yw << vec2<u32>(CORNER_SHIFT)) | (rates << vec2<u32>(2u * CORNER_SHIFT));
    return Verdict(verdict.code, verdict.columns, verdict.rows, words.x, words.y);
}

// Micropolygons along u and along v; of drawn surfaces only.
fn rates_of(verdict: Verdict) -> vec2<u32> {
    return vec2<u32>(verdict.along_u, verdict.along_v) >> vec2<u32>(2u * CORNER_SHIFT);
}

// Mirrors core/src/surface.rs (Draw::new): the surface to be drawn and the pixels the verdict allows it.
fn draw_of(surface: Surface, verdict: Verdict) -> Draw {
    let whole = divided(surface, verdict);
    let rates = rates_of(verdict) << vec2<u32>(RATE_U_SHIFT, RATE_V_SHIFT);
    let shape = whole.shape | rates.x | rates.y;
    return Draw(whole.patch_id, whole.u, whole.v, shape, whole.borders, verdict.columns, verdict.rows);
}

// Micropolygons along u and along v.
fn draw_rates(draw: Draw) -> vec2<u32> {
    return (vec2<u32>(draw.shape) >> vec2<u32>(RATE_U_SHIFT, RATE_V_SHIFT)) & vec2<u32>(FIVE_BITS);
}

// u of a column of vertices, and v of a row, inside the grid, where it is regular.
fn column_of(draw: Draw, column: u32) -> u32 {
    let surface = surface_of(draw);
    return surface.u + place(column, draw_rates(draw).x, PARAM_BITS - u_level(surface));
}

fn row_of(draw: Draw, row: u32) -> u32 {
    let surface = surface_of(draw);
    return surface.v + place(row, draw_rates(draw).y, PARAM_BITS - v_level(surface));
}

// u and v of a vertex on the grid's border: one of the border's own.
fn vertex_on_border(draw: Draw, row: u32, column: u32) -> vec2<u32> {
    let rates = draw_rates(draw);
    let is_along_u = row == 0u || row == rates.y;
    let along_u = select(1u, 0u, row == 0u);
    let along_v = select(3u, 2u, column == 0u);
    return border_vertex(
        surface_of(draw),
        select(along_v, along_u, is_along_u),
        select(row, column, is_along_u),
        select(rates.y, rates.x, is_along_u),
    );
}
