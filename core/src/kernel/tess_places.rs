//! tess_places: where the vertices and primitives of each patch go, for as many patches as there is room for.

use crate::abi::{PIECE_PRIMITIVES, PIECE_VERTICES, TESS_WINDOW, TessFrame, TessRecord, TessTotals};

/// Places for patches from [`TessTotals::first`] on, and what they come to.
#[must_use]
pub fn places(frame: &TessFrame, records: &mut [TessRecord], totals: TessTotals) -> TessTotals {
    let most = frame.patch_count - totals.first;
    let most = totals.first + if most < TESS_WINDOW { most } else { TESS_WINDOW };
    let mut totals = TessTotals { end: totals.first, vertices: 0, primitives: 0, pieces: 0, ..totals };
    for record in &mut records[totals.first as usize..most as usize] {
        let (vertices, primitives) =
            (totals.vertices + record.vertices, totals.primitives + record.primitives);
        if vertices > totals.vertex_room || primitives > totals.primitive_room {
            break;
        }
        record.first_vertex = totals.vertices;
        record.first_primitive = totals.primitives;
        record.first_piece = totals.pieces;
        (totals.vertices, totals.primitives) = (vertices, primitives);
        totals.pieces += pieces(record);
        totals.end += 1;
    }
    totals
}

/// Into how many pieces a patch is cut.
#[inline(always)]
#[must_use]
pub const fn pieces(record: &TessRecord) -> u32 {
    let a = record.vertices.div_ceil(PIECE_VERTICES);
    let b = record.primitives.div_ceil(PIECE_PRIMITIVES);
    if a > b { a } else { b }
}
