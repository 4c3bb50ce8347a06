//! What the stages that draw need for themselves: the grids of a chunk of draws, and lists of tiles or keys of samples.

use micropoly_core::abi::{Layout, Sample, Shared};
use micropoly_core::stage::Extent;

/// Draws a chunk; as `CHUNK` in `grids.cl`.
pub(crate) const DRAWS: u64 = 2048;
/// Words before the first grid; as `GRIDS` there.
const GRIDS: u64 = 4 + 6 * DRAWS;
/// Most entries of all tiles' lists together; as `LIST_ROOM` in `sort_middle.cl`.
const LIST_ROOM: u64 = 1 << 20;
/// Log2 of the columns (and rows) of samples that a work-group samples, at most; as `BLOCK_BITS` in `grids.cl`.
const BLOCK_BITS: u32 = 4;

/// A buffer that stages that draw have for themselves: its name, its layout, and its entries.
pub(crate) type Own = (&'static str, Layout, u64);

/// Those buffers: grids, lists of tiles, keys. One without entries is not needed.
pub(crate) fn own(extent: &Extent) -> [Own; 3] {
    let vertices = (u64::from(extent.rate) + 1).pow(2);
    let grids = GRIDS + DRAWS * 9 * vertices;
    let (lists, keys) =
        if extent.sort_last { (0, extent.samples) } else { (tiles(extent) + 1 + LIST_ROOM, 0) };
    [("grids", u32::LAYOUT, grids), ("lists", u32::LAYOUT, lists), ("keys", Sample::LAYOUT, keys)]
}

/// Bytes of those buffers.
pub(crate) fn bytes(extent: &Extent) -> u64 {
    own(extent).iter().map(|(_, layout, entries)| entries * layout.size as u64).sum()
}

/// Number of tiles.
pub(crate) fn tiles(extent: &Extent) -> u64 {
    let [columns, rows] = squares(extent, tile_bits(extent));
    columns * rows
}

/// Columns and rows of blocks, each sampled by a work-group.
pub(crate) fn blocks(extent: &Extent) -> [u64; 2] {
    squares(extent, tile_bits(extent).min(BLOCK_BITS))
}

const fn tile_bits(extent: &Extent) -> u32 {
    if extent.tile_bits == 0 { BLOCK_BITS } else { extent.tile_bits }
}

fn squares(extent: &Extent, bits: u32) -> [u64; 2] {
    [extent.columns, extent.rows].map(|samples| u64::from(samples).div_ceil(1 << bits))
}
