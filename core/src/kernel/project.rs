//! Perspective projection and the snap to fixed point: from here on, coverage is integers.

use crate::abi::{Frame, GUARD_BAND, SUBPIXELS};
use crate::num::{abs, clamp, max, mul, neg, recip, round};

/// A vertex on screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Column in 1/256 pixels, from the image's left edge.
    pub x: i32,
    /// Row in 1/256 pixels, from the image's top edge.
    pub y: i32,
    /// 1 / distance along the view axis; 0 = before the near plane or off the guard band: clip first.
    pub w: f32,
}

/// Pixel offsets right of and below the optical axis, and 1 / distance, of an eye-space point.
///
/// Points nearer than `near` are taken to be that far away.
#[inline(always)]
#[must_use]
pub fn perspective(frame: &Frame, near: f32, point: [f32; 3]) -> (f32, f32, f32) {
    let w = recip(max(neg(point[2]), near));
    let scale = mul(frame.focal, w);
    (mul(point[0], scale), mul(neg(point[1]), scale), w)
}

/// Projects and snaps an eye-space point, and says by `w` = 0 if it cannot be.
#[inline(always)]
#[must_use]
pub fn project(frame: &Frame, point: [f32; 3]) -> Vertex {
    let (x, y, w) = perspective(frame, frame.near, point);
    let visible = (neg(point[2]) >= frame.near) & (abs(x) <= GUARD_BAND) & (abs(y) <= GUARD_BAND);
    Vertex { w: if visible { w } else { 0.0 }, ..snapped(frame, x, y, w) }
}

/// Projects and snaps a point that has been clipped: whatever rounding left outside is moved in.
#[inline(always)]
#[must_use]
pub fn project_clipped(frame: &Frame, point: [f32; 3]) -> Vertex {
    let (x, y, w) = perspective(frame, frame.near, point);
    snapped(frame, x, y, w)
}

/// The optical axis runs through the middle of the image: a whole number of half pixels.
#[inline(always)]
fn snapped(frame: &Frame, x: f32, y: f32, w: f32) -> Vertex {
    let half_pixel = SUBPIXELS / 2;
    Vertex { x: snap(x) + frame.width as i32 * half_pixel, y: snap(y) + frame.height as i32 * half_pixel, w }
}

/// Pixels to the nearest 1/256 pixel; the rounding boundaries lie away from zero.
#[inline(always)]
#[must_use]
pub fn snap(pixels: f32) -> i32 {
    round(mul(clamp(pixels, neg(GUARD_BAND), GUARD_BAND), SUBPIXELS as f32))
}
