//! Few pieces: on which sides of all of their planes each corner is, as bits. Then choosing a plane is counting bits, and
//! dividing pieces by it is masking some.

use super::choose::CUT_COST;
use super::lattice::Point;
use super::plane::{Plane, Rough};
use super::polygon::{Corner, made_side};

/// A table is of so many pieces at most, and so of as many planes.
pub const FEW: usize = 64;
/// Pieces that it has room for while they are cut.
pub const SLOTS: usize = 2 * FEW;
/// Planes are looked at by so many, the last of them with planes that are none.
const LANES: usize = 8;

/// Pieces, a bit a slot.
pub type Set = u128;

/// Planes, a bit each, that a corner is before, and behind; or that something of a piece is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sides {
    /// Before these.
    pub before: u64,
    /// Behind these.
    pub behind: u64,
}

impl Sides {
    /// Those of two corners.
    #[inline(always)]
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self { before: self.before | other.before, behind: self.behind | other.behind }
    }

    /// 1 before a plane, -1 behind it, 0 on it.
    #[inline(always)]
    #[must_use]
    pub const fn of(self, plane: usize) -> i8 {
        (self.before >> plane & 1) as i8 - (self.behind >> plane & 1) as i8
    }

    /// Of some planes only.
    #[inline(always)]
    #[must_use]
    pub const fn only(self, planes: u64) -> Self {
        Self { before: self.before & planes, behind: self.behind & planes }
    }
}

/// Some planes, a lane each.
#[derive(Clone, Debug)]
pub struct Planes {
    normal: [[i64; FEW]; 3],
    offset: [i64; FEW],
    rough_normal: [[f64; FEW]; 3],
    rough_offset: [f64; FEW],
    /// What is nearer than this, in lengths of the normal, needs a closer look.
    near: [f64; FEW],
    count: usize,
}

impl Default for Planes {
    fn default() -> Self {
        let (whole, float) = ([0; FEW], [0.0; FEW]);
        Self {
            normal: [whole; 3],
            offset: whole,
            rough_normal: [float; 3],
            rough_offset: float,
            near: float,
            count: 0,
        }
    }
}

impl Planes {
    /// Takes [`FEW`] planes at most. What is nearer to one than a tolerance, in units of the lattice, needs a closer look.
    #[inline(always)]
    pub fn lay(&mut self, planes: impl Iterator<Item = Plane>, tolerance: f64) {
        self.count = 0;
        for plane in planes {
            self.set(self.count, &plane, tolerance);
            self.count += 1;
        }
        // No corner is on either side of no plane.
        for k in self.count..self.count.next_multiple_of(LANES) {
            self.set(k, &Plane::default(), 0.0);
        }
    }

    #[inline(always)]
    fn set(&mut self, k: usize, plane: &Plane, tolerance: f64) {
        let rough = Rough::of(plane);
        let (normal, offset) = rough.parts();
        for axis in 0..3 {
            self.normal[axis][k] = plane.normal[axis];
            self.rough_normal[axis][k] = normal[axis];
        }
        self.offset[k] = plane.offset;
        self.rough_offset[k] = offset;
        self.near[k] =
            if tolerance > 0.0 { rough.value_at(tolerance).max(rough.slack()) } else { rough.slack() };
    }

    /// All of them, a bit each.
    #[inline(always)]
    #[must_use]
    pub const fn all(&self) -> u64 {
        if self.count == FEW { u64::MAX } else { (1 << self.count) - 1 }
    }

    /// Plane `k`.
    #[inline(always)]
    #[must_use]
    pub fn plane(&self, k: usize) -> Plane {
        let [x, y, z] = &self.normal;
        Plane { normal: [x[k], y[k], z[k]], offset: self.offset[k] }
    }

    /// The sides on which corner `k` of a piece is, of those planes that are asked for; exactly.
    #[inline(always)]
    #[must_use]
    pub fn sides(&self, triangle: &[Point; 3], piece: &[Corner], k: usize, asked: u64) -> Sides {
        if let Some(vertex) = piece[k].vertex() {
            return self.sides_of_vertex(&triangle[vertex]).only(asked);
        }
        let before = if k == 0 { piece.len() - 1 } else { k - 1 };
        self.sides_of_made(triangle, piece[k].at, [piece[before].line, piece[k].line], asked)
    }

    /// Of a corner of a mesh.
    #[inline(always)]
    #[must_use]
    pub fn sides_of_vertex(&self, corner: &Point) -> Sides {
        let [x, y, z] = [i64::from(corner[0]), i64::from(corner[1]), i64::from(corner[2])];
        let lanes = self.lanes();
        let ([a, b, c], offset) = (&self.normal, &self.offset[..lanes]);
        let (a, b, c) = (&a[..lanes], &b[..lanes], &c[..lanes]);
        let mut sides = Sides::default();
        for k in 0..lanes {
            // As in `Plane::value`, the parts may not fit a word where the whole does.
            let flat = a[k].wrapping_mul(x).wrapping_add(b[k].wrapping_mul(y));
            let value = flat.wrapping_add(c[k].wrapping_mul(z)).wrapping_sub(offset[k]);
            sides.before |= if_negative(value.wrapping_neg()) & 1 << k;
            sides.behind |= if_negative(value) & 1 << k;
        }
        sides
    }

    /// Of a corner that a cut made, where two lines of a triangle meet.
    #[inline(always)]
    #[must_use]
    pub fn sides_of_made(
        &self,
        triangle: &[Point; 3],
        at: [f64; 3],
        lines: [[i64; 3]; 2],
        asked: u64,
    ) -> Sides {
        let mut sides = self.far_sides(at).only(asked);
        let mut unsure = asked & !(sides.before | sides.behind);
        while unsure != 0 {
            let plane = unsure.trailing_zeros();
            let side = made_side(lines, self.plane(plane as usize).values(*triangle));
            sides.before |= u64::from(side > 0) << plane;
            sides.behind |= u64::from(side < 0) << plane;
            unsure &= unsure - 1;
        }
        sides
    }

    /// Of a place, of those planes that it is not near to.
    #[inline(always)]
    #[must_use]
    pub fn far_sides(&self, [x, y, z]: [f64; 3]) -> Sides {
        let lanes = self.lanes();
        let ([a, b, c], offset) = (&self.rough_normal, &self.rough_offset[..lanes]);
        let (a, b, c, near) = (&a[..lanes], &b[..lanes], &c[..lanes], &self.near[..lanes]);
        let mut sides = Sides::default();
        for k in 0..lanes {
            let value = a[k] * x + b[k] * y + c[k] * z - offset[k];
            sides.before |= if_negative((near[k] - value).to_bits().cast_signed()) & 1 << k;
            sides.behind |= if_negative((near[k] + value).to_bits().cast_signed()) & 1 << k;
        }
        sides
    }

    #[inline(always)]
    fn lanes(&self) -> usize {
        self.count.next_multiple_of(LANES).min(FEW)
    }
}

/// All bits of a negative number's, none of another's: without branches, so that lanes stay lanes.
#[inline(always)]
const fn if_negative(bits: i64) -> u64 {
    (bits >> 63).cast_unsigned()
}

/// What a plane makes of some pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Division {
    /// In it.
    pub own: Set,
    /// Before it.
    pub before: Set,
    /// Behind it.
    pub behind: Set,
    /// On both sides.
    pub cut: Set,
}

/// Planes, and for each which pieces have something before it, and behind it.
#[derive(Clone, Debug)]
pub struct Table {
    /// The planes.
    pub planes: Planes,
    before: [[u64; FEW]; 2],
    behind: [[u64; FEW]; 2],
}

impl Default for Table {
    fn default() -> Self {
        Self { planes: Planes::default(), before: [[0; FEW]; 2], behind: [[0; FEW]; 2] }
    }
}

impl Table {
    /// Notes in which planes' sides a piece has something.
    #[inline(always)]
    pub fn put(&mut self, slot: usize, sides: Sides) {
        let (half, shift) = (slot / FEW, slot % FEW);
        let count = self.planes.lanes();
        for (column, row) in [(&mut self.before[half], sides.before), (&mut self.behind[half], sides.behind)]
        {
            for (plane, pieces) in column[..count].iter_mut().enumerate() {
                *pieces = *pieces & !(1 << shift) | (row >> plane & 1) << shift;
            }
        }
    }

    #[inline(always)]
    fn column(columns: &[[u64; FEW]; 2], plane: usize) -> Set {
        u128::from(columns[1][plane]) << FEW | u128::from(columns[0][plane])
    }

    /// What a plane makes of some pieces.
    #[inline(always)]
    #[must_use]
    pub fn divide(&self, set: Set, plane: usize) -> Division {
        let before = set & Self::column(&self.before, plane);
        let behind = set & Self::column(&self.behind, plane);
        let cut = before & behind;
        Division { own: set & !(before | behind), before: before & !cut, behind: behind & !cut, cut }
    }

    /// How many pieces in half of the slots have something before a plane, behind it, and both.
    #[inline(always)]
    const fn counts(&self, half: usize, set: u64, plane: usize) -> [u32; 3] {
        let (before, behind) = (set & self.before[half][plane], set & self.behind[half][plane]);
        [before.count_ones(), behind.count_ones(), (before & behind).count_ones()]
    }

    /// The best of some planes for some pieces, of those as good the first.
    #[inline(always)]
    #[must_use]
    pub fn best(&self, set: Set, mut planes: u64) -> usize {
        let mut best = (u32::MAX, 0);
        while planes != 0 {
            let plane = planes.trailing_zeros() as usize;
            let [mut before, mut behind, mut cuts] = self.counts(0, set as u64, plane);
            if set >> FEW != 0 {
                let more = self.counts(1, (set >> FEW) as u64, plane);
                (before, behind, cuts) = (before + more[0], behind + more[1], cuts + more[2]);
            }
            // What is cut is on both sides.
            let cost = CUT_COST * cuts + before.abs_diff(behind);
            if cost < best.0 {
                best = (cost, plane);
            }
            planes &= planes - 1;
        }
        best.1
    }
}
