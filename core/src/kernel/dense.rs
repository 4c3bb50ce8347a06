//! One micropolygon and the samples around it, many samples at once: for frames whose pattern has more than one sample.
//!
//! Edge functions are affine in the place of the sample: three numbers each, found once. Of a micropolygon that is small
//! enough all of them, and all on the way to them, are whole numbers below 2²⁴, which floats hold exactly: so lanes of floats
//! do, which are faster than integers. Ownership, which of two triangles is nearer, and 1 / distance are as in `triangle.rs`.

use crate::abi::{Frame, MAX_PATTERN_BITS};
use crate::kernel::dice::LANES;
use crate::kernel::project::Vertex;
use crate::kernel::triangle::{Hit, samples_between};
use crate::num::{add, clamp, float, max, min, mul, recip, sub};

/// Rows and columns of the largest pattern.
const SIDE: usize = 1 << MAX_PATTERN_BITS;
/// A micropolygon no longer than this, in snapped units, is small enough.
const SMALL: i32 = 1900;

/// The samples of one block of lanes, for every column and every row of the pattern that it can start with: snapped units
/// from the start of the first lane's field.
#[derive(Clone, Debug)]
struct Layout {
    x: [[[f32; LANES]; SIDE]; SIDE],
    y: [[[f32; LANES]; SIDE]; SIDE],
}

impl Layout {
    /// Blocks of so many columns, and as many rows as that leaves.
    fn new(frame: &Frame, columns: usize) -> Self {
        let zero = [[[0.0; LANES]; SIDE]; SIDE];
        let mut out = Self { x: zero, y: zero };
        let (bits, side) = (frame.pattern_bits, 1_usize << frame.pattern_bits);
        for row in 0..side {
            for first in 0..side {
                for l in 0..LANES {
                    let (across, down) = (l % columns, l / columns);
                    let index = ((row + down) & (side - 1)) << bits | (first + across) & (side - 1);
                    let start = |fields: usize| (fields as i32) << frame.pitch_bits;
                    out.x[row][first][l] = float(start(across) + frame.sample_x[index]);
                    out.y[row][first][l] = float(start(down) + frame.sample_y[index]);
                }
            }
        }
        out
    }
}

/// The pattern of a frame, laid out for lanes.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// For blocks of [`WIDE`] and of [`NARROW`] columns.
    layouts: [Layout; 2],
    bits: u32,
    pitch_bits: u32,
}

/// Columns of a block of one row.
const WIDE: i32 = LANES as i32;
/// Columns of a block of two rows, for micropolygons that are no wider.
const NARROW: i32 = WIDE / 2;

impl Pattern {
    /// The pattern of a frame.
    #[must_use]
    pub fn new(frame: &Frame) -> Self {
        let layouts = [WIDE, NARROW].map(|columns| Layout::new(frame, columns as usize));
        Self { layouts, bits: frame.pattern_bits, pitch_bits: frame.pitch_bits }
    }
}

/// An edge function, `base + x · right + y · down`, positive inside of its triangle, which owns the samples where it is at
/// least `least`: top and left edges own what lies on them. All are whole numbers.
#[derive(Clone, Copy, Debug, Default)]
struct Edge {
    base: f32,
    right: f32,
    down: f32,
    least: f32,
}

impl Edge {
    #[inline(always)]
    fn new([base, right, down]: [i32; 3]) -> Self {
        let (dx, dy) = (down, -right);
        let is_own = (dy < 0) | ((dy == 0) & (dx > 0));
        let least = if is_own { 0.0 } else { 1.0 };
        Self { base: float(base), right: float(right), down: float(down), least }
    }

    #[inline(always)]
    fn at(&self, x: f32, y: f32) -> f32 {
        add(self.base, add(mul(x, self.right), mul(y, self.down)))
    }
}

/// Base, right and down of the edge from p to q, as seen from the origin.
#[inline(always)]
fn edge([px, py]: [i32; 2], [qx, qy]: [i32; 2]) -> [i32; 3] {
    [px * qy - py * qx, py - qy, qx - px]
}

/// A triangle as edge functions opposite its corners.
#[derive(Clone, Copy, Debug, Default)]
struct Triangle {
    edges: [Edge; 3],
    w: [f32; 3],
    /// One over the area.
    share: f32,
    /// The least and the largest `w`.
    low: f32,
    high: f32,
}

impl Triangle {
    /// `edges` are those opposite the corners.
    #[inline(always)]
    fn new(edges: [[i32; 3]; 3], w: [f32; 3]) -> Self {
        // The sum of all three is the same at every sample: twice the area.
        let area = edges[0][0] + edges[1][0] + edges[2][0];
        let sign = if area < 0 { -1 } else { 1 };
        let mut edges = edges.map(|edge| Edge::new(edge.map(|number| number * sign)));
        if area == 0 {
            edges[0].least = f32::INFINITY; // it owns nothing
        }
        let (low, high) = (min(min(w[0], w[1]), w[2]), max(max(w[0], w[1]), w[2]));
        Self { edges, w, share: recip(float(area * sign)), low, high }
    }

    /// Whether it owns a sample, and what it shows there.
    #[inline(always)]
    fn sample(&self, x: f32, y: f32) -> (bool, Hit) {
        let [p, q, r] = &self.edges;
        let edges = [p.at(x, y), q.at(x, y), r.at(x, y)];
        let owns = (edges[0] >= p.least) & (edges[1] >= q.least) & (edges[2] >= r.least);
        let (for_b, for_c) = (mul(edges[1], self.share), mul(edges[2], self.share));
        let [a, b, c] = self.w;
        let w = add(a, add(mul(for_b, sub(b, a)), mul(for_c, sub(c, a))));
        (owns, Hit { w: clamp(w, self.low, self.high), for_b, for_c })
    }
}

/// A micropolygon a b c d that is whole and small enough, and the samples in its bounding box.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    first: Triangle,
    second: Triangle,
    /// From where its edge functions are seen: the start of the field of its first sample.
    origin: [i32; 2],
    /// First column of samples.
    pub left: i32,
    /// One past the last column.
    pub right: i32,
    /// First row of samples.
    pub top: i32,
    /// One past the last row.
    pub bottom: i32,
}

/// What a micropolygon shows at the samples of a block.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// A bit a sample: does it own it?
    pub owned: u32,
    /// 1 / distance.
    pub w: [f32; LANES],
    /// Does the second triangle, a c d, show it?
    pub second: [bool; LANES],
    /// Share of that triangle's second corner.
    pub for_b: [f32; LANES],
    /// Share of its third corner.
    pub for_c: [f32; LANES],
}

/// Blocks that together hold some samples: the columns of one, and its rows.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Columns of a block.
    pub columns: i32,
    /// Rows of a block.
    pub rows: i32,
}

impl Shape {
    /// For samples in so many columns.
    #[inline(always)]
    #[must_use]
    pub const fn of(columns: i32) -> Self {
        if columns <= NARROW {
            Self { columns: NARROW, rows: WIDE / NARROW }
        } else {
            Self { columns: WIDE, rows: 1 }
        }
    }

    /// Bits of the samples of a block that are among the first so many columns and rows.
    #[inline(always)]
    #[must_use]
    pub fn mask(self, columns: i32, rows: i32) -> u32 {
        let row = (1_u32 << columns.min(self.columns)) - 1;
        if self.rows == 1 || rows == 1 { row } else { row | row << NARROW }
    }
}

impl Block {
    /// What it shows at one of them.
    #[inline(always)]
    #[must_use]
    pub fn hit(&self, l: usize) -> Hit {
        Hit { w: self.w[l], for_b: self.for_b[l], for_c: self.for_c[l] }
    }
}

impl Quad {
    /// Left, right, top and bottom of the samples in the bounding box of a quad.
    #[inline(always)]
    #[must_use]
    pub fn samples(frame: &Frame, [a, b, c, d]: [Vertex; 4]) -> [i32; 4] {
        let (left, right) =
            samples_between(frame, a.x.min(b.x).min(c.x.min(d.x)), a.x.max(b.x).max(c.x.max(d.x)));
        let (top, bottom) =
            samples_between(frame, a.y.min(b.y).min(c.y.min(d.y)), a.y.max(b.y).max(c.y.max(d.y)));
        [left, right, top, bottom]
    }

    /// Is it whole and small enough?
    #[inline(always)]
    #[must_use]
    pub fn is_small([a, b, c, d]: [Vertex; 4]) -> bool {
        let whole = min(min(a.w, b.w), min(c.w, d.w)) > 0.0;
        let spread = |p: i32, q: i32, r: i32, s: i32| p.max(q).max(r.max(s)) - p.min(q).min(r.min(s));
        whole && spread(a.x, b.x, c.x, d.x) <= SMALL && spread(a.y, b.y, c.y, d.y) <= SMALL
    }

    /// A quad that is whole and small, and has these samples in its bounding box.
    #[inline(always)]
    #[must_use]
    pub fn new(pattern: &Pattern, corners: [Vertex; 4], [left, right, top, bottom]: [i32; 4]) -> Self {
        let origin = [left << pattern.pitch_bits, top << pattern.pitch_bits];
        let [a, b, c, d] = corners.map(|corner| [corner.x - origin[0], corner.y - origin[1]]);
        let diagonal = edge(c, a);
        let [wa, wb, wc, wd] = corners.map(|corner| corner.w);
        Self {
            first: Triangle::new([edge(b, c), diagonal, edge(a, b)], [wa, wb, wc]),
            second: Triangle::new([edge(c, d), edge(d, a), diagonal.map(|number| -number)], [wa, wc, wd]),
            origin,
            left,
            right,
            top,
            bottom,
        }
    }

    /// What it shows at the samples of a block from a column and a row on, where it owns them; as of two triangles that
    /// overlap, the nearer, and of two that are equally near the first.
    #[inline(always)]
    #[must_use]
    pub fn block(&self, pattern: &Pattern, shape: Shape, column: i32, row: i32) -> Block {
        let mask = (1 << pattern.bits) - 1;
        let (first, line) = ((column & mask) as usize, (row & mask) as usize);
        let layout = &pattern.layouts[usize::from(shape.rows > 1)];
        let (x, y) = (&layout.x[line][first], &layout.y[line][first]);
        let start =
            [(column << pattern.pitch_bits) - self.origin[0], (row << pattern.pitch_bits) - self.origin[1]]
                .map(float);
        let mut out = Block {
            owned: 0,
            w: [0.0; LANES],
            second: [false; LANES],
            for_b: [0.0; LANES],
            for_c: [0.0; LANES],
        };
        let mut owned = [false; LANES];
        for l in 0..LANES {
            let (x, y) = (add(start[0], x[l]), add(start[1], y[l]));
            let (in_first, p) = self.first.sample(x, y);
            let (in_second, q) = self.second.sample(x, y);
            let second = in_second & (!in_first | (q.w > p.w));
            owned[l] = in_first | in_second;
            out.second[l] = second;
            out.w[l] = if second { q.w } else { p.w };
            out.for_b[l] = if second { q.for_b } else { p.for_b };
            out.for_c[l] = if second { q.for_c } else { p.for_c };
        }
        for l in 0..LANES {
            out.owned |= u32::from(owned[l]) << l;
        }
        out
    }
}
