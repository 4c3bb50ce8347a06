//! flat: how far a surface is, on screen, from the one micropolygon that would be drawn for it. Part of `bound`.
//!
//! After Eisenacher, Meyer & Loop 2009 (sec. 3) and Liu & Shih 2012: control points are compared with those that the
//! bilinear patch through the corners has when its degree is raised. Theirs are compared after perspective division;
//! ours are found before it, in eye space, so a plane is flat however it is seen. Lines are compared with their chords,
//! by numbers that both neighbours have.

use crate::abi::{Frame, LINE_SHARE, QUARTER, Surface, THIRD};
use crate::kernel::bound::{distance, measured_point, point_if_cut};
use crate::kernel::sides::Lengths;
use crate::num::{add, max, mul};
use crate::patch::Net;
use crate::patch::half::{Line, SIDE_POINTS};

/// From where distances are measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    pub(super) frame: &'a Frame,
    /// What is nearer than this is measured as if it were this far away.
    pub(super) near: f32,
    /// Is all measured as if it were as near as that, and turned to the eye?
    pub(super) is_cut: bool,
}

/// How far a surface, given the control points of it or of more than it, is from its two triangles, and its sides from
/// their chords.
#[inline(always)]
pub(super) fn flatness(view: View<'_>, part: &Net) -> Lengths {
    let even = elevated(part);
    let mut off = [0.0; 16];
    for (l, off) in off.iter_mut().enumerate() {
        *off = between(view, point(part, l), point(&even, l));
    }
    let mut sides = [0.0; 4];
    for (side, at) in sides.iter_mut().zip(SIDE_POINTS) {
        *side = mul(LINE_SHARE, max(off[at[1]], off[at[2]]));
    }
    let most = off.iter().fold(0.0, |most, off| max(most, *off));
    let whole = add(most, twist(view, part));
    Lengths { u: whole, v: whole, sides }.with_sides(sides)
}

/// How far a line is from its chord.
#[inline(always)]
pub(super) fn line_flatness(view: View<'_>, line: &Line) -> f32 {
    let [a, b, c, d] = *line;
    mul(LINE_SHARE, max(between(view, b, third(a, d)), between(view, c, third(d, a))))
}

/// How far a line inside a Gregory patch is from its chord, from five points of it, a quarter of it apart. Between them it
/// may be a little farther.
#[inline(always)]
pub(super) fn chord_flatness(view: View<'_>, points: &[[f32; 3]; 5]) -> f32 {
    let [a, b, c, d, e] = *points;
    let half = middle(a, e);
    let outer = max(between(view, b, middle(a, half)), between(view, d, middle(e, half)));
    let most = max(outer, between(view, c, half));
    mul(LINE_SHARE, add(most, mul(most, QUARTER)))
}

/// What of a patch has to be flat for a surface whose corners have strayed: all that they enclose.
#[inline(always)]
pub(super) fn enclosed(surface: Surface) -> [[u32; 2]; 2] {
    let [a, b, c, d] = [0, 1, 2, 3].map(|corner| surface.corner(corner));
    [0, 1].map(|k| [a[k].min(b[k]).min(c[k].min(d[k])), a[k].max(b[k]).max(c[k].max(d[k]))])
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

/// Distance of two points on screen.
#[inline(always)]
fn between(view: View<'_>, a: [f32; 3], b: [f32; 3]) -> f32 {
    distance(seen(view, a), seen(view, b))
}

#[inline(always)]
fn seen(View { frame, near, is_cut }: View<'_>, point: [f32; 3]) -> [f32; 3] {
    if is_cut { point_if_cut(frame, near, point) } else { measured_point(frame, near, point) }
}

/// How far the two triangles are from the bilinear patch: it is farthest from them in its middle.
#[inline(always)]
fn twist(view: View<'_>, part: &Net) -> f32 {
    let ridge = middle(point(part, 0), point(part, 15));
    let other = middle(point(part, 3), point(part, 12));
    between(view, ridge, middle(ridge, other))
}
