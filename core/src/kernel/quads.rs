//! Many micropolygons at once: where each could own a sample, and whether it does. For frames whose pattern has a single
//! sample.
//!
//! Most micropolygons are smaller than a pixel and can own one sample at most. For those all edge functions
//! fit 32 bits and are evaluated lane by lane; the few others (larger ones, ones with a sample exactly on an
//! edge, ones that must be clipped) are left to the general way through `triangle.rs`. Both give the same
//! answer.

use crate::abi::Frame;
use crate::kernel::dice::{Grid, LANES, load};
use crate::kernel::triangle::{Hit, samples_between, site, weighted};
use crate::num::{float, min, mul, recip};

/// The micropolygon owns no sample.
pub const NOTHING: u32 = 0;
/// It owns the sample at its `left` and `top`.
pub const FOUND: u32 = 1;
/// It is a case for the general way.
pub const GENERAL: u32 = 2;

/// Vertices of [`LANES`] neighbouring quads of a row: corner (a, b to the right of it, c diagonally, d below
/// it), quad; and the samples that lie in each quad's bounding box.
#[derive(Clone, Copy, Debug)]
pub struct Quads {
    x: [[i32; LANES]; 4],
    y: [[i32; LANES]; 4],
    w: [[f32; LANES]; 4],
    /// Where each quad's first sample is, column and row, snapped.
    first: [[i32; LANES]; 2],
    /// First column of samples.
    pub left: [i32; LANES],
    /// One past the last column.
    pub right: [i32; LANES],
    /// First row of samples.
    pub top: [i32; LANES],
    /// One past the last row.
    pub bottom: [i32; LANES],
}

/// What [`Quads::find`] found.
#[derive(Clone, Copy, Debug)]
pub struct Finds {
    /// `NOTHING`, `FOUND` or `GENERAL`.
    pub state: [u32; LANES],
    /// 1 / distance at the sample, where one was found.
    pub w: [f32; LANES],
    /// Is it the second triangle, a c d, that owns it?
    pub second: [bool; LANES],
    /// Share of that triangle's second corner.
    pub for_b: [f32; LANES],
    /// Share of its third corner.
    pub for_c: [f32; LANES],
}

impl Finds {
    /// What was found of one quad.
    #[inline(always)]
    #[must_use]
    pub fn hit(&self, l: usize) -> Hit {
        Hit { w: self.w[l], for_b: self.for_b[l], for_c: self.for_c[l] }
    }
}

impl Quads {
    /// The quads whose first corners are the vertices from index `at` of the grid on.
    #[inline(always)]
    #[must_use]
    pub fn new(frame: &Frame, grid: &Grid, at: usize) -> Self {
        let mut out = Self {
            x: [[0; LANES]; 4],
            y: [[0; LANES]; 4],
            w: [[0.0; LANES]; 4],
            first: [[0; LANES]; 2],
            left: [0; LANES],
            right: [0; LANES],
            top: [0; LANES],
            bottom: [0; LANES],
        };
        for (corner, start) in [at, at + 1, at + grid.stride + 1, at + grid.stride].into_iter().enumerate() {
            out.x[corner] = load(&grid.x, start);
            out.y[corner] = load(&grid.y, start);
            out.w[corner] = load(&grid.w, start);
        }
        (out.left, out.right) = sample_ranges(frame, &out.x);
        (out.top, out.bottom) = sample_ranges(frame, &out.y);
        let [x, y] = site(frame, 0, 0);
        for l in 0..LANES {
            out.first[0][l] = (out.left[l] << frame.pitch_bits) + x;
            out.first[1][l] = (out.top[l] << frame.pitch_bits) + y;
        }
        out
    }

    /// Left, right, top and bottom of the samples of one quad.
    #[inline(always)]
    #[must_use]
    pub fn samples(&self, l: usize) -> [i32; 4] {
        [self.left[l], self.right[l], self.top[l], self.bottom[l]]
    }

    /// Decides all quads that can own one sample at most.
    #[inline(always)]
    #[must_use]
    pub fn find(&self) -> Finds {
        let (zero, no) = ([0.0; LANES], [false; LANES]);
        let mut out = Finds { state: [NOTHING; LANES], w: zero, second: no, for_b: zero, for_c: zero };
        for l in 0..LANES {
            let (state, second, hit) = self.find_one(l);
            (out.state[l], out.second[l]) = (state, second);
            (out.w[l], out.for_b[l], out.for_c[l]) = (hit.w, hit.for_b, hit.for_c);
        }
        out
    }

    /// Mirrors `triangle::{edge, owns, hit}` for the triangles a b c and a c d. Without branches.
    #[inline(always)]
    fn find_one(&self, l: usize) -> (u32, bool, Hit) {
        let (ax, ay) = self.relative(0, l);
        let (bx, by) = self.relative(1, l);
        let (cx, cy) = self.relative(2, l);
        let (dx, dy) = self.relative(3, l);
        let (ab, bc) = (cross(ax, ay, bx, by), cross(bx, by, cx, cy));
        let ca = cross(cx, cy, ax, ay);
        let (cd, da) = (cross(cx, cy, dx, dy), cross(dx, dy, ax, ay));

        let first = same_sign(ab, bc, ca);
        let second = same_sign(cd, da, ca.wrapping_neg());
        let on_edge = (ab == 0) | (bc == 0) | (ca == 0) | (cd == 0) | (da == 0);
        let clipped = min(min(self.w[0][l], self.w[1][l]), min(self.w[2][l], self.w[3][l])) <= 0.0;
        let (wide, tall) =
            (self.right[l].wrapping_sub(self.left[l]), self.bottom[l].wrapping_sub(self.top[l]));
        let empty = (wide <= 0) | (tall <= 0);
        let large = (wide > 1) | (tall > 1);
        let area =
            if first { ab.wrapping_add(bc).wrapping_add(ca) } else { cd.wrapping_add(da).wrapping_sub(ca) };
        let exact = area.wrapping_abs() < 1 << 24;
        let general = clipped | (!empty & (large | on_edge | (first & second) | !exact));

        let (p, q) = (
            if first { self.w[1][l] } else { self.w[2][l] },
            if first { self.w[2][l] } else { self.w[3][l] },
        );
        let (for_p, for_q) = (if first { ca } else { da }, if first { ab } else { ca.wrapping_neg() });
        let hit = small_hit([self.w[0][l], p, q], area, for_p, for_q);

        let found = !empty & (first | second);
        let state = if general {
            GENERAL
        } else if found {
            FOUND
        } else {
            NOTHING
        };
        (state, !first, hit)
    }

    /// A corner as seen from the quad's first sample.
    #[inline(always)]
    fn relative(&self, corner: usize, l: usize) -> (i32, i32) {
        let [x, y] = [self.first[0][l], self.first[1][l]];
        (self.x[corner][l].wrapping_sub(x), self.y[corner][l].wrapping_sub(y))
    }
}

#[inline(always)]
fn cross(ax: i32, ay: i32, bx: i32, by: i32) -> i32 {
    ax.wrapping_mul(by).wrapping_sub(ay.wrapping_mul(bx))
}

#[inline(always)]
fn same_sign(a: i32, b: i32, c: i32) -> bool {
    ((a > 0) & (b > 0) & (c > 0)) | ((a < 0) & (b < 0) & (c < 0))
}

/// As `triangle::hit`, for areas below 2²⁴.
#[inline(always)]
fn small_hit(corners: [f32; 3], area: i32, for_b: i32, for_c: i32) -> Hit {
    let share = recip(float(area.wrapping_abs()));
    let for_b = mul(float(for_b.wrapping_abs()), share);
    let for_c = mul(float(for_c.wrapping_abs()), share);
    Hit { w: weighted(corners, for_b, for_c), for_b, for_c }
}

#[inline(always)]
fn sample_ranges(frame: &Frame, corners: &[[i32; LANES]; 4]) -> ([i32; LANES], [i32; LANES]) {
    let (mut first, mut end) = ([0; LANES], [0; LANES]);
    for l in 0..LANES {
        let (a, b, c, d) = (corners[0][l], corners[1][l], corners[2][l], corners[3][l]);
        (first[l], end[l]) = samples_between(frame, a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    }
    (first, end)
}
