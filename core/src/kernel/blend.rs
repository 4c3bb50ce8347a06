//! blend: the layer that was just found goes behind those that were found before (front to back, Porter & Duff 1984).
//!
//! What can be seen through is found layer by layer (depth peeling, Everitt 2001): each pass finds, at every sample, the
//! nearest micropolygon behind the last one that was found there, by the same order of depth and identity as everything
//! else. So a sample's list has one entry at a time, nothing overflows and nothing is dropped: there are as many passes as
//! there are layers before something opaque.

use crate::abi::{Colour, OPAQUE_DEPTH, Sample};
use crate::num::{add, mul, sub};

/// What is known of one sample between two passes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layers {
    /// The last layer that was found: the next one is behind it.
    pub behind: Sample,
    /// The first layer.
    pub front: Sample,
    /// All layers so far: linear RGB times opacity, and opacity.
    pub colour: Colour,
}

/// Puts what a pass found at a sample behind the layers before it; says whether there may be more behind it.
#[inline(always)]
#[must_use]
pub fn blend(layers: Layers, found: Sample, colour: Colour) -> (Layers, bool) {
    if found.depth == 0 {
        return (layers, false);
    }
    let front = if layers.front.depth == 0 { found } else { layers.front };
    let opacity = colour.rgba[3];
    let share = mul(sub(1.0, layers.colour.rgba[3]), opacity);
    let mut rgba = layers.colour.rgba;
    for k in 0..3 {
        rgba[k] = add(rgba[k], mul(share, colour.rgba[k]));
    }
    let is_opaque = opacity >= 1.0;
    rgba[3] = if is_opaque { 1.0 } else { add(rgba[3], share) };
    let end = Sample { depth: OPAQUE_DEPTH, ..found };
    let behind = if is_opaque { end } else { found };
    (Layers { behind, front, colour: Colour { rgba } }, !is_opaque)
}

/// Is `new` behind the last layer that was found?
#[inline(always)]
#[must_use]
pub fn is_behind(new: Sample, last: Sample) -> bool {
    if last.depth == 0 {
        return true;
    }
    if new.depth != last.depth {
        return new.depth < last.depth;
    }
    (new.patch_id, new.u, new.v) > (last.patch_id, last.u, last.v)
}
