//! A tree in each cell: planes of triangles cut the parts of the others, until all of a node's own lie in its plane.

#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use micropoly_core::accel::bsp::cells::slab_plane;
use micropoly_core::accel::bsp::choose::{CORNERS, Jury, Side};
use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cut, Cutter, side, whole};
use micropoly_core::accel::bsp::rank::BspNode;
use micropoly_core::accel::bsp::table::FEW;
use multiversion::multiversion;
use rayon::prelude::*;

use super::clip::Clipper;
use super::cut::{Part, Parts};
use super::few::Few;
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

impl Trees {
    /// With room for those of so many parts, unless they are cut much.
    fn for_parts(parts: usize) -> Self {
        let room = parts + parts / 2;
        Self {
            nodes: Vec::with_capacity(room),
            pieces: Vec::with_capacity(room),
            cuts: Vec::with_capacity(2 * room),
        }
    }
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
    slabs: &[Vec<i32>; 3],
    parts: &Parts,
    rules: &Rules,
) -> Result<Forest, BspError> {
    let cells: Vec<usize> = (0..parts.cells()).collect();
    let grown: Result<Vec<Grown>, BspError> = cells
        .par_chunks(CELLS_AT_ONCE)
        .map_init(
            || Gardener::new(triangles, planes, slabs, rules),
            |gardener, cells| {
                let mut ends = Vec::with_capacity(cells.len());
                gardener.trees = Trees::for_parts(cells.iter().map(|cell| parts.count_in(*cell)).sum());
                for &cell in cells {
                    gardener.plant(parts, cell)?;
                    ends.push((gardener.trees.nodes.len(), gardener.trees.pieces.len()));
                }
                Ok((std::mem::take(&mut gardener.trees), ends))
            },
        )
        .collect();
    joined(&grown?, rules)
}

/// All of them in one list.
fn joined(grown: &[Grown], rules: &Rules) -> Result<Forest, BspError> {
    let pieces: usize = grown.iter().map(|(trees, _)| trees.pieces.len()).sum();
    if pieces > rules.most_pieces as usize {
        return Err(BspError::Pieces { most: rules.most_pieces });
    }
    let nodes = || grown.iter().map(|(trees, _)| &trees.nodes[..]).collect::<Vec<_>>().concat();
    let cuts = || grown.iter().map(|(trees, _)| &trees.cuts[..]).collect::<Vec<_>>().concat();
    let (nodes, (pieces, cuts)) = rayon::join(nodes, || (joined_pieces(grown, pieces), cuts()));
    let (mut first_nodes, mut first_pieces) = (vec![0], vec![0]);
    let mut before = (0, 0);
    for (trees, ends) in grown {
        first_nodes.extend(ends.iter().map(|(end, _)| (before.0 + end) as u32));
        first_pieces.extend(ends.iter().map(|(_, end)| (before.1 + end) as u32));
        before = (before.0 + trees.nodes.len(), before.1 + trees.pieces.len());
    }
    Ok(Forest { all: Trees { nodes, pieces, cuts }, first_nodes, first_pieces })
}

fn joined_pieces(grown: &[Grown], count: usize) -> Vec<Piece> {
    let (mut pieces, mut cuts) = (Vec::with_capacity(count), 0);
    for (trees, _) in grown {
        pieces.extend(trees.pieces.iter().map(|p| Piece { first_cut: p.first_cut + cuts, ..*p }));
        cuts += trees.cuts.len() as u32;
    }
    pieces
}

/// The triangle, of some, in whose plane a node should be, of those as good the first.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
fn best(jury: &Jury, planes: &[Plane], candidates: impl Iterator<Item = u32>) -> u32 {
    let mut best = (u32::MAX, 0);
    for candidate in candidates {
        let cost = jury.cost(&planes[candidate as usize]);
        if cost < best.0 {
            best = (cost, candidate);
        }
    }
    best.1
}

/// Some corners of a part, its last one again if it has fewer.
#[inline(always)]
fn some_corners(part: Part, triangles: &[[Point; 3]], corners: &[Corner]) -> [[f32; 3]; CORNERS] {
    let mut some = [[0.0; 3]; CORNERS];
    let (triangle, piece) = (&triangles[part.triangle as usize], part.corners(corners));
    for (k, some) in some.iter_mut().enumerate() {
        for (axis, some) in some.iter_mut().enumerate() {
            *some = if part.is_whole() {
                triangle[k.min(2)][axis] as f32
            } else {
                piece[k.min(piece.len() - 1)].at[axis] as f32
            };
        }
    }
    some
}

/// On which side of a plane some corners are, but for those that are near.
fn far_side(plane: &Rough, near: f64, corners: impl Iterator<Item = [f64; 3]>) -> Side {
    let (mut before, mut behind) = (false, false);
    for corner in corners {
        let value = plane.value(corner);
        before |= value > near;
        behind |= value < -near;
    }
    Side::of(before, behind)
}

/// Parts on one side of a node, at the end of the list of those that wait.
pub(super) struct Waiting {
    pub(super) first: usize,
    pub(super) parent: Option<usize>,
}

pub(super) struct Gardener<'a> {
    pub(super) triangles: &'a [[Point; 3]],
    pub(super) planes: &'a [Plane],
    slabs: &'a [Vec<i32>; 3],
    pub(super) rules: &'a Rules,
    pub(super) trees: Trees,
    /// Of all parts of the cell in work.
    pub(super) corners: Vec<Corner>,
    clipper: Clipper,
    pub(super) few: Few,
    jury: Jury,
}

impl<'a> Gardener<'a> {
    fn new(
        triangles: &'a [[Point; 3]],
        planes: &'a [Plane],
        slabs: &'a [Vec<i32>; 3],
        rules: &'a Rules,
    ) -> Self {
        let (corners, clipper) = Default::default();
        Self {
            triangles,
            planes,
            slabs,
            rules,
            trees: Trees::default(),
            corners,
            clipper,
            few: Few::default(),
            jury: Jury::default(),
        }
    }

    /// Adds the tree of a cell.
    fn plant(&mut self, parts: &Parts, cell: usize) -> Result<(), BspError> {
        let (mut waiting, mut now) = (Vec::new(), Vec::new());
        let (mut before, mut behind) = (Vec::new(), Vec::new());
        self.corners.clear();
        parts.copy(cell, &mut waiting, &mut self.corners);
        let root = self.trees.nodes.len();
        let mut tasks = Vec::new();
        if !waiting.is_empty() {
            tasks.push(Waiting { first: 0, parent: None });
        }
        while let Some(Waiting { first, parent }) = tasks.pop() {
            now.clear();
            now.extend(waiting.drain(first..));
            if self.trees.pieces.len() + waiting.len() + now.len() > self.rules.most_pieces as usize {
                return Err(BspError::Pieces { most: self.rules.most_pieces });
            }
            if let [part] = now[..] {
                self.keep(part);
                self.node(BspNode { triangle: part.triangle, own: 1, ..BspNode::default() }, parent);
                continue;
            }
            if now.len() <= FEW {
                self.grow_few(&now, parent, &mut waiting, &mut tasks);
                continue;
            }
            let node = self.trees.nodes.len();
            self.divide(&now, parent, &mut before, &mut behind);
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

    /// Adds a node, which may be the back of another.
    pub(super) fn node(&mut self, node: BspNode, parent: Option<usize>) {
        let nodes = &mut self.trees.nodes;
        if let Some(parent) = parent {
            nodes[parent].to_back = (nodes.len() - parent) as u32;
        }
        nodes.push(node);
    }

    /// Makes a node of some parts; gives those on either side of it.
    fn divide(
        &mut self,
        parts: &[Part],
        parent: Option<usize>,
        before: &mut Vec<Part>,
        behind: &mut Vec<Part>,
    ) {
        let triangle = self.choose(parts);
        let plane = self.planes[triangle as usize];
        let rough = Rough::of(&plane);
        let mut own = 0;
        for part in parts {
            match self.side_of(*part, triangle, &plane, &rough) {
                Side::InPlane => {
                    self.keep(*part);
                    own += 1;
                }
                Side::Before => before.push(*part),
                Side::Behind => behind.push(*part),
                Side::Cut => {
                    let [front, back] = self.split(*part, &plane, &rough, Cutter::Triangle(triangle));
                    before.extend(front);
                    behind.extend(back);
                }
            }
        }
        let (front, back) = (before.len() as u32, behind.len() as u32);
        self.node(BspNode { triangle, own, front, back, to_back: 0 }, parent);
    }

    /// A triangle in the best plane of those that are tried.
    fn choose(&mut self, parts: &[Part]) -> u32 {
        let tried = self.rules.candidates.min(parts.len());
        if tried < 2 {
            return parts[0].triangle;
        }
        let candidates = (0..tried).map(|k| parts[k * parts.len() / tried].triangle);
        let (triangles, corners) = (self.triangles, &self.corners);
        self.jury.call(parts.len(), |k| some_corners(parts[k], triangles, corners));
        best(&self.jury, self.planes, candidates)
    }

    /// On which side of a triangle's plane a part is.
    fn side_of(&self, part: Part, triangle: u32, plane: &Plane, rough: &Rough) -> Side {
        if part.triangle == triangle {
            return Side::InPlane;
        }
        let (corners, piece) = (&self.triangles[part.triangle as usize], part.corners(&self.corners));
        if self.rules.tolerance > 0.0 {
            let near = rough.value_at(self.rules.tolerance).max(rough.slack());
            return if part.is_whole() {
                far_side(rough, near, corners.iter().map(|corner| corner.map(f64::from)))
            } else {
                far_side(rough, near, piece.iter().map(|corner| corner.at))
            };
        }
        if part.is_whole() {
            let [a, b, c] = plane.values(*corners);
            return Side::of((a > 0) | (b > 0) | (c > 0), (a < 0) | (b < 0) | (c < 0));
        }
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

    /// What of a part is before a plane, and what is behind it; there may be nothing if it reached beyond its cell.
    fn split(&mut self, part: Part, plane: &Plane, rough: &Rough, cutter: Cutter) -> [Option<Part>; 2] {
        let triangle = &self.triangles[part.triangle as usize];
        let slab_planes = self.slab_planes(part);
        self.clipper.piece.clear();
        if part.is_whole() {
            self.clipper.piece.extend(whole(triangle));
        } else {
            self.clipper.piece.extend_from_slice(part.corners(&self.corners));
        }
        for (plane, cut) in slab_planes {
            self.clipper.clip(triangle, &plane, cut);
        }
        self.clipper.cut(triangle, plane, rough, cutter);
        self.clipper.halves.each_ref().map(|half| {
            let (first, count) = (self.corners.len() as u32, half.len() as u32);
            self.corners.extend_from_slice(half);
            (count > 0).then_some(Part { triangle: part.triangle, first, count, slabs: [Cut::NONE; 3] })
        })
    }

    /// The planes beyond which a part is not in its cell, if it reaches that far.
    pub(super) fn slab_planes(&self, part: Part) -> impl Iterator<Item = (Plane, Cut)> + use<'a> {
        let slabs = self.slabs;
        part.slabs.into_iter().filter_map(|cut| match cut.cutter() {
            Cutter::Slab { axis, slab } if cut != Cut::NONE => {
                Some((slab_plane(&slabs[axis], axis, slab), cut))
            }
            _ => None,
        })
    }

    /// A part becomes a piece.
    pub(super) fn keep(&mut self, part: Part) {
        let Trees { pieces, cuts, .. } = &mut self.trees;
        pieces.push(Piece { triangle: part.triangle, first_cut: cuts.len() as u32 });
        for cut in part.slabs {
            if cut != Cut::NONE {
                cuts.push(cut);
            }
        }
        for corner in part.corners(&self.corners) {
            if corner.cut != Cut::NONE {
                cuts.push(corner.cut);
            }
        }
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
