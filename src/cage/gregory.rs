//! Faces that are irregular still, as Gregory patches (Loop, Schaefer, Ni & Castaño 2009, section 4).

use glam::DVec3;

use super::level::Level;
use super::net::Edge;
use super::tags::Kind;
use super::tangents::{Beside, Tangents};
use crate::gregory::GregoryPatch;

/// Number of each corner in a Gregory patch, which counts them clockwise.
const CORNER: [usize; 4] = [0, 3, 2, 1];

/// A corner of a patch while its points are found.
#[derive(Clone, Copy)]
struct Corner {
    point: DVec3,
    beside: Beside,
}

/// The patch of a face all of whose vertices are settled.
pub(super) fn patch(level: &Level, kinds: &[Kind], tangents: &Tangents, face: usize) -> GregoryPatch {
    let first = level.corners_of(face).start;
    let corners: [Corner; 4] = std::array::from_fn(|at| Corner::of(level, kinds, tangents, first + at));
    let mut points = [[0.0; 3]; 20];
    for (at, corner) in corners.iter().enumerate() {
        let (after, before) = (&corners[(at + 1) & 3], &corners[(at + 3) & 3]);
        let to_next = Edge { half_edge: first + at, from_start: true };
        let to_previous = Edge { half_edge: first + ((at + 3) & 3), from_start: false };
        let (next, previous) = (corner.beside.next, corner.beside.previous);
        let place = CORNER[at];
        points[place] = level.limits[level.vertex(first + at)];
        points[4 + place] = previous.as_vec3().to_array();
        points[8 + place] = next.as_vec3().to_array();
        points[12 + place] =
            face_point(level, to_previous, corner, previous, before.beside.next, before).as_vec3().to_array();
        points[16 + place] =
            face_point(level, to_next, corner, next, after.beside.previous, after).as_vec3().to_array();
    }
    GregoryPatch { points }
}

impl Corner {
    fn of(level: &Level, kinds: &[Kind], tangents: &Tangents, corner: usize) -> Self {
        let vertex = level.vertex(corner);
        let point = DVec3::from(level.limits[vertex].map(f64::from));
        let known = if kinds[vertex].is_regular { None } else { tangents.at(corner) };
        let beside = known.unwrap_or_else(|| Beside {
            next: Edge { half_edge: corner, from_start: true }.regular_point(level),
            previous: Edge { half_edge: level.previous(corner), from_start: false }.regular_point(level),
            cosine: 0.0,
        });
        Self { point, beside }
    }
}

/// The face point beside a corner that belongs to one of its edges: `near` and `far` are the inner control points of the
/// edge's curve. On either side of the edge it is as far from the same plane.
fn face_point(level: &Level, edge: Edge, corner: &Corner, near: DVec3, far: DVec3, end: &Corner) -> DVec3 {
    let this_side = edge.this_side(level);
    match edge.other_side(level) {
        Some(other_side) if !level.is_crease(edge.half_edge) => {
            let turned =
                (far - near) * (2.0 * corner.beside.cosine) - (near - corner.point) * end.beside.cosine;
            near + turned / 3.0 + (this_side - other_side) / 18.0
        }
        _ => {
            let [start, end] = edge.ends(level);
            near + (this_side - (start * 2.0 + end)) / 9.0
        }
    }
}
