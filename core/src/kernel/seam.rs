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
    let [bottom, top, left, right] = Border::all(surface);
    [seam(net, frame, bottom), seam(net, frame, top), seam(net, frame, left), seam(net, frame, right)]
}

/// One seam, where the border is a curve of the net.
#[inline(always)]
pub(super) fn seam(net: &Net, frame: &Frame, border: Border) -> Seam {
    let longest = longest_chord(frame, &border.curve(net), border);
    let chord = border.chord_beyond(frame, longest).map(|ends| {
        ends.map(|t| {
            let (u, v) = border.at(t);
            position_at(net, u, v)
        })
    });
    Seam { longest, chord }
}

/// Control points of a curve, or of a part of it, a coordinate each.
pub(super) type Curve = [[f32; 4]; 3];

/// One border of a surface: along it one parameter is fixed, and the other runs through a range.
#[derive(Clone, Copy)]
pub(super) struct Border {
    along_u: bool,
    fixed: u32,
    pub(super) start: u32,
    pub(super) size: u32,
}

impl Border {
    /// Those of constant v, then those of constant u; the low one first.
    #[inline(always)]
    pub(super) fn all(surface: Surface) -> [Self; 4] {
        let Surface { u, v, .. } = surface;
        let (size_u, size_v) = (surface.u_size(), surface.v_size());
        [
            Self { along_u: true, fixed: v, start: u, size: size_u },
            Self { along_u: true, fixed: v + size_v, start: u, size: size_u },
            Self { along_u: false, fixed: u, start: v, size: size_v },
            Self { along_u: false, fixed: u + size_u, start: v, size: size_v },
        ]
    }

    /// Is it part of a border of the whole patch?
    #[inline(always)]
    pub(super) fn is_outer(self) -> bool {
        self.fixed == 0 || self.fixed == PARAM_ONE
    }

    #[inline(always)]
    pub(super) fn end(self) -> u32 {
        self.start + self.size
    }

    /// The same border of the surface of this size that contains it: an ancestor.
    #[inline(always)]
    pub(super) fn ancestor(self, size: u32) -> Self {
        Self { start: self.start & !(size - 1), size, ..self }
    }

    /// The parameters u and v where the one that runs is `t`.
    #[inline(always)]
    pub(super) fn at(self, t: u32) -> (u32, u32) {
        if self.along_u { (t, self.fixed) } else { (self.fixed, t) }
    }

    /// The curve of a net that it lies on, from end to end of the patch.
    #[inline(always)]
    pub(super) fn curve(self, net: &Net) -> Curve {
        let weights = cubic(param(self.fixed));
        let mut curve = [[0.0; 4]; 3];
        for (curve, c) in curve.iter_mut().zip([&net.x, &net.y, &net.z]) {
            for (k, point) in curve.iter_mut().enumerate() {
                let (first, step) = if self.along_u { (4 * k, 1) } else { (k, 4) };
                *point =
                    blend4(weights, [c[first], c[first + step], c[first + 2 * step], c[first + 3 * step]]);
            }
        }
        curve
    }

    /// Control points of the part of such a curve that is the border.
    #[inline(always)]
    pub(super) fn part(self, curve: &Curve) -> Curve {
        let weights = blossom(self.start, self.end());
        let mut part = [[0.0; 4]; 3];
        for k in 0..4 {
            for (part, curve) in part.iter_mut().zip(curve) {
                part[k] = blend4(weights[k], *curve);
            }
        }
        part
    }

    /// The range of the chord that has the border's end in its middle, if no neighbour's can be longer than
    /// `longest` and it is not, but longer than the border.
    #[inline(always)]
    pub(super) fn chord_beyond(self, frame: &Frame, longest: u32) -> Option<[u32; 2]> {
        let end = self.end();
        let half = end & end.wrapping_neg();
        let steps = 2 * half / (self.size / frame.rate);
        let inside = end != PARAM_ONE && steps > frame.rate && steps <= longest;
        if inside { Some([end - half, end + half]) } else { None }
    }
}

/// The longest chord in steps of the border.
///
/// A neighbour's border is an ancestor of this one; one that is too long to be drawn was split, and so was
/// any that contains it.
#[inline(always)]
fn longest_chord(frame: &Frame, curve: &Curve, border: Border) -> u32 {
    let (mut longest, mut size) = (1, 2 * border.size);
    while size <= PARAM_ONE && may_be_drawn(frame, &border.ancestor(size).part(curve)) {
        longest *= 2;
        size *= 2;
    }
    longest
}

/// Is this part of a border before the near plane and short enough to be drawn in one piece?
#[inline(always)]
fn may_be_drawn(frame: &Frame, part: &Curve) -> bool {
    let mut nearer = false;
    for z in part[2] {
        nearer |= neg(z) < frame.near;
    }
    !nearer && is_short(frame, part)
}

/// Is the control polygon on screen no longer than one of a surface that is drawn?
#[inline(always)]
pub(super) fn is_short(frame: &Frame, part: &Curve) -> bool {
    let (mut x, mut y) = ([0.0; 4], [0.0; 4]);
    for k in 0..4 {
        let (right, down, _) = perspective(frame, [part[0][k], part[1][k], part[2][k]]);
        x[k] = clamp(right, neg(FAR_OFF), FAR_OFF);
        y[k] = clamp(down, neg(FAR_OFF), FAR_OFF);
    }
    let mut length = 0.0;
    for k in 0..3 {
        let (dx, dy) = (sub(x[k + 1], x[k]), sub(y[k + 1], y[k]));
        length = add(length, sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY)));
    }
    length <= mul(frame.bound, SEAM_ALLOWANCE)
}
