//! Shapes: the patches of a mesh, in the space of its objects; any number of objects may have the same one.

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

/// Patches of all kinds.
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
}
