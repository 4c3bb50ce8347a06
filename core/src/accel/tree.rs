//! The whole tree: boxes, children, parents; and whether they are right.

use super::bounds::Bounds;
use super::hierarchy::span;
pub use crate::abi::{DEEPEST, NOTHING, Node};

impl Node {
    /// With a box and children.
    #[inline(always)]
    #[must_use]
    pub const fn new(bounds: Bounds, first: u32, second: u32) -> Self {
        Self { low: bounds.low, high: bounds.high, first, second }
    }

    /// A leaf.
    #[inline(always)]
    #[must_use]
    pub const fn leaf(primitive: u32, bounds: Bounds) -> Self {
        Self::new(bounds, primitive, NOTHING)
    }

    /// About all that is below.
    #[inline(always)]
    #[must_use]
    pub const fn bounds(&self) -> Bounds {
        Bounds { low: self.low, high: self.high }
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
    Node::new(EMPTY, first, second)
}

/// The box of a node whose box is still to be found.
pub const EMPTY: Bounds = Bounds { low: [0.0; 3], high: [0.0; 3] };

/// Fills in the parents of all nodes, of which so many are inner ones.
pub fn link(nodes: &[Node], parents: &mut [u32], inner: usize) {
    if let Some(root) = parents.first_mut() {
        *root = NOTHING;
    }
    for (index, node) in (0..).zip(&nodes[..inner]) {
        for child in [node.first, node.second] {
            parents[child as usize] = index;
        }
    }
}

/// Fills in boxes, from those of the primitives upwards, in one thread. `visits` is as long as there are inner nodes, all 0, and
/// is so again afterwards. The same fits a tree to primitives that have moved.
pub fn fit(nodes: &mut [Node], parents: &[u32], boxes: &[Bounds], visits: &mut [u32]) {
    let inner = nodes.len() - boxes.len();
    for leaf in inner..nodes.len() {
        let primitive = nodes[leaf].first;
        nodes[leaf] = Node::leaf(primitive, boxes[primitive as usize]);
        let mut node = parents[leaf];
        while node != NOTHING {
            visits[node as usize] ^= 1;
            // Whoever comes second knows both children.
            if visits[node as usize] == 1 {
                break;
            }
            let Node { first, second, .. } = nodes[node as usize];
            let bounds = nodes[first as usize].bounds().union(nodes[second as usize].bounds());
            nodes[node as usize] = Node::new(bounds, first, second);
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
    if *bounds != node.bounds() {
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
    if node.bounds() != first.bounds().union(second.bounds()) {
        return Err(Fault::Box { node: index });
    }
    for child in [node.first, node.second] {
        if parents[child as usize] != index {
            return Err(Fault::Parent { node: child });
        }
    }
    Ok(())
}
