//! Corners and outer edges of a patch, and the share that each corner has in a point.
#![deny(clippy::float_arithmetic)]

use crate::abi::{TESS_BEZIER, TESS_TRIANGLES, TESS_UNIT, TessFrame, TessPatch};
use crate::num::{float, flush3, mul, sub};

/// Where the normals of a patch begin among its points.
const NORMALS: u32 = 4;
/// A coordinate's unit.
const STEP: f32 = 1.0 / TESS_UNIT as f32;

/// The corners at which an outer edge begins and ends, on its way around the patch.
#[inline(always)]
#[must_use]
pub const fn ends(frame: &TessFrame, edge: u32) -> [u32; 2] {
    if frame.domain == TESS_TRIANGLES { [(edge + 1) % 3, (edge + 2) % 3] } else { [(edge + 3) % 4, edge] }
}

/// Number of corners, and of outer edges.
#[inline(always)]
#[must_use]
pub const fn corner_count(frame: &TessFrame) -> u32 {
    if frame.domain == TESS_TRIANGLES { 3 } else { 4 }
}

/// Is a point on an outer edge?
#[inline(always)]
#[must_use]
pub const fn is_on_edge(frame: &TessFrame, coordinates: [u32; 3], edge: u32) -> bool {
    let [u, v, _] = coordinates;
    if frame.domain == TESS_TRIANGLES {
        return coordinates[edge as usize] == 0;
    }
    match edge {
        0 => u == 0,
        1 => v == 0,
        2 => u == TESS_UNIT,
        _ => v == TESS_UNIT,
    }
}

/// Coordinates as floats: exact.
#[inline(always)]
#[must_use]
pub const fn shares(coordinates: [u32; 3]) -> [f32; 3] {
    [
        mul(float(coordinates[0] as i32), STEP),
        mul(float(coordinates[1] as i32), STEP),
        mul(float(coordinates[2] as i32), STEP),
    ]
}

/// How much of each corner is in a point. On an outer edge this is exact, and 0 for the corners across.
#[inline(always)]
#[must_use]
pub const fn weights(frame: &TessFrame, coordinates: [u32; 3]) -> [f32; 4] {
    let [u, v, w] = shares(coordinates);
    if frame.domain == TESS_TRIANGLES {
        return [u, v, w, 0.0];
    }
    let (s, t) = (sub(1.0, u), sub(1.0, v));
    [mul(s, t), mul(u, t), mul(u, v), mul(s, v)]
}

/// A point of a patch, by its index.
#[inline(always)]
#[must_use]
pub const fn point(patch: &TessPatch, index: u32) -> [f32; 3] {
    let at = 3 * index as usize;
    flush3([patch.points[at], patch.points[at + 1], patch.points[at + 2]])
}

/// The normal at a corner.
#[inline(always)]
#[must_use]
pub const fn normal(patch: &TessPatch, corner: u32) -> [f32; 3] {
    point(patch, NORMALS + corner)
}

/// A corner of a patch, wherever it is among its points.
#[inline(always)]
#[must_use]
pub const fn corner(frame: &TessFrame, patch: &TessPatch, index: u32) -> [f32; 3] {
    if frame.evaluation != TESS_BEZIER {
        return point(patch, index);
    }
    point(patch, bezier_corner(index))
}

/// Which of the 16 points of a Bézier patch a corner is.
#[inline(always)]
#[must_use]
pub const fn bezier_corner(corner: u32) -> u32 {
    let u = corner == 1 || corner == 2;
    let v = corner > 1;
    12 * u as u32 + 3 * v as u32
}
