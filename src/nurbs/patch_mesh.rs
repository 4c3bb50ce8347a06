//! Patch meshes of RenderMan's interface: segments of a uniform basis in both directions.

use super::NurbsError;
use super::basis::{Basis, cubic_chain};
use super::net::{Homogeneous, Net};
use crate::shape::RationalPatch;

/// `PatchMesh`, and `Patch`, which is one that is not periodic and has points for one patch only.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchMesh {
    /// Bases along u and v; both [`Basis::Linear`] for bilinear ones.
    pub bases: [Basis; 2],
    /// Control points from one patch to the next along u and v; see [`Basis::step`].
    pub steps: [usize; 2],
    /// Control points along u and v.
    pub counts: [usize; 2],
    /// Do the last patches reach the first ones again, along u and v?
    pub is_periodic: [bool; 2],
    /// Homogeneous control points as in `"Pw"`: x·w, y·w, z·w, w; u runs fastest.
    pub points: Vec<[f64; 4]>,
}

impl PatchMesh {
    /// A mesh of points without weights, as in `"P"`, with the steps that its bases have by nature.
    #[must_use]
    pub fn with_positions(
        bases: [Basis; 2],
        counts: [usize; 2],
        is_periodic: [bool; 2],
        positions: &[[f64; 3]],
    ) -> Self {
        let columns = counts[0].max(1);
        let is_derivative = |k: usize, index: usize| bases[k] == Basis::Hermite && index % 2 == 1;
        let points = positions.iter().enumerate().map(|(index, &[x, y, z])| {
            // Derivatives of a weight that is always 1.
            let moves = is_derivative(0, index % columns) || is_derivative(1, index / columns);
            [x, y, z, if moves { 0.0 } else { 1.0 }]
        });
        Self { bases, steps: bases.map(Basis::step), counts, is_periodic, points: points.collect() }
    }

    /// Its patches, u slower than v.
    ///
    /// # Errors
    /// [`NurbsError`], if the control points do not make whole patches, or some cannot be drawn.
    pub fn patches(&self) -> Result<Vec<RationalPatch>, NurbsError> {
        let [columns, rows] = self.counts;
        let segments = [self.segments('u', 0)?, self.segments('v', 1)?];
        if columns.checked_mul(rows) != Some(self.points.len()) {
            return Err(NurbsError::Count { counts: self.counts, found: self.points.len() });
        }
        let net = Net { counts: [rows, columns], points: self.points.clone() }.transposed();
        if self.steps == self.bases.map(Basis::step) {
            return self.bezier(&net, [0..segments[0], 0..segments[1]]).patches();
        }
        // With other steps patches do not touch, or overlap.
        let each = (0..segments[0]).flat_map(|i| (0..segments[1]).map(move |j| [i..i + 1, j..j + 1]));
        let patches: Result<Vec<_>, _> = each.map(|part| self.bezier(&net, part).patches()).collect();
        Ok(patches?.concat())
    }

    fn segments(&self, direction: char, k: usize) -> Result<usize, NurbsError> {
        let (basis, count, step) = (self.bases[k], self.counts[k], self.steps[k]);
        let wrong = NurbsError::Segments { direction, count, window: basis.window(), step };
        basis.segments(count, step, self.is_periodic[k]).ok_or(wrong)
    }

    fn bezier(&self, net: &Net, [u, v]: [std::ops::Range<usize>; 2]) -> Net {
        let along = |k: usize, part: std::ops::Range<usize>| {
            move |points: &[Homogeneous]| cubic_chain(self.bases[k], self.steps[k], part.clone(), points)
        };
        net.converted(along(0, u), along(1, v))
    }
}
