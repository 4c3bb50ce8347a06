//! Patches from front to back, by a hierarchy of their boxes.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::morton::{Grid, Precision};
use micropoly_core::accel::tree::{EMPTY, NOTHING, Node, fit, inner, link, node_count};
use micropoly_core::cull::Outline;
use rayon::prelude::*;

use super::depths::Depths;

/// Bits of a depth that a box leaves out, so that the rest is exact in it.
const LEFT_OUT: u32 = 8;

/// An outline as a box: columns, rows, and depth, of which nearly the logarithm, so that distances are told apart alike.
fn bounds_of(outline: &Outline) -> Bounds {
    let Outline { columns, rows, nearest } = *outline;
    let depth = (nearest >> LEFT_OUT) + 1;
    let corner = |end: usize| [columns[end], rows[end], depth].map(|c| c as f32);
    Bounds { low: corner(0), high: corner(1) }
}

/// The outline of all that is in a box.
fn outline_of(bounds: &Bounds) -> Outline {
    let [columns, rows, depth] = [0, 1, 2].map(|axis| [bounds.low[axis] as u32, bounds.high[axis] as u32]);
    Outline { columns, rows, nearest: depth[1] << LEFT_OUT }
}

/// All nodes that nothing is decided of yet.
pub(super) struct Front {
    nodes: Vec<Node>,
    /// The nearest comes first, of equally near ones the lowest.
    open: BinaryHeap<(u32, Reverse<u32>)>,
}

impl Front {
    /// Of outlines, of which there are some.
    pub(super) fn new(outlines: &[Outline]) -> Self {
        let boxes: Vec<Bounds> = outlines.par_iter().map(bounds_of).collect();
        let mut front = Self { open: BinaryHeap::new(), nodes: tree(&boxes) };
        front.push(0);
        front
    }

    /// Is there none left?
    pub(super) fn is_done(&self) -> bool {
        self.open.is_empty()
    }

    /// Takes the next patches, up to so many, that are not hidden; says how often something was.
    pub(super) fn take(&mut self, depths: &Depths, most: usize, taken: &mut Vec<u32>) -> usize {
        let mut hidden = 0;
        while taken.len() < most
            && let Some((_, Reverse(node))) = self.open.pop()
        {
            let node = self.nodes[node as usize];
            let Node { first, second, .. } = node;
            if depths.hide(&outline_of(&node.bounds())) {
                hidden += 1;
            } else if second == NOTHING {
                taken.push(first);
            } else {
                self.push(first);
                self.push(second);
            }
        }
        hidden
    }

    fn push(&mut self, node: u32) {
        let nearest = outline_of(&self.nodes[node as usize].bounds()).nearest;
        self.open.push((nearest, Reverse(node)));
    }
}

/// The linear hierarchy over boxes.
fn tree(boxes: &[Bounds]) -> Vec<Node> {
    let all = boxes.par_iter().copied().reduce(|| Bounds::NONE, Bounds::union);
    let grid = Grid::new(&all, Precision::Bits30);
    let mut keys: Vec<u64> =
        boxes.par_iter().enumerate().map(|(k, bounds)| grid.code(bounds) << 32 | k as u64).collect();
    keys.par_sort_unstable();
    let codes: Vec<u64> = keys.par_iter().map(|key| key >> 32).collect();
    let count = node_count(boxes.len() as u32) as usize;
    let mut nodes = vec![Node::leaf(0, EMPTY); count];
    let (above, leaves) = nodes.split_at_mut(boxes.len() - 1);
    above.par_iter_mut().enumerate().for_each(|(index, node)| *node = inner(&codes, index as u32));
    leaves.par_iter_mut().zip(&keys).for_each(|(leaf, key)| *leaf = Node::leaf(*key as u32, EMPTY));
    let mut parents = vec![NOTHING; count];
    link(&nodes, &mut parents, boxes.len() - 1);
    fit(&mut nodes, &parents, boxes, &mut vec![0; boxes.len() - 1]);
    nodes
}
