//! Faces whose surface is a bicubic B-spline, as Bézier patches.

use super::level::Level;
use super::net::{CORNER, Edge, INNER, TO_NEXT, TO_PREVIOUS};
use crate::shape::BezierPatch;

/// The patch of a face all of whose vertices are regular.
pub(super) fn patch(level: &Level, face: usize) -> BezierPatch {
    let mut points = [[0.0; 3]; 16];
    let first = level.corners_of(face).start;
    for at in 0..4 {
        let corner = first + at;
        let before = level.previous(corner);
        let to_next = Edge { half_edge: corner, from_start: true };
        let to_previous = Edge { half_edge: before, from_start: false };
        let inner =
            (level.point(corner) * 4.0 + to_next.this_side(level) + level.points[level.end(corner)] * 2.0)
                / 9.0;
        points[CORNER[at]] = level.limits[level.vertex(corner)];
        points[TO_NEXT[at]] = to_next.regular_point(level).as_vec3().to_array();
        points[TO_PREVIOUS[at]] = to_previous.regular_point(level).as_vec3().to_array();
        points[INNER[at]] = inner.as_vec3().to_array();
    }
    BezierPatch { points }
}
