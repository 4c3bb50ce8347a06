//! bound: cull, draw or split a surface, by the control hull of its parameter range.
//!
//! Unlike the 3×3 point samples of Weber 2014 (sec. 4.2) the hull contains the surface, so nothing visible
//! is ever culled, and the control polygons are at least as long as the curves they control.

use crate::abi::{
    CULL, DRAW, DRAW_LIMITED, FAR_OFF, Frame, LENGTH_TINY, MAX_SPLITS, Object, Patch, ROUNDING,
    SEAM_ALLOWANCE, SPLIT_U, SPLIT_V, Surface, Verdict,
};
use crate::kernel::project::perspective;
use crate::num::{add, clamp, float, floor, max, min, mul, neg, recip, sqrt, sub};
use crate::patch::Net;
use crate::patch::net::fold;

/// The verdict on one surface.
#[inline(always)]
#[must_use]
pub fn bound(frame: &Frame, patch: &Patch, object: &Object, surface: Surface) -> Verdict {
    let whole = Net::in_eye_space(patch, object);
    let slack = mul(whole.extent(), ROUNDING);
    let part = whole.restricted(surface);
    let nearest = neg(fold(&part.z, max));
    let farthest = neg(fold(&part.z, min));
    if add(farthest, slack) < frame.near {
        return verdict(CULL, PixelBox::EMPTY);
    }
    if nearest < frame.near {
        if beside_the_view(frame, &part, slack) {
            return verdict(CULL, PixelBox::EMPTY);
        }
        let code = refine(frame, surface, depth_spans(&part), None);
        return verdict(code, PixelBox::whole(frame));
    }
    let (x, y) = on_screen(frame, &part);
    let margin = add(1.0, mul(mul(frame.focal, slack), recip(nearest)));
    if PixelBox::around(frame, &x, &y, margin).is_empty() {
        return verdict(CULL, PixelBox::EMPTY);
    }
    // A seam may reach beyond the surface, by no more than the longest border that can be drawn.
    let reach = add(margin, mul(frame.bound, SEAM_ALLOWANCE));
    let pixels = PixelBox::around(frame, &x, &y, reach);
    let extents = (length_u(&x, &y), length_v(&x, &y));
    if max(extents.0, extents.1) <= frame.bound {
        return verdict(DRAW, pixels);
    }
    verdict(refine(frame, surface, extents, Some(frame.bound)), pixels)
}

#[inline(always)]
fn verdict(code: u32, pixels: PixelBox) -> Verdict {
    let [left, right, top, bottom] = pixels.0;
    Verdict { code, columns: left as u32 | (right as u32) << 16, rows: top as u32 | (bottom as u32) << 16 }
}

/// Splits along the direction that wants it more; at the deepest level, or where the range cannot be
/// halved any further, the surface is drawn as it is. The other direction is tried when it too is too long.
#[inline(always)]
fn refine(frame: &Frame, surface: Surface, (u, v): (f32, f32), limit: Option<f32>) -> u32 {
    let open_u = surface.u_level() < MAX_SPLITS;
    let open_v = surface.v_level() < MAX_SPLITS;
    let too_long = |extent| limit.is_some_and(|limit| extent > limit);
    if surface.level() + 1 >= frame.levels {
        DRAW_LIMITED
    } else if u > v {
        if open_u {
            SPLIT_U
        } else if open_v && too_long(v) {
            SPLIT_V
        } else {
            DRAW_LIMITED
        }
    } else if open_v {
        SPLIT_V
    } else if open_u && too_long(u) {
        SPLIT_U
    } else {
        DRAW_LIMITED
    }
}

/// Does the whole hull lie on the outer side of one side plane of the view? Holds behind the eye too.
#[inline(always)]
fn beside_the_view(frame: &Frame, part: &Net, slack: f32) -> bool {
    beyond(frame, part, &part.x, frame.centre_x, slack) || beyond(frame, part, &part.y, frame.centre_y, slack)
}

/// Does the hull lie beyond one of the two planes that cut the coordinate `c` at `half` pixels?
#[inline(always)]
fn beyond(frame: &Frame, part: &Net, c: &[f32; 16], half: f32, slack: f32) -> bool {
    // A point error of `slack` along each axis moves the plane distance by at most this much.
    let tolerance = mul(slack, add(frame.focal, half));
    let (mut low, mut high) = ([0.0; 16], [0.0; 16]);
    for l in 0..16 {
        let offset = mul(c[l], frame.focal);
        let edge = mul(neg(part.z[l]), half);
        low[l] = add(edge, offset);
        high[l] = sub(edge, offset);
    }
    add(fold(&low, max), tolerance) < 0.0 || add(fold(&high, max), tolerance) < 0.0
}

/// How much the distance to the eye plane varies along u and along v: splitting the direction in which it
/// varies more separates what is before the near plane from what is behind it.
#[inline(always)]
fn depth_spans(part: &Net) -> (f32, f32) {
    let z = &part.z;
    let (mut along_u, mut along_v) = (0.0, 0.0);
    for l in 0..4 {
        along_u = max(along_u, span([z[l], z[4 + l], z[8 + l], z[12 + l]]));
        along_v = max(along_v, span([z[4 * l], z[4 * l + 1], z[4 * l + 2], z[4 * l + 3]]));
    }
    (along_u, along_v)
}

#[inline(always)]
fn span([a, b, c, d]: [f32; 4]) -> f32 {
    sub(max(max(a, b), max(c, d)), min(min(a, b), min(c, d)))
}

/// Pixel offsets of the control points from the optical axis.
#[inline(always)]
fn on_screen(frame: &Frame, part: &Net) -> ([f32; 16], [f32; 16]) {
    let (mut xs, mut ys) = ([0.0; 16], [0.0; 16]);
    for l in 0..16 {
        let (x, y, _) = perspective(frame, [part.x[l], part.y[l], part.z[l]]);
        xs[l] = clamp(x, neg(FAR_OFF), FAR_OFF);
        ys[l] = clamp(y, neg(FAR_OFF), FAR_OFF);
    }
    (xs, ys)
}

#[inline(always)]
fn segment(x: &[f32; 16], y: &[f32; 16], from: usize, to: usize) -> f32 {
    let (dx, dy) = (sub(x[to], x[from]), sub(y[to], y[from]));
    sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY))
}

/// Length in pixels of the longest control polygon along u.
#[inline(always)]
fn length_u(x: &[f32; 16], y: &[f32; 16]) -> f32 {
    let mut lengths = [0.0; 12];
    for (l, length) in lengths.iter_mut().enumerate() {
        *length = segment(x, y, l, l + 4);
    }
    let mut polygons = [0.0; 4];
    for (j, polygon) in polygons.iter_mut().enumerate() {
        *polygon = add(add(lengths[j], lengths[4 + j]), lengths[8 + j]);
    }
    max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]))
}

/// Length in pixels of the longest control polygon along v.
#[inline(always)]
fn length_v(x: &[f32; 16], y: &[f32; 16]) -> f32 {
    let mut lengths = [0.0; 15];
    for (l, length) in lengths.iter_mut().enumerate() {
        *length = segment(x, y, l, l + 1); // every fourth joins two rows and is not used
    }
    let mut polygons = [0.0; 4];
    for (i, polygon) in polygons.iter_mut().enumerate() {
        *polygon = add(add(lengths[4 * i], lengths[4 * i + 1]), lengths[4 * i + 2]);
    }
    max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]))
}

/// Left, right, top and bottom in pixels; right and bottom are one past the last.
struct PixelBox([i32; 4]);

impl PixelBox {
    const EMPTY: Self = Self([0; 4]);

    fn whole(frame: &Frame) -> Self {
        Self([0, frame.width as i32, 0, frame.height as i32])
    }

    #[inline(always)]
    fn around(frame: &Frame, x: &[f32; 16], y: &[f32; 16], margin: f32) -> Self {
        let (left, right) = pixel_range(x, frame.centre_x, frame.width, margin);
        let (top, bottom) = pixel_range(y, frame.centre_y, frame.height, margin);
        Self([left, right, top, bottom])
    }

    #[inline(always)]
    fn is_empty(&self) -> bool {
        self.0[0] >= self.0[1] || self.0[2] >= self.0[3]
    }
}

/// First pixel that the offsets, widened by `margin`, can touch, and one past the last; within the image.
#[inline(always)]
fn pixel_range(offsets: &[f32; 16], centre: f32, size: u32, margin: f32) -> (i32, i32) {
    let size = float(size as i32);
    let low = sub(add(fold(offsets, min), centre), margin);
    let high = add(add(fold(offsets, max), centre), add(margin, 1.0));
    (floor(clamp(low, 0.0, size)), floor(clamp(high, 0.0, size)))
}
