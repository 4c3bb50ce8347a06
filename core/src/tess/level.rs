//! Levels as they are asked for become levels as they are used: clamped, rounded, in fixed point.
//!
//! OpenGL 4.6 sec. 11.2.2.1 and Direct3D 11.3 sec. 12.7 agree on all of it. A converted level is a word: the level in units
//! of 2⁻¹⁶, and whether its number of segments is odd, and whose rule places its points.
#![deny(clippy::float_arithmetic)]

use crate::abi::{
    LEVEL_FIXED, LEVEL_ODD, LEVEL_STADLBAUER, MAX_TESS_LEVEL, TESS_EVEN, TESS_ISOLINES, TESS_ODD, TESS_QUADS,
    TESS_STADLBAUER, TESS_UNIT, TessFrame, TessLevels,
};
use crate::num::{clamp, floor, mul, neg, round};

/// The smallest level above 1.
const BARELY_MORE: f32 = 1.0 + 1.0 / TESS_UNIT as f32;
/// The largest level of an odd number of segments.
const MOST_OF_ODD: f32 = MAX_TESS_LEVEL - 1.0;
/// Bits of what is larger than every number.
const INFINITE: u32 = f32::INFINITY.to_bits();

/// How many outer levels a domain has, and how many inner ones.
#[inline(always)]
#[must_use]
pub const fn level_counts(domain: u32) -> [u32; 2] {
    match domain {
        TESS_ISOLINES => [2, 0],
        TESS_QUADS => [4, 2],
        _ => [3, 1],
    }
}

/// The levels of a patch as words, the outer ones first; all are 0 where the patch is to be dropped: an outer level is
/// not above 0, or not a number.
#[inline(always)]
#[must_use]
pub const fn convert(frame: &TessFrame, levels: &TessLevels) -> [u32; 6] {
    if is_dropped(frame.domain, levels) {
        return [0; 6];
    }
    let [outer, inner] = level_counts(frame.domain);
    // One level above 1, as they are converted, is enough for a patch to have an inside.
    let mut is_divided = false;
    let mut words = [0; 6];
    let mut k = 0;
    while k < outer {
        let spacing = if is_line_count(frame.domain, k) { 0 } else { frame.spacing };
        words[k as usize] = word(frame, spacing, clamped(spacing, levels.outer[k as usize], 1.0));
        is_divided |= is_above_one(words[k as usize]);
        k += 1;
    }
    let mut k = 0;
    while k < inner {
        let level = clamped(frame.spacing, levels.inner[k as usize], 1.0);
        is_divided |= is_above_one(word(frame, frame.spacing, level));
        k += 1;
    }
    let least = if is_divided { BARELY_MORE } else { 1.0 };
    let mut k = 0;
    while k < inner {
        let level = clamped(frame.spacing, levels.inner[k as usize], least);
        words[4 + k as usize] = word(frame, frame.spacing, level);
        k += 1;
    }
    words
}

/// Is a converted level above 1?
#[inline(always)]
const fn is_above_one(word: u32) -> bool {
    word & LEVEL_FIXED > TESS_UNIT
}

/// The first level of isolines is how many there are, which are always spaced equally.
#[inline(always)]
const fn is_line_count(domain: u32, level: u32) -> bool {
    domain == TESS_ISOLINES && level == 0
}

#[inline(always)]
const fn is_dropped(domain: u32, levels: &TessLevels) -> bool {
    let [outer, _] = level_counts(domain);
    let mut k = 0;
    let mut dropped = false;
    while k < outer {
        dropped |= !is_positive(levels.outer[k as usize]);
        k += 1;
    }
    dropped
}

/// Is a level above 0? Told by its bits: a device may take a denormal for 0, and need not know what is not a number.
#[inline(always)]
const fn is_positive(level: f32) -> bool {
    level.to_bits().wrapping_sub(1) < INFINITE
}

/// A level in the range of a spacing, and not below `least`; what is not a number is the lower end.
#[inline(always)]
const fn clamped(spacing: u32, level: f32, least: f32) -> f32 {
    let level = if is_positive(level) { level } else { 0.0 };
    match spacing {
        TESS_EVEN => clamp(level, 2.0, MAX_TESS_LEVEL),
        TESS_ODD => clamp(level, least, MOST_OF_ODD),
        _ => clamp(level, least, MAX_TESS_LEVEL),
    }
}

#[inline(always)]
const fn word(frame: &TessFrame, spacing: u32, level: f32) -> u32 {
    let (fixed, odd) = match spacing {
        TESS_EVEN => (fixed(level), 0),
        TESS_ODD => (fixed(level), LEVEL_ODD),
        _ => {
            let whole = rounded_up(level);
            (whole * TESS_UNIT, if whole & 1 > 0 { LEVEL_ODD } else { 0 })
        }
    };
    let rule = if frame.flags & TESS_STADLBAUER > 0 { LEVEL_STADLBAUER } else { 0 };
    fixed & LEVEL_FIXED | odd | rule
}

/// The smallest integer not below a level.
#[inline(always)]
const fn rounded_up(level: f32) -> u32 {
    (-floor(neg(level))) as u32
}

#[inline(always)]
const fn fixed(level: f32) -> u32 {
    round(mul(level, TESS_UNIT as f32)) as u32
}
