//! Coverage by integer edge functions with the top-left rule (Pineda 1988), depth by exact weights.
//!
//! Two triangles that share an edge share its snapped vertices; every sample on or beside the edge belongs
//! to exactly one of them.

use crate::abi::{Draw, Frame, SUBPIXELS};
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
    /// `vertex` as seen from a sample.
    #[inline(always)]
    #[must_use]
    pub fn new(vertex: Vertex, [x, y]: Site) -> Self {
        Self { x: i64::from(vertex.x - x), y: i64::from(vertex.y - y), w: vertex.w }
    }
}

/// Where a sample is, in snapped units.
pub type Site = [i32; 2];

/// What a triangle shows at a sample that it owns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hit {
    /// 1 / distance.
    pub w: f32,
    /// Share of the second corner.
    pub for_b: f32,
    /// Share of the third corner.
    pub for_c: f32,
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
pub fn hit(corners: [Corner; 3], edges: [i64; 3]) -> Hit {
    let area = (edges[0] + edges[1] + edges[2]).abs();
    let spare = 40_u32.saturating_sub(area.leading_zeros());
    let share = recip(float((area >> spare) as i32));
    let for_b = mul(float((edges[1].abs() >> spare) as i32), share);
    let for_c = mul(float((edges[2].abs() >> spare) as i32), share);
    Hit { w: weighted(corners.map(|corner| corner.w), for_b, for_c), for_b, for_c }
}

/// A value of three corners at a place inside the triangle, given the shares of the second and the third.
#[inline(always)]
#[must_use]
pub fn weighted([a, b, c]: [f32; 3], for_b: f32, for_c: f32) -> f32 {
    let value = add(a, add(mul(for_b, sub(b, a)), mul(for_c, sub(c, a))));
    clamp(value, min(min(a, b), c), max(max(a, b), c))
}

/// What a triangle shows at a sample, or `None` if it does not own it.
#[inline(always)]
#[must_use]
pub fn sample_triangle(triangle: [Vertex; 3], site: Site) -> Option<Hit> {
    let [a, b, c] =
        [Corner::new(triangle[0], site), Corner::new(triangle[1], site), Corner::new(triangle[2], site)];
    let edges = [edge(b, c), edge(c, a), edge(a, b)];
    if owns([a, b, c], edges) { Some(hit([a, b, c], edges)) } else { None }
}

/// Twice the area of a triangle, 1/65536 pixels²: negative if it runs anticlockwise as seen on screen.
#[inline(always)]
#[must_use]
pub fn signed_area(a: Vertex, b: Vertex, c: Vertex) -> i64 {
    let side = |to: Vertex| (i64::from(to.x - a.x), i64::from(to.y - a.y));
    let ((bx, by), (cx, cy)) = (side(b), side(c));
    bx * cy - by * cx
}

/// Where the sample in this column and row is.
#[inline(always)]
#[must_use]
pub fn site(frame: &Frame, column: i32, row: i32) -> Site {
    let mask = (1 << frame.pattern_bits) - 1;
    let index = ((row & mask) << frame.pattern_bits | (column & mask)) as usize;
    let start = |field: i32| field << frame.pitch_bits;
    [start(column) + frame.sample_x[index], start(row) + frame.sample_y[index]]
}

/// First column (or row) of samples that need not be before `low`, and one past the last that need not be after `high`.
#[inline(always)]
#[must_use]
pub fn samples_between(frame: &Frame, low: i32, high: i32) -> (i32, i32) {
    let field = (1 << frame.pitch_bits) - 1;
    let first = (low - frame.most_offset + field) >> frame.pitch_bits;
    (first, ((high - frame.least_offset) >> frame.pitch_bits) + 1)
}

/// Columns and rows of samples of the frame that a draw can touch: left, right, top, bottom.
#[inline(always)]
#[must_use]
pub fn samples_of(frame: &Frame, draw: Draw) -> [i32; 4] {
    let along = |packed: u32, first: u32, end: u32| {
        let [low, high] = [packed & 0xffff, packed >> 16].map(|pixel| pixel as i32 * SUBPIXELS);
        let (from, to) = samples_between(frame, low, high - 1);
        [from.max(first as i32), to.min(end as i32)]
    };
    let [left, right] = along(draw.columns, frame.sample_left, frame.sample_right);
    let [top, bottom] = along(draw.rows, frame.sample_top, frame.sample_bottom);
    [left, right, top, bottom]
}

/// Place of a sample in the frame's buffers.
#[inline(always)]
#[must_use]
pub const fn place(frame: &Frame, column: i32, row: i32) -> usize {
    let (column, row) = (column as u32 - frame.sample_left, row as u32 - frame.sample_top);
    frame.place_first as usize
        + row as usize * frame.place_row as usize
        + column as usize * frame.place_column as usize
}
