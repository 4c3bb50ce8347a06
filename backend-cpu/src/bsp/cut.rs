//! Triangles go to the cells of a grid: each thread fills a list of parts, then they are counted into cells.
//!
//! What is about as large as a cell or smaller stays whole in each cell that it touches, with the planes between cells as
//! cuts: nothing is rounded, and few trees cut it where it is not. What is larger is cut to size.

use micropoly_core::accel::bsp::cells::{quadrants, slab_of, slab_plane, slabs_of};
use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cut, Cutter, Knife, side, whole};
use rayon::prelude::*;

/// Triangles that one thread cuts in a row.
const TRIANGLES_AT_ONCE: usize = 2048;

/// A part of a triangle: some corners of a list, and of that what is between some slabs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) triangle: u32,
    pub(super) first: u32,
    /// So many corners; those of a whole triangle are not in the list.
    pub(super) count: u32,
    /// Cuts by slabs that its corners do not have.
    pub(super) slabs: [Cut; 3],
}

impl Part {
    pub(super) const fn is_whole(self) -> bool {
        self.count == 0
    }

    pub(super) fn corners(self, list: &[Corner]) -> &[Corner] {
        &list[self.first as usize..][..self.count as usize]
    }
}

/// What one thread cut: parts, their cells and corners.
#[derive(Default)]
struct Share {
    parts: Vec<Part>,
    cells: Vec<u32>,
    corners: Vec<Corner>,
}

/// Parts by cells.
pub(super) struct Parts {
    shares: Vec<Share>,
    /// First part of each cell, and one past the last.
    first: Vec<u32>,
    /// Share and part, cell by cell, lower triangles first.
    places: Vec<(u32, u32)>,
}

impl Parts {
    pub(super) fn cells(&self) -> usize {
        self.first.len() - 1
    }

    pub(super) fn count(&self) -> usize {
        self.places.len()
    }

    pub(super) fn count_in(&self, cell: usize) -> usize {
        (self.first[cell + 1] - self.first[cell]) as usize
    }

    /// Copies the parts of a cell.
    pub(super) fn copy(&self, cell: usize, parts: &mut Vec<Part>, corners: &mut Vec<Corner>) {
        for &(share, part) in &self.places[self.first[cell] as usize..self.first[cell + 1] as usize] {
            let share = &self.shares[share as usize];
            let part = share.parts[part as usize];
            parts.push(Part { first: corners.len() as u32, ..part });
            corners.extend_from_slice(part.corners(&share.corners));
        }
    }
}

pub(super) fn into_cells(triangles: &[[Point; 3]], planes: &[Plane], slabs: &[Vec<i32>; 3]) -> Parts {
    let shares: Vec<Share> = triangles
        .par_chunks(TRIANGLES_AT_ONCE)
        .enumerate()
        .map(|(chunk, some)| {
            let mut slicer = Slicer::new(slabs);
            for (number, triangle) in (chunk * TRIANGLES_AT_ONCE..).zip(some) {
                if !planes[number].is_none() {
                    slicer.cut(number as u32, triangle);
                }
            }
            slicer.share
        })
        .collect();
    let cells = slabs.iter().map(Vec::len).product();
    by_cells(shares, cells)
}

/// Counts, sums up, fills.
fn by_cells(shares: Vec<Share>, cells: usize) -> Parts {
    let mut first = vec![0; cells + 1];
    for cell in shares.iter().flat_map(|share| &share.cells) {
        first[*cell as usize + 1] += 1;
    }
    for cell in 0..cells {
        first[cell + 1] += first[cell];
    }
    let mut next = first.clone();
    let mut places = vec![(0, 0); first[cells] as usize];
    for (number, share) in (0..).zip(&shares) {
        for (part, cell) in (0..).zip(&share.cells) {
            let place = &mut next[*cell as usize];
            places[*place as usize] = (number, part);
            *place += 1;
        }
    }
    Parts { shares, first, places }
}

/// Cuts triangles along x, then y, then z.
struct Slicer<'a> {
    slabs: &'a [Vec<i32>; 3],
    share: Share,
    sides: Vec<i8>,
    /// Lists to be used again.
    spare: Vec<Vec<Corner>>,
    /// First and last slab of the triangle along each axis.
    ranges: [[u32; 2]; 3],
}

impl<'a> Slicer<'a> {
    fn new(slabs: &'a [Vec<i32>; 3]) -> Self {
        let (sides, spare, corners) = Default::default();
        let share = Share {
            parts: Vec::with_capacity(2 * TRIANGLES_AT_ONCE),
            cells: Vec::with_capacity(2 * TRIANGLES_AT_ONCE),
            corners,
        };
        Self { slabs, share, sides, spare, ranges: [[0; 2]; 3] }
    }

    fn cut(&mut self, number: u32, triangle: &[Point; 3]) {
        let [x, y, z] = self.slabs;
        self.ranges = [slabs_of(x, 0, triangle), slabs_of(y, 1, triangle), slabs_of(z, 2, triangle)];
        let [x, y, z] = self.ranges.map(|[first, last]| last - first);
        match [x, y, z] {
            [0, 0, 0] => self.keep_whole(number, [0; 3]),
            [1, 0, 0] | [0, 1, 0] | [0, 0, 1] => {
                self.keep_whole(number, [0; 3]);
                self.keep_whole(number, [x, y, z]);
            }
            [1, 1, 0] => self.cut_across(number, triangle, [0, 1]),
            [1, 0, 1] => self.cut_across(number, triangle, [0, 2]),
            [0, 1, 1] => self.cut_across(number, triangle, [1, 2]),
            _ => {
                let mut piece = self.spare.pop().unwrap_or_default();
                piece.clear();
                piece.extend(whole(triangle));
                self.along(0, [0; 3], number, triangle, piece);
            }
        }
    }

    /// A triangle that spans two slabs along two axes.
    fn cut_across(&mut self, number: u32, triangle: &[Point; 3], axes: [usize; 2]) {
        let end = |axis: usize| 2 * self.slabs[axis][self.ranges[axis][0] as usize] + 1;
        let touched = quadrants(triangle, axes, [end(axes[0]), end(axes[1])]);
        for quadrant in (0..4).filter(|quadrant| touched >> quadrant & 1 == 1) {
            let mut beyond = [0; 3];
            (beyond[axes[0]], beyond[axes[1]]) = (quadrant & 1, quadrant >> 1);
            self.keep_whole(number, beyond);
        }
    }

    /// Keeps a triangle whole in a cell: of the two slabs along each axis in the second, or in the first (or the only) one.
    fn keep_whole(&mut self, triangle: u32, beyond: [u32; 3]) {
        let (mut slabs, mut cell) = ([Cut::NONE; 3], [0; 3]);
        for axis in 0..3 {
            let [slab, last] = self.ranges[axis];
            cell[axis] = slab + beyond[axis];
            if slab < last {
                slabs[axis] = Cut::new(Cutter::Slab { axis, slab }, beyond[axis] == 0);
            }
        }
        self.share.cells.push(self.number(cell));
        self.share.parts.push(Part { triangle, first: 0, count: 0, slabs });
    }

    fn number(&self, [x, y, z]: [u32; 3]) -> u32 {
        (x * self.slabs[1].len() as u32 + y) * self.slabs[2].len() as u32 + z
    }

    /// Cuts a piece along an axis and those behind it.
    fn along(
        &mut self,
        axis: usize,
        mut cell: [u32; 3],
        number: u32,
        triangle: &[Point; 3],
        mut piece: Vec<Corner>,
    ) {
        if axis == 3 {
            self.keep(number, cell, &piece);
            self.spare.push(piece);
            return;
        }
        let [first, last] = touched(&self.slabs[axis], axis, &piece);
        for slab in first..last {
            let plane = slab_plane(&self.slabs[axis], axis, slab);
            cell[axis] = slab;
            match self.sides(triangle, &piece, &plane) {
                (_, false) => return self.along(axis + 1, cell, number, triangle, piece),
                (false, true) => {}
                (true, true) => {
                    let later = self.spare.pop().unwrap_or_default();
                    let whole = std::mem::replace(&mut piece, later);
                    let kept = self.split(triangle, &whole, &plane, Cutter::Slab { axis, slab }, &mut piece);
                    self.spare.push(whole);
                    self.along(axis + 1, cell, number, triangle, kept);
                }
            }
        }
        cell[axis] = last;
        self.along(axis + 1, cell, number, triangle, piece);
    }

    /// Cuts a piece whose sides are noted: gives what is behind the plane; what is before it goes to a list.
    fn split(
        &mut self,
        triangle: &[Point; 3],
        piece: &[Corner],
        plane: &Plane,
        cutter: Cutter,
        before: &mut Vec<Corner>,
    ) -> Vec<Corner> {
        let mut behind = self.spare.pop().unwrap_or_default();
        before.clear();
        behind.clear();
        let knife = Knife { triangle, line: plane.values(*triangle), sides: &self.sides };
        let mut halves = [before, &mut behind];
        knife.split(piece, cutter, |half, corner, _| halves[half].push(corner));
        behind
    }

    /// Notes on which sides of a plane the corners of a piece are; says whether some are behind and before it.
    fn sides(&mut self, triangle: &[Point; 3], piece: &[Corner], plane: &Plane) -> (bool, bool) {
        let rough = Rough::of(plane);
        self.sides.clear();
        self.sides.extend((0..piece.len()).map(|k| side(triangle, piece, k, plane, &rough) as i8));
        (self.sides.contains(&-1), self.sides.contains(&1))
    }

    /// Keeps what was cut: its corners only if the triangle is large.
    fn keep(&mut self, triangle: u32, cell: [u32; 3], piece: &[Corner]) {
        if self.ranges.iter().all(|[first, last]| last - first <= 1) {
            return self.keep_whole(triangle, [0, 1, 2].map(|axis| cell[axis] - self.ranges[axis][0]));
        }
        self.share.cells.push(self.number(cell));
        let Share { parts, corners, .. } = &mut self.share;
        let (first, count) = (corners.len() as u32, piece.len() as u32);
        parts.push(Part { triangle, first, count, slabs: [Cut::NONE; 3] });
        corners.extend_from_slice(piece);
    }
}

/// First and last slab that a piece may touch. What floats say is right to less than the quarter by which they are widened.
fn touched(ends: &[i32], axis: usize, piece: &[Corner]) -> [u32; 2] {
    let at = |corner: &Corner| corner.at[axis];
    let low = piece.iter().map(at).fold(f64::INFINITY, f64::min) - 0.25;
    let high = piece.iter().map(at).fold(f64::NEG_INFINITY, f64::max) + 0.25;
    let last = ends.len() as u32 - 1;
    [slab_of(ends, libm::floor(low) as i64), slab_of(ends, libm::ceil(high) as i64)]
        .map(|slab| slab.min(last))
}
