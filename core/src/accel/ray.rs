//! What a ray hits first.
//!
//! Rounding keeps order, so a box inside another one is never entered before it; and a hit counts only where the ray is in
//! the primitive's own box. So a tree finds the same as looking at every primitive. What is nearer to 0 than 2⁻⁶³ is taken for
//! 0, and what is farther away than 2⁴⁰ for as far: so no device has to compute with denormals or infinities.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use super::walk::Search;
use crate::abi::{Probe, Triangle};
use crate::num::{abs, add, clamp, cross3, dot3, flush, flush3, max, min, mul, neg, recip, sub};

/// Rounding errors of a place along the ray stay below this share of it.
const ROUNDING: f32 = 1.0 / (1 << 20) as f32;
/// Directions whose components are smaller than this are taken for parallel to a side.
const PARALLEL: f32 = 1.0 / FAR;
/// Nothing is taken to be farther away along an axis.
const FAR: f32 = (1_u64 << 40) as f32;

/// Points `origin + t · direction`, for `t` from 0 to `far`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    /// 1 / direction; 0 along axes that the ray is parallel to.
    steps: [f32; 3],
    far: f32,
}

impl Ray {
    /// From a point, in a direction about as long as 1, as far as `far` of it.
    #[must_use]
    pub const fn new(probe: &Probe) -> Self {
        let (origin, direction) = (flush3(probe.origin), flush3(probe.direction));
        let steps = [step(direction[0]), step(direction[1]), step(direction[2])];
        Self { origin, direction, steps, far: probe.far }
    }

    /// Between which places the ray may be in a box; the first is larger than the second if it is not.
    #[inline(always)]
    #[must_use]
    pub const fn within(&self, bounds: &Bounds) -> [f32; 2] {
        let mut span = [0.0, self.far];
        let mut axis = 0;
        while axis < 3 {
            span = self.cut(span, bounds, axis);
            axis += 1;
        }
        span
    }

    /// What of a span is between two sides of a box.
    #[inline(always)]
    const fn cut(&self, span: [f32; 2], bounds: &Bounds, axis: usize) -> [f32; 2] {
        let low = between(self.origin[axis], bounds.low[axis], FAR);
        let high = between(self.origin[axis], bounds.high[axis], FAR);
        if self.steps[axis] == 0.0 {
            return if low <= 0.0 && high >= 0.0 { span } else { [1.0, 0.0] };
        }
        let (a, b) = (mul(low, self.steps[axis]), mul(high, self.steps[axis]));
        let (near, far) = (min(a, b), max(a, b));
        let near = sub(near, mul(abs(near), ROUNDING));
        let far = add(far, mul(abs(far), ROUNDING));
        [max(span[0], near), min(span[1], far)]
    }

    /// Where the ray hits a triangle, from either side (Möller & Trumbore 1997).
    #[inline(always)]
    #[must_use]
    pub fn hit(&self, [a, b, c]: [[f32; 3]; 3]) -> Option<f32> {
        let (along, across) = (offset(a, b, FAR), offset(a, c, FAR));
        let from = offset(a, self.origin, FAR);
        let p = flush3(cross3(self.direction, across));
        let size = flush(dot3(along, p));
        let sign = if size < 0.0 { neg(1.0) } else { 1.0 };
        let size = mul(size, sign);
        let u = mul(flush(dot3(from, p)), sign);
        let q = flush3(cross3(from, along));
        let v = mul(flush(dot3(self.direction, q)), sign);
        if size == 0.0 || u < 0.0 || v < 0.0 || add(u, v) > size {
            return None;
        }
        Some(mul(mul(flush(dot3(across, q)), sign), recip(size)))
    }
}

/// 1 / x, or 0 where that is out of range.
const fn step(x: f32) -> f32 {
    if abs(x) < PARALLEL { 0.0 } else { recip(x) }
}

/// From one coordinate to another, `most` at most.
#[inline(always)]
pub(super) const fn between(from: f32, to: f32, most: f32) -> f32 {
    clamp(flush(sub(flush(to), flush(from))), neg(most), most)
}

/// From one point to another.
#[inline(always)]
pub(super) const fn offset(from: [f32; 3], to: [f32; 3], most: f32) -> [f32; 3] {
    [between(from[0], to[0], most), between(from[1], to[1], most), between(from[2], to[2], most)]
}

impl Triangle {
    /// Its corners.
    #[inline(always)]
    #[must_use]
    pub const fn points(&self) -> [[f32; 3]; 3] {
        let [a, b, c, d, e, f, g, h, i] = self.corners;
        [[a, b, c], [d, e, f], [g, h, i]]
    }
}

/// A ray among triangles.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// The ray.
    pub ray: Ray,
    /// The primitives.
    pub triangles: &'a [Triangle],
}

impl Search for Shot<'_> {
    #[inline(always)]
    fn enter(&self, bounds: &Bounds) -> Option<f32> {
        let [near, far] = self.ray.within(bounds);
        (near <= far).then_some(near)
    }

    #[inline(always)]
    fn test(&self, primitive: u32, bounds: &Bounds) -> Option<f32> {
        let [near, far] = self.ray.within(bounds);
        let t = self.ray.hit(self.triangles[primitive as usize].points())?;
        (near <= t && t <= far).then_some(t)
    }
}
