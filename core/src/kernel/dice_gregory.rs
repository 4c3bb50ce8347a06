//! Dicing of Gregory patches: as `dice.rs` does it, but the inner control points are another four at each
//! vertex. On borders they have no weight, so border vertices are those of the net alone, bit by bit.

use crate::abi::{Draw, FLAG_WEBER, Frame};
use crate::kernel::dice::{Grid, Vertex, finish_grid};
use crate::kernel::dice_rational::dice_each;
use crate::num::{add, mul, scale3, sub};
use crate::patch::bezier::{blend3, blend4, cubic, cubic_slope, param};
use crate::patch::gregory::{Blend, INNER, blends, weber_blends};
use crate::patch::{Faces, Net};

/// Fills positions, normals and snapped vertices of a surface of a Gregory patch, as
/// [`crate::kernel::dice::dice`] does of a Bézier patch.
pub fn dice_gregory(net: &Net, faces: &Faces, frame: &Frame, draw: Draw, grid: &mut Grid) {
    dice_each(draw, grid, |u, v| evaluate_gregory(net, faces, frame, u, v));
    finish_grid(net, frame, draw, grid);
}

/// Evaluates a Gregory patch; the derivatives are the true ones, those of the blends included.
#[inline(always)]
#[must_use]
pub fn evaluate_gregory(net: &Net, faces: &Faces, frame: &Frame, u: u32, v: u32) -> Vertex {
    let blends = blends_at(frame, u, v);
    let (u, v) = (param(u), param(v));
    let here = faces.net_at(net, blends);
    let (along_u, along_v) = (Weights::at(u), Weights::at(v));
    let change = change(faces, &blends, along_u.cubic, along_v.cubic);
    let mut out = Vertex { point: [0.0; 3], du: [0.0; 3], dv: [0.0; 3] };
    for (k, c) in [&here.x, &here.y, &here.z].into_iter().enumerate() {
        let (mut curve, mut across) = ([0.0; 4], [0.0; 4]);
        for i in 0..4 {
            let p = [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]];
            curve[i] = blend4(along_v.cubic, p);
            across[i] = blend3(along_v.slope, steps(p));
        }
        out.point[k] = blend4(along_u.cubic, curve);
        out.du[k] = add(blend3(along_u.slope, steps(curve)), change[0][k]);
        out.dv[k] = add(blend4(along_u.cubic, across), change[1][k]);
    }
    out
}

/// The blends at a parameter, by the rules of the frame's profile.
#[inline(always)]
#[must_use]
pub fn blends_at(frame: &Frame, u: u32, v: u32) -> [Blend; 4] {
    let (u, v) = (param(u), param(v));
    if frame.flags & FLAG_WEBER != 0 { weber_blends(u, v) } else { blends(u, v) }
}

/// Bernstein weights at a parameter, and those of the derivative.
struct Weights {
    cubic: [f32; 4],
    slope: [f32; 3],
}

impl Weights {
    #[inline(always)]
    const fn at(t: f32) -> Self {
        Self { cubic: cubic(t), slope: cubic_slope(t) }
    }
}

#[inline(always)]
fn steps(p: [f32; 4]) -> [f32; 3] {
    [sub(p[1], p[0]), sub(p[2], p[1]), sub(p[3], p[2])]
}

/// What moving inner points add to the derivatives along u and along v.
#[inline(always)]
fn change(faces: &Faces, blends: &[Blend; 4], along_u: [f32; 4], along_v: [f32; 4]) -> [[f32; 3]; 2] {
    let mut sums = [[0.0; 3]; 2];
    for (m, blend) in blends.iter().enumerate() {
        let weight = mul(along_u[INNER[m] / 4], along_v[INNER[m] % 4]);
        let moved = scale3(faces.difference(m), weight);
        for k in 0..3 {
            sums[0][k] = add(sums[0][k], mul(blend.along_u, moved[k]));
            sums[1][k] = add(sums[1][k], mul(blend.along_v, moved[k]));
        }
    }
    sums
}
