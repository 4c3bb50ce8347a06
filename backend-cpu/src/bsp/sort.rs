//! The order of all pieces for an eye: cells, then the trees in them, all at once.

use micropoly_core::accel::bsp::cells::{far_to_near, slab_of};
use micropoly_core::accel::bsp::rank::rank;
use rayon::prelude::*;

use super::BspGrid;
use crate::device::CpuDevice;

/// Pieces that one thread works off in a row, about.
const PIECES_AT_ONCE: usize = 1 << 14;

/// Lists that sorting needs, to be used again.
#[derive(Clone, Debug, Default)]
pub struct BspOrder {
    /// All pieces, far to near.
    pub pieces: Vec<u32>,
    is_before: Vec<u8>,
    places: Vec<u32>,
}

/// Trees, the places of their nodes and pieces.
struct Work<'a> {
    cells: Vec<usize>,
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
    is_before
        .par_iter_mut()
        .zip(&grid.planes)
        .with_min_len(PIECES_AT_ONCE)
        .for_each(|(is_before, plane)| *is_before = u8::from(plane.is_before(eye)));
    let is_before = &is_before[..];
    shared(grid, eye, places, pieces).into_par_iter().for_each(|work| grid.rank(work, is_before));
}

/// Cells in order, some at a time.
fn shared<'a>(grid: &BspGrid, eye: [i64; 3], places: &'a mut [u32], order: &'a mut [u32]) -> Vec<Work<'a>> {
    let mut all = Vec::new();
    let (mut cells, mut nodes, mut pieces) = (Vec::new(), 0, 0);
    let (mut places, mut order) = (places, order);
    let mut close = |cells: &mut Vec<usize>, nodes: &mut usize, pieces: &mut usize| {
        let (own_places, later) = std::mem::take(&mut places).split_at_mut(*nodes);
        places = later;
        let (own_order, later) = std::mem::take(&mut order).split_at_mut(*pieces);
        order = later;
        all.push(Work { cells: std::mem::take(cells), places: own_places, order: own_order });
        (*nodes, *pieces) = (0, 0);
    };
    let [xs, ys, zs] = [0, 1, 2].map(|axis| {
        let ends = &grid.slabs[axis];
        far_to_near(ends.len() as u32, slab_of(ends, eye[axis]))
    });
    for x in xs {
        for y in ys.clone() {
            let row = (x as usize * grid.slabs[1].len() + y as usize) * grid.slabs[2].len();
            for z in zs.clone() {
                let cell = row + z as usize;
                let count = grid.nodes_of(cell).len();
                if count > 0 {
                    cells.push(cell);
                    nodes += count;
                    pieces += grid.pieces_of(cell).len();
                }
            }
        }
        if pieces > PIECES_AT_ONCE {
            close(&mut cells, &mut nodes, &mut pieces);
        }
    }
    close(&mut cells, &mut nodes, &mut pieces);
    all
}

impl BspGrid {
    fn nodes_of(&self, cell: usize) -> std::ops::Range<usize> {
        self.first_nodes[cell] as usize..self.first_nodes[cell + 1] as usize
    }

    fn pieces_of(&self, cell: usize) -> std::ops::Range<usize> {
        self.first_pieces[cell] as usize..self.first_pieces[cell + 1] as usize
    }

    fn rank(&self, work: Work<'_>, is_before: &[u8]) {
        let (mut places, mut order) = (work.places, work.order);
        for cell in work.cells {
            let (nodes, pieces) = (self.nodes_of(cell), self.pieces_of(cell));
            let (own_places, later) = places.split_at_mut(nodes.len());
            places = later;
            let (own_order, later) = order.split_at_mut(pieces.len());
            order = later;
            rank(&self.nodes[nodes], is_before, pieces.start as u32, own_places, own_order);
        }
    }
}
