//! The faces at a vertex in their order, from crease to crease.

use glam::DVec3;

use super::level::Level;

/// Faces at a vertex, counter-clockwise, between two creases or all around.
pub(super) struct Sector {
    /// The vertex's corners in them.
    pub(super) corners: Vec<usize>,
    /// Vertices at the ends of the edges, less the vertex itself: one more than there are faces. All around the last is the
    /// first.
    pub(super) ends: Vec<DVec3>,
    /// Vertices opposite in the faces, less the vertex itself.
    pub(super) opposite: Vec<DVec3>,
    /// Is there no crease?
    pub(super) is_closed: bool,
}

impl Sector {
    /// All sectors of a vertex.
    pub(super) fn all(level: &Level, vertex: usize) -> Vec<Self> {
        let fan = level.fan(vertex);
        let starts: Vec<usize> =
            fan.iter().map(|&corner| corner as usize).filter(|&corner| level.is_crease(corner)).collect();
        match (starts.is_empty(), fan.first()) {
            (true, Some(&first)) => vec![Self::from(level, first as usize)],
            _ => starts.into_iter().map(|start| Self::from(level, start)).collect(),
        }
    }

    fn from(level: &Level, first: usize) -> Self {
        let mut corners = vec![first];
        let mut last = first;
        while !level.is_crease(level.previous(last)) {
            match level.counter_clockwise(last) {
                Some(next) if next != first => last = next,
                _ => break,
            }
            corners.push(last);
        }
        let here = level.point(first);
        let mut ends: Vec<DVec3> =
            corners.iter().map(|&corner| level.points[level.end(corner)] - here).collect();
        ends.push(level.point(level.previous(last)) - here);
        let opposite =
            corners.iter().map(|&corner| level.points[level.end(level.next(corner))] - here).collect();
        Self { corners, ends, opposite, is_closed: !level.is_crease(first) }
    }

    /// How many faces there are.
    pub(super) fn count(&self) -> usize {
        self.corners.len()
    }
}
