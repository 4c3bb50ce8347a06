//! Spline surfaces: NURBS, piecewise Bézier surfaces and patch meshes as rational bicubic patches.
//!
//! Surfaces become nets of Bézier points in f64, first along u, then along v, and are rounded to f32 at the end only.
//! Neighbours have the points of their common border from one place in the net, so these are the same bits.

mod basis;
mod curves;
mod knots;
mod net;
mod patch_mesh;
#[cfg(test)]
mod tests;
mod weld;

pub use self::basis::Basis;
pub(crate) use self::basis::cubic_chain;
pub(crate) use self::curves::{joined, raised};
use self::knots::Knots;
pub(crate) use self::net::{Homogeneous, Net};
pub use self::patch_mesh::PatchMesh;
use crate::shape::RationalPatch;

/// A non-uniform rational B-spline surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Nurbs {
    /// Degrees along u and v: 1 to 3.
    pub degree: [usize; 2],
    /// Knots along u and v, ascending: as many as control points in that direction, and degree + 1 more. They need
    /// not be clamped.
    pub knots: [Vec<f64>; 2],
    /// Control points and weights, x, y, z, w, not multiplied; index i · (number along v) + j, `i` along u.
    pub points: Vec<[f64; 4]>,
    /// The parameters to be drawn, from and to, along u and v.
    pub range: [[f64; 2]; 2],
}

/// Why a spline surface cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NurbsError {
    /// A degree is too low or too high.
    #[error("the {direction} degree is {degree}; only 1 to 3 can be drawn")]
    Degree {
        /// `'u'` or `'v'`.
        direction: char,
        /// The degree.
        degree: usize,
    },
    /// Too few knots.
    #[error("{found} knots along {direction}; a surface of degree {degree} has {needed} or more")]
    KnotCount {
        /// `'u'` or `'v'`.
        direction: char,
        /// The degree.
        degree: usize,
        /// The fewest possible.
        needed: usize,
        /// How many there are.
        found: usize,
    },
    /// A knot is not a number, or far too large.
    #[error("knot {index} along {direction} (counted from 0) is not a finite number of reasonable size")]
    KnotValue {
        /// `'u'` or `'v'`.
        direction: char,
        /// Which knot.
        index: usize,
    },
    /// A knot is smaller than the one before.
    #[error("knot {index} along {direction} (counted from 0) is smaller than the one before")]
    KnotOrder {
        /// `'u'` or `'v'`.
        direction: char,
        /// Which knot.
        index: usize,
    },
    /// A knot is repeated so often that the surface is torn there.
    #[error("knot {knot} along {direction} is there {found} times; {most} is the most for this degree")]
    Multiplicity {
        /// `'u'` or `'v'`.
        direction: char,
        /// The knot.
        knot: f64,
        /// How often it is there.
        found: usize,
        /// How often it may be there.
        most: usize,
    },
    /// The number of control points is not that of the net.
    #[error("{found} control points where there should be {} × {}", counts[0], counts[1])]
    Count {
        /// How many there should be, along u and v.
        counts: [usize; 2],
        /// How many there are.
        found: usize,
    },
    /// Segments need another number of control points.
    #[error(
        "{count} control points along {direction} do not make whole segments of {window} that start every {step}"
    )]
    Segments {
        /// `'u'` or `'v'`.
        direction: char,
        /// Points along it.
        count: usize,
        /// Points of a segment.
        window: usize,
        /// Points from one segment's first to the next one's.
        step: usize,
    },
    /// A weight that no surface can have.
    #[error("a weight is {weight}; it must be above 0, from 1e-12 to 1e12")]
    Weight {
        /// The weight.
        weight: f64,
    },
    /// A control point that is not finite, or too far away.
    #[error("a control point is at {}, {}, {}; single precision has no such numbers", point[0], point[1], point[2])]
    Point {
        /// The point.
        point: [f64; 3],
    },
    /// There is nothing between the parameters.
    #[error("nothing is to be drawn along {direction}: from {start} to {end}")]
    EmptyRange {
        /// `'u'` or `'v'`.
        direction: char,
        /// The lowest parameter.
        start: f64,
        /// The highest.
        end: f64,
    },
    /// The surface does not reach that far.
    #[error(
        "along {direction} {start} to {end} is to be drawn, but the surface is there from {low} to {high} only"
    )]
    OutsideRange {
        /// `'u'` or `'v'`.
        direction: char,
        /// The lowest parameter wanted.
        start: f64,
        /// The highest wanted.
        end: f64,
        /// The lowest there is.
        low: f64,
        /// The highest there is.
        high: f64,
    },
}

impl Nurbs {
    /// Its patches, u slower than v.
    ///
    /// # Errors
    /// [`NurbsError`], if there is no such surface or it cannot be drawn.
    pub fn patches(&self) -> Result<Vec<RationalPatch>, NurbsError> {
        self.net()?.patches()
    }

    /// Do its weights differ? Otherwise its patches are polynomial, and their weights say nothing.
    #[must_use]
    pub fn is_rational(&self) -> bool {
        self.points.windows(2).any(|pair| pair[0][3] != pair[1][3])
    }

    fn net(&self) -> Result<Net, NurbsError> {
        let [u, v] = [self.along('u', 0), self.along('v', 1)];
        u.check()?;
        v.check()?;
        let net = multiplied([u.point_count(), v.point_count()], &self.points)?;
        Ok(net.converted(|column| u.chain(column), |row| v.chain(row)))
    }

    fn along(&self, direction: char, k: usize) -> Knots<'_> {
        Knots { direction, degree: self.degree[k], values: &self.knots[k], range: self.range[k] }
    }
}

/// The patches of a piecewise Bézier surface: `counts` control points along u and v, each a multiple of the degree and
/// one more; points and their order are as in [`Nurbs::points`].
///
/// # Errors
/// [`NurbsError`], if there is no such surface or it cannot be drawn.
pub fn bezier_net(
    degree: [usize; 2],
    counts: [usize; 2],
    points: &[[f64; 4]],
) -> Result<Vec<RationalPatch>, NurbsError> {
    for (k, direction) in ['u', 'v'].into_iter().enumerate() {
        let (degree, count) = (degree[k], counts[k]);
        if !(1..=3).contains(&degree) {
            return Err(NurbsError::Degree { direction, degree });
        }
        if count <= degree || count % degree != 1 % degree {
            return Err(NurbsError::Segments { direction, count, window: degree + 1, step: degree });
        }
    }
    let raise = |k: usize| move |points: &[Homogeneous]| curves::raised_chain(degree[k], points);
    multiplied(counts, points)?.converted(raise(0), raise(1)).patches()
}

/// Control points with weights as a net of homogeneous ones.
fn multiplied(counts: [usize; 2], points: &[[f64; 4]]) -> Result<Net, NurbsError> {
    if counts[0].checked_mul(counts[1]) != Some(points.len()) {
        return Err(NurbsError::Count { counts, found: points.len() });
    }
    let points = points.iter().map(|&[x, y, z, w]| {
        let is_weight = w > 0.0 && w.is_finite();
        if is_weight { Ok([x * w, y * w, z * w, w]) } else { Err(NurbsError::Weight { weight: w }) }
    });
    Ok(Net { counts, points: points.collect::<Result<_, _>>()? })
}
