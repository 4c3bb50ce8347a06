//! tess_control: which levels a patch has, and how many vertices and primitives it becomes with them.

use crate::abi::{TESS_GIVEN, TESS_POINTS, TessFrame, TessLevels, TessPatch, TessRecord};
use crate::tess::control::levels_of;
use crate::tess::level::convert;
use crate::tess::topology::Topology;

/// The record of patch `index`; `levels` are those of the patches where they have levels of their own.
#[inline(always)]
#[must_use]
pub fn control(frame: &TessFrame, patch: &TessPatch, levels: &[TessLevels], index: u32) -> TessRecord {
    match frame.control {
        TESS_GIVEN => record(frame, &levels[index as usize]),
        _ => record(frame, &levels_of(frame, patch)),
    }
}

/// The record of a patch with these levels.
#[inline(always)]
#[must_use]
pub const fn record(frame: &TessFrame, levels: &TessLevels) -> TessRecord {
    let levels = convert(frame, levels);
    let topology = Topology::new(frame, &levels);
    let primitives = if frame.flags & TESS_POINTS > 0 { 0 } else { topology.primitives() };
    let vertices = topology.vertices();
    TessRecord { levels, vertices, primitives, first_vertex: 0, first_primitive: 0, first_piece: 0 }
}
