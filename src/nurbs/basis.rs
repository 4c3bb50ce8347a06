//! Uniform bases: segments of four control points, or two, as cubic Bézier segments.

use super::curves::{joined, raised, towards};
use super::net::Homogeneous;

/// What the control points of a curve mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Cubic Bézier points; the last of a segment is the first of the next.
    Bezier,
    /// Uniform cubic B-spline points.
    BSpline,
    /// Points that the curve passes through, save the first and the last (Catmull & Rom 1974).
    CatmullRom,
    /// By turns a point and the derivative there.
    Hermite,
    /// The corners of a line.
    Linear,
}

impl Basis {
    /// Control points from the first of a segment to the first of the next.
    #[must_use]
    pub const fn step(self) -> usize {
        match self {
            Self::Bezier => 3,
            Self::BSpline | Self::CatmullRom | Self::Linear => 1,
            Self::Hermite => 2,
        }
    }

    /// Control points of a segment.
    #[must_use]
    pub const fn window(self) -> usize {
        if matches!(self, Self::Linear) { 2 } else { 4 }
    }

    /// Number of segments of so many control points; none if some would be left over.
    #[must_use]
    pub const fn segments(self, count: usize, step: usize, is_periodic: bool) -> Option<usize> {
        let first = if is_periodic { step } else { self.window() };
        if step == 0 || count < first || !(count - first).is_multiple_of(step) {
            return None;
        }
        Some((count - first) / step + 1)
    }

    /// A segment's Bézier points (Farin, ch. 7 to 9).
    fn bezier(self, point: impl Fn(usize) -> Homogeneous) -> [Homogeneous; 4] {
        if self == Self::Linear {
            return raised(&[point(0), point(1)]);
        }
        let p = [0, 1, 2, 3].map(point);
        match self {
            Self::BSpline => b_spline(p),
            Self::CatmullRom => [p[1], ahead(p[1], p[0], p[2], 6.0), ahead(p[2], p[3], p[1], 6.0), p[2]],
            Self::Hermite => [p[0], ahead(p[0], [0.0; 4], p[1], 3.0), ahead(p[2], p[3], [0.0; 4], 3.0), p[2]],
            Self::Bezier | Self::Linear => p,
        }
    }
}

/// A part of the way from `b` to `c`, from `a` on.
fn ahead(a: Homogeneous, b: Homogeneous, c: Homogeneous, parts: f64) -> Homogeneous {
    [0, 1, 2, 3].map(|k| a[k] + (c[k] - b[k]) / parts)
}

/// The ends are means of the inner points on either side; these are thirds of the way between control points.
fn b_spline([a, b, c, d]: [Homogeneous; 4]) -> [Homogeneous; 4] {
    const THIRD: f64 = 1.0 / 3.0;
    let inner = [towards(b, a, THIRD), towards(b, c, THIRD), towards(c, b, THIRD), towards(c, d, THIRD)];
    [towards(inner[0], inner[1], 0.5), inner[1], inner[2], towards(inner[2], inner[3], 0.5)]
}

/// Some segments of a curve in a row, as cubic Bézier segments; control points are counted round and round.
pub(crate) fn cubic_chain(
    basis: Basis,
    step: usize,
    segments: std::ops::Range<usize>,
    points: &[Homogeneous],
) -> Vec<Homogeneous> {
    joined(segments.map(|segment| basis.bezier(|k| points[(segment * step + k) % points.len()])))
}
