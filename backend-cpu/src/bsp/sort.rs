//! The order of all pieces for an eye: cells, then the trees in them, all at once.

#![allow(unsafe_code)] // only what `multiversion` generates: the same function for several instruction sets

use micropoly_core::abi::{BspFrame, BspPlane};
use micropoly_core::accel::bsp::cells::far_to_near;
use micropoly_core::accel::bsp::plan::BspLists;
use micropoly_core::accel::bsp::plane::Plane;
use micropoly_core::accel::bsp::rank::rank;
use multiversion::multiversion;
use rayon::prelude::*;

use super::BspGrid;
use crate::device::CpuDevice;

/// Planes that one thread works off in a row.
const PLANES_AT_ONCE: usize = 1 << 12;
/// Cells that one thread works off in a row.
const CELLS_AT_ONCE: usize = 256;

/// Lists that sorting needs, to be used again.
#[derive(Clone, Debug, Default)]
pub struct BspOrder {
    /// All pieces, far to near.
    pub pieces: Vec<u32>,
    is_before: Vec<u8>,
    places: Vec<u32>,
}

/// Some trees, and where the places of their nodes and the order of their pieces go.
struct Work<'a> {
    cells: &'a [usize],
    places: &'a mut [u32],
    order: &'a mut [u32],
}

impl CpuDevice {
    /// Finds the order in which an eye (see [`micropoly_core::accel::bsp::lattice::Lattice::eye`]) sees all pieces, far to
    /// near.
    pub fn sort_bsp(&self, grid: &BspGrid, eye: [i64; 3], order: &mut BspOrder) {
        self.install(|| sort(grid, eye, order));
    }
}

fn sort(grid: &BspGrid, eye: [i64; 3], order: &mut BspOrder) {
    let BspOrder { pieces, is_before, places } = order;
    pieces.resize(grid.pieces.len(), 0);
    places.resize(grid.nodes.len(), 0);
    is_before.resize(grid.planes.len(), 0);
    let at_once = is_before.par_chunks_mut(PLANES_AT_ONCE).zip(grid.planes.par_chunks(PLANES_AT_ONCE));
    let sides = || at_once.for_each(|(is_before, planes)| note_sides(planes, eye, is_before));
    let (cells, ()) = rayon::join(|| far_to_near_cells(grid, eye), sides);
    let is_before = &is_before[..];
    let works = shared(grid, &cells, places, pieces);
    works.into_par_iter().for_each(|work| grid.rank(work, is_before));
}

/// Notes which planes an eye is before.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))]
fn note_sides(planes: &[Plane], eye: [i64; 3], is_before: &mut [u8]) {
    for (is_before, plane) in is_before.iter_mut().zip(planes) {
        *is_before = u8::from(plane.is_before(eye));
    }
}

/// Cells with something in them, far to near.
fn far_to_near_cells(grid: &BspGrid, eye: [i64; 3]) -> Vec<usize> {
    let BspFrame { slabs, eye_slabs, .. } = grid.frame(eye);
    let along = |axis: usize| {
        let (slabs, eye_slab) = (slabs[axis], eye_slabs[axis]);
        (0..slabs).map(move |place| far_to_near(slabs, eye_slab, place))
    };
    let mut cells = Vec::new();
    for x in along(0) {
        for y in along(1) {
            let row = (x * slabs[1] + y) * slabs[2];
            let cell = |z: u32| (row + z) as usize;
            cells.extend(along(2).map(cell).filter(|cell| !grid.nodes_of(*cell).is_empty()));
        }
    }
    cells
}

/// Cuts lists into those of some cells each.
fn shared<'a>(
    grid: &BspGrid,
    cells: &'a [usize],
    mut places: &'a mut [u32],
    mut order: &'a mut [u32],
) -> Vec<Work<'a>> {
    let share = |cells: &'a [usize]| {
        let nodes = cells.iter().map(|cell| grid.nodes_of(*cell).len()).sum();
        let pieces = cells.iter().map(|cell| grid.pieces_of(*cell).len()).sum();
        let own_places = places.split_off_mut(..nodes).unwrap_or_default();
        let own_order = order.split_off_mut(..pieces).unwrap_or_default();
        Work { cells, places: own_places, order: own_order }
    };
    cells.chunks(CELLS_AT_ONCE).map(share).collect()
}

impl BspGrid {
    /// What an eye's order goes by.
    #[must_use]
    pub fn frame(&self, eye: [i64; 3]) -> BspFrame {
        BspFrame::new(self.slabs.each_ref().map(Vec::as_slice), self.planes.len() as u32, eye)
    }

    /// The planes in words, for [`BspGrid::lists`].
    #[must_use]
    pub fn words(&self) -> Vec<BspPlane> {
        self.planes.iter().map(Plane::words).collect()
    }

    /// What a device needs to find the order.
    #[must_use]
    pub fn lists<'a>(&'a self, planes: &'a [BspPlane]) -> BspLists<'a> {
        BspLists {
            slabs: self.slabs.each_ref().map(Vec::as_slice),
            planes,
            first_nodes: &self.first_nodes,
            first_pieces: &self.first_pieces,
            nodes: &self.nodes,
        }
    }

    fn nodes_of(&self, cell: usize) -> std::ops::Range<usize> {
        self.first_nodes[cell] as usize..self.first_nodes[cell + 1] as usize
    }

    fn pieces_of(&self, cell: usize) -> std::ops::Range<usize> {
        self.first_pieces[cell] as usize..self.first_pieces[cell + 1] as usize
    }

    fn rank(&self, work: Work<'_>, is_before: &[u8]) {
        let (mut places, mut order) = (work.places, work.order);
        for cell in work.cells {
            let (nodes, pieces) = (self.nodes_of(*cell), self.pieces_of(*cell));
            let own_places = places.split_off_mut(..nodes.len()).unwrap_or_default();
            let own_order = order.split_off_mut(..pieces.len()).unwrap_or_default();
            let before = |triangle: usize| is_before[triangle] != 0;
            rank(&self.nodes[nodes], before, pieces.start as u32, own_places, own_order);
        }
    }
}
