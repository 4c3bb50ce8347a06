//! dice: a drawn surface becomes a grid of vertices, each a pure function of patch and dyadic parameter.
//!
//! Rows run along u. The control points of all rows' iso-curves are found first, then the vertices, a
//! coordinate an array and [`LANES`] vertices at once, so that compilers turn each loop into vector
//! instructions.

use crate::abi::{Draw, FLAT, Frame, MAX_RATE, PARALLEL, PARAM_ONE};
use crate::kernel::project::project;
use crate::num::{cross3, dot3, flush3, largest3, max, min, mul, rsqrt, scale3, sub, unit_scale};
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
    /// Vertices a row: micropolygons along u + 1.
    pub stride: usize,
    /// Rows of vertices: micropolygons along v + 1.
    pub rows: usize,
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
    /// Derivatives along u and along v, until they become the normal.
    pub(super) tangents: [[Lane; 3]; 2],
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            stride: 0,
            rows: 0,
            x: [0; GRID],
            y: [0; GRID],
            w: [0.0; GRID],
            position: [[0.0; GRID]; 3],
            normal: [[0.0; GRID]; 3],
            colour: [[0.0; GRID]; 3],
            tangents: [[[0.0; GRID]; 3]; 2],
        }
    }
}

impl Grid {
    /// Where the lanes start that hold all vertices.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.stride * self.rows).step_by(LANES)
    }

    /// Puts position and unit normal of a vertex.
    #[inline(always)]
    pub(super) fn put(&mut self, at: usize, point: [f32; 3], normal: [f32; 3]) {
        for k in 0..3 {
            (self.position[k][at], self.normal[k][at]) = (point[k], normal[k]);
        }
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

/// Fills positions, normals and snapped vertices of a drawn surface: regular inside, and on its borders the
/// vertices that its neighbours have too.
///
/// `net` is the patch's control net in eye space.
#[inline(always)]
pub fn dice(net: &Net, frame: &Frame, draw: Draw, grid: &mut Grid) {
    dice_net(net, draw, grid);
    finish_grid(net, frame, draw, grid);
}

/// Positions and tangents of a drawn surface.
#[inline(always)]
pub(super) fn dice_net(net: &Net, draw: Draw, grid: &mut Grid) {
    prepare_grid(draw, grid);
    let (rate_u, rate_v) = (draw.rate_u(), draw.rate_v());
    let mut columns = [Weights::<LANES>::ZERO; BLOCKS];
    for (first, columns) in (0..=rate_u).step_by(LANES).zip(&mut columns) {
        *columns = Weights::new(first, |column| draw.column(column.min(rate_u)));
    }
    for first_row in (0..=rate_v).step_by(LANES) {
        let rows = Weights::<LANES>::new(first_row, |row| draw.row(row.min(rate_v)));
        let curves = IsoCurves::new(net, &rows);
        for row in first_row..=rate_v.min(first_row + LANES as u32 - 1) {
            let curve = curves.at((row - first_row) as usize);
            for (block, columns) in (0..grid.stride).step_by(LANES).zip(&columns) {
                evaluate(&curve, columns, row as usize * grid.stride + block, grid);
            }
        }
    }
    let moved = Moved::of(draw);
    for block in moved.blocks() {
        evaluate_moved(net, &moved, block, grid);
    }
}

/// Vertices of a grid's borders that need not be where a regular grid has them.
struct Moved {
    count: usize,
    /// Their indices in the grid.
    at: [usize; BORDER],
    u: [u32; BORDER],
    v: [u32; BORDER],
}

/// Vertices on the borders of the largest grid.
const BORDER: usize = 4 * MAX_RATE as usize;

impl Moved {
    #[inline(always)]
    fn of(draw: Draw) -> Self {
        let mut out = Self { count: 0, at: [0; BORDER], u: [0; BORDER], v: [0; BORDER] };
        let (surface, rates) = (draw.surface(), [draw.rate_u(), draw.rate_v()]);
        let stride = rates[0] as usize + 1;
        let last = stride * rates[1] as usize;
        for (corner, at) in [0, rates[0] as usize, last, last + rates[0] as usize].into_iter().enumerate() {
            if surface.has_strayed(corner) {
                out.put(at, surface.corner(corner));
            }
        }
        for (side, (first, step)) in
            [(0, 1), (last, 1), (0, stride), (stride - 1, stride)].into_iter().enumerate()
        {
            let rate = rates[side / 2];
            if surface.is_regular(side, rate) {
                continue;
            }
            for index in 1..rate {
                out.put(first + index as usize * step, surface.border_vertex(side, index, rate));
            }
        }
        out
    }

    #[inline(always)]
    fn put(&mut self, at: usize, [u, v]: [u32; 2]) {
        (self.at[self.count], self.u[self.count], self.v[self.count]) = (at, u, v);
        self.count += 1;
    }

    fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.count).step_by(LANES)
    }
}

/// Positions and tangents of up to [`LANES`] vertices, each with an iso-curve of its own.
#[inline(always)]
fn evaluate_moved(net: &Net, moved: &Moved, first: usize, grid: &mut Grid) {
    let known = |l: u32| (l as usize).min(moved.count - 1);
    let columns = Weights::<LANES>::new(first as u32, |l| moved.u[known(l)]);
    let curves = IsoCurves::new(net, &Weights::<LANES>::new(first as u32, |l| moved.v[known(l)]));
    for k in 0..3 {
        let (mut position, mut du, mut dv) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (point, across) = (&curves.point[k], &curves.across[k]);
        for l in 0..LANES {
            let p = [point[0][l], point[1][l], point[2][l], point[3][l]];
            position[l] = blend4(columns.cubic_at(l), p);
            du[l] = blend3(columns.slope_at(l), [sub(p[1], p[0]), sub(p[2], p[1]), sub(p[3], p[2])]);
            dv[l] = blend4(columns.cubic_at(l), [across[0][l], across[1][l], across[2][l], across[3][l]]);
        }
        for l in 0..LANES.min(moved.count - first) {
            let at = moved.at[first + l];
            grid.position[k][at] = position[l];
            (grid.tangents[0][k][at], grid.tangents[1][k][at]) = (du[l], dv[l]);
        }
    }
}

/// What a grid has before its vertices: their number.
#[inline(always)]
pub(super) fn prepare_grid(draw: Draw, grid: &mut Grid) {
    grid.stride = draw.rate_u() as usize + 1;
    grid.rows = draw.rate_v() as usize + 1;
}

/// Normals and snapped vertices, from positions and tangents.
#[inline(always)]
pub(super) fn finish_grid(net: &Net, frame: &Frame, draw: Draw, grid: &mut Grid) {
    let flat = mul(size(net), FLAT);
    for block in grid.blocks() {
        find_normals(block, flat, grid);
        project_block(frame, block, grid);
    }
    mend_normals(net, draw, flat, grid);
}

/// Snapped vertices, from positions.
#[inline(always)]
pub(super) fn project_all(frame: &Frame, grid: &mut Grid) {
    for block in grid.blocks() {
        project_block(frame, block, grid);
    }
}

/// Bernstein weights of vertices along one side of a grid, an array a weight.
#[derive(Clone, Copy)]
struct Weights<const N: usize> {
    cubic: [[f32; N]; 4],
    slope: [[f32; N]; 3],
}

impl<const N: usize> Weights<N> {
    const ZERO: Self = Self { cubic: [[0.0; N]; 4], slope: [[0.0; N]; 3] };

    /// From vertex number `first` on, each at its parameter.
    #[inline(always)]
    fn new(first: u32, parameter: impl Fn(u32) -> u32) -> Self {
        let mut out = Self::ZERO;
        for l in 0..N {
            let t = param(parameter(first + l as u32));
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
        Self::new(0, |_| t)
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

/// Normals of [`LANES`] vertices.
#[inline(always)]
fn find_normals(block: usize, flat: f32, grid: &mut Grid) {
    let (du, dv) = (load3(&grid.tangents[0], block), load3(&grid.tangents[1], block));
    let mut normal = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let (du, dv) = ([du[0][l], du[1][l], du[2][l]], [dv[0][l], dv[1][l], dv[2][l]]);
        [normal[0][l], normal[1][l], normal[2][l]] = unit_normal(du, dv, flat);
    }
    for (all, lanes) in grid.normal.iter_mut().zip(&normal) {
        store(all, block, lanes);
    }
}

/// [`LANES`] snapped vertices.
#[inline(always)]
fn project_block(frame: &Frame, block: usize, grid: &mut Grid) {
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
    evaluate_bezier(net, u, v).point
}

/// A point of a patch and its derivatives along u and along v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, in the space of the control points.
    pub point: [f32; 3],
    /// Derivative along u.
    pub du: [f32; 3],
    /// Derivative along v.
    pub dv: [f32; 3],
}

/// A vertex of a Bézier patch by itself: the same bits as in a grid.
#[inline(always)]
#[must_use]
pub fn evaluate_bezier(net: &Net, u: u32, v: u32) -> Vertex {
    let (row, column) = (Weights::<1>::at(v), Weights::<1>::at(u));
    let curve = IsoCurves::new(net, &row).at(0);
    let (cubic, slope) = (column.cubic_at(0), column.slope_at(0));
    Vertex {
        point: curve.point.map(|point| blend4(cubic, point)),
        du: curve.along.map(|along| blend3(slope, along)),
        dv: curve.across.map(|across| blend4(cubic, across)),
    }
}

/// The unit normal of a vertex, or one from nearby where it vanishes.
#[inline(always)]
#[must_use]
pub fn normal_of(net: &Net, vertex: &Vertex, u: u32, v: u32, flat: f32) -> [f32; 3] {
    let normal = unit_normal(vertex.du, vertex.dv, flat);
    if largest3(normal) < 0.5 { normal_nearby(net, u, v, flat) } else { normal }
}

/// Largest side of the box around the control points.
#[inline(always)]
pub(super) fn size(net: &Net) -> f32 {
    max(max(side(&net.x), side(&net.y)), side(&net.z))
}

#[inline(always)]
fn side(c: &[f32; 16]) -> f32 {
    sub(fold(c, max), fold(c, min))
}

/// Unit vector along `du` × `dv`, or zero where a tangent is not longer than `flat` or both are parallel.
///
/// The tangents are scaled by powers of two first, so that denormals, which some devices do not have, matter to no
/// component that is not flushed.
#[inline(always)]
#[must_use]
pub fn unit_normal(du: [f32; 3], dv: [f32; 3], flat: f32) -> [f32; 3] {
    let (long_u, long_v) = (largest3(du), largest3(dv));
    let normal = cross3(scale3(du, unit_scale(long_u)), scale3(dv, unit_scale(long_v)));
    let square = dot3(normal, normal);
    let sound = (long_u > flat) & (long_v > flat) & (square > PARALLEL);
    let scale = if sound { rsqrt(max(square, PARALLEL)) } else { 0.0 };
    flush3(scale3(normal, scale))
}

/// Replaces normals that vanished: at collapsed edges, cusps, zero-area patches.
#[inline(always)]
fn mend_normals(net: &Net, draw: Draw, flat: f32, grid: &mut Grid) {
    let mut vanished = 0;
    for block in grid.blocks() {
        let normal = load3(&grid.normal, block);
        for l in 0..LANES {
            vanished += u32::from(largest3([normal[0][l], normal[1][l], normal[2][l]]) < 0.5);
        }
    }
    if vanished > 0 {
        mend_each(net, draw, flat, grid);
    }
}

#[cold]
fn mend_each(net: &Net, draw: Draw, flat: f32, grid: &mut Grid) {
    for at in 0..grid.stride * grid.rows {
        let (row, column) = ((at / grid.stride) as u32, (at % grid.stride) as u32);
        if largest3(grid.unit_normal(at)) < 0.5 {
            let [u, v] = draw.vertex(row, column);
            let normal = normal_nearby(net, u, v, flat);
            [grid.normal[0][at], grid.normal[1][at], grid.normal[2][at]] = normal;
        }
    }
}

/// The normal a 64th of the way towards the patch's middle, where a collapsed edge has opened; if there is
/// none, that of the patch's diagonals; if there is none either, towards the eye.
#[must_use]
pub fn normal_nearby(net: &Net, u: u32, v: u32, flat: f32) -> [f32; 3] {
    let inward = |t: u32| t - t / 64 + PARAM_ONE / 128;
    let Vertex { du, dv, .. } = evaluate_bezier(net, inward(u), inward(v));
    let nearby = unit_normal(du, dv, flat);
    if largest3(nearby) > 0.5 {
        return nearby;
    }
    let chord =
        |a: usize, b: usize| [sub(net.x[b], net.x[a]), sub(net.y[b], net.y[a]), sub(net.z[b], net.z[a])];
    let diagonal = unit_normal(chord(0, 15), chord(12, 3), 0.0);
    if largest3(diagonal) > 0.5 { diagonal } else { [0.0, 0.0, 1.0] }
}
