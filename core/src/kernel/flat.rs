//! flat: how far triangles can be, on screen, from the part of a patch that they stand for. Part of `bound`.
//!
//! After Eisenacher, Meyer & Loop 2009 (sec. 3) and Liu & Shih 2012, who compare control points with those of a bilinear
//! patch after perspective division. Ours is a bound for every triangle whose corners lie anywhere in the part: the error
//! of linear interpolation is at most an eighth of the largest second derivative along u, and along v, and a quarter of the
//! mixed one (a weighted variance is at most a quarter of the squared range, Popoviciu 1935); derivatives lie in the hulls
//! of differences of control points. They are seen where their control points are, as if those were as near as the nearest
//! of the part. So a part of what is flat enough is flat enough, and a plane is flat however it is seen.

use crate::abi::{FLAG_WHOLE, Frame, LENGTH_TINY, LINE_SHARE, Surface};
use crate::border::SIDES;
use crate::kernel::sides::Lengths;
use crate::num::{add, clamp, dot3, float, largest3, max, min, mul, neg, recip, sqrt, sub};
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

/// How far a part of a patch is from triangles in it.
#[inline(always)]
pub(super) fn part_flatness(frame: &Frame, near: f32, part: &Net) -> f32 {
    let (mut bent_u, mut bent_v, mut twisted, mut before) = (0.0, 0.0, 0.0, before(frame, point(part, 0)));
    for i in 0..4 {
        for j in 0..4 {
            let at = 4 * i + j;
            before = min(before, self::before(frame, point(part, at)));
            if i < 2 {
                bent_u =
                    max(bent_u, bend(frame, near, point(part, at), point(part, at + 4), point(part, at + 8)));
            }
            if j < 2 {
                bent_v =
                    max(bent_v, bend(frame, near, point(part, at), point(part, at + 1), point(part, at + 2)));
            }
            if i < 3 && j < 3 {
                let (low, high) =
                    ([point(part, at), point(part, at + 1)], [point(part, at + 4), point(part, at + 5)]);
                twisted = max(twisted, twist(frame, near, low, high));
            }
        }
    }
    let bent = mul(0.75, add(length(bent_u), length(bent_v)));
    mul(add(bent, mul(2.25, length(twisted))), recip(max(before, near)))
}

/// How far a line is from its chord.
#[inline(always)]
pub(super) fn line_flatness(frame: &Frame, near: f32, line: &Line) -> f32 {
    let [a, b, c, d] = *line;
    let bent = max(bend(frame, near, a, b, c), bend(frame, near, b, c, d));
    let before = min(min(before(frame, a), before(frame, d)), min(before(frame, b), before(frame, c)));
    mul(mul(0.75, length(bent)), recip(max(before, near)))
}

/// How many times as flat as a surface a line must be of which a piece 2^`bits` units long is looked at.
#[inline(always)]
pub(super) const fn strictness(bits: u32) -> f32 {
    add(1.0, mul(LINE_SHARE, float(bits as i32)))
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

/// Squared length on screen, times the distance, of a small step at a point.
#[inline(always)]
fn seen(frame: &Frame, near: f32, at: [f32; 3], way: [f32; 3]) -> f32 {
    if frame.flags & FLAG_WHOLE != 0 {
        return mul(mul(frame.focal, frame.focal), dot3(way, way));
    }
    let scale = mul(frame.focal, recip(max(neg(at[2]), near)));
    let x = clamp(mul(at[0], scale), neg(frame.centre_x), frame.centre_x);
    let y = clamp(mul(at[1], scale), neg(frame.centre_y), frame.centre_y);
    let way =
        [add(mul(way[0], frame.focal), mul(x, way[2])), add(mul(way[1], frame.focal), mul(y, way[2])), 0.0];
    dot3(way, way)
}

/// How far before the eye a point is; if the mesh is to be whole, as if the eye had turned to it.
#[inline(always)]
const fn before(frame: &Frame, point: [f32; 3]) -> f32 {
    let before = neg(point[2]);
    if frame.flags & FLAG_WHOLE == 0 { before } else { max(before, mul(largest3(point), frame.around)) }
}

#[inline(always)]
fn point(net: &Net, l: usize) -> [f32; 3] {
    [net.x[l], net.y[l], net.z[l]]
}

/// Squared length of a second difference; the same from either end.
#[inline(always)]
fn bend(frame: &Frame, near: f32, a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> f32 {
    seen(frame, near, b, [0, 1, 2].map(|k| add(sub(a[k], b[k]), sub(c[k], b[k]))))
}

/// Squared length of a difference of differences.
#[inline(always)]
fn twist(frame: &Frame, near: f32, [a, b]: [[f32; 3]; 2], [c, d]: [[f32; 3]; 2]) -> f32 {
    seen(frame, near, a, [0, 1, 2].map(|k| sub(add(a[k], d[k]), add(b[k], c[k]))))
}

#[inline(always)]
fn length(square: f32) -> f32 {
    sqrt(add(square, LENGTH_TINY))
}
