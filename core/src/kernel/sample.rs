//! sample: micropolygons become samples, one a pixel at its centre; the nearest wins.
//!
//! A micropolygon is two triangles. Where two are equally near the smaller identity (patch, u, v) wins, so
//! the image does not depend on the order in which surfaces arrive.

use crate::abi::{Colour, Draw, FLAG_CULL_BACKFACES, Frame, Sample};
use crate::kernel::clip::clip;
use crate::kernel::dice::Grid;
use crate::kernel::project::{Vertex, project_clipped};
use crate::kernel::triangle::{Triangle, pixels_between, signed_area};
use crate::num::{add, mul};

/// Rows `first_row` … of the image, `width` samples each.
#[derive(Debug)]
pub struct Band<'a> {
    /// Samples a row.
    pub width: u32,
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
        (self.first_row, self.first_row + (self.samples.len() / self.width as usize) as u32)
    }
}

/// Is `new` to be shown rather than `old`?
#[inline(always)]
#[must_use]
pub fn nearer(new: Sample, old: Sample) -> bool {
    if new.depth != old.depth {
        return new.depth > old.depth;
    }
    (new.patch, new.u, new.v) < (old.patch, old.u, old.v)
}

/// Samples all micropolygons of a shaded grid inside the band.
#[inline(always)]
pub fn sample<const ROW: usize>(frame: &Frame, draw: Draw, grid: &Grid<ROW>, band: &mut Band<'_>) {
    if frame.flags & FLAG_CULL_BACKFACES != 0 && faces_away(frame, grid) {
        return;
    }
    let surface = draw.surface();
    let (step_u, step_v) = (surface.u_size() / frame.rate, surface.v_size() / frame.rate);
    for row in 0..frame.rate as usize {
        let touched = touched_pixels(grid, row);
        for column in 0..frame.rate as usize {
            if !touched.reaches(column) {
                continue;
            }
            let micropolygon = Micropolygon {
                grid,
                row,
                column,
                identity: Sample {
                    depth: 0,
                    patch: draw.patch,
                    u: draw.u + column as u32 * step_u,
                    v: draw.v + row as u32 * step_v,
                },
            };
            if micropolygon.is_snapped() {
                micropolygon.sample_snapped(touched.pixels(column), band);
            } else {
                micropolygon.sample_clipped(frame, band);
            }
        }
    }
}

/// Pixels that each micropolygon of a row may own, by its bounding box.
struct Touched<const ROW: usize> {
    left: [i32; ROW],
    right: [i32; ROW],
    top: [i32; ROW],
    bottom: [i32; ROW],
}

impl<const ROW: usize> Touched<ROW> {
    #[inline(always)]
    fn reaches(&self, column: usize) -> bool {
        self.left[column] < self.right[column] && self.top[column] < self.bottom[column]
    }

    #[inline(always)]
    fn pixels(&self, column: usize) -> [i32; 4] {
        [self.left[column], self.right[column], self.top[column], self.bottom[column]]
    }
}

#[inline(always)]
fn touched_pixels<const ROW: usize>(grid: &Grid<ROW>, row: usize) -> Touched<ROW> {
    let mut out = Touched { left: [0; ROW], right: [0; ROW], top: [0; ROW], bottom: [0; ROW] };
    let corners = |at: &[[i32; ROW]], l: usize| [at[row][l], at[row][l + 1], at[row + 1][l], at[row + 1][l + 1]];
    for l in 0..ROW - 1 {
        let (low, high) = range(corners(&grid.x, l));
        (out.left[l], out.right[l]) = pixels_between(low, high);
        let (low, high) = range(corners(&grid.y, l));
        (out.top[l], out.bottom[l]) = pixels_between(low, high);
        let whole = (grid.w[row][l] > 0.0)
            & (grid.w[row][l + 1] > 0.0)
            & (grid.w[row + 1][l] > 0.0)
            & (grid.w[row + 1][l + 1] > 0.0);
        // What must be clipped first may be anywhere.
        out.left[l] = if whole { out.left[l] } else { 0 };
        out.right[l] = if whole { out.right[l] } else { 1 };
        out.top[l] = if whole { out.top[l] } else { 0 };
        out.bottom[l] = if whole { out.bottom[l] } else { 1 };
    }
    out
}

#[inline(always)]
fn range([a, b, c, d]: [i32; 4]) -> (i32, i32) {
    (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
}

/// One quad of a grid.
struct Micropolygon<'a, const ROW: usize> {
    grid: &'a Grid<ROW>,
    row: usize,
    column: usize,
    identity: Sample,
}

impl<const ROW: usize> Micropolygon<'_, ROW> {
    #[inline(always)]
    fn vertex(&self, down: usize, right: usize) -> Vertex {
        let (r, c) = (self.row + down, self.column + right);
        Vertex { x: self.grid.x[r][c], y: self.grid.y[r][c], w: self.grid.w[r][c] }
    }

    fn position(&self, down: usize, right: usize) -> [f32; 3] {
        [0, 1, 2].map(|k| self.grid.position[self.row + down][k][self.column + right])
    }

    #[inline(always)]
    fn is_snapped(&self) -> bool {
        [(0, 0), (0, 1), (1, 0), (1, 1)].iter().all(|&(d, r)| self.vertex(d, r).w > 0.0)
    }

    /// Mean colour of the four vertices.
    #[inline(always)]
    fn colour(&self) -> Colour {
        let (r, c) = (self.row, self.column);
        let [red, green, blue] = [0, 1, 2].map(|k| {
            let (here, below) = (&self.grid.colour[r][k], &self.grid.colour[r + 1][k]);
            mul(0.25, add(add(here[c], below[c + 1]), add(here[c + 1], below[c])))
        });
        Colour { rgba: [red, green, blue, 1.0] }
    }

    #[inline(always)]
    fn sample_snapped(&self, pixels: [i32; 4], band: &mut Band<'_>) {
        let (a, b) = (self.vertex(0, 0), self.vertex(0, 1));
        let (c, d) = (self.vertex(1, 1), self.vertex(1, 0));
        if let Some(triangle) = Triangle::new(a, b, c) {
            self.fill(&triangle, pixels, band);
        }
        if let Some(triangle) = Triangle::new(a, c, d) {
            self.fill(&triangle, pixels, band);
        }
    }

    /// Clips both triangles and samples what is left of them, as fans.
    #[cold]
    fn sample_clipped(&self, frame: &Frame, band: &mut Band<'_>) {
        let (a, b) = (self.position(0, 0), self.position(0, 1));
        let (c, d) = (self.position(1, 1), self.position(1, 0));
        for triangle in [[a, b, c], [a, c, d]] {
            let polygon = clip(frame, triangle);
            for k in 2..polygon.count {
                let fan = [0, k - 1, k].map(|k| project_clipped(frame, polygon.corners[k]));
                let (left, right) = pixel_range(fan.map(|v| v.x));
                let (top, bottom) = pixel_range(fan.map(|v| v.y));
                if let Some(triangle) = Triangle::new(fan[0], fan[1], fan[2]) {
                    self.fill(&triangle, [left, right, top, bottom], band);
                }
            }
        }
    }

    /// Samples a triangle at those of the given pixels that are inside the band.
    #[inline(always)]
    fn fill(&self, triangle: &Triangle, [left, right, top, bottom]: [i32; 4], band: &mut Band<'_>) {
        let (first_row, end_row) = band.rows();
        for row in top.max(first_row as i32)..bottom.min(end_row as i32) {
            for column in left.max(0)..right.min(band.width as i32) {
                if let Some(w) = triangle.sample(column, row) {
                    let place = (row as u32 - first_row) as usize * band.width as usize + column as usize;
                    let new = Sample { depth: w.to_bits(), ..self.identity };
                    if nearer(new, band.samples[place]) {
                        band.samples[place] = new;
                        band.colours[place] = self.colour();
                    }
                }
            }
        }
    }
}

fn pixel_range([a, b, c]: [i32; 3]) -> (i32, i32) {
    pixels_between(a.min(b).min(c), a.max(b).max(c))
}

/// Does no micropolygon of the grid face the eye? Block-level back-face culling (Weber 2014, sec. 4.4).
/// The front is the side from which u runs to the right where v runs up.
fn faces_away<const ROW: usize>(frame: &Frame, grid: &Grid<ROW>) -> bool {
    let vertex = |r: usize, c: usize| Vertex { x: grid.x[r][c], y: grid.y[r][c], w: grid.w[r][c] };
    let rate = frame.rate as usize;
    (0..rate).all(|r| {
        (0..rate).all(|c| {
            let quad = [vertex(r, c), vertex(r, c + 1), vertex(r + 1, c + 1), vertex(r + 1, c)];
            quad.iter().all(|v| v.w > 0.0)
                && signed_area(quad[0], quad[1], quad[2]) >= 0
                && signed_area(quad[0], quad[2], quad[3]) >= 0
        })
    })
}
