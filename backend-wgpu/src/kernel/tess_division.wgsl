// Mirrors core/src/tess/division.rs: a converted level divides a line: into how many segments, and where their ends are.

// How a line from 0 to TESS_UNIT is divided. What lies at a place from one end lies there from the other.
struct Division {
    // The level in units of 2^-16.
    fixed: u32,
    // Points of the first half; a point in the middle is none of them.
    halves: u32,
    // 1 where there is a segment in the middle, 0 where there is a point.
    odd: u32,
    // Not 0 where points are placed as in Stadlbauer 2019; what follows is of Direct3D 11.
    by_lengths: u32,
    // Share of the larger of the two whole levels between which this one is.
    fraction: u32,
    // The point of the larger level that the smaller one has not got.
    split: u32,
    // Lengths of segments at both levels.
    lengths: vec2<u32>,
}

// Of a converted level.
fn division(word: u32) -> Division {
    let fixed = word & LEVEL_FIXED;
    let odd = select(0u, 1u, (word & LEVEL_ODD) != 0u);
    let half = (fixed + 1u) / 2u + odd * TESS_HALF;
    let whole = half / TESS_UNIT;
    let fraction = half % TESS_UNIT;
    let halves = whole + select(0u, 1u, fraction > 0u);
    let lengths = vec2<u32>(length_of(2u * whole - odd), length_of(2u * halves - odd));
    return Division(
        fixed, halves, odd, word & LEVEL_STADLBAUER, fraction, split_of(fraction, whole - odd), lengths);
}

// How many segments there are.
fn segments_of(line: Division) -> u32 {
    return 2u * line.halves - line.odd;
}

// Half of the segments, of an odd number the smaller half: those at whose start a ruler has a mark.
fn marks_of(line: Division) -> u32 {
    return line.halves - line.odd;
}

// Where point `number` of 0 to the number of segments lies, in units of 2^-16.
fn place(line: Division, number: u32) -> u32 {
    let is_far = number >= line.halves;
    let near_end = select(number, segments_of(line) - number, is_far);
    if near_end == line.halves {
        return TESS_HALF;
    }
    let found = near(line, near_end);
    return select(found, TESS_UNIT - found, is_far);
}

// Where a point of the first half lies.
fn near(line: Division, number: u32) -> u32 {
    if line.by_lengths != 0u {
        return near_by_lengths(line, number);
    }
    let smaller = (number - select(0u, 1u, number > line.split)) * line.lengths.x;
    let larger = number * line.lengths.y;
    return (smaller * (TESS_UNIT - line.fraction) + larger * line.fraction + TESS_HALF) / TESS_UNIT;
}

// All segments are 1 / level long but for two that share the rest, which are the second ones from both ends, or the
// outermost ones if there are but three.
fn near_by_lengths(line: Division, number: u32) -> u32 {
    let segments = segments_of(line);
    let shorts = select(2u, 1u, segments == 3u);
    let rest = line.fixed + 2u * TESS_UNIT - segments * TESS_UNIT;
    // Twice the place, in segments.
    let twice =
        select(2u * number * TESS_UNIT, 2u * (number - 1u) * TESS_UNIT + rest, number >= shorts);
    return quotient(twice, 2u * line.fixed);
}

// 1 / `segments`, rounded; 1 where there are none.
fn length_of(segments: u32) -> u32 {
    return (TESS_UNIT + segments / 2u) / select(1u, segments, segments > 0u);
}

// Which point of half a line comes with the next level, when points come in the order of the marks of a ruler.
fn split_of(fraction: u32, marks: u32) -> u32 {
    if fraction == 0u {
        return 0xffffffffu;
    }
    if marks == 0u {
        return 0u;
    }
    return 2u * (marks - highest_bit(marks)) + 1u;
}

// The largest power of two in `x` > 0.
fn highest_bit(x: u32) -> u32 {
    var bits = x;
    bits |= bits >> 1u;
    bits |= bits >> 2u;
    bits |= bits >> 4u;
    return bits - (bits >> 1u);
}

// `a / b` in units of 2^-16, rounded; `a` < `b` <= 2^23.
fn quotient(a: u32, b: u32) -> u32 {
    let high = a << 8u;
    let low = (high % b) << 8u;
    let rest = low % b;
    return ((high / b) << 8u) + low / b + select(0u, 1u, 2u * rest >= b);
}
