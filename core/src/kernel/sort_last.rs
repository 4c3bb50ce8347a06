//! sort-last: samples of grids that are drawn at the same time, anywhere, are merged without locks.
//!
//! All grids are sampled once a [`Turn`]. In the first, each sample's key gets the largest depth of all that hit it; in the
//! next, of those that have that depth the smallest patch; then the smallest u, then the smallest v. Maximum and minimum do
//! not depend on who comes first. In the last turn the one micropolygon whose identity is the key's shows its colour, if it
//! is nearer than what was there before ([`merge`]).

use crate::abi::{Colour, Sample};
use crate::kernel::sample::nearer;

/// A key before anything hit the sample.
pub const NOBODY: Sample = Sample { depth: 0, patch_id: u32::MAX, u: u32::MAX, v: u32::MAX };

/// What is looked for while all grids are sampled once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The largest depth.
    Depth,
    /// Of those that have it, the smallest patch.
    Patch,
    /// Of those, the smallest u.
    U,
    /// Of those, the smallest v.
    V,
    /// The colour of the one that is left.
    Colour,
}

impl Turn {
    /// All of them, in order.
    pub const ALL: [Self; 5] = [Self::Depth, Self::Patch, Self::U, Self::V, Self::Colour];

    /// Is a hit still in question, given the key so far?
    #[inline(always)]
    #[must_use]
    pub fn concerns(self, new: Sample, key: Sample) -> bool {
        let depth = new.depth == key.depth;
        let patch = depth && new.patch_id == key.patch_id;
        let u = patch && new.u == key.u;
        match self {
            Self::Depth => true,
            Self::Patch => depth,
            Self::U => patch,
            Self::V => u,
            Self::Colour => u && new.v == key.v,
        }
    }
}

/// The sample after the last turn, and whether it is another than before.
#[inline(always)]
#[must_use]
pub fn merge(key: Sample, before: Sample) -> (Sample, bool) {
    let is_new = key.depth != 0 && nearer(key, before);
    (if is_new { key } else { before }, is_new)
}

/// The colour of a sample after the last turn, if the hit that shows `colour` is the one that is left.
#[inline(always)]
#[must_use]
pub fn shown(new: Sample, key: Sample, before: Sample, colour: Colour) -> Option<Colour> {
    (Turn::Colour.concerns(new, key) && nearer(key, before)).then_some(colour)
}
