//! Triangles are cut into the cells of a grid: each thread fills a list of parts, then they are counted into cells.

use micropoly_core::accel::bsp::cells::{slab_of, slab_plane, slabs_of};
use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cutter, Knife, side, whole};
use rayon::prelude::*;

/// Triangles that one thread cuts in a row.
const TRIANGLES_AT_ONCE: usize = 2048;

/// A part of a triangle: some corners of a list; none if it is all of the triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) triangle: u32,
    pub(super) first: u32,
    pub(super) count: u32,
}

impl Part {
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

    /// Copies the parts of a cell, all with corners.
    pub(super) fn copy(
        &self,
        cell: usize,
        triangles: &[[Point; 3]],
        parts: &mut Vec<Part>,
        corners: &mut Vec<Corner>,
    ) {
        for &(share, part) in &self.places[self.first[cell] as usize..self.first[cell + 1] as usize] {
            let share = &self.shares[share as usize];
            let part = share.parts[part as usize];
            let first = corners.len() as u32;
            if part.count == 0 {
                corners.extend(whole(&triangles[part.triangle as usize]));
            } else {
                corners.extend_from_slice(part.corners(&share.corners));
            }
            parts.push(Part { first, count: corners.len() as u32 - first, ..part });
        }
    }
}

pub(super) fn into_cells(triangles: &[[Point; 3]], planes: &[Plane], slabs: &[Vec<i32>; 3]) -> Parts {
    let numbers: Vec<u32> = (0..triangles.len() as u32).filter(|k| !planes[*k as usize].is_none()).collect();
    let shares: Vec<Share> = numbers
        .par_chunks(TRIANGLES_AT_ONCE)
        .map(|numbers| {
            let mut cutter = Slicer { slabs, share: Share::default(), sides: Vec::new(), spare: Vec::new() };
            numbers.iter().for_each(|&number| cutter.cut(number, &triangles[number as usize]));
            cutter.share
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
}

impl Slicer<'_> {
    fn cut(&mut self, number: u32, triangle: &[Point; 3]) {
        let ranges = [0, 1, 2].map(|axis| slabs_of(&self.slabs[axis], axis, triangle));
        if ranges.iter().all(|[first, last]| first == last) {
            self.keep(number, ranges.map(|[first, _]| first), &[]);
        } else {
            self.along(0, [0; 3], number, triangle, whole(triangle).to_vec());
        }
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
        knife.split(piece, cutter, |corner| before.push(corner), |corner| behind.push(corner));
        behind
    }

    /// Notes on which sides of a plane the corners of a piece are; says whether some are behind and before it.
    fn sides(&mut self, triangle: &[Point; 3], piece: &[Corner], plane: &Plane) -> (bool, bool) {
        let rough = Rough::of(plane);
        self.sides.clear();
        self.sides.extend((0..piece.len()).map(|k| side(triangle, piece, k, plane, &rough) as i8));
        (self.sides.contains(&-1), self.sides.contains(&1))
    }

    fn keep(&mut self, triangle: u32, [x, y, z]: [u32; 3], piece: &[Corner]) {
        let [_, rows, columns] = [0, 1, 2].map(|axis| self.slabs[axis].len() as u32);
        let Share { parts, cells, corners } = &mut self.share;
        cells.push((x * rows + y) * columns + z);
        parts.push(Part { triangle, first: corners.len() as u32, count: piece.len() as u32 });
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
