//! One micropolygon and the samples around it, many samples at once: for frames whose pattern has more than one sample.
//!
//! All edge functions of a micropolygon that is small enough fit 32 bits, and are affine in the place of the sample: three
//! numbers each, found once. Ownership, which of two triangles is nearer, and 1 / distance are as in `triangle.rs`.

use crate::abi::{Frame, MAX_PATTERN_BITS};
use crate::kernel::dice::LANES;
use crate::kernel::project::Vertex;
use crate::kernel::triangle::{Hit, samples_between};
use crate::num::{add, clamp, float, max, min, mul, recip, sub};

/// Rows and columns of the largest pattern.
const SIDE: usize = 1 << MAX_PATTERN_BITS;
/// A micropolygon no longer than this, in snapped units, is small enough.
const SMALL: i32 = 16_000;

/// The pattern of a frame, laid out for lanes: snapped units from the start of the first lane's field to each sample of
/// [`LANES`] successive ones of a row, for every column of the pattern to start with, and every row.
#[derive(Clone, Debug)]
pub struct Pattern {
    x: [[[i32; LANES]; SIDE]; SIDE],
    y: [[[i32; LANES]; SIDE]; SIDE],
    bits: u32,
    pitch_bits: u32,
}

impl Pattern {
    /// The pattern of a frame.
    #[must_use]
    pub fn new(frame: &Frame) -> Self {
        let zero = [[[0; LANES]; SIDE]; SIDE];
        let mut out = Self { x: zero, y: zero, bits: frame.pattern_bits, pitch_bits: frame.pitch_bits };
        let side = 1_usize << out.bits;
        for row in 0..side {
            for first in 0..side {
                for l in 0..LANES {
                    let index = row << out.bits | (first + l) & (side - 1);
                    out.x[row][first][l] = ((l as i32) << out.pitch_bits) + frame.sample_x[index];
                    out.y[row][first][l] = frame.sample_y[index];
                }
            }
        }
        out
    }
}

/// `base + x · right + y · down`: an edge function, positive inside, less one where samples on the edge belong to the
/// triangle on its other side.
#[derive(Clone, Copy, Debug, Default)]
struct Edge {
    base: i32,
    right: i32,
    down: i32,
}

impl Edge {
    /// Of the edge between two points, as seen from the origin.
    #[inline(always)]
    fn between([px, py]: [i32; 2], [qx, qy]: [i32; 2]) -> Self {
        Self { base: px * qy - py * qx, right: py - qy, down: qx - px }
    }

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> i32 {
        self.base.wrapping_add(x.wrapping_mul(self.right)).wrapping_add(y.wrapping_mul(self.down))
    }

    /// Seen from its other side.
    #[inline(always)]
    fn turned(self) -> Self {
        Self { base: -self.base, right: -self.right, down: -self.down }
    }

    /// The least value at which the edge's triangle, which lies to its right on screen, owns a sample: top and left edges
    /// own what lies on them.
    #[inline(always)]
    fn least(&self) -> i32 {
        let (dx, dy) = (self.down, -self.right);
        i32::from(!(dy < 0 || (dy == 0 && dx > 0)))
    }
}

/// A triangle as edge functions opposite its corners.
#[derive(Clone, Copy, Debug, Default)]
struct Triangle {
    edges: [Edge; 3],
    least: [i32; 3],
    w: [f32; 3],
    /// Bits by which areas are shifted, and one over the shifted area of all.
    spare: u32,
    share: f32,
    low: f32,
    high: f32,
}

impl Triangle {
    /// `edges` are those opposite the corners.
    #[inline(always)]
    fn new(edges: [Edge; 3], w: [f32; 3]) -> Self {
        // The sum of all three is the same at every sample: twice the area.
        let area = edges[0].base.wrapping_add(edges[1].base).wrapping_add(edges[2].base);
        let edges = if area < 0 { edges.map(Edge::turned) } else { edges };
        let size = area.unsigned_abs();
        let spare = 8_u32.saturating_sub(size.leading_zeros());
        let never = i32::MAX;
        let least = if area == 0 { [never; 3] } else { edges.map(|edge| edge.least()) };
        let (low, high) = (min(min(w[0], w[1]), w[2]), max(max(w[0], w[1]), w[2]));
        Self { edges, least, w, spare, share: recip(float((size >> spare) as i32)), low, high }
    }

    /// Whether it owns a sample, and what it shows there.
    #[inline(always)]
    fn sample(&self, x: i32, y: i32) -> (bool, Hit) {
        let edges = [self.edges[0].at(x, y), self.edges[1].at(x, y), self.edges[2].at(x, y)];
        let owns = (edges[0] >= self.least[0]) & (edges[1] >= self.least[1]) & (edges[2] >= self.least[2]);
        let for_b = mul(float(edges[1] >> self.spare), self.share);
        let for_c = mul(float(edges[2] >> self.spare), self.share);
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

/// What a micropolygon shows at [`LANES`] successive samples of a row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
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

impl Row {
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
        let diagonal = Edge::between(c, a);
        let [wa, wb, wc, wd] = corners.map(|corner| corner.w);
        Self {
            first: Triangle::new([Edge::between(b, c), diagonal, Edge::between(a, b)], [wa, wb, wc]),
            second: Triangle::new(
                [Edge::between(c, d), Edge::between(d, a), diagonal.turned()],
                [wa, wc, wd],
            ),
            origin,
            left,
            right,
            top,
            bottom,
        }
    }

    /// What it shows at the samples of a row from a column on, where it owns them; as of two triangles that overlap, the
    /// nearer, and of two that are equally near the first.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, pattern: &Pattern, column: i32, row: i32) -> Row {
        let mask = (1 << pattern.bits) - 1;
        let (first, line) = ((column & mask) as usize, (row & mask) as usize);
        let (x, y) = (&pattern.x[line][first], &pattern.y[line][first]);
        let start =
            [(column << pattern.pitch_bits) - self.origin[0], (row << pattern.pitch_bits) - self.origin[1]];
        let mut out = Row {
            owned: 0,
            w: [0.0; LANES],
            second: [false; LANES],
            for_b: [0.0; LANES],
            for_c: [0.0; LANES],
        };
        let mut owned = [false; LANES];
        for l in 0..LANES {
            let (x, y) = (start[0] + x[l], start[1] + y[l]);
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
