//! A piece that planes cut, one after the other; with lists to be used again.

use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cut, Cutter, Knife, side};

#[derive(Default)]
pub(super) struct Clipper {
    pub(super) piece: Vec<Corner>,
    sides: Vec<i8>,
    /// What of the piece is before the last plane, and behind it.
    pub(super) halves: [Vec<Corner>; 2],
}

impl Clipper {
    /// Cuts the piece in two.
    pub(super) fn cut(&mut self, triangle: &[Point; 3], plane: &Plane, rough: &Rough, cutter: Cutter) {
        let Self { piece, sides, halves } = self;
        sides.clear();
        sides.extend((0..piece.len()).map(|k| side(triangle, piece, k, plane, rough) as i8));
        halves.iter_mut().for_each(Vec::clear);
        if let Some(half) = uncut(sides) {
            return std::mem::swap(piece, &mut halves[half]);
        }
        let knife = Knife { triangle, line: plane.values(*triangle), sides };
        knife.split(piece, cutter, |half, corner, _| halves[half].push(corner));
    }

    /// Keeps what of the piece is on the right side of a cut's plane.
    pub(super) fn clip(&mut self, triangle: &[Point; 3], plane: &Plane, cut: Cut) {
        self.cut(triangle, plane, &Rough::of(plane), cut.cutter());
        std::mem::swap(&mut self.piece, &mut self.halves[usize::from(cut.keeps_back())]);
    }
}

/// The half that is all of a piece, if a plane does not cut it: 0 before the plane, 1 behind it.
pub(super) fn uncut(sides: &[i8]) -> Option<usize> {
    match (sides.contains(&1), sides.contains(&-1)) {
        (true, true) => None,
        (true, false) => Some(0),
        (false, _) => Some(1),
    }
}
