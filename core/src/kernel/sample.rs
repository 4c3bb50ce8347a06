//! sample: micropolygons become samples, one a pixel at its centre; the nearest wins.
//!
//! A micropolygon is two triangles. Where two are equally near the smaller identity (patch, u, v) wins, so
//! the image does not depend on the order in which surfaces arrive.

use crate::abi::{Colour, Draw, FLAG_CULL_BACKFACES, Frame, MAX_RATE_BITS, Sample};
use crate::kernel::clip::clip;
use crate::kernel::dice::{Grid, LANES};
use crate::kernel::project::{Vertex, project_clipped};
use crate::kernel::quads::{FOUND, NOTHING, Quads};
use crate::kernel::triangle::{Corner, depth, edge, owns, pixels_between, sample_triangle, signed_area};
use crate::num::{add, mul};

/// Rows `first_row` … of the image, `width` samples each.
#[derive(Debug)]
pub struct Band<'a> {
    /// Samples a row.
    pub width: u32,
    /// Rows of the band.
    pub height: u32,
    /// Row of the image that the band starts with.
    pub first_row: u32,
    /// Nearest micropolygon a sample, row after row.
    pub samples: &'a mut [Sample],
    /// Its colour.
    pub colours: &'a mut [Colour],
}

impl Band<'_> {
    /// Rows of the image that the band covers: the first, and one past the last.
    #[inline(always)]
    #[must_use]
    pub fn rows(&self) -> (u32, u32) {
        (self.first_row, self.first_row + self.height)
    }

    #[inline(always)]
    fn contains(&self, column: i32, row: i32) -> bool {
        let row = row.wrapping_sub(self.first_row as i32) as u32;
        (column as u32) < self.width && row < self.height
    }

    /// The part of a box of pixels that lies inside the band.
    #[inline(always)]
    fn inside(&self, [left, right, top, bottom]: [i32; 4]) -> [i32; 4] {
        let (first_row, end_row) = self.rows();
        [left.max(0), right.min(self.width as i32), top.max(first_row as i32), bottom.min(end_row as i32)]
    }

    /// Keeps a new sample if it is to be shown rather than the old one.
    #[inline(always)]
    fn put(&mut self, column: i32, row: i32, new: Sample, colour: Colour) {
        let place = (row as u32 - self.first_row) as usize * self.width as usize + column as usize;
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

/// Samples all micropolygons of a shaded grid inside the band.
#[inline(always)]
pub fn sample(frame: &Frame, draw: Draw, grid: &Grid, band: &mut Band<'_>) {
    if frame.flags & FLAG_CULL_BACKFACES != 0 && faces_away(grid) {
        return;
    }
    let sampler = Sampler { frame, draw, grid };
    for row in 0..grid.rows - 1 {
        for block in (0..grid.stride - 1).step_by(LANES) {
            sampler.block(row, block, band);
        }
    }
}

/// A row and column of a grid: of a vertex, or of the micropolygon that starts there.
type Place = (usize, usize);

/// What is being sampled.
struct Sampler<'a> {
    frame: &'a Frame,
    draw: Draw,
    grid: &'a Grid,
}

impl Sampler<'_> {
    #[inline(always)]
    fn index(&self, (row, column): Place) -> usize {
        row * self.grid.stride + column
    }

    #[inline(always)]
    fn vertex(&self, place: Place) -> Vertex {
        let at = self.index(place);
        Vertex { x: self.grid.x[at], y: self.grid.y[at], w: self.grid.w[at] }
    }

    /// Identity of the micropolygon in this row and column, at this depth.
    #[inline(always)]
    fn sample(&self, (row, column): Place, w: f32) -> Sample {
        let surface = self.draw.surface();
        Sample {
            depth: w.to_bits(),
            patch_id: surface.patch_id,
            u: surface.u + column as u32 * (surface.u_size() >> MAX_RATE_BITS),
            v: surface.v + row as u32 * (surface.v_size() >> MAX_RATE_BITS),
        }
    }

    /// Mean colour of the four vertices of a micropolygon.
    #[inline(always)]
    fn colour(&self, place: Place) -> Colour {
        let at = self.index(place);
        let below = at + self.grid.stride;
        let mut rgba = [1.0; 4];
        for k in 0..3 {
            let colour = &self.grid.colour[k];
            rgba[k] = mul(0.25, add(add(colour[at], colour[below + 1]), add(colour[at + 1], colour[below])));
        }
        Colour { rgba }
    }

    /// Samples [`LANES`] micropolygons of one row.
    #[inline(always)]
    fn block(&self, row: usize, block: usize, band: &mut Band<'_>) {
        let quads = Quads::new(self.grid, self.index((row, block)));
        let finds = quads.find();
        for l in 0..LANES.min(self.grid.stride - 1 - block) {
            let place = (row, block + l);
            match finds.state[l] {
                NOTHING => {}
                FOUND => {
                    let (x, y) = (quads.left[l], quads.top[l]);
                    if band.contains(x, y) {
                        band.put(x, y, self.sample(place, finds.w[l]), self.colour(place));
                    }
                }
                _ => self.micropolygon(place, quads.pixels(l), band),
            }
        }
    }

    /// Samples one quad of any size as the triangles a b c and a c d.
    #[inline(never)]
    fn micropolygon(&self, place: Place, pixels: [i32; 4], band: &mut Band<'_>) {
        let (row, column) = place;
        let places = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column)];
        let quad = places.map(|place| self.vertex(place));
        if quad.iter().any(|vertex| vertex.w == 0.0) {
            let [a, b, c, d] = places.map(|place| self.grid.point(self.index(place)));
            self.clipped([a, b, c], place, band);
            self.clipped([a, c, d], place, band);
            return;
        }
        let [left, right, top, bottom] = band.inside(pixels);
        for y in top..bottom {
            for x in left..right {
                if let Some(w) = sample_quad(quad, x, y) {
                    band.put(x, y, self.sample(place, w), self.colour(place));
                }
            }
        }
    }

    /// Clips a triangle and samples what is left of it, as a fan.
    #[cold]
    fn clipped(&self, triangle: [[f32; 3]; 3], place: Place, band: &mut Band<'_>) {
        let polygon = clip(self.frame, triangle);
        for k in 2..polygon.count {
            let fan = [0, k - 1, k].map(|k| project_clipped(self.frame, polygon.corners[k]));
            self.triangle(fan, place, band);
        }
    }

    /// Samples a triangle that belongs to the micropolygon at `place`.
    #[inline(always)]
    fn triangle(&self, triangle: [Vertex; 3], place: Place, band: &mut Band<'_>) {
        let [a, b, c] = triangle;
        let (left, right) = pixels_between(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (top, bottom) = pixels_between(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let [left, right, top, bottom] = band.inside([left, right, top, bottom]);
        for y in top..bottom {
            for x in left..right {
                if let Some(w) = sample_triangle(triangle, x, y) {
                    band.put(x, y, self.sample(place, w), self.colour(place));
                }
            }
        }
    }
}

/// 1 / distance at the centre of a pixel if one of the quad's two triangles, a b c and a c d, owns it; of
/// two that overlap, the nearer.
#[inline(always)]
fn sample_quad(quad: [Vertex; 4], column: i32, row: i32) -> Option<f32> {
    let [a, b, c, d] = [
        Corner::new(quad[0], column, row),
        Corner::new(quad[1], column, row),
        Corner::new(quad[2], column, row),
        Corner::new(quad[3], column, row),
    ];
    let diagonal = edge(c, a);
    let first = [edge(b, c), diagonal, edge(a, b)];
    let second = [edge(c, d), edge(d, a), -diagonal];
    match (owns([a, b, c], first), owns([a, c, d], second)) {
        (true, false) => Some(depth([a, b, c], first)),
        (false, true) => Some(depth([a, c, d], second)),
        (true, true) => Some(crate::num::max(depth([a, b, c], first), depth([a, c, d], second))),
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
