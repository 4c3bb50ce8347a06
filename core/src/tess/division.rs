//! A converted level divides a line: into how many segments, and where their ends are.

use crate::abi::{LEVEL_FIXED, LEVEL_ODD, LEVEL_STADLBAUER, TESS_HALF, TESS_UNIT};

/// How a line from 0 to [`TESS_UNIT`] is divided. What lies at a place from one end lies there from the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Division {
    /// The level in units of 2⁻¹⁶.
    fixed: u32,
    /// Points of the first half; a point in the middle is none of them.
    halves: u32,
    /// 1 where there is a segment in the middle, 0 where there is a point.
    odd: u32,
    rule: Rule,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Rule {
    Direct3D {
        /// Share of the larger of the two whole levels between which this one is.
        fraction: u32,
        /// The point of the larger level that the smaller one has not got.
        split: u32,
        /// Lengths of segments at both levels.
        lengths: [u32; 2],
    },
    #[default]
    Stadlbauer,
}

impl Division {
    /// Of a converted level (see [`super::level`]).
    #[inline(always)]
    #[must_use]
    pub const fn new(word: u32) -> Self {
        let (fixed, odd) = (word & LEVEL_FIXED, (word & LEVEL_ODD > 0) as u32);
        let half = fixed.div_ceil(2) + odd * TESS_HALF;
        let (floor, fraction) = (half / TESS_UNIT, half % TESS_UNIT);
        let halves = floor + (fraction > 0) as u32;
        let rule = if word & LEVEL_STADLBAUER > 0 {
            Rule::Stadlbauer
        } else {
            let lengths = [length(2 * floor - odd), length(2 * halves - odd)];
            Rule::Direct3D { fraction, split: split(fraction, floor - odd), lengths }
        };
        Self { fixed, halves, odd, rule }
    }

    /// How many segments there are.
    #[inline(always)]
    #[must_use]
    pub const fn segments(&self) -> u32 {
        2 * self.halves - self.odd
    }

    /// Half of the segments, of an odd number the smaller half: those at whose start a ruler has a mark.
    #[inline(always)]
    #[must_use]
    pub const fn marks(&self) -> u32 {
        self.halves - self.odd
    }

    /// Where point `point` of 0 ..= [`Division::segments`] lies, in units of 2⁻¹⁶.
    #[inline(always)]
    #[must_use]
    pub const fn place(&self, point: u32) -> u32 {
        let is_far = point >= self.halves;
        let near = if is_far { self.segments() - point } else { point };
        let place = if near == self.halves { TESS_HALF } else { self.near(near) };
        if is_far { TESS_UNIT - place } else { place }
    }

    /// Where a point of the first half lies.
    #[inline(always)]
    const fn near(&self, point: u32) -> u32 {
        match self.rule {
            Rule::Direct3D { fraction, split, lengths } => {
                let floor = (point - (point > split) as u32) * lengths[0];
                let ceil = point * lengths[1];
                (floor * (TESS_UNIT - fraction) + ceil * fraction + TESS_HALF) / TESS_UNIT
            }
            Rule::Stadlbauer => self.near_by_lengths(point),
        }
    }

    /// Stadlbauer 2019, sec. 4.2: all segments are 1 / level long but for two that share the rest, which are the second
    /// ones from both ends, or the outermost ones if there are but three.
    #[inline(always)]
    const fn near_by_lengths(&self, point: u32) -> u32 {
        let shorts = if self.segments() == 3 { 1 } else { 2 };
        let rest = self.fixed + 2 * TESS_UNIT - self.segments() * TESS_UNIT;
        // Twice the place, in segments.
        let twice = if point >= shorts { 2 * (point - 1) * TESS_UNIT + rest } else { 2 * point * TESS_UNIT };
        quotient(twice, 2 * self.fixed)
    }
}

/// 1 / `segments`, rounded; 1 where there are none.
#[inline(always)]
const fn length(segments: u32) -> u32 {
    (TESS_UNIT + segments / 2) / if segments > 0 { segments } else { 1 }
}

/// Which point of half a line comes with the next level, when points come in the order of the marks of a ruler.
#[inline(always)]
const fn split(fraction: u32, marks: u32) -> u32 {
    if fraction == 0 {
        u32::MAX
    } else if marks == 0 {
        0
    } else {
        2 * (marks - highest_bit(marks)) + 1
    }
}

/// The largest power of two in `x` > 0.
#[inline(always)]
#[must_use]
pub const fn highest_bit(x: u32) -> u32 {
    let mut bits = x;
    bits |= bits >> 1;
    bits |= bits >> 2;
    bits |= bits >> 4;
    bits - (bits >> 1)
}

/// `a / b` in units of 2⁻¹⁶, rounded; `a` < `b` ≤ 2²³.
#[inline(always)]
const fn quotient(a: u32, b: u32) -> u32 {
    let high = a << 8;
    let low = (high % b) << 8;
    let rest = low % b;
    ((high / b) << 8) + low / b + (2 * rest >= b) as u32
}
