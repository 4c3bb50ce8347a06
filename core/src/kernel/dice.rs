//! dice: a drawn surface becomes a grid of vertices, each a pure function of patch and dyadic parameter.
//!
//! Rows run along u. The control points of a row's iso-curve are found once, then all its vertices at once,
//! a coordinate an array (`ROW` lanes), so that compilers turn each loop into vector instructions.

use crate::abi::{Frame, PARAM_ONE, Surface};
use crate::kernel::project::project;
use crate::num::{cross3, dot3, largest3, max, min, mul, rsqrt, scale3, sub, unit_scale};
use crate::patch::Net;
use crate::patch::bezier::{blend3, blend4, cubic, cubic_slope, param};
use crate::patch::net::fold;

/// Most rows of vertices that a grid can have.
pub const ROWS: usize = crate::abi::MAX_RATE as usize + 1;

/// Vertices of a diced surface: row `r`, column `c` at `[r][c]`; `ROW` ≥ dice rate + 1 columns of storage.
#[derive(Clone, Debug)]
pub struct Grid<const ROW: usize> {
    /// Snapped column, 1/256 pixels.
    pub x: [[i32; ROW]; ROWS],
    /// Snapped row, 1/256 pixels.
    pub y: [[i32; ROW]; ROWS],
    /// 1 / distance; 0 = must be clipped (see [`crate::kernel::project::Vertex`]).
    pub w: [[f32; ROW]; ROWS],
    /// Eye-space position: x, y, z.
    pub position: [[[f32; ROW]; 3]; ROWS],
    /// Unit normal in eye space: x, y, z.
    pub normal: [[[f32; ROW]; 3]; ROWS],
    /// Colour, linear RGB; written by `shade`.
    pub colour: [[[f32; ROW]; 3]; ROWS],
}

impl<const ROW: usize> Default for Grid<ROW> {
    fn default() -> Self {
        Self {
            x: [[0; ROW]; ROWS],
            y: [[0; ROW]; ROWS],
            w: [[0.0; ROW]; ROWS],
            position: [[[0.0; ROW]; 3]; ROWS],
            normal: [[[0.0; ROW]; 3]; ROWS],
            colour: [[[0.0; ROW]; 3]; ROWS],
        }
    }
}

/// Fills positions, normals and snapped vertices of `surface`, `frame.rate` + 1 rows and columns.
///
/// `net` is the patch's control net in eye space. Columns beyond the last repeat it.
#[inline(always)]
pub fn dice<const ROW: usize>(net: &Net, frame: &Frame, surface: Surface, grid: &mut Grid<ROW>) {
    let columns = Columns::<ROW>::new(surface, frame.rate);
    let flat = mul(size(net), FLAT);
    let step = surface.v_size() / frame.rate;
    for row in 0..=frame.rate as usize {
        let v = surface.v + row as u32 * step;
        let curve = IsoCurve::at(net, v);
        positions(&curve, &columns, &mut grid.position[row]);
        normals(&curve, &columns, flat, &mut grid.normal[row]);
        mend_normals(net, &columns, v, flat, &mut grid.normal[row]);
        let position = &grid.position[row];
        for l in 0..ROW {
            let vertex = project(frame, [position[0][l], position[1][l], position[2][l]]);
            grid.x[row][l] = vertex.x;
            grid.y[row][l] = vertex.y;
            grid.w[row][l] = vertex.w;
        }
    }
}

/// Parameters and weights of the vertices of every row.
struct Columns<const ROW: usize> {
    u: [u32; ROW],
    cubic: [[f32; ROW]; 4],
    slope: [[f32; ROW]; 3],
}

impl<const ROW: usize> Columns<ROW> {
    #[inline(always)]
    fn new(surface: Surface, rate: u32) -> Self {
        let mut out = Self { u: [0; ROW], cubic: [[0.0; ROW]; 4], slope: [[0.0; ROW]; 3] };
        let step = surface.u_size() / rate;
        for l in 0..ROW {
            let column = if (l as u32) < rate { l as u32 } else { rate };
            out.u[l] = surface.u + column * step;
            let t = param(out.u[l]);
            let (weights, slopes) = (cubic(t), cubic_slope(t));
            for k in 0..4 {
                out.cubic[k][l] = weights[k];
            }
            for k in 0..3 {
                out.slope[k][l] = slopes[k];
            }
        }
        out
    }
}

/// The curve `v` = constant of a patch: control points, differences along u, derivatives across.
struct IsoCurve {
    point: [[f32; 4]; 3],
    along: [[f32; 3]; 3],
    across: [[f32; 4]; 3],
}

impl IsoCurve {
    #[inline(always)]
    fn at(net: &Net, v: u32) -> Self {
        let t = param(v);
        let (weights, slopes) = (cubic(t), cubic_slope(t));
        let mut out = Self { point: [[0.0; 4]; 3], along: [[0.0; 3]; 3], across: [[0.0; 4]; 3] };
        for (k, c) in [&net.x, &net.y, &net.z].into_iter().enumerate() {
            for i in 0..4 {
                let p = [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]];
                out.point[k][i] = blend4(weights, p);
                out.across[k][i] = blend3(slopes, [sub(p[1], p[0]), sub(p[2], p[1]), sub(p[3], p[2])]);
            }
            for i in 0..3 {
                out.along[k][i] = sub(out.point[k][i + 1], out.point[k][i]);
            }
        }
        out
    }

    /// Derivatives along u and along v at one parameter.
    #[inline(always)]
    fn tangents(&self, cubic: [f32; 4], slope: [f32; 3]) -> ([f32; 3], [f32; 3]) {
        let du = [0, 1, 2].map(|k| blend3(slope, self.along[k]));
        let dv = [0, 1, 2].map(|k| blend4(cubic, self.across[k]));
        (du, dv)
    }
}

#[inline(always)]
fn positions<const ROW: usize>(curve: &IsoCurve, at: &Columns<ROW>, out: &mut [[f32; ROW]; 3]) {
    for k in 0..3 {
        for l in 0..ROW {
            let weights = [at.cubic[0][l], at.cubic[1][l], at.cubic[2][l], at.cubic[3][l]];
            out[k][l] = blend4(weights, curve.point[k]);
        }
    }
}

#[inline(always)]
fn normals<const ROW: usize>(curve: &IsoCurve, at: &Columns<ROW>, flat: f32, out: &mut [[f32; ROW]; 3]) {
    for l in 0..ROW {
        let weights = [at.cubic[0][l], at.cubic[1][l], at.cubic[2][l], at.cubic[3][l]];
        let slopes = [at.slope[0][l], at.slope[1][l], at.slope[2][l]];
        let (du, dv) = curve.tangents(weights, slopes);
        let normal = unit_normal(du, dv, flat);
        for k in 0..3 {
            out[k][l] = normal[k];
        }
    }
}

/// A tangent shorter than this share of the patch's size is taken for vanished.
const FLAT: f32 = 1.0 / (1 << 12) as f32;
/// Squared sine of the angle between two tangents that are taken for parallel.
const PARALLEL: f32 = 1.0 / (1 << 24) as f32;

/// Largest side of the box around the control points.
#[inline(always)]
fn size(net: &Net) -> f32 {
    let side = |c: &[f32; 16]| sub(fold(c, max), fold(c, min));
    max(max(side(&net.x), side(&net.y)), side(&net.z))
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
fn mend_normals<const ROW: usize>(
    net: &Net,
    at: &Columns<ROW>,
    v: u32,
    flat: f32,
    normal: &mut [[f32; ROW]; 3],
) {
    let mut vanished = 0;
    for l in 0..ROW {
        vanished += u32::from(largest3([normal[0][l], normal[1][l], normal[2][l]]) < 0.5);
    }
    if vanished == 0 {
        return;
    }
    for l in 0..ROW {
        if largest3([normal[0][l], normal[1][l], normal[2][l]]) < 0.5 {
            let mended = normal_nearby(net, at.u[l], v, flat);
            for k in 0..3 {
                normal[k][l] = mended[k];
            }
        }
    }
}

/// The normal a 64th of the way towards the patch's middle, where a collapsed edge has opened; if there is
/// none, that of the patch's diagonals; if there is none either, towards the eye.
#[must_use]
pub fn normal_nearby(net: &Net, u: u32, v: u32, flat: f32) -> [f32; 3] {
    let inward = |t: u32| t - t / 64 + PARAM_ONE / 128;
    let t = param(inward(u));
    let (du, dv) = IsoCurve::at(net, inward(v)).tangents(cubic(t), cubic_slope(t));
    let nearby = unit_normal(du, dv, flat);
    if largest3(nearby) > 0.5 {
        return nearby;
    }
    let chord = |a: usize, b: usize| {
        [sub(net.x[b], net.x[a]), sub(net.y[b], net.y[a]), sub(net.z[b], net.z[a])]
    };
    let diagonal = unit_normal(chord(0, 15), chord(12, 3), 0.0);
    if largest3(diagonal) > 0.5 { diagonal } else { [0.0, 0.0, 1.0] }
}
