//! dice: a drawn surface becomes a grid of vertices, each a pure function of patch and dyadic parameter.
//!
//! Rows run along u. The control points of all rows' iso-curves are found first, then the vertices, a
//! coordinate an array and [`LANES`] vertices at once, so that compilers turn each loop into vector
//! instructions.

use crate::abi::{FLAT, Frame, MAX_RATE, PARALLEL, PARAM_ONE, Surface};
use crate::kernel::project::project;
use crate::kernel::seam::{Seam, seams};
use crate::num::{cross3, dot3, largest3, max, min, mul, rsqrt, scale3, sub, unit_scale};
use crate::patch::Net;
use crate::patch::bezier::{blend3, blend4, cubic, cubic_slope, param};
use crate::patch::net::fold;

/// Vertices that are worked on at once.
pub const LANES: usize = 8;
/// Blocks of lanes that a row of the largest grid needs.
const BLOCKS: usize = (MAX_RATE as usize + 1).div_ceil(LANES);
/// Vertices of the largest grid; its last row is filled up to whole lanes.
pub const GRID: usize = MAX_RATE as usize * (MAX_RATE as usize + 1) + BLOCKS * LANES;

/// One number a vertex.
type Lane = [f32; GRID];

/// Vertices of a diced surface: row `r`, column `c` at index `r · stride + c`.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Vertices a row: the dice rate + 1.
    pub stride: usize,
    /// Snapped column, 1/256 pixels.
    pub x: [i32; GRID],
    /// Snapped row, 1/256 pixels.
    pub y: [i32; GRID],
    /// 1 / distance; 0 = must be clipped (see [`crate::kernel::project::Vertex`]).
    pub w: Lane,
    /// Eye-space position: x, y, z.
    pub position: [Lane; 3],
    /// Unit normal in eye space: x, y, z.
    pub normal: [Lane; 3],
    /// Colour, linear RGB; written by `shade`.
    pub colour: [Lane; 3],
    /// What closes the gaps to coarser neighbours along the borders v = low, v = high, u = low, u = high.
    pub seams: [Seam; 4],
    /// Derivatives along u and along v, until they become the normal.
    pub(super) tangents: [[Lane; 3]; 2],
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            stride: 0,
            x: [0; GRID],
            y: [0; GRID],
            w: [0.0; GRID],
            position: [[0.0; GRID]; 3],
            normal: [[0.0; GRID]; 3],
            colour: [[0.0; GRID]; 3],
            seams: [Seam::default(); 4],
            tangents: [[[0.0; GRID]; 3]; 2],
        }
    }
}

impl Grid {
    /// Where the lanes start that hold all vertices.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.stride * self.stride).step_by(LANES)
    }

    /// Eye-space position of a vertex.
    #[inline(always)]
    #[must_use]
    pub fn point(&self, at: usize) -> [f32; 3] {
        [self.position[0][at], self.position[1][at], self.position[2][at]]
    }

    /// Unit normal of a vertex.
    #[inline(always)]
    #[must_use]
    pub fn unit_normal(&self, at: usize) -> [f32; 3] {
        [self.normal[0][at], self.normal[1][at], self.normal[2][at]]
    }
}

/// Fills positions, normals and snapped vertices of `surface`, `frame.rate` + 1 rows and columns.
///
/// `net` is the patch's control net in eye space.
#[inline(always)]
pub fn dice(net: &Net, frame: &Frame, surface: Surface, grid: &mut Grid) {
    prepare_grid(frame, seams(net, frame, surface), grid);
    let rate = frame.rate;
    let (step_u, step_v) = (surface.u_size() / rate, surface.v_size() / rate);
    let mut columns = [Weights::<LANES>::ZERO; BLOCKS];
    for (first, columns) in (0..=rate).step_by(LANES).zip(&mut columns) {
        *columns = Weights::new(surface.u, step_u, first, rate);
    }
    for first_row in (0..=rate).step_by(LANES) {
        let curves = IsoCurves::new(net, &Weights::<LANES>::new(surface.v, step_v, first_row, rate));
        for row in first_row..=rate.min(first_row + LANES as u32 - 1) {
            let curve = curves.at((row - first_row) as usize);
            for (block, columns) in (0..grid.stride).step_by(LANES).zip(&columns) {
                evaluate(&curve, columns, row as usize * grid.stride + block, grid);
            }
        }
    }
    finish_grid(net, frame, surface, grid);
}

/// What a grid has before its vertices: their number and the seams.
#[inline(always)]
pub(super) fn prepare_grid(frame: &Frame, seams: [Seam; 4], grid: &mut Grid) {
    grid.stride = frame.rate as usize + 1;
    grid.seams = seams;
}

/// Normals and snapped vertices, from positions and tangents.
#[inline(always)]
pub(super) fn finish_grid(net: &Net, frame: &Frame, surface: Surface, grid: &mut Grid) {
    let flat = mul(size(net), FLAT);
    for block in grid.blocks() {
        finish(frame, block, flat, grid);
    }
    mend_normals(net, surface, flat, grid);
}

/// Bernstein weights of vertices along one side of a grid, an array a weight.
#[derive(Clone, Copy)]
struct Weights<const N: usize> {
    cubic: [[f32; N]; 4],
    slope: [[f32; N]; 3],
}

impl<const N: usize> Weights<N> {
    const ZERO: Self = Self { cubic: [[0.0; N]; 4], slope: [[0.0; N]; 3] };

    /// From vertex number `first` on; beyond the last, number `rate`, that one is repeated.
    #[inline(always)]
    fn new(start: u32, step: u32, first: u32, rate: u32) -> Self {
        let mut out = Self::ZERO;
        for l in 0..N {
            let place = first + l as u32;
            let t = param(start + step * if place < rate { place } else { rate });
            [out.cubic[0][l], out.cubic[1][l], out.cubic[2][l], out.cubic[3][l]] = cubic(t);
            [out.slope[0][l], out.slope[1][l], out.slope[2][l]] = cubic_slope(t);
        }
        out
    }

    #[inline(always)]
    fn cubic_at(&self, l: usize) -> [f32; 4] {
        [self.cubic[0][l], self.cubic[1][l], self.cubic[2][l], self.cubic[3][l]]
    }

    #[inline(always)]
    fn slope_at(&self, l: usize) -> [f32; 3] {
        [self.slope[0][l], self.slope[1][l], self.slope[2][l]]
    }
}

impl Weights<1> {
    /// The weights of one parameter.
    #[inline(always)]
    fn at(t: u32) -> Self {
        Self::new(t, 0, 0, 0)
    }
}

/// The curves `v` = constant of several rows at once: coordinate, control point, row.
struct IsoCurves<const N: usize> {
    point: [[[f32; N]; 4]; 3],
    across: [[[f32; N]; 4]; 3],
}

impl<const N: usize> IsoCurves<N> {
    #[inline(always)]
    fn new(net: &Net, rows: &Weights<N>) -> Self {
        let mut out = Self { point: [[[0.0; N]; 4]; 3], across: [[[0.0; N]; 4]; 3] };
        for (k, c) in [&net.x, &net.y, &net.z].into_iter().enumerate() {
            for i in 0..4 {
                let p = [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]];
                let steps = [sub(p[1], p[0]), sub(p[2], p[1]), sub(p[3], p[2])];
                for row in 0..N {
                    out.point[k][i][row] = blend4(rows.cubic_at(row), p);
                    out.across[k][i][row] = blend3(rows.slope_at(row), steps);
                }
            }
        }
        out
    }

    #[inline(always)]
    fn at(&self, row: usize) -> IsoCurve {
        let mut curve = IsoCurve { point: [[0.0; 4]; 3], along: [[0.0; 3]; 3], across: [[0.0; 4]; 3] };
        for k in 0..3 {
            for i in 0..4 {
                curve.point[k][i] = self.point[k][i][row];
                curve.across[k][i] = self.across[k][i][row];
            }
            for i in 0..3 {
                curve.along[k][i] = sub(self.point[k][i + 1][row], self.point[k][i][row]);
            }
        }
        curve
    }
}

/// The curve `v` = constant of a patch: control points, differences along u, derivatives across.
struct IsoCurve {
    point: [[f32; 4]; 3],
    along: [[f32; 3]; 3],
    across: [[f32; 4]; 3],
}

/// [`LANES`] numbers of a grid from an index on.
#[inline(always)]
pub(crate) fn load<T: Copy>(all: &[T; GRID], at: usize) -> [T; LANES] {
    let mut lanes = [all[at]; LANES];
    lanes.copy_from_slice(&all[at..at + LANES]);
    lanes
}

/// Puts [`LANES`] numbers into a grid from an index on.
#[inline(always)]
pub(crate) fn store<T: Copy>(all: &mut [T; GRID], at: usize, lanes: &[T; LANES]) {
    all[at..at + LANES].copy_from_slice(lanes);
}

/// Three coordinates of [`LANES`] vertices.
#[inline(always)]
pub(crate) fn load3(all: &[Lane; 3], at: usize) -> [[f32; LANES]; 3] {
    [load(&all[0], at), load(&all[1], at), load(&all[2], at)]
}

/// Positions and tangents of [`LANES`] vertices of one row, from index `at` of the grid on.
///
/// What they write beyond the row's end is overwritten by the next row.
#[inline(always)]
fn evaluate(curve: &IsoCurve, columns: &Weights<LANES>, at: usize, grid: &mut Grid) {
    for k in 0..3 {
        let (mut position, mut du, mut dv) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            position[l] = blend4(columns.cubic_at(l), curve.point[k]);
            du[l] = blend3(columns.slope_at(l), curve.along[k]);
            dv[l] = blend4(columns.cubic_at(l), curve.across[k]);
        }
        store(&mut grid.position[k], at, &position);
        store(&mut grid.tangents[0][k], at, &du);
        store(&mut grid.tangents[1][k], at, &dv);
    }
}

/// Normals and snapped vertices of [`LANES`] vertices.
#[inline(always)]
fn finish(frame: &Frame, block: usize, flat: f32, grid: &mut Grid) {
    let (du, dv) = (load3(&grid.tangents[0], block), load3(&grid.tangents[1], block));
    let mut normal = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let (du, dv) = ([du[0][l], du[1][l], du[2][l]], [dv[0][l], dv[1][l], dv[2][l]]);
        [normal[0][l], normal[1][l], normal[2][l]] = unit_normal(du, dv, flat);
    }
    for (all, lanes) in grid.normal.iter_mut().zip(&normal) {
        store(all, block, lanes);
    }
    let point = load3(&grid.position, block);
    let (mut x, mut y, mut w) = ([0; LANES], [0; LANES], [0.0; LANES]);
    for l in 0..LANES {
        let vertex = project(frame, [point[0][l], point[1][l], point[2][l]]);
        (x[l], y[l], w[l]) = (vertex.x, vertex.y, vertex.w);
    }
    store(&mut grid.x, block, &x);
    store(&mut grid.y, block, &y);
    store(&mut grid.w, block, &w);
}

/// Position of a vertex by itself: the same bits as in a grid.
#[inline(always)]
#[must_use]
pub fn position_at(net: &Net, u: u32, v: u32) -> [f32; 3] {
    let (row, column) = (Weights::<1>::at(v), Weights::<1>::at(u));
    let curve = IsoCurves::new(net, &row).at(0);
    let at = column.cubic_at(0);
    [blend4(at, curve.point[0]), blend4(at, curve.point[1]), blend4(at, curve.point[2])]
}

/// Largest side of the box around the control points.
#[inline(always)]
fn size(net: &Net) -> f32 {
    max(max(side(&net.x), side(&net.y)), side(&net.z))
}

#[inline(always)]
fn side(c: &[f32; 16]) -> f32 {
    sub(fold(c, max), fold(c, min))
}

/// Unit vector along `du` × `dv`, or zero where a tangent is not longer than `flat` or both are parallel.
///
/// The tangents are scaled by powers of two first, so that no product can reach the denormals.
#[inline(always)]
#[must_use]
pub fn unit_normal(du: [f32; 3], dv: [f32; 3], flat: f32) -> [f32; 3] {
    let (long_u, long_v) = (largest3(du), largest3(dv));
    let normal = cross3(scale3(du, unit_scale(long_u)), scale3(dv, unit_scale(long_v)));
    let square = dot3(normal, normal);
    let sound = (long_u > flat) & (long_v > flat) & (square > PARALLEL);
    let scale = if sound { rsqrt(max(square, PARALLEL)) } else { 0.0 };
    scale3(normal, scale)
}

/// Replaces normals that vanished: at collapsed edges, cusps, zero-area patches.
#[inline(always)]
fn mend_normals(net: &Net, surface: Surface, flat: f32, grid: &mut Grid) {
    let mut vanished = 0;
    for block in grid.blocks() {
        let normal = load3(&grid.normal, block);
        for l in 0..LANES {
            vanished += u32::from(largest3([normal[0][l], normal[1][l], normal[2][l]]) < 0.5);
        }
    }
    if vanished > 0 {
        mend_each(net, surface, flat, grid);
    }
}

#[cold]
fn mend_each(net: &Net, surface: Surface, flat: f32, grid: &mut Grid) {
    let rate = grid.stride as u32 - 1;
    let (step_u, step_v) = (surface.u_size() / rate, surface.v_size() / rate);
    for at in 0..grid.stride * grid.stride {
        let (row, column) = ((at / grid.stride) as u32, (at % grid.stride) as u32);
        if largest3(grid.unit_normal(at)) < 0.5 {
            let normal = normal_nearby(net, surface.u + column * step_u, surface.v + row * step_v, flat);
            [grid.normal[0][at], grid.normal[1][at], grid.normal[2][at]] = normal;
        }
    }
}

/// The normal a 64th of the way towards the patch's middle, where a collapsed edge has opened; if there is
/// none, that of the patch's diagonals; if there is none either, towards the eye.
#[must_use]
pub fn normal_nearby(net: &Net, u: u32, v: u32, flat: f32) -> [f32; 3] {
    let inward = |t: u32| t - t / 64 + PARAM_ONE / 128;
    let (row, column) = (Weights::<1>::at(inward(v)), Weights::<1>::at(inward(u)));
    let curve = IsoCurves::new(net, &row).at(0);
    let (cubic, slope) = (column.cubic_at(0), column.slope_at(0));
    let du = curve.along.map(|along| blend3(slope, along));
    let dv = curve.across.map(|across| blend4(cubic, across));
    let nearby = unit_normal(du, dv, flat);
    if largest3(nearby) > 0.5 {
        return nearby;
    }
    let chord =
        |a: usize, b: usize| [sub(net.x[b], net.x[a]), sub(net.y[b], net.y[a]), sub(net.z[b], net.z[a])];
    let diagonal = unit_normal(chord(0, 15), chord(12, 3), 0.0);
    if largest3(diagonal) > 0.5 { diagonal } else { [0.0, 0.0, 1.0] }
}
