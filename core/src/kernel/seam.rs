//! Seams: slivers that close the gap where a border meets a coarser one.
//!
//! Two surfaces that share a border may have been split differently often, so one has vertices between two
//! neighbouring vertices of the other. All vertices are dyadic, so the coarser border is one of the chords
//! that arise by leaving out every other vertex, again and again. The finer side draws the triangles
//! between its vertices and these chords, up to the longest chord that any surface drawn along this border
//! can have. That depends on the border alone, so both sides end at the same chords.

use crate::abi::{FAR_OFF, Frame, LENGTH_TINY, PARAM_ONE, SEAM_ALLOWANCE, Surface};
use crate::kernel::dice::position_at;
use crate::kernel::project::perspective;
use crate::num::{add, clamp, mul, neg, sqrt, sub};
use crate::patch::Net;
use crate::patch::bezier::{blend4, blossom, cubic, param};

/// How one border of a grid is closed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seam {
    /// Longest chord that a neighbour can have, in steps of this border: a power of two; 1 = no seam.
    pub longest: u32,
    /// Ends, in eye space, of the chord beyond this border whose middle is the border's upper corner; only
    /// where it is not longer than the longest.
    pub chord: Option<[[f32; 3]; 2]>,
}

/// The seams along the borders v = low, v = high, u = low and u = high of a surface.
#[inline(always)]
#[must_use]
pub fn seams(net: &Net, frame: &Frame, surface: Surface) -> [Seam; 4] {
    let Surface { u, v, .. } = surface;
    let (size_u, size_v) = (surface.u_size(), surface.v_size());
    [
        seam_along_u(net, frame, u, size_u, v),
        seam_along_u(net, frame, u, size_u, v + size_v),
        seam_along_v(net, frame, u, v, size_v),
        seam_along_v(net, frame, u + size_u, v, size_v),
    ]
}

#[inline(always)]
fn seam_along_u(net: &Net, frame: &Frame, u: u32, size: u32, v: u32) -> Seam {
    let weights = cubic(param(v));
    let mut curve = [[0.0; 4]; 3];
    for (curve, c) in curve.iter_mut().zip([&net.x, &net.y, &net.z]) {
        for i in 0..4 {
            curve[i] = blend4(weights, [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]]);
        }
    }
    let (longest, beyond) = longest_chord(frame, &curve, u, size);
    let chord = beyond.map(|(low, high)| [position_at(net, low, v), position_at(net, high, v)]);
    Seam { longest, chord }
}

#[inline(always)]
fn seam_along_v(net: &Net, frame: &Frame, u: u32, v: u32, size: u32) -> Seam {
    let weights = cubic(param(u));
    let mut curve = [[0.0; 4]; 3];
    for (curve, c) in curve.iter_mut().zip([&net.x, &net.y, &net.z]) {
        for j in 0..4 {
            curve[j] = blend4(weights, [c[j], c[4 + j], c[8 + j], c[12 + j]]);
        }
    }
    let (longest, beyond) = longest_chord(frame, &curve, v, size);
    let chord = beyond.map(|(low, high)| [position_at(net, u, low), position_at(net, u, high)]);
    Seam { longest, chord }
}

/// The longest chord in steps of the border from `start` on, and the range of the chord that has the
/// border's end in its middle, if it is not longer.
///
/// A neighbour's border is an ancestor of this one; one that is too long to be drawn was split.
#[inline(always)]
fn longest_chord(frame: &Frame, curve: &[[f32; 4]; 3], start: u32, size: u32) -> (u32, Option<(u32, u32)>) {
    let (mut longest, mut ancestor) = (1, 2 * size);
    while ancestor <= PARAM_ONE && may_be_drawn(frame, curve, start & !(ancestor - 1), ancestor) {
        longest *= 2;
        ancestor *= 2;
    }
    let end = start + size;
    let half = end & end.wrapping_neg();
    let steps = 2 * half / (size / frame.rate);
    let inside = end != PARAM_ONE && steps > frame.rate && steps <= longest;
    (longest, if inside { Some((end - half, end + half)) } else { None })
}

/// Is this part of a border before the near plane and short enough to be drawn in one piece?
#[inline(always)]
fn may_be_drawn(frame: &Frame, curve: &[[f32; 4]; 3], start: u32, size: u32) -> bool {
    let weights = blossom(start, start + size);
    let (mut x, mut y) = ([0.0; 4], [0.0; 4]);
    let mut nearer = false;
    for k in 0..4 {
        let point =
            [blend4(weights[k], curve[0]), blend4(weights[k], curve[1]), blend4(weights[k], curve[2])];
        nearer |= neg(point[2]) < frame.near;
        let (right, down, _) = perspective(frame, point);
        x[k] = clamp(right, neg(FAR_OFF), FAR_OFF);
        y[k] = clamp(down, neg(FAR_OFF), FAR_OFF);
    }
    let mut length = 0.0;
    for k in 0..3 {
        let (dx, dy) = (sub(x[k + 1], x[k]), sub(y[k + 1], y[k]));
        length = add(length, sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY)));
    }
    !nearer && length <= mul(frame.bound, SEAM_ALLOWANCE)
}
