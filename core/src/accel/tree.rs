//! The whole tree: boxes, children, parents; and whether they are right.

use bytemuck::{Pod, Zeroable};

use super::bounds::Bounds;
use super::hierarchy::span;

/// No node, no parent.
pub const NOTHING: u32 = u32::MAX;
/// Inner nodes on the way to a leaf, at most: bits of a code, and of a place among equal ones.
pub const DEEPEST: usize = 64 + 32;

/// A node: its box, and its children; or a leaf's primitive.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Node {
    /// About all that is below.
    pub bounds: Bounds,
    /// First child; of a leaf the number of its primitive.
    pub first: u32,
    /// Second child; of a leaf [`NOTHING`].
    pub second: u32,
}

impl Node {
    /// A leaf.
    #[inline(always)]
    #[must_use]
    pub const fn leaf(primitive: u32, bounds: Bounds) -> Self {
        Self { bounds, first: primitive, second: NOTHING }
    }

    /// Is it a leaf?
    #[inline(always)]
    #[must_use]
    pub const fn is_leaf(&self) -> bool {
        self.second == NOTHING
    }
}

/// How many nodes a tree of so many primitives has.
#[must_use]
pub const fn node_count(primitives: u32) -> u32 {
    if primitives == 0 { 0 } else { 2 * primitives - 1 }
}

/// What is wrong with a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// There are not as many nodes and parents as so many primitives need.
    Count,
    /// A node names a child, or a primitive, that is not there.
    Missing {
        /// The node.
        node: u32,
    },
    /// A node's box is not the smallest about its children, or its primitive.
    Box {
        /// The node.
        node: u32,
    },
    /// A node is not said to be the parent of its child.
    Parent {
        /// The child.
        node: u32,
    },
    /// A primitive has no leaf, or several.
    Leaf {
        /// The primitive.
        primitive: u32,
    },
}

/// The children of inner node `index`; its box is still to be found.
#[inline(always)]
#[must_use]
pub fn inner(codes: &[u64], index: u32) -> Node {
    let [first, second] = span(codes, index).children(codes.len() as u32);
    Node { bounds: Bounds::NONE, first, second }
}

/// Fills in boxes and parents from the leaves upwards, in one thread: `visits` is as long as there are inner nodes, all 0.
pub fn fit(nodes: &mut [Node], parents: &mut [u32], visits: &mut [u32]) {
    let inner = visits.len();
    if let Some(root) = parents.first_mut() {
        *root = NOTHING;
    }
    for node in 0..inner {
        for child in [nodes[node].first, nodes[node].second] {
            parents[child as usize] = node as u32;
        }
    }
    for leaf in inner..nodes.len() {
        let mut node = parents[leaf];
        while node != NOTHING {
            visits[node as usize] += 1;
            // Whoever comes second knows both children.
            if visits[node as usize] < 2 {
                break;
            }
            let Node { first, second, .. } = nodes[node as usize];
            nodes[node as usize].bounds = nodes[first as usize].bounds.union(nodes[second as usize].bounds);
            node = parents[node as usize];
        }
    }
}

/// Is the tree over these boxes sound: every primitive has one leaf, all boxes are tight, all parents right? `seen` is as long
/// as there are primitives, all false.
///
/// # Errors
/// The first [`Fault`].
pub fn validate(nodes: &[Node], parents: &[u32], boxes: &[Bounds], seen: &mut [bool]) -> Result<(), Fault> {
    let count = node_count(boxes.len() as u32) as usize;
    if nodes.len() != count || parents.len() != count || seen.len() != boxes.len() {
        return Err(Fault::Count);
    }
    if count > 0 && parents[0] != NOTHING {
        return Err(Fault::Parent { node: 0 });
    }
    for (index, node) in (0..).zip(nodes) {
        if node.is_leaf() {
            check_leaf(index, node, boxes, seen)?;
        } else {
            check_inner(index, node, nodes, parents)?;
        }
    }
    match seen.iter().position(|seen| !seen) {
        Some(primitive) => Err(Fault::Leaf { primitive: primitive as u32 }),
        None => Ok(()),
    }
}

fn check_leaf(index: u32, node: &Node, boxes: &[Bounds], seen: &mut [bool]) -> Result<(), Fault> {
    let primitive = node.first;
    let bounds = boxes.get(primitive as usize).ok_or(Fault::Missing { node: index })?;
    if *bounds != node.bounds {
        return Err(Fault::Box { node: index });
    }
    if core::mem::replace(&mut seen[primitive as usize], true) {
        return Err(Fault::Leaf { primitive });
    }
    Ok(())
}

fn check_inner(index: u32, node: &Node, nodes: &[Node], parents: &[u32]) -> Result<(), Fault> {
    let child = |child: u32| nodes.get(child as usize).ok_or(Fault::Missing { node: index });
    let (first, second) = (child(node.first)?, child(node.second)?);
    if node.bounds != first.bounds.union(second.bounds) {
        return Err(Fault::Box { node: index });
    }
    for child in [node.first, node.second] {
        if parents[child as usize] != index {
            return Err(Fault::Parent { node: child });
        }
    }
    Ok(())
}
