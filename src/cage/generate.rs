//! Cages of any size, to measure with.

use std::f64::consts::TAU;

use libm::{cos, sin};

use super::Cage;

/// How the faces of a torus are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Quads, four at every vertex.
    Regular,
    /// The same, but for every fiftieth pair of neighbours, which are divided the other way: two vertices with three faces and
    /// two with five each.
    Turned,
    /// Triangles, six at every vertex.
    Triangles,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Regular, Self::Turned, Self::Triangles];

    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Turned => "turned",
            Self::Triangles => "triangles",
        }
    }
}

/// Pairs of columns from one pair of faces that is turned to the next, and rows likewise.
const TURNED: [u32; 2] = [5, 10];
/// The smallest number of rows and columns: with fewer, faces would meet themselves.
const LEAST: u32 = 3;

/// A bumpy torus of about so many faces, 2³¹ at most.
#[must_use]
pub fn torus_cage(faces: u32, layout: Layout) -> Cage {
    let quads = if layout == Layout::Triangles { faces / 2 } else { faces }.min(1 << 31);
    let columns = (f64::from(quads).sqrt() as u32).max(LEAST).next_multiple_of(2);
    let grid = Grid { columns, rows: quads.div_ceil(columns).max(LEAST) };
    let mut cage = Cage { positions: grid.positions(), ..Cage::default() };
    match layout {
        Layout::Triangles => {
            cage.corners = grid.quads().flat_map(|[a, b, c, d]| [a, b, c, a, c, d]).collect();
            cage.face_sizes = vec![3; cage.corners.len() / 3];
        }
        Layout::Regular => cage.corners = grid.quads().flatten().collect(),
        Layout::Turned => cage.corners = grid.turned_pairs().flatten().flatten().collect(),
    }
    if layout != Layout::Triangles {
        cage.face_sizes = vec![4; cage.corners.len() / 4];
    }
    cage
}

struct Grid {
    columns: u32,
    rows: u32,
}

impl Grid {
    fn positions(&self) -> Vec<[f64; 3]> {
        let places = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        places.map(|(row, column)| self.position(row, column)).collect()
    }

    fn position(&self, row: u32, column: u32) -> [f64; 3] {
        let along = TAU * f64::from(column) / f64::from(self.columns);
        let around = TAU * f64::from(row) / f64::from(self.rows);
        let radius = 0.4 + 0.02 * sin(12.0 * along) * cos(7.0 * around);
        let from_axis = 1.0 + radius * cos(around);
        [from_axis * cos(along), from_axis * sin(along), radius * sin(around)]
    }

    fn vertex(&self, row: u32, column: u32) -> u32 {
        row % self.rows * self.columns + column % self.columns
    }

    fn quad(&self, row: u32, column: u32) -> [u32; 4] {
        let corners = [(0, 0), (0, 1), (1, 1), (1, 0)];
        corners.map(|(down, across)| self.vertex(row + down, column + across))
    }

    fn quads(&self) -> impl Iterator<Item = [u32; 4]> {
        (0..self.rows).flat_map(move |row| (0..self.columns).map(move |column| self.quad(row, column)))
    }

    /// Quads in pairs along the rows, some of which are divided along another diagonal of their hexagon.
    fn turned_pairs(&self) -> impl Iterator<Item = [[u32; 4]; 2]> {
        let pairs = (0..self.rows).flat_map(move |row| (0..self.columns / 2).map(move |pair| (row, pair)));
        pairs.map(|(row, pair)| {
            let [[a, b, e, f], [_, c, d, _]] = [2 * pair, 2 * pair + 1].map(|column| self.quad(row, column));
            let is_turned = pair % TURNED[0] == 2 && row % TURNED[1] == 5;
            if is_turned { [[a, b, c, f], [c, d, e, f]] } else { [[a, b, e, f], [b, c, d, e]] }
        })
    }
}
