//! Where the points of a quad's net stand, and the curves of its edges.
//!
//! A quad's corners run counter-clockwise from (0, 0): to (1, 0), (1, 1) and (0, 1). A net has index 4·i + j with i along
//! u, as a Bézier patch has.

use glam::DVec3;

use super::level::Level;

/// Index of each corner in a net.
pub(super) const CORNER: [usize; 4] = [0, 12, 15, 3];
/// Index of the point beside each corner, along the edge to the next one.
pub(super) const TO_NEXT: [usize; 4] = [4, 13, 11, 2];
/// Index of the point beside each corner, along the edge to the one before.
pub(super) const TO_PREVIOUS: [usize; 4] = [1, 8, 14, 7];
/// Index of the inner point at each corner.
pub(super) const INNER: [usize; 4] = [5, 9, 10, 6];
/// Number of the side that begins at each corner, as [`micropoly_core::border`] counts them.
pub(super) const SIDE: [u8; 4] = [0, 3, 1, 2];
/// Number of each corner, as [`micropoly_core::border`] counts them.
pub(super) const BORDER_CORNER: [u8; 4] = [0, 1, 3, 2];

/// Does the parameter along the side that begins at a corner run from there, not against it?
pub(super) const fn runs_along(corner: usize) -> bool {
    corner < 2
}

/// An edge as seen from one of its ends.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    /// A half-edge of it, on the side that counts as this one.
    pub(super) half_edge: usize,
    /// Is the end from which it is seen the start of that half-edge?
    pub(super) from_start: bool,
}

impl Edge {
    /// The point from which it is seen, and the other end.
    pub(super) fn ends(self, level: &Level) -> [DVec3; 2] {
        let ends = [level.point(self.half_edge), level.points[level.end(self.half_edge)]];
        if self.from_start { ends } else { [ends[1], ends[0]] }
    }

    /// The neighbour of the near end on this side, twice, and that of the far end.
    pub(super) fn this_side(self, level: &Level) -> DVec3 {
        beside(level, self.half_edge, self.from_start)
    }

    /// The same on the other side.
    pub(super) fn other_side(self, level: &Level) -> Option<DVec3> {
        level.twin(self.half_edge).map(|twin| beside(level, twin, !self.from_start))
    }

    /// The control point beside the near end, if that is regular: a third of the way to the next knot of the B-spline. Both
    /// sides add the same numbers in the same order.
    pub(super) fn regular_point(self, level: &Level) -> DVec3 {
        let [near, far] = self.ends(level);
        match self.other_side(level) {
            Some(other) if !level.is_crease(self.half_edge) => {
                ((near * 8.0 + far * 4.0) + (self.this_side(level) + other)) / 18.0
            }
            _ => (near * 2.0 + far) / 3.0,
        }
    }
}

fn beside(level: &Level, half_edge: usize, from_start: bool) -> DVec3 {
    let (at_start, at_end) = (level.previous(half_edge), level.next(level.next(half_edge)));
    let (near, far) = if from_start { (at_start, at_end) } else { (at_end, at_start) };
    level.point(near) * 2.0 + level.point(far)
}
