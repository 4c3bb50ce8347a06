//! tess_evaluate: vertices and indices of a piece of a patch: a run of its vertices and one of its primitives, which any
//! work-group can make without the others.

use crate::abi::{
    PIECE_PRIMITIVES, PIECE_VERTICES, TESS_CLOCKWISE, TESS_ISOLINES, TessFrame, TessPatch, TessRecord,
    TessVertex,
};
use crate::tess::evaluate::evaluate;
use crate::tess::surface::TessSurface;
use crate::tess::topology::Topology;

/// A run of the vertices, or primitives, of a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// The first.
    pub first: u32,
    /// One past the last.
    pub end: u32,
}

/// Vertices and primitives of a piece of a patch.
#[inline(always)]
#[must_use]
pub const fn spans(record: &TessRecord, piece: u32) -> [Span; 2] {
    [span(piece, PIECE_VERTICES, record.vertices), span(piece, PIECE_PRIMITIVES, record.primitives)]
}

#[inline(always)]
const fn span(piece: u32, size: u32, count: u32) -> Span {
    let (first, end) = (piece * size, (piece + 1) * size);
    Span { first: if first < count { first } else { count }, end: if end < count { end } else { count } }
}

/// The patch of a chunk that a piece is of: the last one whose pieces begin no later.
#[inline(always)]
#[must_use]
pub fn patch_of(records: &[TessRecord], first: u32, end: u32, piece: u32) -> u32 {
    let (mut low, mut high) = (first, end);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if records[middle as usize].first_piece <= piece { low = middle } else { high = middle }
    }
    low
}

/// Indices of a primitive.
#[inline(always)]
#[must_use]
pub const fn corners(frame: &TessFrame) -> u32 {
    if frame.domain == TESS_ISOLINES { 2 } else { 3 }
}

/// Makes vertices of a patch; `out` is as long as the span.
#[inline(always)]
pub fn vertices(
    topology: &Topology,
    span: Span,
    out: &mut [TessVertex],
    mut evaluated: impl FnMut([u32; 3]) -> TessVertex,
) {
    if span.first == span.end {
        return;
    }
    let mut side = topology.side_of(span.first);
    let mut vertex = span.first;
    while vertex < span.end {
        let end = (side.first + side.count).min(span.end);
        for (at, out) in (vertex..end).zip(&mut out[(vertex - span.first) as usize..]) {
            *out = evaluated(topology.coordinates(side, at - side.first));
        }
        vertex = end;
        if vertex < span.end {
            side = topology.next_side(side);
        }
    }
}

/// Makes a patch's vertices by the frame's own evaluation.
#[inline(always)]
pub fn built_in(
    frame: &TessFrame,
    patch: &TessPatch,
    heights: &[f32],
    topology: &Topology,
    span: Span,
    out: &mut [TessVertex],
) {
    let surface = TessSurface::new(frame, patch);
    vertices(topology, span, out, |coordinates| evaluate(frame, patch, &surface, heights, coordinates));
}

/// Lays primitives of a patch whose first vertex has index `base`; `out` has room for the span.
#[inline(always)]
pub fn indices(frame: &TessFrame, topology: &Topology, base: u32, span: Span, out: &mut [u32]) {
    if span.first == span.end {
        return;
    }
    let corners = corners(frame) as usize;
    let is_turned = frame.flags & TESS_CLOCKWISE > 0;
    let mut strip = topology.strip_of(span.first);
    let mut primitive = span.first;
    while primitive < span.end {
        let end = (strip.first + strip.count).min(span.end);
        let own = &mut out[corners * (primitive - span.first) as usize..];
        for (at, out) in (primitive..end).zip(own.chunks_exact_mut(corners)) {
            let [a, b, c] = strip.triangle(at - strip.first);
            let turned = if is_turned { [a, c, b] } else { [a, b, c] };
            for (out, index) in out.iter_mut().zip(turned) {
                *out = base + index;
            }
        }
        primitive = end;
        if primitive < span.end {
            strip = topology.next_strip(strip);
        }
    }
}
