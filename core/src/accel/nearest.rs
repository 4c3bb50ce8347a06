//! What is nearest to a point.
//!
//! No triangle is nearer than its box, by definition, and rounding keeps order: a tree finds the same as looking at every
//! triangle. Distances are squared; what is nearer to 0 than 2⁻⁶³ is taken for 0, and what is farther away than 2²⁸ along an
//! axis for as far.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use super::ray::{between, offset};
use super::walk::Search;
use crate::abi::{Probe, Triangle};
use crate::num::{add3, clamp, cross3, dot3, flush, flush3, max, min, mul, neg, recip, rsqrt, scale3};

/// Differences of coordinates are no larger.
const FAR: f32 = (1 << 28) as f32;

/// The square of how far a point is from a box.
#[inline(always)]
#[must_use]
pub const fn to_box(point: [f32; 3], bounds: &Bounds) -> f32 {
    let d = [beside(point, bounds, 0), beside(point, bounds, 1), beside(point, bounds, 2)];
    dot3(d, d)
}

/// How far it is beside a box along one axis.
#[inline(always)]
const fn beside(point: [f32; 3], bounds: &Bounds, axis: usize) -> f32 {
    let (below, above) =
        (between(point[axis], bounds.low[axis], FAR), between(bounds.high[axis], point[axis], FAR));
    max(max(below, above), 0.0)
}

/// The square of how far a point is from a triangle.
#[inline(always)]
#[must_use]
pub fn to_triangle(point: [f32; 3], [a, b, c]: [[f32; 3]; 3]) -> f32 {
    let (a, b, c) = (offset(point, a, FAR), offset(point, b, FAR), offset(point, c, FAR));
    let (ab, bc, ca) = (offset(a, b, FAR), offset(b, c, FAR), offset(c, a, FAR));
    let normal = flush3(cross3(ab, bc));
    let size = flush(dot3(normal, normal));
    if size > 0.0 && is_inside(normal, a, ab) && is_inside(normal, b, bc) && is_inside(normal, c, ca) {
        let height = flush(mul(flush(dot3(normal, a)), rsqrt(size)));
        return mul(height, height);
    }
    min(min(to_line(a, ab), to_line(b, bc)), to_line(c, ca))
}

/// Is the origin on the inner side of an edge?
#[inline(always)]
const fn is_inside(normal: [f32; 3], start: [f32; 3], edge: [f32; 3]) -> bool {
    flush(dot3(flush3(cross3(normal, edge)), start)) <= 0.0
}

/// The square of how far the origin is from a line.
#[inline(always)]
const fn to_line(start: [f32; 3], edge: [f32; 3]) -> f32 {
    let square = flush(dot3(edge, edge));
    if square == 0.0 {
        return dot3(start, start);
    }
    let share = clamp(mul(neg(flush(dot3(start, edge))), recip(square)), 0.0, 1.0);
    let nearest = flush3(add3(start, scale3(edge, flush(share))));
    dot3(nearest, nearest)
}

/// A point among triangles.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    /// Where, and the square of how far to look.
    pub probe: Probe,
    /// The primitives.
    pub triangles: &'a [Triangle],
}

impl Search for Around<'_> {
    #[inline(always)]
    fn enter(&self, bounds: &Bounds) -> Option<f32> {
        let distance = to_box(self.probe.origin, bounds);
        (distance <= self.probe.far).then_some(distance)
    }

    #[inline(always)]
    fn test(&self, primitive: u32, bounds: &Bounds) -> Option<f32> {
        let own = to_triangle(self.probe.origin, self.triangles[primitive as usize].points());
        let distance = max(own, to_box(self.probe.origin, bounds));
        (distance <= self.probe.far).then_some(distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_to_the_nearest_of_many_points() {
        let triangle = [[1.0, 0.0, 0.5], [3.0, 0.5, 0.0], [1.5, 2.0, 1.0]];
        for point in [[2.0, 1.0, 3.0], [0.0, 0.0, 0.0], [2.0, -1.0, 0.0], [1.8, 0.7, 0.5], [4.0, 4.0, -1.0]] {
            let mut wanted = f32::INFINITY;
            for i in 0..=400_i16 {
                for j in 0..=400 - i {
                    let [u, v] = [i, j].map(|k| f32::from(k) / 400.0);
                    let at = |k: usize| {
                        triangle[0][k]
                            + u * (triangle[1][k] - triangle[0][k])
                            + v * (triangle[2][k] - triangle[0][k])
                    };
                    let d: f32 = (0..3).map(|k| (at(k) - point[k]) * (at(k) - point[k])).sum();
                    wanted = wanted.min(d);
                }
            }
            let found = to_triangle(point, triangle);
            assert!(found <= wanted + 1.0e-5 && found >= wanted - 2.0e-2, "{point:?}: {found} {wanted}");
        }
    }
}
