//! A vertex of a tessellated patch: a point of its surface, moved along its normal by the height map.
#![deny(clippy::float_arithmetic)]

use super::corner::{corner_count, ends, is_on_edge, weights};
use super::surface::TessSurface;
use crate::abi::{TessFrame, TessPatch, TessVertex};
use crate::num::{add, add3, float, floor, flush, flush3, mul, scale3, sub};

/// A vertex by its coordinates.
#[inline(always)]
#[must_use]
pub fn evaluate(
    frame: &TessFrame,
    patch: &TessPatch,
    surface: &TessSurface,
    heights: &[f32],
    coordinates: [u32; 3],
) -> TessVertex {
    let [position, normal] = surface.at(frame, patch, coordinates);
    let uv = texture(&patch.uv, weights(frame, coordinates));
    if frame.columns == 0 {
        return TessVertex { position, normal, uv };
    }
    let height = height_at(frame, heights, place_of_height(frame, patch, coordinates, uv));
    let position = flush3(add3(position, scale3(normal, flush(mul(frame.scale, height)))));
    TessVertex { position, normal, uv }
}

/// Texture coordinates: those of the corners times their shares.
#[inline(always)]
const fn texture(uv: &[f32; 8], w: [f32; 4]) -> [f32; 2] {
    [share(uv, w, 0), share(uv, w, 1)]
}

#[inline(always)]
const fn share(uv: &[f32; 8], w: [f32; 4], axis: usize) -> f32 {
    let [a, b] = [mul(w[0], flush(uv[axis])), mul(w[1], flush(uv[2 + axis]))];
    let [c, d] = [mul(w[2], flush(uv[4 + axis])), mul(w[3], flush(uv[6 + axis]))];
    flush(add(add(a, b), add(c, d)))
}

/// Where the height of a vertex is looked up: on outer edges and at corners where their owners have it.
#[inline(always)]
const fn place_of_height(
    frame: &TessFrame,
    patch: &TessPatch,
    coordinates: [u32; 3],
    inside: [f32; 2],
) -> [f32; 2] {
    let weights = weights(frame, coordinates);
    let mut place = inside;
    let mut edge = 0;
    while edge < corner_count(frame) {
        if is_on_edge(frame, coordinates, edge) {
            place = on_edge(frame, patch, weights, edge);
        }
        edge += 1;
    }
    let mut corner = 0;
    while corner < corner_count(frame) {
        if weights[corner as usize] == 1.0 {
            place =
                [flush(patch.corners[2 * corner as usize]), flush(patch.corners[2 * corner as usize + 1])];
        }
        corner += 1;
    }
    place
}

#[inline(always)]
const fn on_edge(frame: &TessFrame, patch: &TessPatch, weights: [f32; 4], edge: u32) -> [f32; 2] {
    let [first, last] = ends(frame, edge);
    let (a, b) = (weights[first as usize], weights[last as usize]);
    let at = 4 * edge as usize;
    [
        flush(add(mul(a, flush(patch.edges[at])), mul(b, flush(patch.edges[at + 2])))),
        flush(add(mul(a, flush(patch.edges[at + 1])), mul(b, flush(patch.edges[at + 3])))),
    ]
}

/// The height at a place of the height map, which repeats itself; texels are at half-integers, heights between them are
/// bilinear.
#[inline(always)]
#[must_use]
pub fn height_at(frame: &TessFrame, heights: &[f32], place: [f32; 2]) -> f32 {
    let (left, right, across) = texels(place[0], frame.columns);
    let (low, high, along) = texels(place[1], frame.rows);
    let texel = |column: u32, row: u32| flush(heights[(row * frame.columns + column) as usize]);
    let below = mix(texel(left, low), texel(right, low), across);
    let above = mix(texel(left, high), texel(right, high), across);
    mix(below, above, along)
}

#[inline(always)]
const fn mix(a: f32, b: f32, t: f32) -> f32 {
    flush(add(mul(a, sub(1.0, t)), mul(b, t)))
}

/// The two texels of a row between which a place is, and how far it is from the first.
#[inline(always)]
const fn texels(place: f32, count: u32) -> (u32, u32, f32) {
    let within = sub(place, float(floor(place)));
    let at = sub(mul(within, float(count as i32)), 0.5);
    let first = floor(at);
    let share = flush(sub(at, float(first)));
    // A place that rounding has moved to the very end is that of the last texel.
    let before = if first < 0 { count - 1 } else { umin(first as u32, count - 1) };
    let after = before + 1;
    (before, if after < count { after } else { 0 }, share)
}

#[inline(always)]
const fn umin(a: u32, b: u32) -> u32 {
    if a < b { a } else { b }
}
