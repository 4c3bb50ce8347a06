//! Which plane is best for a node: one that cuts few pieces, and has as many on one side as on the other.
//!
//! Pieces are looked at many at once, in single floats, four corners of each. That is enough to choose, as any choice gives
//! the same order.
#![deny(clippy::float_arithmetic)]

use super::plane::Plane;
use crate::num::{abs, add, max, min, mul, neg, recip, sub};

/// Planes are judged by so many pieces at most.
pub const JUDGES: usize = 64;
/// Corners of a piece that are looked at.
pub const CORNERS: usize = 4;
/// Pieces that are looked at together.
const LANES: usize = 8;
/// A cut is as bad as so many pieces more on one side than on the other.
pub(super) const CUT_COST: u32 = 10;
/// What is nearer to a plane than that, in units of the lattice, may be on the other side. Coordinates are below 2²⁰: those
/// of corners are off by 2⁻⁴, a normal's by 2⁻²³ of the largest, the offset and the sums by about 2⁻² each, all together by less than that.
const NEAR: f32 = 2.0;

/// On which side of a plane a piece is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// In it.
    InPlane,
    /// Before it.
    Before,
    /// Behind it.
    Behind,
    /// On both sides.
    Cut,
}

impl Side {
    /// Of a piece of which something, or nothing, is before a plane and behind it.
    #[inline(always)]
    #[must_use]
    pub const fn of(before: bool, behind: bool) -> Self {
        match (before, behind) {
            (false, false) => Self::InPlane,
            (true, false) => Self::Before,
            (false, true) => Self::Behind,
            (true, true) => Self::Cut,
        }
    }
}

/// Some pieces of a node, a lane each.
#[derive(Clone, Debug)]
pub struct Jury {
    corners: [[[f32; JUDGES]; 3]; CORNERS],
    count: usize,
}

impl Default for Jury {
    fn default() -> Self {
        Self { corners: [[[0.0; JUDGES]; 3]; CORNERS], count: 0 }
    }
}

impl Jury {
    /// Calls some of so many pieces, whatever their number: about [`JUDGES`] of them, evenly spread; `corners` gives some
    /// of a piece's corners.
    #[inline(always)]
    pub fn call(&mut self, pieces: usize, corners: impl Fn(usize) -> [[f32; 3]; CORNERS]) {
        let step = pieces.div_ceil(JUDGES).max(1);
        self.count = 0;
        for piece in (0..pieces).step_by(step) {
            for (corners, corner) in self.corners.iter_mut().zip(corners(piece)) {
                for axis in 0..3 {
                    corners[axis][self.count] = corner[axis];
                }
            }
            self.count += 1;
        }
        // The last lanes are filled with the last piece, which does not count there.
        let filled = self.count.next_multiple_of(LANES).min(JUDGES);
        for lane in self.count..filled {
            for corner in self.corners.iter_mut().flatten() {
                corner[lane] = corner[self.count - 1];
            }
        }
    }

    /// How bad a plane is.
    #[inline(always)]
    #[must_use]
    pub fn cost(&self, plane: &Plane) -> u32 {
        let (normal, offset) = scaled(plane);
        let (mut before, mut behind, mut cuts) = ([0_u32; LANES], [0_u32; LANES], [0_u32; LANES]);
        for first in (0..self.count).step_by(LANES) {
            let [low, high] = self.between(first, normal, offset);
            for l in 0..LANES {
                let counts = u32::from(first + l < self.count);
                let (is_before, is_behind) = (u32::from(high[l] > NEAR), u32::from(low[l] < neg(NEAR)));
                cuts[l] += counts & is_before & is_behind;
                before[l] += counts & is_before;
                behind[l] += counts & is_behind;
            }
        }
        let sum = |lanes: [u32; LANES]| lanes.iter().sum::<u32>();
        CUT_COST * sum(cuts) + sum(before).abs_diff(sum(behind))
    }

    /// Smallest and largest value of some pieces' corners.
    #[inline(always)]
    fn between(&self, first: usize, normal: [f32; 3], offset: f32) -> [[f32; LANES]; 2] {
        let (mut low, mut high) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
        for [x, y, z] in &self.corners {
            for l in 0..LANES {
                let at = first + l;
                let along = add(add(mul(x[at], normal[0]), mul(y[at], normal[1])), mul(z[at], normal[2]));
                let value = sub(along, offset);
                low[l] = min(value, low[l]);
                high[l] = max(value, high[l]);
            }
        }
        [low, high]
    }
}

/// A plane's normal and offset, such that values are about distances.
#[inline(always)]
fn scaled(plane: &Plane) -> ([f32; 3], f32) {
    let [x, y, z] = [plane.normal[0] as f32, plane.normal[1] as f32, plane.normal[2] as f32];
    let length = max(max(abs(x), abs(y)), abs(z));
    let scale = recip(length);
    ([mul(x, scale), mul(y, scale), mul(z, scale)], mul(plane.offset as f32, scale))
}
