//! A cage at one level of refinement: who is next to whom, in flat arrays.
//!
//! A corner of a face stands for two things: the vertex there, and the half-edge from there to the next corner.

use glam::DVec3;

use super::INFINITELY_SHARP;
use super::origin::Origin;

/// Where an index would be, if there were something.
pub(super) const NONE: u32 = u32::MAX;

/// Faces and vertices of one level.
#[derive(Debug, Default)]
pub(super) struct Level {
    /// Positions of vertices.
    pub(super) points: Vec<DVec3>,
    /// The vertex at each corner, face after face, counter-clockwise.
    pub(super) corners: Vec<u32>,
    /// First corner of each face, and the end of the last; empty if all faces have four.
    pub(super) starts: Vec<u32>,
    /// Face of each corner; empty if all faces have four.
    pub(super) faces: Vec<u32>,
    /// The half-edge that runs against each one, or `NONE` on a boundary.
    pub(super) twins: Vec<u32>,
    /// Where the corners of each vertex begin in `fans`, and the end of the last one's.
    pub(super) fan_starts: Vec<u32>,
    /// Corners at vertices, in order of their indices.
    pub(super) fans: Vec<u32>,
    /// How sharp half-edges are; empty if none is. Boundaries are sharp without being listed.
    pub(super) sharp_edges: Vec<f32>,
    /// How sharp vertices are; empty if none is.
    pub(super) sharp_vertices: Vec<f32>,
    /// Where faces lie on the cage; those without an origin are not drawn, and only shape the others.
    pub(super) origins: Vec<Option<Origin>>,
    /// Limit positions, rounded, of vertices that have been found already; NaN of the others.
    pub(super) limits: Vec<[f32; 3]>,
}

impl Level {
    pub(super) fn face_count(&self) -> usize {
        if self.starts.is_empty() { self.corners.len() / 4 } else { self.starts.len() - 1 }
    }

    /// The corners of a face.
    pub(super) fn corners_of(&self, face: usize) -> std::ops::Range<usize> {
        if self.starts.is_empty() {
            4 * face..4 * face + 4
        } else {
            self.starts[face] as usize..self.starts[face + 1] as usize
        }
    }

    pub(super) fn face_of(&self, corner: usize) -> usize {
        if self.faces.is_empty() { corner / 4 } else { self.faces[corner] as usize }
    }

    /// The next corner of the same face.
    pub(super) fn next(&self, corner: usize) -> usize {
        if self.starts.is_empty() {
            return corner & !3 | (corner + 1) & 3;
        }
        let range = self.corners_of(self.face_of(corner));
        if corner + 1 == range.end { range.start } else { corner + 1 }
    }

    /// The corner before this one.
    pub(super) fn previous(&self, corner: usize) -> usize {
        if self.starts.is_empty() {
            return corner & !3 | (corner + 3) & 3;
        }
        let range = self.corners_of(self.face_of(corner));
        if corner == range.start { range.end - 1 } else { corner - 1 }
    }

    /// The half-edge against this one, unless this is a boundary.
    pub(super) fn twin(&self, half_edge: usize) -> Option<usize> {
        let twin = self.twins[half_edge];
        (twin != NONE).then_some(twin as usize)
    }

    /// Of the two half-edges of an edge the one that stands for it.
    pub(super) fn edge(&self, half_edge: usize) -> usize {
        half_edge.min(self.twins[half_edge] as usize)
    }

    /// The vertex at a corner: where the half-edge starts.
    pub(super) fn vertex(&self, corner: usize) -> usize {
        self.corners[corner] as usize
    }

    /// The vertex at which a half-edge ends.
    pub(super) fn end(&self, half_edge: usize) -> usize {
        self.vertex(self.next(half_edge))
    }

    /// Position of the vertex at a corner.
    pub(super) fn point(&self, corner: usize) -> DVec3 {
        self.points[self.vertex(corner)]
    }

    /// Corners at a vertex, in no order.
    pub(super) fn fan(&self, vertex: usize) -> &[u32] {
        &self.fans[self.fan_starts[vertex] as usize..self.fan_starts[vertex + 1] as usize]
    }

    /// The next corner counter-clockwise around the same vertex.
    pub(super) fn counter_clockwise(&self, corner: usize) -> Option<usize> {
        self.twin(self.previous(corner))
    }

    /// The next corner clockwise around the same vertex.
    pub(super) fn clockwise(&self, corner: usize) -> Option<usize> {
        self.twin(corner).map(|twin| self.next(twin))
    }

    /// How sharp an edge is.
    pub(super) fn edge_sharpness(&self, half_edge: usize) -> f32 {
        if self.twins[half_edge] == NONE {
            INFINITELY_SHARP
        } else if self.sharp_edges.is_empty() {
            0.0
        } else {
            self.sharp_edges[half_edge]
        }
    }

    /// Is an edge sharp for ever?
    pub(super) fn is_crease(&self, half_edge: usize) -> bool {
        self.edge_sharpness(half_edge) >= INFINITELY_SHARP
    }

    /// How sharp a vertex is, its edges aside.
    pub(super) fn vertex_sharpness(&self, vertex: usize) -> f32 {
        self.sharp_vertices.get(vertex).copied().unwrap_or(0.0)
    }

    /// Is nothing sharp at a vertex? Tells so of most; never of one where something is.
    pub(super) fn is_plain(&self, vertex: usize) -> bool {
        let has_twin = |&corner: &u32| self.twins[corner as usize] != NONE;
        self.sharp_edges.is_empty()
            && self.vertex_sharpness(vertex) == 0.0
            && self.fan(vertex).iter().all(has_twin)
    }

    /// Has a face four corners?
    pub(super) fn is_quad(&self, face: usize) -> bool {
        self.corners_of(face).len() == 4
    }

    /// The edges at a vertex, each once: a half-edge, and whether it starts at the vertex.
    pub(super) fn edges_at(&self, vertex: usize) -> impl Iterator<Item = (usize, bool)> {
        self.fan(vertex).iter().flat_map(|&corner| {
            let (corner, before) = (corner as usize, self.previous(corner as usize));
            let boundary = (self.twins[before] == NONE).then_some((before, false));
            std::iter::once((corner, true)).chain(boundary)
        })
    }
}

/// What is left of a sharpness one level later.
pub(super) fn decayed(sharpness: f32) -> f32 {
    if sharpness >= INFINITELY_SHARP { sharpness } else { (sharpness - 1.0).max(0.0) }
}
