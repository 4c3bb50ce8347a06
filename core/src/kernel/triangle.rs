//! Coverage by integer edge functions with the top-left rule (Pineda 1988), depth by exact weights.
//!
//! Two triangles that share an edge share its snapped vertices; every sample on or beside the edge belongs
//! to exactly one of them.

use crate::abi::{SUBPIXEL_BITS, SUBPIXELS};
use crate::kernel::project::Vertex;
use crate::num::{add, clamp, float, max, min, mul, recip, sub};

/// The line from one vertex to the next: positive on the triangle's side.
#[derive(Clone, Copy, Debug)]
struct Edge {
    x: i64,
    y: i64,
    dx: i64,
    dy: i64,
}

impl Edge {
    #[inline(always)]
    fn new(from: Vertex, to: Vertex) -> Self {
        let (x, y) = (i64::from(from.x), i64::from(from.y));
        Self { x, y, dx: i64::from(to.x) - x, dy: i64::from(to.y) - y }
    }

    /// Twice the area between the edge and a point, 1/65536 pixels².
    #[inline(always)]
    fn at(&self, x: i64, y: i64) -> i64 {
        self.dx * (y - self.y) - self.dy * (x - self.x)
    }

    /// Smallest value that counts as inside: 0 on top and left edges, which own their samples, else 1.
    #[inline(always)]
    fn threshold(&self) -> i64 {
        i64::from(!(self.dy < 0 || (self.dy == 0 && self.dx > 0)))
    }
}

/// A triangle ready to be sampled.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    edges: [Edge; 3],
    thresholds: [i64; 3],
    area: i64,
    w: [f32; 3],
}

impl Triangle {
    /// Either orientation will do; `None` if the snapped triangle has no area.
    #[inline(always)]
    #[must_use]
    pub fn new(a: Vertex, b: Vertex, c: Vertex) -> Option<Self> {
        let area = signed_area(a, b, c);
        if area == 0 {
            return None;
        }
        let (b, c) = if area < 0 { (c, b) } else { (b, c) };
        let edges = [Edge::new(b, c), Edge::new(c, a), Edge::new(a, b)];
        let thresholds = edges.map(|edge| edge.threshold());
        Some(Self { edges, thresholds, area: area.abs(), w: [a.w, b.w, c.w] })
    }

    /// 1 / distance at the centre of a pixel, or `None` if the triangle does not own that sample.
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, column: i32, row: i32) -> Option<f32> {
        let (x, y) = (i64::from(centre(column)), i64::from(centre(row)));
        let values = self.edges.map(|edge| edge.at(x, y));
        let [a, b, c] = [0, 1, 2].map(|k| values[k] - self.thresholds[k]);
        if (a | b | c) < 0 { None } else { Some(self.depth(values)) }
    }

    /// 1 / distance is affine on screen: weighted by the areas opposite the vertices.
    ///
    /// The areas are shifted until they fit a float's mantissa, so that the conversion is exact.
    #[inline(always)]
    fn depth(&self, values: [i64; 3]) -> f32 {
        let spare = 40_u32.saturating_sub(self.area.leading_zeros());
        let share = recip(float((self.area >> spare) as i32));
        let weight = |k: usize| mul(float((values[k] >> spare) as i32), share);
        let [a, b, c] = self.w;
        let w = add(a, add(mul(weight(1), sub(b, a)), mul(weight(2), sub(c, a))));
        clamp(w, min(min(a, b), c), max(max(a, b), c))
    }
}

/// Twice the area of a triangle, 1/65536 pixels²: negative if it runs anticlockwise as seen on screen.
#[inline(always)]
#[must_use]
pub fn signed_area(a: Vertex, b: Vertex, c: Vertex) -> i64 {
    Edge::new(a, b).at(i64::from(c.x), i64::from(c.y))
}

/// The centre of a pixel column or row in snapped units.
#[inline(always)]
#[must_use]
pub fn centre(pixel: i32) -> i32 {
    pixel * SUBPIXELS + SUBPIXELS / 2
}

/// First pixel whose centre is not before `low`, and one past the last whose centre is not after `high`.
#[inline(always)]
#[must_use]
pub fn pixels_between(low: i32, high: i32) -> (i32, i32) {
    let half = SUBPIXELS / 2;
    ((low + half - 1) >> SUBPIXEL_BITS, ((high - half) >> SUBPIXEL_BITS) + 1)
}
