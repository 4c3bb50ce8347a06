//! Dicing of rational patches: vertex by vertex.

use crate::abi::{Draw, Frame};
use crate::kernel::dice::{Grid, LANES, Vertex, finish_grid, prepare_grid, store};
use crate::patch::{Net, Weights};

/// Fills positions, normals and snapped vertices of a surface of a rational patch, as [`crate::kernel::dice::dice`] does of
/// one that is not.
#[inline(never)]
pub fn dice_rational(net: &Net, weights: &Weights, frame: &Frame, draw: Draw, grid: &mut Grid) {
    dice_each(draw, grid, |u, v| weights.evaluate(net, u, v));
    finish_grid(net, frame, draw, grid);
}

/// Positions and tangents of all vertices of a surface, one by one.
#[inline(always)]
pub(super) fn dice_each(draw: Draw, grid: &mut Grid, vertex: impl Fn(u32, u32) -> Vertex) {
    prepare_grid(draw, grid);
    let (rate_u, rate_v) = (draw.rate_u(), draw.rate_v());
    for row in 0..=rate_v {
        for block in (0..=rate_u).step_by(LANES) {
            let at = (row * (rate_u + 1) + block) as usize;
            let mut lanes = [[[0.0; LANES]; 3]; 3];
            for l in 0..LANES {
                // Beyond the row's end, where the next row will be, its last vertex is repeated.
                let [u, v] = draw.vertex(row, rate_u.min(block + l as u32));
                let Vertex { point, du, dv } = vertex(u, v);
                for k in 0..3 {
                    (lanes[0][k][l], lanes[1][k][l], lanes[2][k][l]) = (point[k], du[k], dv[k]);
                }
            }
            for k in 0..3 {
                store(&mut grid.position[k], at, &lanes[0][k]);
                store(&mut grid.tangents[0][k], at, &lanes[1][k]);
                store(&mut grid.tangents[1][k], at, &lanes[2][k]);
            }
        }
    }
}
