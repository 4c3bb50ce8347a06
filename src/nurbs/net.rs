//! Nets of control points: many bicubic patches beside each other, whose neighbours have their border's points in common.

use super::NurbsError;
use super::weld::weld;
use crate::shape::RationalPatch;

/// A point times its weight, and the weight: x·w, y·w, z·w, w.
pub(crate) type Homogeneous = [f64; 4];

/// Weights that devices can work with in f32 lie between this and its reciprocal.
const LEAST_WEIGHT: f64 = 1.0e-12;

/// Control points, row after row; a row runs along v.
#[derive(Clone, Debug)]
pub(crate) struct Net {
    /// Points along u, and along v.
    pub(crate) counts: [usize; 2],
    /// Index i · `counts[1]` + j, `i` along u.
    pub(crate) points: Vec<Homogeneous>,
}

impl Net {
    /// Rows become columns.
    pub(crate) fn transposed(&self) -> Self {
        let [rows, columns] = self.counts;
        let points = (0..rows * columns).map(|k| self.points[k % rows * columns + k / rows]).collect();
        Self { counts: [columns, rows], points }
    }

    /// Makes other curves of all rows.
    pub(crate) fn with_rows(&self, convert: impl Fn(&[Homogeneous]) -> Vec<Homogeneous>) -> Self {
        let rows = self.counts[0];
        let points: Vec<_> = self.points.chunks_exact(self.counts[1].max(1)).flat_map(convert).collect();
        Self { counts: [rows, points.len() / rows.max(1)], points }
    }

    /// Makes other curves of all columns, then of all rows of what that gives.
    pub(crate) fn converted(
        &self,
        along_u: impl Fn(&[Homogeneous]) -> Vec<Homogeneous>,
        along_v: impl Fn(&[Homogeneous]) -> Vec<Homogeneous>,
    ) -> Self {
        self.transposed().with_rows(along_u).transposed().with_rows(along_v)
    }

    /// The patches of a net of bicubics; closed where its sides meet, and a side that is a point is one in all bits.
    pub(crate) fn patches(self) -> Result<Vec<RationalPatch>, NurbsError> {
        self.finished()?.cut()
    }

    /// Points no longer multiplied by their weights, and welded.
    pub(super) fn finished(mut self) -> Result<Self, NurbsError> {
        for point in &mut self.points {
            let weight = point[3];
            // This way round NaN is refused too.
            if !(LEAST_WEIGHT..=1.0 / LEAST_WEIGHT).contains(&weight) {
                return Err(NurbsError::Weight { weight });
            }
            *point = [point[0] / weight, point[1] / weight, point[2] / weight, weight];
        }
        weld(&mut self);
        Ok(self)
    }

    fn cut(&self) -> Result<Vec<RationalPatch>, NurbsError> {
        let [rows, columns] = self.counts.map(|count| count.saturating_sub(1) / 3);
        (0..rows * columns).map(|k| self.patch(k / columns, k % columns)).collect()
    }

    fn patch(&self, row: usize, column: usize) -> Result<RationalPatch, NurbsError> {
        let mut patch = RationalPatch { points: [[0.0; 3]; 16], weights: [1.0; 16] };
        for k in 0..16 {
            let point = self.points[(3 * row + k / 4) * self.counts[1] + 3 * column + k % 4];
            patch.points[k] = rounded([point[0], point[1], point[2]])?;
            patch.weights[k] = point[3] as f32;
        }
        Ok(patch)
    }
}

/// A point as devices have it, in which no zero is negative.
fn rounded(point: [f64; 3]) -> Result<[f32; 3], NurbsError> {
    let near = point.map(|coordinate| coordinate as f32 + 0.0);
    if near.iter().all(|coordinate| coordinate.is_finite()) {
        Ok(near)
    } else {
        Err(NurbsError::Point { point })
    }
}
