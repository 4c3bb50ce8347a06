//! Built-in control: which levels a patch has.
//!
//! The level of an edge depends on nothing but the edge, the same from either end, so that patches that share it divide it
//! alike (Stadlbauer 2019, Fig. 5.15).
#![deny(clippy::float_arithmetic)]

use super::corner::{bezier_corner, corner, corner_count, ends, point};
use crate::abi::{
    LENGTH_TINY, TESS_BEZIER, TESS_CONSTANT, TESS_ISOLINES, TESS_LENGTH, TESS_TRIANGLES, TessFrame,
    TessLevels, TessPatch,
};
use crate::num::{add, add3, dot3, flush3, max, mul, neg, recip, scale3, sqrt};

/// Levels of a patch; not for `TESS_GIVEN`, where patches have levels of their own.
#[inline(always)]
#[must_use]
pub const fn levels_of(frame: &TessFrame, patch: &TessPatch) -> TessLevels {
    if frame.control == TESS_CONSTANT {
        return TessLevels { outer: frame.outer, inner: frame.inner };
    }
    let mut edges = [1.0; 4];
    let mut edge = 0;
    while edge < corner_count(frame) {
        edges[edge as usize] = edge_level(frame, patch, edge);
        edge += 1;
    }
    let [a, b, c, d] = edges;
    match frame.domain {
        TESS_TRIANGLES => TessLevels { outer: edges, inner: [max(max(a, b), c), 1.0] },
        TESS_ISOLINES => TessLevels { outer: [max(a, c), max(b, d), 1.0, 1.0], inner: [1.0; 2] },
        _ => TessLevels { outer: edges, inner: [max(b, d), max(a, c)] },
    }
}

/// Level of an outer edge: never below 1, so that no patch is dropped.
#[inline(always)]
const fn edge_level(frame: &TessFrame, patch: &TessPatch, edge: u32) -> f32 {
    let [first, last] = ends(frame, edge);
    let middle = scale3(add3(corner(frame, patch, first), corner(frame, patch, last)), 0.5);
    let near = mul(frame.factor, recip(length(minus(middle, frame.eye))));
    let level =
        if frame.control == TESS_LENGTH { mul(near, edge_length(frame, patch, [first, last])) } else { near };
    max(level, 1.0)
}

/// How long an edge is, or the legs of its control points.
#[inline(always)]
const fn edge_length(frame: &TessFrame, patch: &TessPatch, corners: [u32; 2]) -> f32 {
    let (a, d) = (corner(frame, patch, corners[0]), corner(frame, patch, corners[1]));
    if frame.evaluation != TESS_BEZIER {
        return length(minus(d, a));
    }
    let [first, last] = [bezier_corner(corners[0]), bezier_corner(corners[1])];
    let b = point(patch, (2 * first + last) / 3);
    let c = point(patch, (first + 2 * last) / 3);
    add(add(length(minus(b, a)), length(minus(d, c))), length(minus(c, b)))
}

#[inline(always)]
const fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    flush3(add3(a, [neg(b[0]), neg(b[1]), neg(b[2])]))
}

/// Length of a vector, never 0.
#[inline(always)]
const fn length(a: [f32; 3]) -> f32 {
    sqrt(add(dot3(a, a), LENGTH_TINY))
}
