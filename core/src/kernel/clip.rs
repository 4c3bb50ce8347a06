//! Clipping at the near plane and the guard band, for the few micropolygons that cannot be snapped as they
//! are (Sutherland & Hodgman 1974).
//!
//! Every cut is computed from the inner to the outer end of an edge, so two polygons that share an edge cut
//! it at the same bits.

use crate::abi::{Frame, GUARD_BAND};
use crate::num::{add, mul, neg, recip, sub};

/// A triangle clipped by five planes has at most this many corners.
pub const MAX_CORNERS: usize = 8;

/// A convex polygon in eye space.
#[derive(Clone, Copy, Debug, Default)]
pub struct Polygon {
    /// Corners; the first `count` are in use.
    pub corners: [[f32; 3]; MAX_CORNERS],
    /// Number of corners; fewer than 3: nothing is left.
    pub count: usize,
}

impl Polygon {
    fn push(&mut self, corner: [f32; 3]) {
        if self.count < MAX_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

/// The planes, in the order in which they cut.
#[derive(Clone, Copy)]
enum Plane {
    Near,
    Left,
    Right,
    Bottom,
    Top,
}

impl Plane {
    const ALL: [Self; 5] = [Self::Near, Self::Left, Self::Right, Self::Bottom, Self::Top];

    /// How far inside a point is; negative outside.
    fn inside(self, frame: &Frame, p: [f32; 3]) -> f32 {
        let edge = mul(neg(p[2]), GUARD_BAND);
        match self {
            Self::Near => sub(neg(p[2]), frame.near),
            Self::Left => add(edge, mul(p[0], frame.focal)),
            Self::Right => sub(edge, mul(p[0], frame.focal)),
            Self::Bottom => add(edge, mul(p[1], frame.focal)),
            Self::Top => sub(edge, mul(p[1], frame.focal)),
        }
    }

    /// Where the edge from an inner to an outer point meets the plane.
    fn cut(self, frame: &Frame, inner: [f32; 3], outer: [f32; 3]) -> [f32; 3] {
        let from = self.inside(frame, inner);
        let share = mul(from, recip(sub(from, self.inside(frame, outer))));
        let mut point = [0, 1, 2].map(|k| add(inner[k], mul(share, sub(outer[k], inner[k]))));
        if matches!(self, Self::Near) {
            point[2] = neg(frame.near);
        }
        point
    }
}

/// What of a triangle lies before the near plane and within the guard band.
#[must_use]
pub fn clip(frame: &Frame, triangle: [[f32; 3]; 3]) -> Polygon {
    let mut polygon = Polygon::default();
    for corner in triangle {
        polygon.push(corner);
    }
    Plane::ALL.into_iter().fold(polygon, |polygon, plane| clip_by(frame, plane, &polygon))
}

fn clip_by(frame: &Frame, plane: Plane, polygon: &Polygon) -> Polygon {
    let mut out = Polygon::default();
    for index in 0..polygon.count {
        let here = polygon.corners[index];
        let next = polygon.corners[(index + 1) % polygon.count];
        let here_in = plane.inside(frame, here) >= 0.0;
        let next_in = plane.inside(frame, next) >= 0.0;
        if here_in {
            out.push(here);
        }
        if here_in && !next_in {
            out.push(plane.cut(frame, here, next));
        } else if next_in && !here_in {
            out.push(plane.cut(frame, next, here));
        }
    }
    out
}
