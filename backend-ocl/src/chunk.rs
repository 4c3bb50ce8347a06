//! What the fused stage needs for itself: the grids of a chunk of draws.

use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use micropoly_core::abi::Shared;
use opencl3::command_queue::CommandQueue;
use opencl3::context::Context;

use crate::buffer::OclBuffer;
use crate::error::OclError;
use crate::program::GROUP;

/// Draws a chunk; as `CHUNK` in `grids.cl`.
pub(crate) const DRAWS: u64 = 2048;
/// Draws that share a box; as `BLOCK` there.
const BLOCK: u64 = GROUP as u64;
/// Blocks a chunk; as `BLOCKS` there.
pub(crate) const BLOCKS: u64 = DRAWS / BLOCK;
/// Words before the first grid; as `GRIDS` there.
const GRIDS: u64 = 4 + 2 * BLOCKS + 3 * DRAWS;

/// Room for the grids of a chunk at this rate: what was kept from before, if that is enough.
///
/// `limit`: most bytes in one piece; what is reserved is added to `allocated`.
pub(crate) fn grids(
    kept: Option<OclBuffer>,
    device: (&Context, &CommandQueue),
    (limit, allocated): (u64, &Arc<AtomicU64>),
    rate: u32,
) -> Result<OclBuffer, OclError> {
    let words = grids_words(rate);
    match kept.filter(|grids| grids.entries() >= words) {
        Some(grids) => Ok(grids),
        None => OclBuffer::new(device, ("grids", u32::LAYOUT, words), limit, allocated),
    }
}

/// Bytes of the grids of a chunk at this rate.
pub(crate) fn bytes(rate: u32) -> u64 {
    grids_words(rate) * u32::LAYOUT.size as u64
}

/// Words of the grids of a chunk; see `grids.cl`.
fn grids_words(rate: u32) -> u64 {
    let vertices = (u64::from(rate) + 1).pow(2);
    GRIDS + DRAWS * 9 * vertices
}
