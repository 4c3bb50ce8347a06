//! How far Gregory patches are from the limit surface, measured where it is cheap: in the middle of a face, where the limit is
//! known from the next level (Halstead, Kass & DeRose 1993).
//!
//! Around vertices with many edges, and corners that are not those of a B-spline, surfaces become smooth slowly: there the
//! levels that suffice elsewhere do not. Where a cage is fine, fewer suffice.

use glam::DVec3;
use rayon::prelude::*;

use super::eval::Evaluation;
use super::level::Level;
use super::masks::{edge_point, face_point, vertex_point};
use super::tags::{Fate, Kind, Rule};
use crate::gregory::GregoryPatch;

/// Levels that may be added because of the offset, and because of the normal.
const MORE_LEVELS: [u32; 2] = [5, 2];
/// Largest offset along the normal, over the diagonal of the cage's box, for each number of levels: what is reached
/// around vertices with 3 or 5 edges.
const OFFSETS: [f64; 4] = [5e-3, 1e-3, 2e-4, 1.5e-5];
/// How much smaller it is with each level more.
const FURTHER: f64 = 0.45;
/// Largest angle between normals, degrees, from 3 levels on.
const ANGLE: f64 = 1.0;
/// By so much less patches may be off that need fewer levels.
const EARLY: f64 = 0.25;
/// Where a crease ends patches are farther off beside it than in the middle: by so much less they may be off there.
const AT_DARTS: f64 = 0.25;

/// What patches may be off by, for a number of levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerances {
    levels: u32,
    offset: f64,
}

/// What they may be off by at one level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// Along the normal.
    offset: f64,
    /// Between normals, degrees.
    angle: f64,
}

impl Tolerances {
    /// Of a cage with these vertices.
    pub(super) fn new(points: &[DVec3], levels: u32) -> Self {
        let low = points.iter().fold(DVec3::INFINITY, |low, &point| low.min(point));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |high, &point| high.max(point));
        let known = (levels as usize).min(OFFSETS.len() - 1);
        let further = libm::pow(FURTHER, f64::from(levels) - known as f64);
        Self { levels, offset: OFFSETS[known] * further * (high - low).length() }
    }

    /// At a level, if anything is to be measured there.
    pub(super) fn at(&self, depth: u32) -> Option<Tolerance> {
        let Some(more) = depth.checked_sub(self.levels) else {
            return Some(Tolerance { offset: self.offset * EARLY, angle: ANGLE * EARLY });
        };
        let angle = if self.levels >= 3 && more < MORE_LEVELS[1] { ANGLE } else { f64::INFINITY };
        (more < MORE_LEVELS[0]).then_some(Tolerance { offset: self.offset, angle })
    }
}

impl Tolerance {
    /// Refines those faces whose patches, listed beside them, are farther off.
    pub(super) fn apply(
        &self,
        level: &Level,
        kinds: &[Kind],
        (faces, patches): (&[u32], &[GregoryPatch]),
        fates: &mut [Fate],
    ) {
        if faces.is_empty() {
            return;
        }
        let next = Next::of(level, faces);
        let is_off = |(&face, patch): (&u32, &GregoryPatch)| {
            let mut corners = level.corners_of(face as usize);
            let is_at_dart = corners.any(|at| kinds[level.vertex(at)].rule == Rule::Dart);
            let most = self.offset * if is_at_dart { AT_DARTS } else { 1.0 };
            let [offset, turned] = next.errors(level, patch, face as usize);
            offset > most || turned > self.angle
        };
        let off: Vec<u32> =
            faces.par_iter().zip(patches).filter(|&pair| is_off(pair)).map(|(&face, _)| face).collect();
        off.into_iter().for_each(|face| fates[face as usize] = Fate::Refined);
    }
}

/// Vertices that some faces would have on the next level.
struct Next {
    /// In the middle of each face.
    middles: Vec<DVec3>,
    /// At each vertex; of no meaning at others than theirs.
    vertices: Vec<DVec3>,
}

impl Next {
    fn of(level: &Level, faces: &[u32]) -> Self {
        let middles: Vec<DVec3> =
            (0..level.face_count()).into_par_iter().map(|face| face_point(level, face)).collect();
        let mut needed = vec![false; level.points.len()];
        for &vertex in faces.iter().flat_map(|&face| &level.corners[level.corners_of(face as usize)]) {
            needed[vertex as usize] = true;
        }
        let moved = |(vertex, is_needed)| match is_needed {
            true => vertex_point(level, vertex, |face| middles[face]),
            false => DVec3::ZERO,
        };
        let vertices = needed.into_par_iter().enumerate().map(moved).collect();
        Self { middles, vertices }
    }

    /// In the middle of a face: how far its patch is off along the normal, and how far its normal has turned, in degrees.
    fn errors(&self, level: &Level, patch: &GregoryPatch, face: usize) -> [f64; 2] {
        let found = Evaluation::of_gregory(patch, 0.5, 0.5);
        let (position, normal) = self.middle(level, face);
        let turned = found.normal.cross(normal).length().atan2(found.normal.dot(normal)).to_degrees();
        [(found.position - position).dot(normal).abs(), turned]
    }

    /// Limit position and normal in the middle of a quad, which will be a regular vertex.
    fn middle(&self, level: &Level, face: usize) -> (DVec3, DVec3) {
        let first = level.corners_of(face).start;
        let edges = [0, 1, 2, 3].map(|at| edge_point(level, first + at, |face| self.middles[face]));
        let corners = [0, 1, 2, 3].map(|at| self.vertices[level.vertex(first + at)]);
        let (edge_sum, corner_sum): (DVec3, DVec3) = (edges.iter().sum(), corners.iter().sum());
        let position = (self.middles[face] * 16.0 + edge_sum * 4.0 + corner_sum) / 36.0;
        let along_u = (edges[1] - edges[3]) * 4.0 + (corners[1] + corners[2]) - (corners[0] + corners[3]);
        let along_v = (edges[2] - edges[0]) * 4.0 + (corners[2] + corners[3]) - (corners[0] + corners[1]);
        (position, along_u.cross(along_v).normalize_or_zero())
    }
}
