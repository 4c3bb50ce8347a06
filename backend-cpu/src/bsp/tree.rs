//! A tree in each cell: planes of triangles cut the parts of the others, until all of a node's own lie in its plane.

#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use micropoly_core::accel::bsp::choose::{JUDGES, Jury, Side};
use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cut, Cutter, Knife, side};
use micropoly_core::accel::bsp::rank::BspNode;
use multiversion::multiversion;
use rayon::prelude::*;

use super::cut::{Part, Parts};
use super::{BspError, Piece};

/// Cells that one thread works off in a row.
const CELLS_AT_ONCE: usize = 64;

/// What trees are built by.
pub(super) struct Rules {
    /// In units of the lattice.
    pub(super) tolerance: f64,
    pub(super) candidates: usize,
    pub(super) most_pieces: u32,
}

/// Some trees, one after the other.
#[derive(Default)]
pub(super) struct Trees {
    pub(super) nodes: Vec<BspNode>,
    pub(super) pieces: Vec<Piece>,
    pub(super) cuts: Vec<Cut>,
}

/// The trees of all cells.
pub(super) struct Forest {
    pub(super) all: Trees,
    pub(super) first_nodes: Vec<u32>,
    pub(super) first_pieces: Vec<u32>,
}

/// Those of some neighbouring cells, and how many nodes and pieces there were after each.
type Grown = (Trees, Vec<(usize, usize)>);

pub(super) fn build(
    triangles: &[[Point; 3]],
    planes: &[Plane],
    parts: &Parts,
    rules: &Rules,
) -> Result<Forest, BspError> {
    let cells: Vec<usize> = (0..parts.cells()).collect();
    let grown: Result<Vec<Grown>, BspError> = cells
        .par_chunks(CELLS_AT_ONCE)
        .map(|cells| {
            let mut gardener = Gardener::new(triangles, planes, rules);
            let mut ends = Vec::with_capacity(cells.len());
            for &cell in cells {
                gardener.plant(parts, cell)?;
                ends.push((gardener.trees.nodes.len(), gardener.trees.pieces.len()));
            }
            Ok((gardener.trees, ends))
        })
        .collect();
    joined(grown?, rules)
}

/// All of them in one list.
fn joined(grown: Vec<Grown>, rules: &Rules) -> Result<Forest, BspError> {
    let pieces: usize = grown.iter().map(|(trees, _)| trees.pieces.len()).sum();
    if pieces > rules.most_pieces as usize {
        return Err(BspError::Pieces { most: rules.most_pieces });
    }
    let mut forest = Forest { all: Trees::default(), first_nodes: vec![0], first_pieces: vec![0] };
    for (trees, ends) in grown {
        let Forest { all, first_nodes, first_pieces } = &mut forest;
        let (nodes, pieces, cuts) = (all.nodes.len(), all.pieces.len(), all.cuts.len() as u32);
        first_nodes.extend(ends.iter().map(|(end, _)| (nodes + end) as u32));
        first_pieces.extend(ends.iter().map(|(_, end)| (pieces + end) as u32));
        all.nodes.extend_from_slice(&trees.nodes);
        all.pieces.extend(trees.pieces.iter().map(|p| Piece { first_cut: p.first_cut + cuts, ..*p }));
        all.cuts.extend_from_slice(&trees.cuts);
    }
    Ok(forest)
}

/// The triangle, of some, in whose plane a node should be, of those as good the first; and on which side of it all are.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
fn best(
    jury: &Jury,
    planes: &[Plane],
    candidates: impl Iterator<Item = u32>,
    sides: &mut [Side; JUDGES],
) -> u32 {
    let mut best = (u32::MAX, 0);
    for candidate in candidates {
        let cost = jury.cost(&planes[candidate as usize]);
        if cost < best.0 {
            best = (cost, candidate);
        }
    }
    jury.sides(&planes[best.1 as usize], sides);
    best.1
}

/// Parts on one side of a node, at the end of the list of those that wait.
struct Waiting {
    first: usize,
    parent: Option<usize>,
}

struct Gardener<'a> {
    triangles: &'a [[Point; 3]],
    planes: &'a [Plane],
    rules: &'a Rules,
    trees: Trees,
    /// Of all parts of the cell in work.
    corners: Vec<Corner>,
    /// The part that is being cut, what of it is behind the plane, and its corners' sides.
    piece: Vec<Corner>,
    behind: Vec<Corner>,
    sides: Vec<i8>,
    jury: Jury,
    judged: [Side; JUDGES],
}

impl<'a> Gardener<'a> {
    fn new(triangles: &'a [[Point; 3]], planes: &'a [Plane], rules: &'a Rules) -> Self {
        let (corners, piece, behind, sides) = Default::default();
        Self {
            triangles,
            planes,
            rules,
            trees: Trees::default(),
            corners,
            piece,
            behind,
            sides,
            jury: Jury::default(),
            judged: [Side::Unsure; JUDGES],
        }
    }

    /// Adds the tree of a cell.
    fn plant(&mut self, parts: &Parts, cell: usize) -> Result<(), BspError> {
        let (mut waiting, mut now) = (Vec::new(), Vec::new());
        let (mut before, mut behind) = (Vec::new(), Vec::new());
        self.corners.clear();
        parts.copy(cell, self.triangles, &mut waiting, &mut self.corners);
        let root = self.trees.nodes.len();
        let mut tasks = Vec::new();
        if !waiting.is_empty() {
            tasks.push(Waiting { first: 0, parent: None });
        }
        while let Some(Waiting { first, parent }) = tasks.pop() {
            now.clear();
            now.extend(waiting.drain(first..));
            let node = self.trees.nodes.len();
            if let Some(parent) = parent {
                self.trees.nodes[parent].to_back = (node - parent) as u32;
            }
            if let [part] = now[..] {
                self.keep(part);
                self.trees.nodes.push(BspNode { triangle: part.triangle, own: 1, ..BspNode::default() });
                continue;
            }
            self.divide(&now, &mut before, &mut behind);
            if self.trees.pieces.len() + before.len() + behind.len() > self.rules.most_pieces as usize {
                return Err(BspError::Pieces { most: self.rules.most_pieces });
            }
            // What is before the plane comes next.
            for (parts, parent) in [(&mut behind, Some(node)), (&mut before, None)] {
                if !parts.is_empty() {
                    tasks.push(Waiting { first: waiting.len(), parent });
                    waiting.append(parts);
                }
            }
        }
        self.count(root);
        Ok(())
    }

    /// Makes a node of some parts; gives those on either side of it.
    fn divide(&mut self, parts: &[Part], before: &mut Vec<Part>, behind: &mut Vec<Part>) {
        let (triangle, are_judged) = self.choose(parts);
        let plane = self.planes[triangle as usize];
        let rough = Rough::of(&plane);
        let mut own = 0;
        for (k, part) in parts.iter().enumerate() {
            let judged = if are_judged { self.judged[k] } else { Side::Unsure };
            match self.side_of(*part, judged, triangle, &rough) {
                Side::InPlane | Side::Unsure => {
                    self.keep(*part);
                    own += 1;
                }
                Side::Before => before.push(*part),
                Side::Behind => behind.push(*part),
                Side::Cut => {
                    let [front, back] = self.split(*part, &plane, &rough, Cutter::Triangle(triangle));
                    before.push(front);
                    behind.push(back);
                }
            }
        }
        let (front, back) = (before.len() as u32, behind.len() as u32);
        self.trees.nodes.push(BspNode { triangle, own, front, back, to_back: 0 });
    }

    /// A triangle in the best plane of those that are tried; and does the jury say on which side of it all parts are?
    fn choose(&mut self, parts: &[Part]) -> (u32, bool) {
        let tried = self.rules.candidates.min(parts.len());
        if tried < 2 {
            return (parts[0].triangle, false);
        }
        if let [a, b] = *parts {
            let rough = Rough::of(&self.planes[a.triangle as usize]);
            let is_cut = self.side_of(b, Side::Unsure, a.triangle, &rough) == Side::Cut;
            return (if is_cut { b.triangle } else { a.triangle }, false);
        }
        let candidates = (0..tried).map(|k| parts[k * parts.len() / tried].triangle);
        self.jury.call(parts.iter().map(|part| part.corners(&self.corners)));
        let best = best(&self.jury, self.planes, candidates, &mut self.judged);
        (best, parts.len() <= JUDGES && self.rules.tolerance == 0.0)
    }

    /// On which side of a triangle's plane a part is, if the jury was not sure.
    fn side_of(&self, part: Part, judged: Side, triangle: u32, rough: &Rough) -> Side {
        if part.triangle == triangle {
            return Side::InPlane;
        }
        if judged != Side::Unsure {
            return judged;
        }
        let piece = part.corners(&self.corners);
        if self.rules.tolerance > 0.0 {
            let near = rough.value_at(self.rules.tolerance).max(rough.slack());
            let (before, behind) = piece.iter().fold((false, false), |(before, behind), corner| {
                let value = rough.value(corner.at);
                (before | (value > near), behind | (value < -near))
            });
            return Side::of(before, behind);
        }
        let (corners, plane) = (&self.triangles[part.triangle as usize], &self.planes[triangle as usize]);
        let (mut before, mut behind) = (false, false);
        for k in 0..piece.len() {
            let side = side(corners, piece, k, plane, rough);
            before |= side > 0;
            behind |= side < 0;
            if before && behind {
                break;
            }
        }
        Side::of(before, behind)
    }

    /// What of a part is before a plane, and what is behind it.
    fn split(&mut self, part: Part, plane: &Plane, rough: &Rough, cutter: Cutter) -> [Part; 2] {
        let triangle = &self.triangles[part.triangle as usize];
        self.piece.clear();
        self.piece.extend_from_slice(part.corners(&self.corners));
        self.sides.clear();
        self.sides.extend((0..self.piece.len()).map(|k| side(triangle, &self.piece, k, plane, rough) as i8));
        let knife = Knife { triangle, line: plane.values(*triangle), sides: &self.sides };
        let (corners, behind) = (&mut self.corners, &mut self.behind);
        let first = corners.len() as u32;
        knife.split(&self.piece, cutter, |corner| corners.push(corner), |corner| behind.push(corner));
        let middle = corners.len() as u32;
        corners.append(behind);
        let end = corners.len() as u32;
        [Part { first, count: middle - first, ..part }, Part { first: middle, count: end - middle, ..part }]
    }

    /// A part becomes a piece.
    fn keep(&mut self, part: Part) {
        let Trees { pieces, cuts, .. } = &mut self.trees;
        pieces.push(Piece { triangle: part.triangle, first_cut: cuts.len() as u32 });
        let made = part.corners(&self.corners).iter().map(|corner| corner.cut);
        cuts.extend(made.filter(|cut| *cut != Cut::NONE));
    }

    /// Counts what is on either side of the nodes from `root` on; so far each knows whether there is anything.
    fn count(&mut self, root: usize) {
        let nodes = &mut self.trees.nodes;
        let all = |node: &BspNode| node.own + node.front + node.back;
        for k in (root..nodes.len()).rev() {
            if nodes[k].front > 0 {
                nodes[k].front = all(&nodes[k + 1]);
            }
            if nodes[k].back > 0 {
                nodes[k].back = all(&nodes[k + nodes[k].to_back as usize]);
            }
        }
    }
}
