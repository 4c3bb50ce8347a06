// Mirrors core/src/tess/level.rs: levels as they are asked for become levels as they are used: clamped, rounded, in fixed
// point.

// The smallest level above 1.
const BARELY_MORE: f32 = 1.0000152587890625;
// The largest level of an odd number of segments.
const MOST_OF_ODD: f32 = MAX_TESS_LEVEL - 1.0;
// Bits of what is larger than every number.
const INFINITE: u32 = 0x7f800000u;

// How many outer levels the domain has, and how many inner ones.
fn level_counts() -> vec2<u32> {
    switch tess_frame.domain {
        case TESS_ISOLINES: { return vec2<u32>(2u, 0u); }
        case TESS_QUADS: { return vec2<u32>(4u, 2u); }
        default: { return vec2<u32>(3u, 1u); }
    }
}

// The levels of a patch as words, the outer ones first; all are 0 where the patch is to be dropped: an outer level is not
// above 0, or not a number.
fn convert(asked: TessLevels) -> array<u32, 6> {
    var levels = asked;
    var words = array<u32, 6>(0u, 0u, 0u, 0u, 0u, 0u);
    if is_dropped_by(levels) {
        return words;
    }
    let counts = level_counts();
    // One level above 1, as they are converted, is enough for a patch to have an inside.
    var is_divided = false;
    for (var k = 0u; k < counts.x; k++) {
        let spacing = select(tess_frame.spacing, TESS_EQUAL, is_line_count(k));
        words[k] = word(spacing, clamped(spacing, levels.outer[k], 1.0));
        is_divided = is_divided || is_above_one(words[k]);
    }
    for (var k = 0u; k < counts.y; k++) {
        let level = clamped(tess_frame.spacing, levels.inner[k], 1.0);
        is_divided = is_divided || is_above_one(word(tess_frame.spacing, level));
    }
    let least = select(1.0, BARELY_MORE, is_divided);
    for (var k = 0u; k < counts.y; k++) {
        words[4u + k] = word(tess_frame.spacing, clamped(tess_frame.spacing, levels.inner[k], least));
    }
    return words;
}

// Is a converted level above 1?
fn is_above_one(converted: u32) -> bool {
    return (converted & LEVEL_FIXED) > TESS_UNIT;
}

// The first level of isolines is how many there are, which are always spaced equally.
fn is_line_count(level: u32) -> bool {
    return tess_frame.domain == TESS_ISOLINES && level == 0u;
}

fn is_dropped_by(asked: TessLevels) -> bool {
    var levels = asked;
    var dropped = false;
    for (var k = 0u; k < level_counts().x; k++) {
        dropped = dropped || !is_positive(levels.outer[k]);
    }
    return dropped;
}

// Is a level above 0? Told by its bits: a device may take a denormal for 0, and knows not what is not a number.
fn is_positive(level: f32) -> bool {
    return bitcast<u32>(level) - 1u < INFINITE;
}

// A level in the range of a spacing, and not below `least`; what is not a number is the lower end.
fn clamped(spacing: u32, level: f32, least: f32) -> f32 {
    let low = select(least, 2.0, spacing == TESS_EVEN);
    let high = select(MAX_TESS_LEVEL, MOST_OF_ODD, spacing == TESS_ODD);
    return clamp(select(0.0, level, is_positive(level)), low, high);
}

fn word(spacing: u32, level: f32) -> u32 {
    let rule = select(0u, LEVEL_STADLBAUER, (tess_frame.flags & TESS_STADLBAUER) != 0u);
    if spacing == TESS_EVEN {
        return (fixed(level) & LEVEL_FIXED) | rule;
    }
    if spacing == TESS_ODD {
        return (fixed(level) & LEVEL_FIXED) | LEVEL_ODD | rule;
    }
    let whole = rounded_up(level);
    return ((whole * TESS_UNIT) & LEVEL_FIXED) | select(0u, LEVEL_ODD, (whole & 1u) != 0u) | rule;
}

// The smallest integer not below a level.
fn rounded_up(level: f32) -> u32 {
    return u32(-floor(neg(level)));
}

fn fixed(level: f32) -> u32 {
    return u32(round(mul(level, 65536.0)));
}
