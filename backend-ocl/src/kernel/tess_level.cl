// Mirrors core/src/tess/level.rs: levels as they are asked for become levels as they are used, in fixed point.

// The smallest level above 1.
#define BARELY_MORE 0x1.0001p0f

// How many outer levels a domain has, and how many inner ones.
static uint2 level_counts(uint domain) {
    if (domain == TESS_ISOLINES) {
        return (uint2)(2u, 0u);
    }
    return domain == TESS_QUADS ? (uint2)(4u, 2u) : (uint2)(3u, 1u);
}

// The first level of isolines is how many there are, which are always spaced equally.
static bool is_line_count(uint domain, uint level) {
    return domain == TESS_ISOLINES && level == 0u;
}

// Told by its bits: no option lets a compiler assume that those are a number's.
static bool is_positive(float level) {
    return as_uint(level) - 1u < 0x7f800000u;
}

static bool is_dropped(uint domain, const TessLevels *levels) {
    bool dropped = false;
    for (uint k = 0u; k < level_counts(domain).x; k++) {
        dropped = dropped || !is_positive(levels->outer[k]);
    }
    return dropped;
}

// A level in the range of a spacing, and not below `least`; what is not a number is the lower end.
static float clamped(uint spacing, float level, float least) {
    const float known = as_float(is_positive(level) ? as_uint(level) : 0u);
    if (spacing == TESS_EVEN) {
        return clamp(known, 2.0f, MAX_TESS_LEVEL);
    }
    return clamp(known, least, spacing == TESS_ODD ? 63.0f : MAX_TESS_LEVEL);
}

// The smallest integer not below a level.
static uint rounded_up(float level) {
    return (uint)(-floor(neg(level)));
}

static uint fixed_level(uint zero, float level) {
    return (uint)round(mul(level, number((int)TESS_UNIT)));
}

static uint level_word(__constant TessFrame *frame, uint spacing, float level) {
    const uint zero = frame->zero, whole = rounded_up(level);
    const bool is_equal = spacing != TESS_EVEN && spacing != TESS_ODD;
    const uint fixed = is_equal ? whole * TESS_UNIT : fixed_level(zero, level);
    const bool is_odd = is_equal ? (whole & 1u) != 0u : spacing == TESS_ODD;
    const uint rule = (frame->flags & TESS_STADLBAUER) != 0u ? LEVEL_STADLBAUER : 0u;
    return (fixed & LEVEL_FIXED) | (is_odd ? LEVEL_ODD : 0u) | rule;
}

// Is a converted level above 1?
static bool is_above_one(uint word) {
    return (word & LEVEL_FIXED) > TESS_UNIT;
}

// The levels of a patch as words, the outer ones first; all are 0 where the patch is to be dropped: an outer level is
// not above 0, or not a number.
static void convert(__constant TessFrame *frame, const TessLevels *levels, uint *words) {
    for (uint k = 0u; k < 6u; k++) {
        words[k] = 0u;
    }
    if (is_dropped(frame->domain, levels)) {
        return;
    }
    const uint2 counts = level_counts(frame->domain);
    // One level above 1, as they are converted, is enough for a patch to have an inside.
    bool is_divided = false;
    for (uint k = 0u; k < counts.x; k++) {
        const uint spacing = is_line_count(frame->domain, k) ? TESS_EQUAL : frame->spacing;
        words[k] = level_word(frame, spacing, clamped(spacing, levels->outer[k], 1.0f));
        is_divided = is_divided || is_above_one(words[k]);
    }
    for (uint k = 0u; k < counts.y; k++) {
        const float level = clamped(frame->spacing, levels->inner[k], 1.0f);
        is_divided = is_divided || is_above_one(level_word(frame, frame->spacing, level));
    }
    const float least = is_divided ? BARELY_MORE : 1.0f;
    for (uint k = 0u; k < counts.y; k++) {
        words[4u + k] = level_word(frame, frame->spacing, clamped(frame->spacing, levels->inner[k], least));
    }
}
