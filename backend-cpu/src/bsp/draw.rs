//! Pieces in order become samples: bands of rows, a thread each, near to far until nothing more can be seen.

#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use micropoly_core::abi::{Colour, FLAG_CULL_BACKFACES, Frame, Object, Sample};
use micropoly_core::accel::bsp::polygon::{Corner, whole};
use micropoly_core::accel::bsp::show::{Eye, Face};
use micropoly_core::accel::bsp::sight::{Glance, Sight};
use micropoly_core::kernel::blend::{Layers, blend};
use micropoly_core::kernel::dice::LANES;
use micropoly_core::kernel::shade::colours;
use micropoly_core::kernel::triangle::{samples_between, site};
use multiversion::multiversion;
use rayon::prelude::*;

use super::clip::Clipper;
use super::{BspGrid, BspOrder};
use crate::device::CpuDevice;

/// Rows of samples of a band.
const BAND: usize = 16;
/// What is seen of a piece is found this many snapped units around it, too: rounding stays far below.
const MARGIN: f64 = 2.0;

/// What is behind something else.
const BEHIND: Sample = Sample { depth: 1, patch_id: 0, u: 0, v: 0 };

/// What an eye sees of all pieces, whatever part of the image is drawn.
#[derive(Clone, Debug)]
pub struct BspSight {
    /// The eye.
    pub eye: Eye,
    /// All pieces, far to near.
    pub order: Vec<u32>,
    /// Where each may be: columns and rows of snapped units, the first and the last; empty ones have a first beyond the last.
    boxes: Vec<[[i32; 2]; 2]>,
}

/// Pieces in order, and how they are seen.
#[derive(Clone, Copy, Debug)]
pub struct BspShot<'a> {
    /// The pieces.
    pub grid: &'a BspGrid,
    /// What each triangle is seen as.
    pub faces: &'a [Face],
    /// From where.
    pub sight: &'a BspSight,
    /// Samples, lights and the near plane.
    pub frame: &'a Frame,
    /// Colours and opacities.
    pub objects: &'a [Object],
}

impl CpuDevice {
    /// Finds the order of all pieces, and where they may be seen from this distance on.
    #[must_use]
    pub fn see_bsp(&self, grid: &BspGrid, eye: Eye, near: f64) -> BspSight {
        let mut order = BspOrder::default();
        self.sort_bsp(grid, eye.view.eye, &mut order);
        let pieces = (0..grid.pieces.len() as u32).into_par_iter().with_min_len(1024);
        let boxes = self.install(|| pieces.map(|piece| grid.box_of(piece, &eye, near)).collect());
        BspSight { eye, order: order.pieces, boxes }
    }

    /// Blends all that is seen at each sample of the frame, in order: what is nearest goes to `front`, the colour of all
    /// to `layers`, in the places that the frame has for them.
    pub fn draw_bsp(&self, shot: &BspShot<'_>, front: &mut [Sample], layers: &mut [Colour]) {
        self.install(|| draw(shot, front, layers));
    }
}

fn draw(shot: &BspShot<'_>, front: &mut [Sample], layers: &mut [Colour]) {
    let row = shot.frame.place_row as usize;
    if row == 0 {
        return;
    }
    let bands = front.par_chunks_mut(row * BAND).zip(layers.par_chunks_mut(row * BAND));
    bands.enumerate().for_each(|(number, (front, layers))| {
        let top = shot.frame.sample_top as i32 + (number * BAND) as i32;
        let mut band =
            Band { shot, top, front, layers, lines: Vec::new(), glances: Vec::new(), waiting: Vec::new() };
        for &piece in shot.sight.order.iter().rev() {
            let [left, right, first, end] = shot.samples_of(piece);
            let rows = [first.max(top), end.min(top + BAND as i32)];
            if left < right && rows[0] < rows[1] {
                band.draw(piece, [left, right], rows);
            }
        }
    });
}

impl BspShot<'_> {
    /// The samples that may show something of a piece: left, right, top, bottom.
    fn samples_of(&self, piece: u32) -> [i32; 4] {
        let frame = self.frame;
        let [columns, rows] = self.sight.boxes[piece as usize];
        let along = |[low, high]: [i32; 2], first: u32, end: u32| {
            let (from, to) = samples_between(frame, low, high);
            [from.max(first as i32), to.min(end as i32)]
        };
        let [left, right] = along(columns, frame.sample_left, frame.sample_right);
        let [top, bottom] = along(rows, frame.sample_top, frame.sample_bottom);
        [left, right, top, bottom]
    }
}

/// First and last column, first and last row of what of a polygon is at least so far away.
fn around(places: &[[f64; 3]], near: f64) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let mut add = |[depth, x, y]: [f64; 3]| {
        for (axis, at) in [x / depth, y / depth].into_iter().enumerate() {
            bounds[axis] = [bounds[axis][0].min(at), bounds[axis][1].max(at)];
        }
    };
    for (k, &here) in places.iter().enumerate() {
        let there = places[(k + 1) % places.len()];
        if here[0] >= near {
            add(here);
        }
        if (here[0] >= near) != (there[0] >= near) {
            let share = (near - here[0]) / (there[0] - here[0]);
            let between = |axis: usize| here[axis] + share * (there[axis] - here[axis]);
            add([near, between(1), between(2)]);
        }
    }
    bounds
}

/// As core's `colours`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
fn shaded(
    frame: &Frame,
    object: &Object,
    points: [[f32; LANES]; 3],
    normals: [[f32; LANES]; 3],
) -> [[f32; LANES]; 3] {
    colours(frame, object, points, normals)
}

/// A hit that has no colour yet.
struct Hit {
    place: usize,
    sample: Sample,
    point: [f32; 3],
}

struct Band<'a> {
    shot: &'a BspShot<'a>,
    top: i32,
    front: &'a mut [Sample],
    layers: &'a mut [Colour],
    lines: Vec<[i64; 3]>,
    glances: Vec<Glance>,
    waiting: Vec<Hit>,
}

impl Band<'_> {
    /// Blends what is seen of a piece in some columns and rows.
    fn draw(&mut self, piece: u32, [left, right]: [i32; 2], [top, bottom]: [i32; 2]) {
        let BspShot { grid, faces, frame, sight: BspSight { eye, .. }, .. } = *self.shot;
        let number = grid.pieces[piece as usize].triangle as usize;
        let Some(sight) = Sight::new(&eye.view, &grid.triangles[number]) else { return };
        if frame.flags & FLAG_CULL_BACKFACES != 0 && !grid.planes[number].is_before(eye.view.eye) {
            return;
        }
        self.lines.clear();
        self.lines.extend(grid.cuts_of(piece).iter().map(|cut| grid.line(number, *cut)));
        self.glances.clear();
        self.glances.extend([[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|side| sight.glance(side)));
        self.glances.extend(self.lines.iter().map(|line| sight.glance(*line)));
        for y in top..bottom {
            for x in left..right {
                let (at, place) = (site(frame, x, y), self.place(x, y));
                if self.layers[place].rgba[3] >= 1.0 {
                    continue;
                }
                let Some(weights) = self.hit(&sight, at) else { continue };
                let depth = eye.depth(sight.distance(weights));
                if depth >= f64::from(frame.near) {
                    // Only of what is nearest anybody asks where it is.
                    let is_first = self.front[place].depth == 0;
                    let sample = if is_first { faces[number].sample(weights, depth) } else { BEHIND };
                    self.waiting.push(Hit { place, sample, point: eye.point(at, depth) });
                }
            }
        }
        if !self.waiting.is_empty() {
            let object = &self.shot.objects[faces[number].object as usize];
            self.blend(object, eye.normal(&grid.planes[number]));
        }
    }

    /// Weights of the corners, if the piece is hit: mostly a glance is enough to say that it is not.
    #[inline(always)]
    fn hit(&self, sight: &Sight, at: [i32; 2]) -> Option<[i128; 3]> {
        let [x, y] = at.map(f64::from);
        let mut is_sure = true;
        for glance in &self.glances {
            let is_within = glance.is_within(x, y);
            if is_within == Some(false) {
                return None;
            }
            is_sure &= is_within.is_some();
        }
        let weights = sight.hit(at[0], at[1])?;
        let is_within = is_sure || self.lines.iter().all(|line| sight.is_within(weights, *line));
        is_within.then_some(weights)
    }

    fn place(&self, x: i32, y: i32) -> usize {
        let frame = self.shot.frame;
        let (column, row) = ((x - frame.sample_left as i32) as usize, (y - self.top) as usize);
        frame.place_first as usize + column * frame.place_column as usize + row * frame.place_row as usize
    }

    /// Colours what waits, and puts it behind what is there.
    fn blend(&mut self, object: &Object, normal: [f32; 3]) {
        let normals = normal.map(|c| [c; LANES]);
        for hits in self.waiting.chunks(LANES) {
            let points =
                std::array::from_fn(|k| std::array::from_fn(|l| hits[l.min(hits.len() - 1)].point[k]));
            let rgb = shaded(self.shot.frame, object, points, normals);
            for (l, hit) in hits.iter().enumerate() {
                let colour = Colour { rgba: [rgb[0][l], rgb[1][l], rgb[2][l], object.opacity] };
                let (front, all) = (&mut self.front[hit.place], &mut self.layers[hit.place]);
                let before = Layers { behind: Sample::default(), front: *front, colour: *all };
                let (after, _) = blend(before, hit.sample, colour);
                (*front, *all) = (after.front, after.colour);
            }
        }
        self.waiting.clear();
    }
}

impl BspGrid {
    /// Columns and rows of snapped units in which a piece may be seen.
    fn box_of(&self, piece: u32, eye: &Eye, near: f64) -> [[i32; 2]; 2] {
        let mut corners = Vec::new();
        self.corners_of(piece, &mut corners);
        let places: Vec<[f64; 3]> = corners.iter().map(|corner| eye.project(corner.at)).collect();
        // No image is as large as that; where nothing is, the first is beyond the last.
        let limited = |c: f64| c.clamp(-1.0e8, 1.0e8) as i32;
        around(&places, 0.5 * near).map(|[low, high]| [limited(low - MARGIN), limited(high + MARGIN)])
    }

    /// The corners of a piece; none if there is nothing between its cuts.
    pub fn corners_of(&self, piece: u32, corners: &mut Vec<Corner>) {
        let triangle = &self.triangles[self.pieces[piece as usize].triangle as usize];
        let mut clipper = Clipper::default();
        clipper.piece.extend(whole(triangle));
        for cut in self.cuts_of(piece) {
            clipper.clip(triangle, &self.plane(*cut), *cut);
        }
        *corners = clipper.piece;
    }
}
