//! From the root downwards, what is nearer first, for whatever nearer means.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use super::tree::{DEEPEST, NOTHING, Node};
use crate::abi::Finding;

/// Something is looked for along a ray, or around a point.
pub trait Search {
    /// How far away anything in a box is at least, if it is not too far. Never more for a box about another one.
    fn enter(&self, bounds: &Bounds) -> Option<f32>;

    /// How far away a primitive is, if there is anything of it; not less than its box.
    fn test(&self, primitive: u32, bounds: &Bounds) -> Option<f32>;
}

impl Finding {
    /// Nothing.
    pub const NONE: Self = Self { primitive: NOTHING, distance: 0.0 };

    /// The nearer of two, the lower primitive if both are as near.
    #[inline(always)]
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        let is_nearer = other.distance < self.distance
            || (other.distance == self.distance && other.primitive < self.primitive);
        if self.primitive == NOTHING || (other.primitive != NOTHING && is_nearer) { other } else { self }
    }
}

/// What a search finds of one primitive.
#[inline(always)]
#[must_use]
pub fn find_one(search: &impl Search, primitive: u32, bounds: &Bounds) -> Finding {
    match (search.enter(bounds), search.test(primitive, bounds)) {
        (Some(_), Some(distance)) => Finding { primitive, distance },
        _ => Finding::NONE,
    }
}

/// What a search finds in a tree: the same as by looking at every primitive.
#[must_use]
pub fn find(search: &impl Search, nodes: &[Node]) -> Finding {
    let mut stack = Stack { entries: [(0, 0.0); DEEPEST as usize + 2], height: 0 };
    let mut found = Finding::NONE;
    if let Some(root) = nodes.first() {
        stack.push(0, search.enter(&root.bounds()));
    }
    while let Some((index, near)) = stack.pop() {
        if found.primitive != NOTHING && near > found.distance {
            continue;
        }
        let node = &nodes[index as usize];
        if node.is_leaf() {
            found = found.or(find_one(search, node.first, &node.bounds()));
            continue;
        }
        let enter = |child: u32| search.enter(&nodes[child as usize].bounds());
        let (first, second) = (enter(node.first), enter(node.second));
        // What is on top is looked at first.
        if second < first {
            stack.push(node.first, first);
            stack.push(node.second, second);
        } else {
            stack.push(node.second, second);
            stack.push(node.first, first);
        }
    }
    found
}

struct Stack {
    entries: [(u32, f32); DEEPEST as usize + 2],
    height: usize,
}

impl Stack {
    fn push(&mut self, node: u32, near: Option<f32>) {
        if let Some(near) = near {
            self.entries[self.height] = (node, near);
            self.height += 1;
        }
    }

    fn pop(&mut self) -> Option<(u32, f32)> {
        self.height = self.height.checked_sub(1)?;
        Some(self.entries[self.height])
    }
}
