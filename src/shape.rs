//! Shapes: the patches of a mesh, in the space of its objects; any number of objects may have the same one.

use crate::cage::Patches;
use crate::gregory::GregoryPatch;

/// A bicubic Bézier patch: 16 control points, index `4·i + j` with `i` along u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BezierPatch {
    /// Control points in object space.
    pub points: [[f32; 3]; 16],
}

impl BezierPatch {
    /// Lets v run the other way, so that the back becomes the front.
    pub fn reverse(&mut self) {
        self.points.chunks_exact_mut(4).for_each(<[_]>::reverse);
    }
}

/// A rational bicubic Bézier patch: 16 control points and their weights, index `4·i + j` with `i` along u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RationalPatch {
    /// Control points in object space, not multiplied by their weights.
    pub points: [[f32; 3]; 16],
    /// Weights, above 0.
    pub weights: [f32; 16],
}

impl RationalPatch {
    /// Lets v run the other way, so that the back becomes the front.
    pub fn reverse(&mut self) {
        self.points.chunks_exact_mut(4).for_each(<[_]>::reverse);
        self.weights.chunks_exact_mut(4).for_each(<[_]>::reverse);
    }
}

/// A side of a Bézier patch that is one half of the side of another one, twice as large: where a cage was refined on one
/// side of an edge only. Sides are numbered as in [`micropoly_core::border`]: v = 0, v = 1, u = 0, u = 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfSide {
    /// Index of the small patch among the shape's Bézier patches.
    pub fine: u32,
    /// Its side.
    pub fine_side: u8,
    /// Index of the large patch among the shape's Bézier patches.
    pub coarse: u32,
    /// Its side.
    pub coarse_side: u8,
    /// Does the parameter along the small patch's side run against the large one's?
    pub is_reversed: bool,
    /// Is it the half of the large patch's side with the parameters from 1/2 to 1?
    pub is_second: bool,
}

/// Patches of all kinds; in this order they are numbered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Bézier patches.
    pub bezier: Vec<BezierPatch>,
    /// Rational Bézier patches.
    pub rational: Vec<RationalPatch>,
    /// Gregory patches.
    pub gregory: Vec<GregoryPatch>,
    /// Which sides of Bézier patches are halves of others.
    pub halves: Vec<HalfSide>,
    /// Are all patches polygons with three or four corners, those of three with the last one twice?
    pub is_polygons: bool,
}

impl Shape {
    /// Of Bézier patches.
    #[must_use]
    pub fn of_bezier(bezier: Vec<BezierPatch>) -> Self {
        Self { bezier, ..Self::default() }
    }

    /// Of polygons (see [`crate::polygon::polygons`]).
    #[must_use]
    pub fn of_polygons(bezier: Vec<BezierPatch>) -> Self {
        Self { bezier, is_polygons: true, ..Self::default() }
    }

    /// Of Gregory patches.
    #[must_use]
    pub fn of_gregory(gregory: Vec<GregoryPatch>) -> Self {
        Self { gregory, ..Self::default() }
    }

    /// Of rational patches: as Bézier patches if no weight says otherwise. All patches of a shape are of one kind, since
    /// borders between two kinds would differ in rounding.
    #[must_use]
    pub fn of_rational(rational: Vec<RationalPatch>) -> Self {
        if rational.iter().any(|patch| patch.weights != [1.0; 16]) {
            return Self { rational, ..Self::default() };
        }
        Self::of_bezier(rational.into_iter().map(|patch| BezierPatch { points: patch.points }).collect())
    }

    /// Number of its patches.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        self.bezier.len() + self.rational.len() + self.gregory.len()
    }

    /// Records that patches of some kinds need besides their own.
    pub(crate) fn extra_count(&self) -> usize {
        self.rational.len() + self.gregory.len()
    }

    /// Control points of all patches.
    pub fn points(&self) -> impl Iterator<Item = [f32; 3]> {
        let bezier = self.bezier.iter().flat_map(|patch| patch.points);
        let rational = self.rational.iter().flat_map(|patch| patch.points);
        bezier.chain(rational).chain(self.gregory.iter().flat_map(|patch| patch.points))
    }

    /// Are all weights above 0, and what halves name there?
    pub(crate) fn is_sound(&self) -> bool {
        let weights = self.rational.iter().flat_map(|patch| patch.weights);
        let count = self.bezier.len();
        weights.into_iter().all(|weight| weight > 0.0 && weight.is_finite())
            && self.halves.iter().all(|half| {
                (half.fine as usize) < count
                    && (half.coarse as usize) < count
                    && half.fine_side < 4
                    && half.coarse_side < 4
            })
    }

    /// Lets v run the other way in all patches, so that the back becomes the front.
    pub fn reverse(&mut self) {
        self.bezier.iter_mut().for_each(BezierPatch::reverse);
        self.rational.iter_mut().for_each(RationalPatch::reverse);
        self.gregory.iter_mut().for_each(GregoryPatch::reverse);
        self.halves.iter_mut().for_each(HalfSide::reverse);
    }
}

impl From<Patches> for Shape {
    fn from(Patches { bezier, gregory, halves, .. }: Patches) -> Self {
        Self { bezier, gregory, halves, ..Self::default() }
    }
}

impl HalfSide {
    /// Sides of constant v change places; along the others, parameters run the other way.
    fn reverse(&mut self) {
        let turned = |side: u8| if side < 2 { 1 - side } else { side };
        let (fine_turns, coarse_turns) = (self.fine_side >= 2, self.coarse_side >= 2);
        (self.fine_side, self.coarse_side) = (turned(self.fine_side), turned(self.coarse_side));
        self.is_reversed ^= fine_turns != coarse_turns;
        self.is_second ^= coarse_turns;
    }
}
