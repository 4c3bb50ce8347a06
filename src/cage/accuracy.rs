//! How far Gregory patches are from the limit surface, measured where it is cheap: in the middle of a face, where the limit is
//! known from the next level (Halstead, Kass & DeRose 1993).
//!
//! Around vertices with many edges, and corners that are not those of a B-spline, surfaces become smooth slowly: there the
//! levels that suffice elsewhere do not.

use glam::DVec3;
use rayon::prelude::*;

use super::eval::Evaluation;
use super::gregory;
use super::level::Level;
use super::masks::{edge_point, face_point, vertex_point};
use super::tags::{Fate, Kind, Rule};
use super::tangents::Tangents;

/// Levels that may be added because of the offset, and because of the normal.
const MORE_LEVELS: [u32; 2] = [5, 2];
/// Largest offset along the normal, over the diagonal of the cage's box, for each number of levels: what is reached
/// around vertices with 3 or 5 edges.
const OFFSETS: [f64; 4] = [5e-3, 1e-3, 2e-4, 1.5e-5];
/// How much smaller it is with each level more.
const FURTHER: f64 = 0.45;
/// Largest angle between normals, degrees, from 3 levels on.
const ANGLE: f64 = 1.0;
/// Where a crease ends patches are farther off beside it than in the middle: by so much less they may be off there.
const AT_DARTS: f64 = 0.25;
/// Vertices with more faces are not measured, since each of their faces would look at all the others.
const MOST_FACES: usize = 64;

/// What a patch may be off by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    levels: u32,
    offset: f64,
}

impl Tolerance {
    /// Of a cage with these vertices.
    pub(super) fn new(points: &[DVec3], levels: u32) -> Self {
        let low = points.iter().fold(DVec3::INFINITY, |low, &point| low.min(point));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |high, &point| high.max(point));
        let known = (levels as usize).min(OFFSETS.len() - 1);
        let further = libm::pow(FURTHER, f64::from(levels) - known as f64);
        Self { levels, offset: OFFSETS[known] * further * (high - low).length() }
    }

    /// Is anything to be measured at this level?
    pub(super) const fn matters(&self, depth: u32) -> bool {
        depth >= self.levels && depth < self.levels + MORE_LEVELS[0]
    }

    /// Refines those faces whose patches are farther off.
    pub(super) fn apply(
        &self,
        level: &Level,
        kinds: &[Kind],
        tangents: &Tangents,
        depth: u32,
        fates: &mut [Fate],
    ) {
        let angle = if self.levels >= 3 && depth < self.levels + MORE_LEVELS[1] { ANGLE } else { f64::INFINITY };
        fates.par_iter_mut().enumerate().filter(|(_, fate)| **fate == Fate::Irregular).for_each(|(face, fate)| {
            let is_measured = level.corners_of(face).all(|at| level.fan(level.vertex(at)).len() <= MOST_FACES);
            let is_near = is_measured && {
                let [offset, turned] = errors(level, kinds, tangents, face);
                let is_at_dart = level.corners_of(face).any(|at| kinds[level.vertex(at)].rule == Rule::Dart);
                offset <= self.offset * if is_at_dart { AT_DARTS } else { 1.0 } && turned <= angle
            };
            if !is_near {
                *fate = Fate::Refined;
            }
        });
    }
}

/// In the middle of a face: how far its patch is off along the normal, and how far its normal has turned, in degrees.
fn errors(level: &Level, kinds: &[Kind], tangents: &Tangents, face: usize) -> [f64; 2] {
    let patch = gregory::patch(level, kinds, tangents, face);
    let found = Evaluation::of_gregory(&patch, 0.5, 0.5);
    let (position, normal) = middle(level, face);
    let turned = found.normal.cross(normal).length().atan2(found.normal.dot(normal)).to_degrees();
    [(found.position - position).dot(normal).abs(), turned]
}

/// Limit position and normal in the middle of a quad.
fn middle(level: &Level, face: usize) -> (DVec3, DVec3) {
    let first = level.corners_of(face).start;
    let here = face_point(level, face);
    let edges = [0, 1, 2, 3].map(|at| edge_point(level, first + at, |face| face_point(level, face)));
    let corners = [0, 1, 2, 3].map(|at| vertex_point(level, level.vertex(first + at), |face| face_point(level, face)));
    let (edge_sum, corner_sum): (DVec3, DVec3) = (edges.iter().sum(), corners.iter().sum());
    let position = (here * 16.0 + edge_sum * 4.0 + corner_sum) / 36.0;
    let along_u = (edges[1] - edges[3]) * 4.0 + (corners[1] + corners[2]) - (corners[0] + corners[3]);
    let along_v = (edges[2] - edges[0]) * 4.0 + (corners[2] + corners[3]) - (corners[0] + corners[1]);
    (position, along_u.cross(along_v).normalize_or_zero())
}
