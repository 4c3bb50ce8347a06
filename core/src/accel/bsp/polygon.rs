//! A convex piece of a triangle, and what a plane makes of it.
//!
//! A place in a triangle has three weights, one a corner. A plane's values at the three corners are a line there: weights
//! `w` with `values · w = 0`. So a piece is a ring of lines, and its corners, where two of them meet, are cross products:
//! nothing is rounded, however often a piece is cut.

use super::exact::{cross, dot_sign, each};
use super::lattice::Point;
use super::plane::{Plane, Rough};

/// A corner of a piece that is no corner of its triangle.
const MADE: u32 = 3;

/// A corner of a piece, and its side from there to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Where it is, in units of the lattice, to 2⁻³⁰ of them.
    pub at: [f64; 3],
    /// The line that the side is on; inside is where it is above 0.
    pub line: [i64; 3],
    /// What made the side; [`Cut::NONE`] if it is the triangle's.
    pub cut: Cut,
    /// Which corner of the triangle it is; 3 if none.
    vertex: u32,
}

impl Corner {
    /// Which corner of the triangle it is, if it is one.
    #[inline(always)]
    pub(super) const fn vertex(&self) -> Option<usize> {
        if self.vertex < MADE { Some(self.vertex as usize) } else { None }
    }
}

/// A plane that cuts, and which side of it is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut(pub u32);

/// What a cut's plane is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cutter {
    /// That of a triangle.
    Triangle(u32),
    /// That behind a slab of cells along an axis.
    Slab {
        /// 0 to 2.
        axis: usize,
        /// Which slab.
        slab: u32,
    },
}

const SLABS: u32 = 1 << 31;
const AXIS_SHIFT: u32 = 28;
/// Most triangles and slabs that cuts can name.
pub const MOST_TRIANGLES: u32 = 1 << 30;
/// Most slabs of cells along an axis.
pub const MOST_SLABS: u32 = 1 << 8;

impl Cut {
    /// No cut.
    pub const NONE: Self = Self(u32::MAX);

    /// Of a plane; is its back kept?
    #[must_use]
    pub const fn new(cutter: Cutter, keeps_back: bool) -> Self {
        let code = match cutter {
            Cutter::Triangle(triangle) => triangle << 1,
            Cutter::Slab { axis, slab } => SLABS | (axis as u32) << AXIS_SHIFT | slab << 1,
        };
        Self(code | keeps_back as u32)
    }

    /// Is the back of the plane kept?
    #[must_use]
    pub const fn keeps_back(self) -> bool {
        self.0 & 1 == 1
    }

    /// Which plane it is.
    #[must_use]
    pub const fn cutter(self) -> Cutter {
        if self.0 & SLABS == 0 {
            return Cutter::Triangle(self.0 >> 1);
        }
        let axis = (self.0 >> AXIS_SHIFT & 3) as usize;
        Cutter::Slab { axis, slab: (self.0 & ((1 << AXIS_SHIFT) - 1)) >> 1 }
    }
}

/// All of a triangle.
#[inline]
#[must_use]
pub fn whole(triangle: &[Point; 3]) -> [Corner; 3] {
    each(|k| {
        let mut line = [0; 3];
        line[(k + 2) % 3] = 1; // the side to the next corner is where the last one weighs nothing
        let at = each(|axis| f64::from(triangle[k][axis]));
        Corner { at, line, cut: Cut::NONE, vertex: k as u32 }
    })
}

/// On which side of a plane corner `k` of a piece is: 1 before it, -1 behind it, 0 on it.
#[inline]
#[must_use]
pub fn side(triangle: &[Point; 3], piece: &[Corner], k: usize, plane: &Plane, rough: &Rough) -> i32 {
    let corner = &piece[k];
    if let Some(sign) = rough.sign(rough.value(corner.at)) {
        return sign;
    }
    if let Some(vertex) = corner.vertex() {
        return plane.value(triangle[vertex]).signum() as i32;
    }
    let before = if k == 0 { piece.len() - 1 } else { k - 1 };
    made_side([piece[before].line, corner.line], plane.values(*triangle))
}

/// On which side of a plane, whose values at a triangle's corners are given, two of the triangle's lines meet, on its edge
/// or within.
#[inline(always)]
pub(super) fn made_side(lines: [[i64; 3]; 2], values: [i64; 3]) -> i32 {
    let mut side = side_on_edge(lines[0], values);
    if side.is_none() {
        side = side_on_edge(lines[1], values);
    }
    if let Some(side) = side {
        return side;
    }
    let weights = cross(lines[0], lines[1]);
    dot_sign(weights, values) * sign_of(weights)
}

/// If the line is a side of the triangle, and both of its ends are on one side of a plane, or on the plane: so is what is
/// between.
#[inline(always)]
const fn side_on_edge(line: [i64; 3], values: [i64; 3]) -> Option<i32> {
    let [a, b] = match line {
        [1, 0, 0] => [values[1].signum(), values[2].signum()],
        [0, 1, 0] => [values[2].signum(), values[0].signum()],
        [0, 0, 1] => [values[0].signum(), values[1].signum()],
        _ => return None,
    };
    if a * b < 0 { None } else { Some((a + b).signum() as i32) }
}

/// The sign that weights of a place in the triangle have in common.
#[inline(always)]
const fn sign_of(weights: [i128; 3]) -> i32 {
    let is_below = weights[0] < 0 || weights[1] < 0 || weights[2] < 0;
    if is_below { -1 } else { 1 }
}

/// A plane in a piece that it cuts: its line, and on which side of it each corner is.
#[derive(Clone, Copy, Debug)]
pub struct Knife<'a> {
    /// Corners of the triangle.
    pub triangle: &'a [Point; 3],
    /// The plane's values there.
    pub line: [i64; 3],
    /// Sides of the piece's corners: some are on one side, some on the other.
    pub sides: &'a [i8],
}

/// Whose corner something is that a cut left, or whose side was cut there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The piece's corner `k`.
    Corner(usize),
    /// Made where the side from corner `k` crosses the plane.
    Side(usize),
}

impl Knife<'_> {
    /// Cuts a piece in two. Tells the corners of what is before the plane (half 0), and of what is behind it (half 1).
    #[inline]
    pub fn split(&self, piece: &[Corner], cutter: Cutter, mut tell: impl FnMut(usize, Corner, Origin)) {
        let back = each(|k| -self.line[k]);
        let edge = [(self.line, Cut::new(cutter, false)), (back, Cut::new(cutter, true))];
        for (k, corner) in piece.iter().enumerate() {
            let next = if k + 1 == piece.len() { 0 } else { k + 1 };
            let (here, there) = (self.sides[k], self.sides[next]);
            let (end, from) = if here * there < 0 {
                let at = meet(self.triangle, corner.line, self.line);
                (Corner { at, vertex: MADE, ..*corner }, Origin::Side(k))
            } else {
                (piece[next], Origin::Corner(next))
            };
            for (half, way) in [(0, 1), (1, -1)] {
                let (here, there) = (here * way, there * way);
                if here > 0 || (here == 0 && there > 0) {
                    tell(half, *corner, Origin::Corner(k));
                } else if there > 0 {
                    tell(half, end, from);
                }
                if here > 0 && there <= 0 {
                    let (line, cut) = edge[half];
                    tell(half, Corner { line, cut, ..end }, from);
                }
            }
        }
    }
}

/// Where two lines meet, which is in the triangle. All weights have one sign, so nothing cancels.
fn meet(triangle: &[Point; 3], a: [i64; 3], b: [i64; 3]) -> [f64; 3] {
    let weights = cross(a, b);
    let weights = each(|k| float(weights[k]));
    let all = weights[0] + weights[1] + weights[2];
    each(|axis| {
        let [a, b, c] = each(|k| f64::from(triangle[k][axis]));
        (a * weights[0] + b * weights[1] + c * weights[2]) / all
    })
}

/// The magnitude of a number, to 2⁻⁵² of it.
#[inline(always)]
fn float(number: i128) -> f64 {
    let magnitude = number.unsigned_abs();
    (magnitude >> 64) as u64 as f64 * 18_446_744_073_709_551_616.0 + magnitude as u64 as f64
}
