//! What is in a frustum.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use super::tree::{DEEPEST, Node};
use crate::num::{add, max, mul};

/// The side of a plane on which things are seen: `x · n[0] + y · n[1] + z · n[2] + n[3] >= 0`.
pub type Plane = [f32; 4];

/// May anything in a box be on the visible side of a plane?
///
/// Rounding keeps order, so a box inside another one is never visible where that is not: a tree finds the same as looking at
/// every box.
#[inline(always)]
#[must_use]
pub const fn is_before(plane: &Plane, bounds: &Bounds) -> bool {
    let far = [
        max(mul(plane[0], bounds.low[0]), mul(plane[0], bounds.high[0])),
        max(mul(plane[1], bounds.low[1]), mul(plane[1], bounds.high[1])),
        max(mul(plane[2], bounds.low[2]), mul(plane[2], bounds.high[2])),
    ];
    add(add(add(far[0], far[1]), far[2]), plane[3]) >= 0.0
}

/// May anything in a box be within all planes?
#[inline(always)]
#[must_use]
pub fn is_visible(planes: &[Plane], bounds: &Bounds) -> bool {
    planes.iter().all(|plane| is_before(plane, bounds))
}

/// Tells every primitive whose box may be within all planes, in the order of the leaves.
pub fn in_frustum(nodes: &[Node], planes: &[Plane], mut tell: impl FnMut(u32)) {
    let (mut stack, mut top) = ([0; DEEPEST + 1], 0);
    if nodes.is_empty() {
        return;
    }
    let mut next = Some(0);
    while let Some(index) = next {
        let node = &nodes[index as usize];
        next = None;
        if is_visible(planes, &node.bounds) {
            if node.is_leaf() {
                tell(node.first);
            } else {
                stack[top] = node.second;
                top += 1;
                next = Some(node.first);
            }
        }
        if next.is_none() && top > 0 {
            top -= 1;
            next = Some(stack[top]);
        }
    }
}
