//! How a mesh becomes pieces that can be put into order for any eye, and what that takes (Imre 2016, Table 6.1).

mod naive;
pub mod on_device;
pub mod pieces;

use std::time::Instant;

use micropoly_backend_cpu::{BspError, BspGrid, BspOptions, BspOrder, CpuDevice};
use rdst::{RadixKey, RadixSort};
use serde::Serialize;

use crate::Camera;
use crate::accel::mesh::TriangleMesh;
use crate::error::{Error, Result};

/// Corners of a triangle.
pub type Triangle = [[f32; 3]; 3];

/// What cutting a mesh took, and what it gave.
#[derive(Clone, Debug, Serialize)]
pub struct Cut {
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Of these, so many have no area on the lattice, and no pieces.
    pub degenerate: usize,
    /// Cells along each axis.
    pub grid: [usize; 3],
    /// See [`BspOptions::tolerance`].
    pub tolerance: f64,
    /// Pieces after the grid alone, for each triangle.
    pub grid_growth: f64,
    /// Pieces.
    pub pieces: usize,
    /// Pieces for each triangle.
    pub growth: f64,
    /// Nodes of all trees.
    pub nodes: usize,
    /// Bytes of all lists.
    pub bytes: usize,
    /// Milliseconds, the shortest of all runs.
    pub milliseconds: f64,
}

/// What putting the pieces into order took.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sorted {
    /// Milliseconds, the shortest of all runs.
    pub milliseconds: f64,
    /// The same of a radix sort of the triangles by the distance of their centroids, which is not exact.
    pub radix_milliseconds: f64,
}

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The mesh.
    pub mesh: String,
    /// Cutting it.
    pub cut: Cut,
    /// Sorting its pieces for one view.
    pub sorted: Sorted,
}

/// Cuts triangles `repeat` times, on so many threads (0 = one a core).
///
/// # Errors
/// [`Error::Scene`] if they cannot be cut.
pub fn cut(
    triangles: &[Triangle],
    options: &BspOptions,
    threads: usize,
    repeat: u32,
) -> Result<(BspGrid, Cut)> {
    let device = CpuDevice::new(threads).map_err(|error| Error::on_device(&error))?;
    let start = Instant::now();
    let mut grid = device.build_bsp(triangles, options).map_err(unfit)?;
    let mut milliseconds = elapsed(start);
    for _ in 1..repeat {
        drop(grid);
        let start = Instant::now();
        grid = device.build_bsp(triangles, options).map_err(unfit)?;
        milliseconds = elapsed(start).min(milliseconds);
    }
    let growth = |pieces: usize| pieces as f64 / triangles.len().max(1) as f64;
    let cut = Cut {
        triangles: triangles.len(),
        degenerate: grid.degenerate,
        grid: grid.slabs.each_ref().map(Vec::len),
        tolerance: options.tolerance,
        grid_growth: growth(grid.grid_pieces),
        pieces: grid.pieces.len(),
        growth: growth(grid.pieces.len()),
        nodes: grid.nodes.len(),
        bytes: grid.bytes(),
        milliseconds,
    };
    Ok((grid, cut))
}

/// Where a camera is, in units of the grid's lattice.
///
/// # Errors
/// [`Error::Scene`] if it is too far away.
pub fn eye(grid: &BspGrid, camera: &Camera) -> Result<[i64; 3]> {
    let place = camera.view.inverse().translation;
    grid.lattice.eye(place.to_array()).ok_or_else(too_far)
}

/// Puts the pieces into order for a camera, and in turns, the triangles by their centroids; on all threads.
///
/// # Errors
/// [`Error::Scene`] if the camera is too far away.
pub fn sort(
    grid: &BspGrid,
    triangles: &[Triangle],
    camera: &Camera,
    repeat: u32,
) -> Result<(BspOrder, Sorted)> {
    let device = CpuDevice::new(0).map_err(|error| Error::on_device(&error))?;
    let eye = eye(grid, camera)?;
    let from = camera.view.inverse().translation.as_vec3().to_array();
    let (mut order, mut keys) = (BspOrder::default(), Vec::new());
    let mut sorted = Sorted { milliseconds: f64::INFINITY, radix_milliseconds: f64::INFINITY };
    for _ in 0..repeat.max(1) {
        let start = Instant::now();
        device.sort_bsp(grid, eye, &mut order);
        sorted.milliseconds = elapsed(start).min(sorted.milliseconds);
        let start = Instant::now();
        by_centroids(triangles, from, &mut keys);
        sorted.radix_milliseconds = elapsed(start).min(sorted.radix_milliseconds);
    }
    Ok((order, sorted))
}

/// A triangle and the bits of its distance, far to near.
#[derive(Clone, Copy)]
struct Key {
    distance: u32,
    triangle: u32,
}

impl RadixKey for Key {
    const LEVELS: usize = 4;

    fn get_level(&self, level: usize) -> u8 {
        (self.distance >> (8 * level)) as u8
    }
}

fn by_centroids(triangles: &[Triangle], eye: [f32; 3], keys: &mut Vec<Key>) {
    keys.clear();
    keys.extend((0..).zip(triangles).map(|(triangle, [a, b, c])| {
        let away = |k: usize| a[k] + b[k] + c[k] - 3.0 * eye[k];
        let square: f32 = (0..3).map(|k| away(k) * away(k)).sum();
        Key { distance: !square.to_bits(), triangle }
    }));
    keys.radix_sort_unstable();
    // What nobody looks at need not be sorted.
    std::hint::black_box(keys.first().map(|key| key.triangle));
}

pub(crate) fn too_far() -> Error {
    Error::scene(
        "the camera is more than 500 times as far away as the mesh is large, too far to sort it",
        "move it nearer, or use --transparency layers",
    )
}

pub(crate) fn unfit(error: BspError) -> Error {
    match error {
        BspError::Pieces { most } => Error::scene(
            format!("the triangles cut each other into more than {most} pieces"),
            "choose another --bsp-grid, a --bsp-tolerance, or --transparency layers",
        ),
        BspError::Triangles => {
            Error::scene("there are more than 2^30 triangles", "use --transparency layers")
        }
        BspError::Corner { triangle } => Error::scene(
            format!("triangle {triangle} (counted from 0) has a corner that is not finite"),
            "scale the scene down",
        ),
    }
}

/// Cells along each axis in the thesis's table.
const GRIDS: [u32; 3] = [25, 30, 35];
/// Exact, and the class of tolerance of the thesis.
const TOLERANCES: [f64; 2] = [0.0, 1.0e-3];

/// What one tree over all of a mesh takes on one thread.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OneTree {
    /// Pieces for each triangle.
    pub growth: f64,
    /// Milliseconds.
    pub milliseconds: f64,
}

/// The table of a mesh.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Grids and tolerances.
    pub rows: Vec<Row>,
    /// One tree over all of the mesh: in floats, planes in random order.
    pub naive: OneTree,
}

/// Measures one tree over all of the mesh, and grids and tolerances, which are told one by one.
/// What is over sooner is run more often.
///
/// # Errors
/// As [`cut`] and [`sort`].
pub fn measure(
    name: &str,
    mesh: &TriangleMesh,
    repeat: u32,
    mut progress: impl FnMut(&Row, &OneTree),
) -> Result<Table> {
    let (triangles, camera) = (&mesh.triangles, mesh.camera()?);
    let naive = naive_tree(triangles, repeat);
    let mut rows = Vec::new();
    for tolerance in TOLERANCES {
        for grid in GRIDS {
            let options = BspOptions { grid: Some(grid), tolerance, ..BspOptions::default() };
            let (grid, cut) = cut(triangles, &options, 0, 8 * repeat)?;
            let (_, sorted) = sort(&grid, triangles, &camera, 10 * repeat)?;
            let row = Row { mesh: name.to_owned(), cut, sorted };
            progress(&row, &naive);
            rows.push(row);
        }
    }
    Ok(Table { rows, naive })
}

fn naive_tree(triangles: &[Triangle], repeat: u32) -> OneTree {
    let (mut pieces, mut milliseconds) = (0, f64::INFINITY);
    for _ in 0..repeat.max(1) {
        let start = Instant::now();
        let tree = naive::build(triangles);
        milliseconds = elapsed(start).min(milliseconds);
        pieces = tree.pieces;
    }
    OneTree { growth: pieces as f64 / triangles.len().max(1) as f64, milliseconds }
}

fn elapsed(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
