//! Coverage by integer edge functions with the top-left rule (Pineda 1988), depth by exact weights.
//!
//! Two triangles that share an edge share its snapped vertices; every sample on or beside the edge belongs
//! to exactly one of them.

use crate::abi::{SUBPIXEL_BITS, SUBPIXELS};
use crate::kernel::project::Vertex;
use crate::num::{add, clamp, float, max, min, mul, recip, sub};

/// A snapped vertex as seen from a sample.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    x: i64,
    y: i64,
    w: f32,
}

impl Corner {
    /// `vertex` as seen from the centre of a pixel.
    #[inline(always)]
    #[must_use]
    pub fn new(vertex: Vertex, column: i32, row: i32) -> Self {
        Self { x: i64::from(vertex.x - centre(column)), y: i64::from(vertex.y - centre(row)), w: vertex.w }
    }
}

/// Twice the area between the sample and the edge from `a` to `b`, in 1/65536 pixels²: positive if the
/// sample lies to the right of the edge as seen on screen.
#[inline(always)]
#[must_use]
pub fn edge(a: Corner, b: Corner) -> i64 {
    a.x * b.y - a.y * b.x
}

/// Does the triangle `corners`, whose edges opposite them have the values `edges`, own the sample?
///
/// Strictly inside all edges agree in sign. On an edge, top and left edges own the sample.
#[inline(always)]
#[must_use]
pub fn owns(corners: [Corner; 3], edges: [i64; 3]) -> bool {
    let [a, b, c] = edges;
    if a != 0 && b != 0 && c != 0 {
        return (a > 0) == (b > 0) && (b > 0) == (c > 0);
    }
    owns_border(corners, edges)
}

#[cold]
fn owns_border([a, b, c]: [Corner; 3], edges: [i64; 3]) -> bool {
    let area = edges[0] + edges[1] + edges[2];
    let sides = [(b, c), (c, a), (a, b)];
    area != 0
        && sides.into_iter().zip(edges).all(|((from, to), value)| {
            let (from, to, value) = if area > 0 { (from, to, value) } else { (to, from, -value) };
            let (dx, dy) = (to.x - from.x, to.y - from.y);
            value > 0 || (value == 0 && (dy < 0 || (dy == 0 && dx > 0)))
        })
}

/// 1 / distance at a sample that the triangle owns. It is affine on screen: the corners' values are
/// weighted by the areas opposite them, shifted until they fit a float's mantissa, so that the conversion
/// is exact.
#[inline(always)]
#[must_use]
pub fn depth(corners: [Corner; 3], edges: [i64; 3]) -> f32 {
    let area = (edges[0] + edges[1] + edges[2]).abs();
    let spare = 40_u32.saturating_sub(area.leading_zeros());
    let share = recip(float((area >> spare) as i32));
    let weight_b = mul(float((edges[1].abs() >> spare) as i32), share);
    let weight_c = mul(float((edges[2].abs() >> spare) as i32), share);
    let [a, b, c] = [corners[0].w, corners[1].w, corners[2].w];
    let w = add(a, add(mul(weight_b, sub(b, a)), mul(weight_c, sub(c, a))));
    clamp(w, min(min(a, b), c), max(max(a, b), c))
}

/// 1 / distance at the centre of a pixel, or `None` if the triangle does not own that sample.
#[inline(always)]
#[must_use]
pub fn sample_triangle(triangle: [Vertex; 3], column: i32, row: i32) -> Option<f32> {
    let [a, b, c] = [
        Corner::new(triangle[0], column, row),
        Corner::new(triangle[1], column, row),
        Corner::new(triangle[2], column, row),
    ];
    let edges = [edge(b, c), edge(c, a), edge(a, b)];
    if owns([a, b, c], edges) { Some(depth([a, b, c], edges)) } else { None }
}

/// Twice the area of a triangle, 1/65536 pixels²: negative if it runs anticlockwise as seen on screen.
#[inline(always)]
#[must_use]
pub fn signed_area(a: Vertex, b: Vertex, c: Vertex) -> i64 {
    let side = |to: Vertex| (i64::from(to.x - a.x), i64::from(to.y - a.y));
    let ((bx, by), (cx, cy)) = (side(b), side(c));
    bx * cy - by * cx
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
