//! Axis-aligned boxes.
#![deny(clippy::float_arithmetic)]

pub use crate::abi::Bounds;
use crate::num::{max, min};

impl Bounds {
    /// Of nothing.
    pub const NONE: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    /// Of points.
    #[inline(always)]
    #[must_use]
    pub fn of(points: &[[f32; 3]]) -> Self {
        points.iter().fold(Self::NONE, |bounds, point| bounds.union(Self { low: *point, high: *point }))
    }

    /// The smallest box about two. Devices compare bits, since some take the smallest numbers for 0.
    #[inline(always)]
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        let (a, b, c, d) = (self.low, other.low, self.high, other.high);
        Self {
            low: [min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2])],
            high: [max(c[0], d[0]), max(c[1], d[1]), max(c[2], d[2])],
        }
    }

    /// Is another box inside?
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.low[axis] && self.high[axis] >= other.high[axis])
    }

    /// Half of its surface; 0 of nothing. No kernel needs it, so it may be as large and as small as boxes are.
    #[must_use]
    #[allow(clippy::float_arithmetic)]
    pub fn half_area(&self) -> f64 {
        let side = |axis: usize| (f64::from(self.high[axis]) - f64::from(self.low[axis])).max(0.0);
        side(0) * side(1) + side(1) * side(2) + side(2) * side(0)
    }
}
