//! tess_evaluate: vertices and indices of a piece of a patch: a run of its vertices and one of its primitives, which any
//! work-group can make without the others.

use crate::abi::{
    PIECE_PRIMITIVES, PIECE_VERTICES, TESS_BEZIER, TESS_CLOCKWISE, TESS_ISOLINES, TESS_LINEAR, TESS_PHONG,
    TESS_PN, TESS_QUADS, TESS_TRIANGLES, TessFrame, TessPatch, TessRecord, TessVertex,
};
use crate::tess::evaluate::evaluate;
use crate::tess::strip::{Kind, Strip};
use crate::tess::surface::TessSurface;
use crate::tess::topology::{Row, Topology};

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

/// Evaluation of one patch.
pub trait Evaluation {
    /// May it be asked for the same vertex several times? That is quicker where vertices are evaluated together.
    const IS_PURE: bool;

    /// The vertex at coordinates in units of 2⁻¹⁶.
    fn at(&self, coordinates: [u32; 3]) -> TessVertex;
}

/// Makes vertices of a patch; `out` is as long as the span.
#[inline(always)]
pub fn vertices<E: Evaluation>(topology: &Topology, span: Span, out: &mut [TessVertex], evaluation: &E) {
    if span.first == span.end {
        return;
    }
    let mut side = topology.side_of(span.first);
    let mut vertex = span.first;
    while vertex < span.end {
        let (row, end) = (topology.row(side), (side.first + side.count).min(span.end));
        let own = &mut out[(vertex - span.first) as usize..(end - span.first) as usize];
        let last = end - side.first - 1;
        for (first, out) in (vertex - side.first..).step_by(LANES).zip(own.chunks_mut(LANES)) {
            if E::IS_PURE {
                evaluate_lanes(&row, first, last, evaluation, out);
            } else {
                (first..).zip(out).for_each(|(index, out)| *out = evaluation.at(row.coordinates(index)));
            }
        }
        vertex = end;
        if vertex < span.end {
            side = topology.next_side(side);
        }
    }
}

/// Vertices that are evaluated together, so that the compiler may use vectors.
const LANES: usize = 8;

/// Vertices of a row from one on; beyond `last` they are it once more, and are not kept.
#[inline(always)]
fn evaluate_lanes<E: Evaluation>(row: &Row, first: u32, last: u32, evaluation: &E, out: &mut [TessVertex]) {
    let (mut places, mut lanes) = ([[0; LANES]; 3], [[0.0; LANES]; 8]);
    for lane in 0..LANES {
        let index = first + lane as u32;
        let coordinates = row.coordinates(if index < last { index } else { last });
        for axis in 0..3 {
            places[axis][lane] = coordinates[axis];
        }
    }
    for lane in 0..LANES {
        let vertex = evaluation.at([places[0][lane], places[1][lane], places[2][lane]]);
        for axis in 0..3 {
            lanes[axis][lane] = vertex.position[axis];
            lanes[3 + axis][lane] = vertex.normal[axis];
        }
        lanes[6][lane] = vertex.uv[0];
        lanes[7][lane] = vertex.uv[1];
    }
    for (lane, out) in out.iter_mut().enumerate() {
        let value = |k: usize| lanes[k][lane];
        *out = TessVertex {
            position: [value(0), value(1), value(2)],
            normal: [value(3), value(4), value(5)],
            uv: [value(6), value(7)],
        };
    }
}

/// The frame's own.
struct BuiltIn<'a> {
    frame: &'a TessFrame,
    patch: &'a TessPatch,
    surface: TessSurface,
    heights: &'a [f32],
}

impl Evaluation for BuiltIn<'_> {
    const IS_PURE: bool = true;

    #[inline(always)]
    fn at(&self, coordinates: [u32; 3]) -> TessVertex {
        evaluate(self.frame, self.patch, &self.surface, self.heights, coordinates)
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
    // The same in all cases, but where the compiler knows the case it need not ask for every vertex.
    macro_rules! known {
        ($($domain:ident $evaluation:ident),*) => {
            match (frame.domain, frame.evaluation, frame.columns) {
                $(($domain, $evaluation, 0) => {
                    let frame = TessFrame { domain: $domain, evaluation: $evaluation, columns: 0, ..*frame };
                    all_vertices(&frame, patch, heights, topology, span, out);
                })*
                _ => all_vertices(frame, patch, heights, topology, span, out),
            }
        };
    }
    known!(
        TESS_TRIANGLES TESS_LINEAR, TESS_TRIANGLES TESS_PN, TESS_TRIANGLES TESS_PHONG, TESS_QUADS TESS_LINEAR,
        TESS_QUADS TESS_BEZIER
    );
}

#[inline(always)]
fn all_vertices(
    frame: &TessFrame,
    patch: &TessPatch,
    heights: &[f32],
    topology: &Topology,
    span: Span,
    out: &mut [TessVertex],
) {
    let surface = TessSurface::new(frame, patch);
    vertices(topology, span, out, &BuiltIn { frame, patch, surface, heights });
}

/// Lays primitives of a patch whose first vertex has index `base`; `out` has room for the span.
#[inline(always)]
pub fn indices(frame: &TessFrame, topology: &Topology, base: u32, span: Span, out: &mut [u32]) {
    if span.first == span.end {
        return;
    }
    let corners = corners(frame) as usize;
    let mut strip = topology.strip_of(span.first);
    let mut primitive = span.first;
    while primitive < span.end {
        let end = (strip.first + strip.count).min(span.end);
        let own =
            &mut out[corners * (primitive - span.first) as usize..corners * (end - span.first) as usize];
        let first = primitive - strip.first;
        // As in `built_in`: what is known need not be asked for every triangle.
        match strip.kind {
            Kind::Line => lay_lines(&strip, base, own, first),
            Kind::Regular => lay(frame, &Strip { kind: Kind::Regular, ..strip }, base, own, first),
            Kind::Between => lay(frame, &Strip { kind: Kind::Between, ..strip }, base, own, first),
            _ => lay(frame, &strip, base, own, first),
        }
        primitive = end;
        if primitive < span.end {
            strip = topology.next_strip(strip);
        }
    }
}

/// Triangles of a strip from one on.
#[inline(always)]
fn lay(frame: &TessFrame, strip: &Strip, base: u32, out: &mut [u32], first: u32) {
    let is_turned = frame.flags & TESS_CLOCKWISE > 0;
    for (index, out) in (first..).zip(out.as_chunks_mut::<3>().0) {
        let [a, b, c] = strip.triangle(index);
        *out = if is_turned { [base + a, base + c, base + b] } else { [base + a, base + b, base + c] };
    }
}

#[inline(always)]
fn lay_lines(strip: &Strip, base: u32, out: &mut [u32], first: u32) {
    for (index, out) in (first..).zip(out.as_chunks_mut::<2>().0) {
        let [a, b, _] = strip.triangle(index);
        *out = [base + a, base + b];
    }
}
