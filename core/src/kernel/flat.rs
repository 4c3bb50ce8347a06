//! flat: how far a surface is, on screen, from the one micropolygon that would be drawn for it. Part of `bound`.
//!
//! After Eisenacher, Meyer & Loop 2009 (sec. 3) and Liu & Shih 2012: control points are compared with those that the
//! bilinear patch through the corners has when its degree is raised; lines with their chords. Theirs are compared after
//! perspective division; ours before it, in eye space, and what they are apart is measured where it is nearest to the
//! eye. So a part of what is flat enough is flat enough, a plane is flat however it is seen, and nothing is farther off on
//! screen than is said here.

use crate::abi::{FLAG_WHOLE, Frame, LENGTH_TINY, LINE_SHARE, Surface, THIRD};
use crate::border::SIDES;
use crate::kernel::sides::Lengths;
use crate::num::{add, dot3, float, largest3, max, min, mul, neg, recip, sqrt, sub};
use crate::patch::half::{Line, SIDE_POINTS};
use crate::patch::{Net, Range};

/// How far a surface, given its control points, is from its two triangles, and its sides from their chords.
#[inline(always)]
pub(super) fn flatness(frame: &Frame, near: f32, part: &Net) -> Lengths {
    let whole = part_flatness(frame, near, part);
    let sides = SIDES.map(|side| side_flatness(frame, near, part, side));
    Lengths { u: whole, v: whole, sides }
}

/// How far a side, given the control points of what it is a side of, is from its chord.
#[inline(always)]
pub(super) fn side_flatness(frame: &Frame, near: f32, part: &Net, side: usize) -> f32 {
    line_flatness(frame, near, &SIDE_POINTS[side].map(|l| point(part, l)))
}

/// How far a part of a patch is from its two triangles, whatever its sides are.
#[inline(always)]
pub(super) fn part_flatness(frame: &Frame, near: f32, part: &Net) -> f32 {
    let even = elevated(part);
    let (mut most, mut before) = (0.0, before(frame, point(part, 0)));
    for l in 0..16 {
        most = max(most, apart(point(part, l), point(&even, l)));
        before = min(before, self::before(frame, point(part, l)));
    }
    mul(add(most, twist(part)), pixels(frame, max(before, near)))
}

/// How far a line is from its chord.
#[inline(always)]
pub(super) fn line_flatness(frame: &Frame, near: f32, line: &Line) -> f32 {
    let [a, b, c, d] = *line;
    let most = max(apart(b, third(a, d)), apart(c, third(d, a)));
    let before = min(min(before(frame, a), before(frame, d)), min(before(frame, b), before(frame, c)));
    mul(most, pixels(frame, max(before, near)))
}

/// How many times as flat as a surface a line must be of which a piece 2^`bits` units long is looked at.
#[inline(always)]
pub(super) const fn strictness(bits: u32) -> f32 {
    add(2.0, mul(LINE_SHARE, float(bits as i32)))
}

/// What of a patch has to be flat for a surface whose corners have strayed: a range around each of its triangles.
#[inline(always)]
pub(super) fn enclosed(surface: Surface) -> [Range; 2] {
    let [a, b, d, c] = [0, 1, 2, 3].map(|corner| surface.corner(corner));
    [around(a, b, c), around(a, c, d)]
}

/// The range around three vertices.
#[inline(always)]
pub(super) fn around(a: [u32; 2], b: [u32; 2], c: [u32; 2]) -> Range {
    [0, 1].map(|k| [a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k])])
}

/// Pixels that a length of 1 has at most in the image, so far before the eye, whichever way it lies.
#[inline(always)]
fn pixels(frame: &Frame, before: f32) -> f32 {
    let corner = [frame.focal, frame.centre_x, frame.centre_y];
    mul(sqrt(dot3(corner, corner)), recip(before))
}

/// How far before the eye a point is; if the mesh is to be whole, as if the eye had turned to it.
#[inline(always)]
const fn before(frame: &Frame, point: [f32; 3]) -> f32 {
    let before = neg(point[2]);
    if frame.flags & FLAG_WHOLE == 0 { before } else { max(before, mul(largest3(point), frame.around)) }
}

/// Control points of the bilinear patch through the corners, as a bicubic one.
#[inline(always)]
fn elevated(part: &Net) -> Net {
    Net { x: raised(&part.x), y: raised(&part.y), z: raised(&part.z) }
}

#[inline(always)]
fn raised(c: &[f32; 16]) -> [f32; 16] {
    let mut out = *c;
    for j in [0, 3] {
        (out[4 + j], out[8 + j]) = (between_thirds(c[j], c[12 + j]), between_thirds(c[12 + j], c[j]));
    }
    for i in 0..4 {
        let (a, b) = (out[4 * i], out[4 * i + 3]);
        (out[4 * i + 1], out[4 * i + 2]) = (between_thirds(a, b), between_thirds(b, a));
    }
    out
}

/// A third of the way from one number to another.
#[inline(always)]
const fn between_thirds(a: f32, b: f32) -> f32 {
    mul(add(add(a, a), b), THIRD)
}

#[inline(always)]
fn third(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|k| between_thirds(a[k], b[k]))
}

#[inline(always)]
fn middle(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|k| mul(0.5, add(a[k], b[k])))
}

#[inline(always)]
fn point(net: &Net, l: usize) -> [f32; 3] {
    [net.x[l], net.y[l], net.z[l]]
}

/// Distance of two points in eye space.
#[inline(always)]
fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
    let way = [0, 1, 2].map(|k| sub(b[k], a[k]));
    sqrt(add(dot3(way, way), LENGTH_TINY))
}

/// How far the two triangles are from the bilinear patch: it is farthest from them in its middle.
#[inline(always)]
fn twist(part: &Net) -> f32 {
    let ridge = middle(point(part, 0), point(part, 15));
    let other = middle(point(part, 3), point(part, 12));
    apart(ridge, middle(ridge, other))
}
