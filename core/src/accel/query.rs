//! What is in a frustum.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use super::tree::{DEEPEST, Node};
use crate::abi::{AccelFrame, Frustum, SEE_BLOCK};
use crate::num::{add, flush, max, mul};

/// The side of a plane on which things are seen: `x · n[0] + y · n[1] + z · n[2] + n[3] >= 0`.
pub type Plane = [f32; 4];

/// May anything in a box be on the visible side of a plane?
///
/// Rounding keeps order, so a box inside another one is never visible where that is not: a tree finds the same as looking at
/// every box. What is nearer to 0 than 2⁻⁶³ is taken for 0.
#[inline(always)]
#[must_use]
pub const fn is_before(plane: &Plane, bounds: &Bounds) -> bool {
    let far = [farthest(plane, bounds, 0), farthest(plane, bounds, 1), farthest(plane, bounds, 2)];
    add(add(add(far[0], far[1]), far[2]), flush(plane[3])) >= 0.0
}

/// What one coordinate can add, at most.
#[inline(always)]
const fn farthest(plane: &Plane, bounds: &Bounds, axis: usize) -> f32 {
    let slope = flush(plane[axis]);
    let (a, b) = (flush(mul(slope, flush(bounds.low[axis]))), flush(mul(slope, flush(bounds.high[axis]))));
    max(a, b)
}

/// May anything in a box be within all planes?
#[inline(always)]
#[must_use]
pub fn is_visible(planes: &[Plane], bounds: &Bounds) -> bool {
    planes.iter().all(|plane| is_before(plane, bounds))
}

/// Tells every primitive whose box may be within all planes, in the order of the leaves.
pub fn in_frustum(nodes: &[Node], planes: &[Plane], mut tell: impl FnMut(u32)) {
    let (mut stack, mut top) = ([0; DEEPEST as usize + 1], 0);
    if nodes.is_empty() {
        return;
    }
    let mut next = Some(0);
    while let Some(index) = next {
        let node = &nodes[index as usize];
        next = None;
        if is_visible(planes, &node.bounds()) {
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

impl Frustum {
    /// Between so many planes, six at most.
    #[must_use]
    pub fn new(planes: &[Plane]) -> Self {
        let mut all = [[0.0, 0.0, 0.0, 1.0]; 6]; // no plane at all: everything is before it
        for (own, plane) in all.iter_mut().zip(planes) {
            *own = *plane;
        }
        Self { planes: *bytemuck::cast_ref(&all) }
    }

    /// May anything in a box be in it?
    #[inline(always)]
    #[must_use]
    pub fn sees(&self, bounds: &Bounds) -> bool {
        is_visible(self.planes.as_chunks().0, bounds)
    }
}

/// How many blocks of leaves a frustum looks at.
#[inline(always)]
#[must_use]
pub const fn blocks(leaves: u32) -> u32 {
    leaves.div_ceil(SEE_BLOCK)
}

/// The leaves of a block that a frustum sees, in order. Blocks are numbered frustum by frustum.
pub fn seen<'a>(
    frame: &AccelFrame,
    nodes: &'a [Node],
    frusta: &'a [Frustum],
    block: u32,
) -> impl Iterator<Item = u32> + 'a {
    let all = blocks(frame.count);
    let frustum = &frusta[(block / all) as usize];
    let leaves = &nodes[frame.count as usize - 1..][..frame.count as usize];
    let first = ((block % all) * SEE_BLOCK) as usize;
    let own = &leaves[first..leaves.len().min(first + SEE_BLOCK as usize)];
    own.iter().filter(|leaf| frustum.sees(&leaf.bounds())).map(|leaf| leaf.first)
}
