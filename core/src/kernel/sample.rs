//! sample: micropolygons become samples; the nearest wins.
//!
//! A micropolygon is two triangles. Where two are equally near the smaller identity (patch, u, v) wins, so
//! the image does not depend on the order in which surfaces arrive.

use crate::abi::{Colour, Draw, FLAG_CULL_BACKFACES, FLAG_SMOOTH, Frame, MAX_RATE, Sample};
use crate::kernel::blend::is_behind;
use crate::kernel::clip::clip;
use crate::kernel::dense::{Pattern, Quad, Shape};
use crate::kernel::dice::{Grid, LANES, load};
use crate::kernel::project::{Vertex, project_clipped};
use crate::kernel::quads::{FOUND, NOTHING, Quads};
use crate::kernel::triangle::{
    Corner, Hit, Site, edge, hit, owns, sample_triangle, samples_between, signed_area, site, weighted,
};
use crate::num::{add, mul};

/// Where samples go.
pub trait Target {
    /// Samples that it takes: first column and one past the last, first row and one past the last.
    fn limits(&self) -> [i32; 4];

    /// Takes what a micropolygon shows at a sample within the limits.
    fn put(&mut self, column: i32, row: i32, new: Sample, colour: Colour);
}

/// Samples in a rectangle of columns and rows, and the slice of the frame's buffers that they lie in.
#[derive(Debug)]
pub struct Band<'a> {
    /// First column of samples, and one past the last; first row, and one past the last.
    pub limits: [i32; 4],
    /// The column and the row whose sample is at place `first` of the slices.
    pub origin: [i32; 2],
    /// That place.
    pub first: usize,
    /// Places from a column to the next.
    pub column: usize,
    /// Places from a row to the next.
    pub row: usize,
    /// What has been found at the last layer, sample for sample; empty if there is only one.
    pub behind: &'a [Sample],
    /// Nearest micropolygon a sample.
    pub samples: &'a mut [Sample],
    /// Its colour.
    pub colours: &'a mut [Colour],
}

impl<'a> Band<'a> {
    /// All samples of a frame with one layer.
    #[must_use]
    pub const fn whole(frame: &Frame, samples: &'a mut [Sample], colours: &'a mut [Colour]) -> Self {
        let (left, top) = (frame.sample_left as i32, frame.sample_top as i32);
        Self {
            limits: [left, frame.sample_right as i32, top, frame.sample_bottom as i32],
            origin: [left, top],
            first: frame.place_first as usize,
            column: frame.place_column as usize,
            row: frame.place_row as usize,
            behind: &[],
            samples,
            colours,
        }
    }
}

impl Target for Band<'_> {
    #[inline(always)]
    fn limits(&self) -> [i32; 4] {
        self.limits
    }

    /// Keeps a new sample if it is to be shown rather than the old one.
    #[inline(always)]
    fn put(&mut self, column: i32, row: i32, new: Sample, colour: Colour) {
        let columns = (column - self.origin[0]) as usize * self.column;
        let place = self.first + (row - self.origin[1]) as usize * self.row + columns;
        if !self.behind.is_empty() && !is_behind(new, self.behind[place]) {
            return;
        }
        if nearer(new, self.samples[place]) {
            self.samples[place] = new;
            self.colours[place] = colour;
        }
    }
}

/// Is `new` to be shown rather than `old`?
#[inline(always)]
#[must_use]
pub fn nearer(new: Sample, old: Sample) -> bool {
    if new.depth != old.depth {
        return new.depth > old.depth;
    }
    (new.patch_id, new.u, new.v) < (old.patch_id, old.u, old.v)
}

/// Samples all micropolygons of a shaded grid, whose object has this opacity.
#[inline(always)]
pub fn sample<T: Target>(
    frame: &Frame,
    pattern: &Pattern,
    (draw, opacity): (Draw, f32),
    grid: &Grid,
    target: &mut T,
) {
    if frame.flags & FLAG_CULL_BACKFACES != 0 && faces_away(grid) {
        return;
    }
    let sampler = Sampler::new(frame, draw, opacity, grid);
    for row in 0..grid.rows - 1 {
        for block in (0..grid.stride - 1).step_by(LANES) {
            match (frame.pattern_bits, frame.flags & FLAG_SMOOTH) {
                (0, _) => sampler.block(row, block, target),
                (_, 0) => sampler.dense::<false, T>(pattern, row, block, target),
                _ => sampler.dense::<true, T>(pattern, row, block, target),
            }
        }
    }
}

/// A row and column of a grid: of a vertex, or of the micropolygon that starts there.
type Place = (usize, usize);

/// The corners of a micropolygon: a, b to the right of it, c diagonally, d below it.
type Corners = [usize; 4];

/// What is being sampled.
struct Sampler<'a> {
    frame: &'a Frame,
    opacity: f32,
    grid: &'a Grid,
    patch_id: u32,
    /// Low u of the micropolygons of each column, and low v of those of each row.
    u: [u32; MAX_RATE as usize],
    v: [u32; MAX_RATE as usize],
}

impl<'a> Sampler<'a> {
    #[inline(always)]
    fn new(frame: &'a Frame, draw: Draw, opacity: f32, grid: &'a Grid) -> Self {
        let (mut u, mut v) = ([0; MAX_RATE as usize], [0; MAX_RATE as usize]);
        for column in 0..draw.rate_u() {
            u[column as usize] = draw.column(column);
        }
        for row in 0..draw.rate_v() {
            v[row as usize] = draw.row(row);
        }
        Self { frame, opacity, grid, patch_id: draw.patch_id, u, v }
    }

    #[inline(always)]
    fn index(&self, (row, column): Place) -> usize {
        row * self.grid.stride + column
    }

    #[inline(always)]
    fn corners(&self, place: Place) -> Corners {
        let at = self.index(place);
        let below = at + self.grid.stride;
        [at, at + 1, below + 1, below]
    }

    #[inline(always)]
    fn vertex(&self, at: usize) -> Vertex {
        Vertex { x: self.grid.x[at], y: self.grid.y[at], w: self.grid.w[at] }
    }

    /// The micropolygon in this row and column, at this depth.
    #[inline(always)]
    fn sample(&self, (row, column): Place, w: f32) -> Sample {
        Sample { depth: w.to_bits(), patch_id: self.patch_id, u: self.u[column], v: self.v[row] }
    }

    /// Its colour where one of its triangles, a b c or the second, a c d, was hit.
    #[inline(always)]
    fn colour(&self, corners: Corners, second: bool, hit: Hit) -> Colour {
        if self.frame.flags & FLAG_SMOOTH == 0 {
            self.mean(corners)
        } else {
            self.smooth(corners, second, hit)
        }
    }

    /// Mean colour of the four vertices of a micropolygon.
    #[inline(always)]
    fn mean(&self, [a, b, c, d]: Corners) -> Colour {
        let mut rgba = [self.opacity; 4];
        for k in 0..3 {
            let colour = &self.grid.colour[k];
            rgba[k] = mul(0.25, add(add(colour[a], colour[c]), add(colour[b], colour[d])));
        }
        Colour { rgba }
    }

    /// Colour between the vertices of a triangle.
    #[inline(always)]
    fn smooth(&self, [a, b, c, d]: Corners, second: bool, hit: Hit) -> Colour {
        let [p, q] = if second { [c, d] } else { [b, c] };
        let mut rgba = [self.opacity; 4];
        for k in 0..3 {
            let colour = &self.grid.colour[k];
            rgba[k] = weighted([colour[a], colour[p], colour[q]], hit.for_b, hit.for_c);
        }
        Colour { rgba }
    }

    /// Samples [`LANES`] micropolygons of one row, each of which owns one sample at most, or is left to the general way.
    #[inline(always)]
    fn block<T: Target>(&self, row: usize, block: usize, target: &mut T) {
        let [left, right, top, bottom] = target.limits();
        let quads = Quads::new(self.frame, self.grid, self.index((row, block)));
        let finds = quads.find();
        for l in 0..LANES.min(self.grid.stride - 1 - block) {
            let place = (row, block + l);
            match finds.state[l] {
                NOTHING => {}
                FOUND => {
                    let (x, y) = (quads.left[l], quads.top[l]);
                    if x >= left && x < right && y >= top && y < bottom {
                        let colour = self.colour(self.corners(place), finds.second[l], finds.hit(l));
                        target.put(x, y, self.sample(place, finds.w[l]), colour);
                    }
                }
                _ => self.micropolygon(place, quads.samples(l), target),
            }
        }
    }

    /// Mean colours of [`LANES`] micropolygons of one row.
    #[inline(always)]
    fn means(&self, at: usize) -> [[f32; LANES]; 3] {
        let mut means = [[0.0; LANES]; 3];
        for (mean, colour) in means.iter_mut().zip(&self.grid.colour) {
            let below = at + self.grid.stride;
            let [a, b] = [load(colour, at), load(colour, at + 1)];
            let [d, c] = [load(colour, below), load(colour, below + 1)];
            for l in 0..LANES {
                mean[l] = mul(0.25, add(add(a[l], c[l]), add(b[l], d[l])));
            }
        }
        means
    }

    /// Samples [`LANES`] micropolygons of one row, each of which may own many samples.
    #[inline(always)]
    fn dense<const SMOOTH: bool, T: Target>(
        &self,
        pattern: &Pattern,
        row: usize,
        block: usize,
        target: &mut T,
    ) {
        let means = self.means(self.index((row, block)));
        for l in 0..LANES.min(self.grid.stride - 1 - block) {
            let mean = Colour { rgba: [means[0][l], means[1][l], means[2][l], self.opacity] };
            self.quad::<SMOOTH, T>(pattern, (row, block + l), mean, target);
        }
    }

    /// Samples one of them, of this mean colour.
    #[inline(always)]
    fn quad<const SMOOTH: bool, T: Target>(
        &self,
        pattern: &Pattern,
        place: Place,
        mean: Colour,
        target: &mut T,
    ) {
        let corners = self.corners(place);
        let quad = corners.map(|at| self.vertex(at));
        let samples = Quad::samples(self.frame, quad);
        if !Quad::is_small(quad) {
            self.micropolygon(place, samples, target);
            return;
        }
        let [left, right, top, bottom] = inside(target.limits(), samples);
        if left >= right || top >= bottom {
            return;
        }
        let quad = Quad::new(pattern, quad, samples);
        let shape = Shape::of(right - left);
        let (mut x, mut y) = (left, top);
        while y < bottom {
            let block = quad.block(pattern, shape, x, y);
            let mut owned = block.owned & shape.mask(right - x, bottom - y);
            while owned != 0 {
                let l = owned.trailing_zeros() as usize;
                owned &= owned - 1;
                let colour = if SMOOTH { self.smooth(corners, block.second[l], block.hit(l)) } else { mean };
                let (across, down) = (l as i32 & (shape.columns - 1), l as i32 / shape.columns);
                target.put(x + across, y + down, self.sample(place, block.w[l]), colour);
            }
            x += shape.columns;
            if x >= right {
                (x, y) = (left, y + shape.rows);
            }
        }
    }

    /// Samples one quad of any size as the triangles a b c and a c d.
    #[inline(never)]
    fn micropolygon<T: Target>(&self, place: Place, samples: [i32; 4], target: &mut T) {
        let corners = self.corners(place);
        let quad = corners.map(|at| self.vertex(at));
        if quad.iter().any(|vertex| vertex.w == 0.0) {
            let [a, b, c, d] = corners.map(|at| self.grid.point(at));
            self.clipped([a, b, c], place, target);
            self.clipped([a, c, d], place, target);
            return;
        }
        let [left, right, top, bottom] = inside(target.limits(), samples);
        for y in top..bottom {
            for x in left..right {
                if let Some((second, hit)) = sample_quad(quad, site(self.frame, x, y)) {
                    target.put(x, y, self.sample(place, hit.w), self.colour(corners, second, hit));
                }
            }
        }
    }

    /// Clips a triangle and samples what is left of it, as a fan, all in the micropolygon's mean colour.
    #[cold]
    fn clipped<T: Target>(&self, triangle: [[f32; 3]; 3], place: Place, target: &mut T) {
        let polygon = clip(self.frame, triangle);
        for k in 2..polygon.count {
            let fan = [0, k - 1, k].map(|k| project_clipped(self.frame, polygon.corners[k]));
            self.triangle(fan, place, target);
        }
    }

    /// Samples a triangle that belongs to the micropolygon at `place`.
    #[inline(always)]
    fn triangle<T: Target>(&self, triangle: [Vertex; 3], place: Place, target: &mut T) {
        let [a, b, c] = triangle;
        let (left, right) = samples_between(self.frame, a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (top, bottom) = samples_between(self.frame, a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let [left, right, top, bottom] = inside(target.limits(), [left, right, top, bottom]);
        for y in top..bottom {
            for x in left..right {
                if let Some(hit) = sample_triangle(triangle, site(self.frame, x, y)) {
                    target.put(x, y, self.sample(place, hit.w), self.mean(self.corners(place)));
                }
            }
        }
    }
}

/// What two boxes of samples have in common.
#[inline(always)]
fn inside(limits: [i32; 4], [left, right, top, bottom]: [i32; 4]) -> [i32; 4] {
    [left.max(limits[0]), right.min(limits[1]), top.max(limits[2]), bottom.min(limits[3])]
}

/// What a quad shows at a sample that one of its two triangles, a b c and a c d, owns, and whether that is the second;
/// of two that overlap, the nearer, of two equally near the first.
#[inline(always)]
fn sample_quad(quad: [Vertex; 4], site: Site) -> Option<(bool, Hit)> {
    let [a, b, c, d] = [
        Corner::new(quad[0], site),
        Corner::new(quad[1], site),
        Corner::new(quad[2], site),
        Corner::new(quad[3], site),
    ];
    let diagonal = edge(c, a);
    let first = [edge(b, c), diagonal, edge(a, b)];
    let second = [edge(c, d), edge(d, a), -diagonal];
    match (owns([a, b, c], first), owns([a, c, d], second)) {
        (true, false) => Some((false, hit([a, b, c], first))),
        (false, true) => Some((true, hit([a, c, d], second))),
        (true, true) => {
            let (p, q) = (hit([a, b, c], first), hit([a, c, d], second));
            Some(if q.w > p.w { (true, q) } else { (false, p) })
        }
        (false, false) => None,
    }
}

/// Does no micropolygon of the grid face the eye? Block-level back-face culling (Weber 2014, sec. 4.4).
/// The front is the side from which u runs to the right where v runs up.
fn faces_away(grid: &Grid) -> bool {
    let vertex = |at: usize| Vertex { x: grid.x[at], y: grid.y[at], w: grid.w[at] };
    let stride = grid.stride;
    (0..grid.rows - 1).flat_map(|row| (0..stride - 1).map(move |column| row * stride + column)).all(|at| {
        let quad = [vertex(at), vertex(at + 1), vertex(at + stride + 1), vertex(at + stride)];
        quad.iter().all(|v| v.w > 0.0)
            && signed_area(quad[0], quad[1], quad[2]) >= 0
            && signed_area(quad[0], quad[2], quad[3]) >= 0
    })
}
