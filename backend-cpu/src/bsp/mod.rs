//! The BSP-grid on all threads: `micropoly_core::accel::bsp` over a mesh.
//!
//! | step | file |
//! |---|---|
//! | triangles are cut into the cells of a grid | `cut.rs` |
//! | a tree in each cell | `tree.rs` |
//! | the rest of a tree, once few parts are left | `few.rs` |
//! | corners that those have in common | `shared.rs` |
//! | a piece that planes cut | `clip.rs` |
//! | the order of all pieces for an eye | `sort.rs` |
//! | the same order, as the stages of any device find it | `stages.rs` |
//! | samples that blend them in that order | `draw.rs` |
//!
//! All lists are counted, summed up and filled, or grow; nothing is dropped. What is built does not depend on the number of
//! threads.

mod clip;
mod cut;
mod draw;
mod few;
mod shared;
mod sort;
pub(crate) mod stages;
mod tree;

use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::bsp::cells::{slab_end, slab_plane};
use micropoly_core::accel::bsp::lattice::{Lattice, Point};
use micropoly_core::accel::bsp::plane::Plane;
use micropoly_core::accel::bsp::polygon::{Cut, Cutter, MOST_SLABS, MOST_TRIANGLES};
use micropoly_core::accel::bsp::rank::BspNode;
use rayon::prelude::*;

pub use draw::{BspShot, BspSight};
pub use sort::BspOrder;

use crate::device::CpuDevice;
use tree::Rules;

/// How a BSP-grid is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BspOptions {
    /// Cells along each axis; chosen from the number of triangles if there is nothing here.
    pub grid: Option<u32>,
    /// What is nearer to a plane than this share of the longest side of the mesh is not cut by it; 0 is exact.
    pub tolerance: f64,
    /// Planes that are tried for each node of many pieces: the more, the fewer pieces, and the longer it takes. Of few
    /// pieces all are tried; with 1 always the first is taken.
    pub candidates: u32,
    /// Most pieces that there may be.
    pub most_pieces: u32,
}

impl Default for BspOptions {
    fn default() -> Self {
        Self { grid: None, tolerance: 0.0, candidates: 4, most_pieces: 1 << 28 }
    }
}

/// Why there is no BSP-grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BspError {
    /// Planes cut the triangles into more pieces than there may be.
    Pieces {
        /// So many.
        most: u32,
    },
    /// There are more triangles than cuts can name.
    Triangles,
    /// A corner is not finite.
    Corner {
        /// Of this triangle.
        triangle: usize,
    },
}

/// A piece of a triangle: what is left of it between some planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The triangle.
    pub triangle: u32,
    /// First of its cuts; they end where the next piece's begin.
    pub first_cut: u32,
}

/// The pieces of a mesh, in a grid of trees.
#[derive(Clone, Debug, PartialEq)]
pub struct BspGrid {
    /// Where corners are.
    pub lattice: Lattice,
    /// Last coordinates of slabs of cells, along each axis.
    pub slabs: [Vec<i32>; 3],
    /// The triangles' corners.
    pub triangles: Vec<[Point; 3]>,
    /// Their planes.
    pub planes: Vec<Plane>,
    /// First node of each cell, those along z first, then y, then x; and one past the last.
    pub first_nodes: Vec<u32>,
    /// First piece of each cell, and one past the last.
    pub first_pieces: Vec<u32>,
    /// The nodes of all trees.
    pub nodes: Vec<BspNode>,
    /// The pieces of all nodes.
    pub pieces: Vec<Piece>,
    /// The cuts of all pieces, without the sides of the triangles.
    pub cuts: Vec<Cut>,
    /// Pieces after the grid cut the triangles, before planes of triangles did.
    pub grid_pieces: usize,
    /// Triangles without area on the lattice, which nobody can see: they have no pieces.
    pub degenerate: usize,
}

impl CpuDevice {
    /// Builds the BSP-grid of triangles.
    ///
    /// # Errors
    /// [`BspError`].
    pub fn build_bsp(&self, triangles: &[[[f32; 3]; 3]], options: &BspOptions) -> Result<BspGrid, BspError> {
        self.install(|| build(triangles, options))
    }
}

/// Cells along each axis, so that there are some triangles in each that a mesh passes through.
fn chosen_grid(triangles: usize) -> u32 {
    (libm::cbrt(triangles as f64) * 0.6).clamp(1.0, f64::from(MOST_SLABS)) as u32
}

fn build(triangles: &[[[f32; 3]; 3]], options: &BspOptions) -> Result<BspGrid, BspError> {
    if triangles.len() as u64 > u64::from(MOST_TRIANGLES) {
        return Err(BspError::Triangles);
    }
    let bounds = bounds(triangles)?;
    let lattice = Lattice::new(&bounds);
    let snapped = |[a, b, c]: &[[f32; 3]; 3]| {
        let corners = [lattice.snap(*a), lattice.snap(*b), lattice.snap(*c)];
        (corners, Plane::of(corners))
    };
    let (mut corners, mut planes) = (Vec::new(), Vec::new());
    triangles.par_iter().map(snapped).unzip_into_vecs(&mut corners, &mut planes);
    let grid = options.grid.unwrap_or_else(|| chosen_grid(triangles.len())).clamp(1, MOST_SLABS);
    let (low, high) = (lattice.snap(bounds.low), lattice.snap(bounds.high));
    let slabs = [0, 1, 2].map(|axis| slab_ends(low[axis], high[axis], grid));
    let longest = (0..3).map(|axis| high[axis] - low[axis]).max().unwrap_or(0);
    let rules = Rules {
        tolerance: options.tolerance * f64::from(longest),
        candidates: options.candidates.max(1) as usize,
        most_pieces: options.most_pieces,
    };
    let degenerate = planes.par_iter().filter(|plane| plane.is_none()).count();
    let parts = cut::into_cells(&corners, &planes, &slabs);
    let grid_pieces = parts.count();
    let trees = tree::build(&corners, &planes, &slabs, &parts, &rules)?;
    Ok(BspGrid {
        lattice,
        slabs,
        triangles: corners,
        planes,
        first_nodes: trees.first_nodes,
        first_pieces: trees.first_pieces,
        nodes: trees.all.nodes,
        pieces: trees.all.pieces,
        cuts: trees.all.cuts,
        grid_pieces,
        degenerate,
    })
}

/// The box around triangles, all of whose corners are finite; around the origin if there are none.
fn bounds(triangles: &[[[f32; 3]; 3]]) -> Result<Bounds, BspError> {
    let is_finite = |triangle: &[[f32; 3]; 3]| triangle.as_flattened().iter().all(|c| c.is_finite());
    let some = |triangle: &[[f32; 3]; 3]| is_finite(triangle).then(|| Bounds::of(triangle));
    match triangles.par_iter().map(some).try_reduce(|| Bounds::NONE, |a, b| Some(a.union(b))) {
        Some(_) if triangles.is_empty() => Ok(Bounds::of(&[[0.0; 3]])),
        Some(bounds) => Ok(bounds),
        None => {
            let triangle = triangles.iter().position(|triangle| !is_finite(triangle)).unwrap_or(0);
            Err(BspError::Corner { triangle })
        }
    }
}

/// Slabs of the same size; no more than there are coordinates.
fn slab_ends(low: i32, high: i32, slabs: u32) -> Vec<i32> {
    let slabs = slabs.min((high - low).unsigned_abs()).max(1);
    (0..slabs).map(|slab| slab_end(low, high, slab, slabs)).collect()
}

impl BspGrid {
    /// The cuts of a piece.
    #[must_use]
    pub fn cuts_of(&self, piece: u32) -> &[Cut] {
        let index = piece as usize;
        let end = self.pieces.get(index + 1).map_or(self.cuts.len(), |next| next.first_cut as usize);
        &self.cuts[self.pieces[index].first_cut as usize..end]
    }

    /// The plane of a cut.
    #[must_use]
    pub fn plane(&self, cut: Cut) -> Plane {
        match cut.cutter() {
            Cutter::Triangle(cutter) => self.planes[cutter as usize],
            Cutter::Slab { axis, slab } => slab_plane(&self.slabs[axis], axis, slab),
        }
    }

    /// The line of a cut in a triangle, above 0 on the side that is kept (see [`Corner::line`]).
    ///
    /// [`Corner::line`]: micropoly_core::accel::bsp::polygon::Corner::line
    #[must_use]
    pub fn line(&self, triangle: usize, cut: Cut) -> [i64; 3] {
        let way = if cut.keeps_back() { -1 } else { 1 };
        self.plane(cut).values(self.triangles[triangle]).map(|value| value * way)
    }

    /// Bytes of all lists.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.triangles[..])
            + size_of_val(&self.planes[..])
            + size_of_val(&self.first_nodes[..])
            + size_of_val(&self.first_pieces[..])
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.pieces[..])
            + size_of_val(&self.cuts[..])
    }
}
