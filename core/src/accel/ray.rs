//! What a ray hits first.
//!
//! Rounding keeps order, so a box inside another one is never entered before it; and a hit counts only where the ray is in
//! the primitive's own box. So a tree finds the same as looking at every primitive.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use super::tree::{DEEPEST, NOTHING, Node};
use crate::num::{abs, add, cross3, dot3, flush, max, min, mul, neg, recip, sub};

/// Rounding errors of a place along the ray stay below this share of it.
const ROUNDING: f32 = 1.0 / (1 << 20) as f32;
/// Directions whose components are smaller than this are taken for parallel to a side.
const FLAT: f32 = 1.0e-30;

/// Points `origin + t · direction`, for `t` from 0 to `far`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    /// 1 / direction; 0 along axes that the ray is parallel to.
    steps: [f32; 3],
    far: f32,
}

/// What was hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which primitive; of several at the same place the lowest.
    pub primitive: u32,
    /// Where along the ray, in lengths of its direction.
    pub t: f32,
}

impl Ray {
    /// From a point, in a direction about as long as 1, as far as `far` of it.
    #[must_use]
    pub const fn new(origin: [f32; 3], direction: [f32; 3], far: f32) -> Self {
        let steps = [step(direction[0]), step(direction[1]), step(direction[2])];
        Self { origin, direction, steps, far }
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
        let low = sub(bounds.low[axis], self.origin[axis]);
        let high = sub(bounds.high[axis], self.origin[axis]);
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
        let (along, across, from) = (minus(b, a), minus(c, a), minus(self.origin, a));
        let p = cross3(self.direction, across);
        let size = dot3(along, p);
        let sign = if size < 0.0 { neg(1.0) } else { 1.0 };
        let size = flush(mul(size, sign));
        let u = mul(dot3(from, p), sign);
        let q = cross3(from, along);
        let v = mul(dot3(self.direction, q), sign);
        if size == 0.0 || u < 0.0 || v < 0.0 || add(u, v) > size {
            return None;
        }
        Some(mul(mul(dot3(across, q), sign), recip(size)))
    }
}

/// 1 / x, or 0 where that is out of range.
const fn step(x: f32) -> f32 {
    if abs(x) < FLAT {
        0.0
    } else if x < 0.0 {
        neg(recip(neg(x)))
    } else {
        recip(x)
    }
}

#[inline(always)]
const fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [sub(a[0], b[0]), sub(a[1], b[1]), sub(a[2], b[2])]
}

/// A hit, if it is in the primitive's own box.
#[inline(always)]
#[must_use]
pub fn counted(ray: &Ray, bounds: &Bounds, primitive: u32, t: Option<f32>) -> Option<Hit> {
    let [near, far] = ray.within(bounds);
    let t = t.filter(|t| near <= *t && *t <= far)?;
    Some(Hit { primitive, t })
}

/// The nearer of two hits, the lower primitive if both are as near.
#[inline(always)]
#[must_use]
pub fn nearer(a: Option<Hit>, b: Option<Hit>) -> Option<Hit> {
    match (a, b) {
        (Some(x), Some(y)) if y.t < x.t || (y.t == x.t && y.primitive < x.primitive) => b,
        (None, _) => b,
        _ => a,
    }
}

/// What a ray hits first; `test` says where it hits a primitive.
pub fn first_hit(nodes: &[Node], ray: &Ray, mut test: impl FnMut(u32) -> Option<f32>) -> Option<Hit> {
    let (mut stack, mut top) = ([(0, 0.0); DEEPEST + 2], 0);
    let mut found: Option<Hit> = None;
    if let Some(root) = nodes.first() {
        top = push(&mut stack, top, ray, root, 0);
    }
    while top > 0 {
        top -= 1;
        let (index, near): (u32, f32) = stack[top];
        if found.is_some_and(|hit| near > hit.t) {
            continue;
        }
        let node = &nodes[index as usize];
        if node.second == NOTHING {
            found = nearer(found, counted(ray, &node.bounds, node.first, test(node.first)));
            continue;
        }
        let [first, second] = [node.first, node.second].map(|child| (child, &nodes[child as usize]));
        // The nearer child is looked at first: it comes on top.
        let swapped = ray.within(&first.1.bounds)[0] > ray.within(&second.1.bounds)[0];
        let (near, far) = if swapped { (second, first) } else { (first, second) };
        top = push(&mut stack, top, ray, far.1, far.0);
        top = push(&mut stack, top, ray, near.1, near.0);
    }
    found
}

/// Puts a node on the stack, if the ray may be in it.
fn push(stack: &mut [(u32, f32)], top: usize, ray: &Ray, node: &Node, index: u32) -> usize {
    let [near, far] = ray.within(&node.bounds);
    if near > far {
        return top;
    }
    stack[top] = (index, near);
    top + 1
}
