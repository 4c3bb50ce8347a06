// Mirrors core/src/tess/division.rs: a converted level divides a line: into how many segments, and where their ends are.

// How a line from 0 to TESS_UNIT is divided. What lies at a place from one end lies there from the other.
typedef struct {
    // The level in units of 2^-16.
    uint fixed;
    // Points of the first half; a point in the middle is none of them.
    uint halves;
    // 1 where there is a segment in the middle, 0 where there is a point.
    uint odd;
    // Are points placed as in Stadlbauer 2019? If not, what follows says how.
    bool is_stadlbauer;
    // Share of the larger of the two whole levels between which this one is.
    uint fraction;
    // The point of the larger level that the smaller one has not got.
    uint split;
    // Lengths of segments at both levels.
    uint2 lengths;
} Division;

// 1 / `segments`, rounded; 1 where there are none. `length` in core, which is a built-in function here.
static uint segment_length(uint segments) {
    return (TESS_UNIT + segments / 2u) / (segments > 0u ? segments : 1u);
}

// The largest power of two in `x` > 0.
static uint highest_bit(uint x) {
    uint bits = x;
    bits |= bits >> 1;
    bits |= bits >> 2;
    bits |= bits >> 4;
    return bits - (bits >> 1);
}

// Which point of half a line comes with the next level, when points come in the order of the marks of a ruler.
static uint split_point(uint fraction, uint marks) {
    if (fraction == 0u) {
        return 0xffffffffu;
    }
    return marks == 0u ? 0u : 2u * (marks - highest_bit(marks)) + 1u;
}

// `a / b` in units of 2^-16, rounded; `a` < `b` <= 2^23.
static uint quotient(uint a, uint b) {
    const uint high = a << 8;
    const uint low = (high % b) << 8;
    const uint rest = low % b;
    return ((high / b) << 8) + low / b + (2u * rest >= b ? 1u : 0u);
}

// Of a converted level.
static Division new_division(uint word) {
    Division division;
    division.fixed = word & LEVEL_FIXED;
    division.odd = (word & LEVEL_ODD) != 0u ? 1u : 0u;
    const uint middle = (division.fixed + 1u) / 2u + division.odd * TESS_HALF;
    const uint whole = middle / TESS_UNIT;
    division.fraction = middle % TESS_UNIT;
    division.halves = whole + (division.fraction > 0u ? 1u : 0u);
    division.is_stadlbauer = (word & LEVEL_STADLBAUER) != 0u;
    division.split = split_point(division.fraction, whole - division.odd);
    division.lengths = (uint2)(segment_length(2u * whole - division.odd),
                               segment_length(2u * division.halves - division.odd));
    return division;
}

// How many segments there are.
static uint segments_of(const Division *division) {
    return 2u * division->halves - division->odd;
}

// Half of the segments, of an odd number the smaller half: those at whose start a ruler has a mark.
static uint marks_of(const Division *division) {
    return division->halves - division->odd;
}

// Stadlbauer 2019, sec. 4.2: all segments are 1 / level long but for two that share the rest, which are the second
// ones from both ends, or the outermost ones if there are but three.
static uint near_by_lengths(const Division *division, uint point) {
    const uint segments = segments_of(division);
    const uint shorts = segments == 3u ? 1u : 2u;
    const uint rest = division->fixed + 2u * TESS_UNIT - segments * TESS_UNIT;
    // Twice the place, in segments.
    const uint twice = point >= shorts ? 2u * (point - 1u) * TESS_UNIT + rest : 2u * point * TESS_UNIT;
    return quotient(twice, 2u * division->fixed);
}

// Where a point of the first half lies; `near` in core.
static uint near_place(const Division *division, uint point) {
    if (division->is_stadlbauer) {
        return near_by_lengths(division, point);
    }
    const uint fraction = division->fraction;
    const uint smaller = (point - (point > division->split ? 1u : 0u)) * division->lengths.x;
    const uint larger = point * division->lengths.y;
    return (smaller * (TESS_UNIT - fraction) + larger * fraction + TESS_HALF) / TESS_UNIT;
}

// Where a point of 0 ..= `segments_of` lies, in units of 2^-16; `place` in core.
static uint place_of(const Division *division, uint point) {
    const bool is_far = point >= division->halves;
    const uint near = is_far ? segments_of(division) - point : point;
    const uint place = near == division->halves ? TESS_HALF : near_place(division, near);
    return is_far ? TESS_UNIT - place : place;
}
