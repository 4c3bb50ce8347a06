//! The linear bounding volume hierarchy on all threads: the tree of `micropoly_core::accel`, cut in two and two again.

use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::hierarchy::{Span, split};
use micropoly_core::accel::morton::{Grid, Precision};
use micropoly_core::accel::tree::{NOTHING, Node, node_count};
use rayon::prelude::*;

use crate::device::CpuDevice;

/// Fewer leaves than this are one thread's.
const FEW: usize = 1024;

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
    let (codes, order) = sorted(&grid, boxes, precision);
    let count = node_count(boxes.len() as u32) as usize;
    let mut tree = Lbvh { nodes: vec![Node::leaf(0, Bounds::NONE); count], parents: vec![NOTHING; count] };
    let (inner, leaves) = tree.nodes.split_at_mut(boxes.len() - 1);
    let (inner_parents, leaf_parents) = tree.parents.split_at_mut(boxes.len() - 1);
    leaves
        .par_iter_mut()
        .zip(&order)
        .for_each(|(leaf, &primitive)| *leaf = Node::leaf(primitive, boxes[primitive as usize]));
    let part = Part { first: 0, inner, inner_parents, leaves, leaf_parents };
    part.build(&codes, NOTHING, false);
    tree
}

/// Codes in order, and whose they are; of equal ones the lower primitive comes first.
fn sorted(grid: &Grid, boxes: &[Bounds], precision: Precision) -> (Vec<u64>, Vec<u32>) {
    if precision == Precision::Bits30 {
        // Code and number fit one word.
        let mut keys: Vec<u64> =
            boxes.par_iter().enumerate().map(|(k, bounds)| grid.code(bounds) << 32 | k as u64).collect();
        keys.par_sort_unstable();
        return keys.into_par_iter().map(|key| (key >> 32, key as u32)).unzip();
    }
    let mut keys: Vec<(u64, u32)> =
        boxes.par_iter().enumerate().map(|(k, bounds)| (grid.code(bounds), k as u32)).collect();
    keys.par_sort_unstable();
    keys.into_par_iter().unzip()
}

/// Neighbouring leaves, and the inner nodes above them alone: those with the same numbers, one of which is another part's.
struct Part<'a> {
    /// Number of the first leaf.
    first: u32,
    inner: &'a mut [Node],
    inner_parents: &'a mut [u32],
    leaves: &'a [Node],
    leaf_parents: &'a mut [u32],
}

impl Part<'_> {
    /// Makes all nodes of a part; gives its box. Its highest inner node has the number of its last leaf if it is the first half
    /// of its parent, and else of its first.
    fn build(self, codes: &[u64], parent: u32, is_first_half: bool) -> Bounds {
        let Self { first, inner, inner_parents, leaves, leaf_parents } = self;
        if let [leaf] = leaves {
            leaf_parents[0] = parent;
            return leaf.bounds;
        }
        let last = first + leaves.len() as u32 - 1;
        let span = Span { first, last, split: split(codes, first, last) };
        let own = if is_first_half { leaves.len() - 1 } else { 0 };
        let number = first + own as u32;
        inner_parents[own] = parent;
        let part = Part { first, inner: &mut *inner, inner_parents, leaves, leaf_parents };
        let (a, b) = part.halves(span.split);
        let [a, b] = if leaves.len() < FEW {
            [a.build(codes, number, true), b.build(codes, number, false)]
        } else {
            rayon::join(|| a.build(codes, number, true), || b.build(codes, number, false)).into()
        };
        let [left, right] = span.children(codes.len() as u32);
        let bounds = a.union(b);
        inner[own] = Node { bounds, first: left, second: right };
        bounds
    }

    /// Those up to a leaf, and those behind it.
    fn halves(self, split: u32) -> (Self, Self) {
        let Self { first, inner, inner_parents, leaves, leaf_parents } = self;
        let cut = (split + 1 - first) as usize;
        let (inner, inner_b) = inner.split_at_mut(cut);
        let (inner_parents, inner_parents_b) = inner_parents.split_at_mut(cut);
        let (leaves, leaves_b) = leaves.split_at(cut);
        let (leaf_parents, leaf_parents_b) = leaf_parents.split_at_mut(cut);
        let behind = Self {
            first: split + 1,
            inner: inner_b,
            inner_parents: inner_parents_b,
            leaves: leaves_b,
            leaf_parents: leaf_parents_b,
        };
        (Self { first, inner, inner_parents, leaves, leaf_parents }, behind)
    }
}
