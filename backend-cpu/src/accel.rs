//! The linear bounding volume hierarchy on all threads: the tree of `micropoly_core::accel`, cut in two and two again
//! until each part is one thread's, which goes through its leaves once.

use bytemuck::zeroed_vec;
use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::hierarchy::{common, split};
use micropoly_core::accel::morton::{Grid, Precision};
use micropoly_core::accel::tree::{DEEPEST, NOTHING, Node, node_count};
use rayon::prelude::*;

use crate::device::CpuDevice;
use crate::radix::{Key, sorted};

/// Fewer leaves than this are one thread's.
const FEW: usize = 4096;

/// A tree over boxes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lbvh {
    /// Inner nodes, the root first, then leaves in the order of their codes.
    pub nodes: Vec<Node>,
    /// The parent of each.
    pub parents: Vec<u32>,
}

impl CpuDevice {
    /// Builds the tree over boxes, which are finite. It does not depend on the number of threads.
    #[must_use]
    pub fn build_lbvh(&self, boxes: &[Bounds], precision: Precision) -> Lbvh {
        self.install(|| build(boxes, precision))
    }
}

fn build(boxes: &[Bounds], precision: Precision) -> Lbvh {
    if boxes.is_empty() {
        return Lbvh::default();
    }
    let all = boxes.par_iter().copied().reduce(|| Bounds::NONE, Bounds::union);
    let grid = Grid::new(&all, precision);
    let keys = boxes.par_iter().enumerate().map(|(k, bounds)| (grid.code(bounds), k as u32)).collect();
    let keys = sorted(keys, 3 * precision.bits());
    let codes: Vec<u64> = keys.par_iter().map(|key| key.0).collect();
    let count = node_count(boxes.len() as u32) as usize;
    // Zeroed by the operating system, page by page, by whichever thread uses them first.
    let mut tree = Lbvh { nodes: zeroed_vec(count), parents: zeroed_vec(count) };
    let (inner, leaves) = tree.nodes.split_at_mut(boxes.len() - 1);
    let (inner_parents, leaf_parents) = tree.parents.split_at_mut(boxes.len() - 1);
    let mut whole = Part { first: 0, inner, inner_parents, leaves, leaf_parents };
    let sorted = Sorted { keys: &keys, codes: &codes, boxes };
    let root = whole.build(&sorted);
    whole.settle(&root, 0, &sorted);
    tree.parents[0] = NOTHING;
    tree
}

/// Primitives in the order of their codes.
struct Sorted<'a> {
    keys: &'a [Key],
    codes: &'a [u64],
    boxes: &'a [Bounds],
}

impl Sorted<'_> {
    /// Number of a leaf's node.
    fn node(&self, leaf: u32) -> u32 {
        leaf + self.codes.len() as u32 - 1
    }
}

/// The highest node over neighbouring leaves, which has no number yet.
#[derive(Clone, Copy)]
struct Top {
    /// First leaf.
    first: u32,
    /// Leading bits that its code shares with the one before.
    shared: i32,
    node: Node,
}

/// Neighbouring leaves, and the inner nodes above them alone: those with the same numbers, one of which is another part's.
struct Part<'a> {
    /// Number of the first leaf.
    first: u32,
    inner: &'a mut [Node],
    inner_parents: &'a mut [u32],
    leaves: &'a mut [Node],
    leaf_parents: &'a mut [u32],
}

impl Part<'_> {
    /// Makes all nodes of a part but the highest, which it gives.
    fn build(&mut self, sorted: &Sorted<'_>) -> Top {
        if self.leaves.len() < FEW {
            return self.build_in_turn(sorted);
        }
        let (mut a, mut b) = self.halves(sorted);
        let (a, b) = rayon::join(|| a.build(sorted), || b.build(sorted));
        self.join(&a, &b, sorted)
    }

    /// Leaf by leaf: two neighbouring nodes have the same parent as soon as the next leaf has less in common with them than
    /// they with each other.
    fn build_in_turn(&mut self, sorted: &Sorted<'_>) -> Top {
        let end = self.first + self.leaves.len() as u32;
        let (mut stack, mut height) =
            ([Top { first: 0, shared: 0, node: Node::leaf(0, Bounds::NONE) }; DEEPEST as usize + 2], 0);
        let mut shared = 0;
        for leaf in self.first..end {
            let primitive = sorted.keys[leaf as usize].1;
            let mut top =
                Top { first: leaf, shared, node: Node::leaf(primitive, sorted.boxes[primitive as usize]) };
            shared = if leaf + 1 < end { common(sorted.codes, leaf, i64::from(leaf) + 1) } else { -1 };
            while height > 0 && top.shared > shared {
                height -= 1;
                top = self.join(&stack[height], &top, sorted);
            }
            stack[height] = top;
            height += 1;
        }
        stack[0]
    }

    /// The parent of two.
    #[inline(always)]
    fn join(&mut self, a: &Top, b: &Top, sorted: &Sorted<'_>) -> Top {
        let first = self.settle(a, b.first - 1, sorted);
        let second = self.settle(b, b.first, sorted);
        Top { node: Node::new(a.node.bounds().union(b.node.bounds()), first, second), ..*a }
    }

    /// Puts a node into its place: an inner one has the number of its last leaf if it is the first half of its parent, and
    /// else of its first. Gives that number.
    #[inline(always)]
    fn settle(&mut self, top: &Top, leaf: u32, sorted: &Sorted<'_>) -> u32 {
        let at = (leaf - self.first) as usize;
        if top.node.is_leaf() {
            self.leaves[at] = top.node;
            return sorted.node(leaf);
        }
        self.inner[at] = top.node;
        for child in [top.node.first, top.node.second] {
            match child.checked_sub(sorted.node(self.first)) {
                Some(place) => self.leaf_parents[place as usize] = leaf,
                None => self.inner_parents[(child - self.first) as usize] = leaf,
            }
        }
        leaf
    }

    /// Those up to where codes differ first, and those behind.
    fn halves(&mut self, sorted: &Sorted<'_>) -> (Part<'_>, Part<'_>) {
        let last = self.first + self.leaves.len() as u32 - 1;
        let behind = split(sorted.codes, self.first, last) + 1;
        let cut = (behind - self.first) as usize;
        let (inner, inner_b) = self.inner.split_at_mut(cut);
        let (inner_parents, inner_parents_b) = self.inner_parents.split_at_mut(cut);
        let (leaves, leaves_b) = self.leaves.split_at_mut(cut);
        let (leaf_parents, leaf_parents_b) = self.leaf_parents.split_at_mut(cut);
        let b = Part {
            first: behind,
            inner: inner_b,
            inner_parents: inner_parents_b,
            leaves: leaves_b,
            leaf_parents: leaf_parents_b,
        };
        (Part { first: self.first, inner, inner_parents, leaves, leaf_parents }, b)
    }
}
