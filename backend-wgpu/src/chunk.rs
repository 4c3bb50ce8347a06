//! What the fused stages need for themselves: the grids of a chunk of draws, sorted into tiles, and how far its tiles are;
//! or the keys of sort-last.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use micropoly_core::stage::{Extent, Stage};

use crate::device::memory;
use crate::error::WgpuError;

/// Draws a chunk, at most; as `CHUNK` in `grids.wgsl`.
pub(crate) const DRAWS: u64 = 2048;
/// Log2 of the samples a side of the largest block; as in `blocks.wgsl`.
const MOST_BLOCK_BITS: u32 = 4;
/// Words before the first grid; as `GRIDS` in `grids.wgsl`.
const GRIDS: u64 = 1;
/// Words of a grid before its vertices; as `GRID_HEAD` there.
const GRID_HEAD: u64 = 4;
/// Words before the first bin, and entries of the list at least; as `BINS` and `ENTRIES` in `bins.wgsl`.
const BINS: u64 = 8;
const ENTRIES: u64 = 1 << 20;
/// Bytes of a key; see `keys.wgsl`.
const KEY: u64 = 16;
/// Places in `rounds.wgsl`, in bytes: was a loop cut, the next draw, turn, is anything left (of the draws, and of either
/// kind of grids), progress.
pub(crate) const TRUNCATED: u64 = 8;
pub(crate) const NEXT: u64 = 12;
pub(crate) const TURN: u64 = 20;
pub(crate) const LEFT: u64 = 24;
const PROGRESS: u64 = 36;

/// Turns of sort-last.
pub(crate) const TURNS: u64 = 5;

/// Draws, near and general, that a block samples in one dispatch: the first words of `rounds.wgsl`. A GPU does
/// all at once; llvmpipe goes in rounds, far from its limit of 65535 loop iterations (see `tiles.wgsl`).
const ALL_AT_ONCE: [u32; 2] = [u32::MAX; 2];
const IN_ROUNDS: [u32; 2] = [128, 1];

/// Buffers of the fused stages.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// Does a tile need several dispatches?
    pub(crate) in_rounds: bool,
    /// See `grids.wgsl`.
    pub(crate) grids: wgpu::Buffer,
    /// See `bins.wgsl`.
    pub(crate) bins: wgpu::Buffer,
    /// See `keys.wgsl`.
    pub(crate) keys: wgpu::Buffer,
    /// See `rounds.wgsl`.
    pub(crate) rounds: wgpu::Buffer,
    /// The numbers of all turns.
    pub(crate) turns: wgpu::Buffer,
    allocated: Arc<AtomicU64>,
}

impl Chunk {
    /// Buffers too small for anything; [`Chunk::fit`] makes them larger.
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        in_rounds: bool,
        allocated: &Arc<AtomicU64>,
    ) -> Self {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let turns = memory(device, "turns", 4 * TURNS, usage);
        let numbers: Vec<u32> = (0..TURNS as u32).collect();
        queue.write_buffer(&turns, 0, bytemuck::cast_slice(&numbers));
        Self {
            in_rounds,
            grids: memory(device, "grids", 4, usage),
            bins: memory(device, "bins", 4, usage),
            keys: memory(device, "keys", 4, usage),
            rounds: memory(device, "rounds", PROGRESS, usage),
            turns,
            allocated: Arc::clone(allocated),
        }
    }

    /// Makes room for a stage on frames as large as this.
    pub(crate) fn fit(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        stage: Stage,
        extent: &Extent,
    ) -> Result<(), WgpuError> {
        let budget = if self.in_rounds { IN_ROUNDS } else { ALL_AT_ONCE };
        let is_sort_last = stage == Stage::SortLast;
        if grow(device, &mut self.rounds, rounds_bytes(is_sort_last, extent), &self.allocated)? {
            queue.write_buffer(&self.rounds, 0, bytemuck::cast_slice(&budget));
        }
        grow(device, &mut self.grids, grids_bytes(extent), &self.allocated)?;
        if is_sort_last {
            grow(device, &mut self.keys, keys_bytes(extent), &self.allocated)?;
        } else {
            grow(device, &mut self.bins, bins_bytes(extent), &self.allocated)?;
        }
        Ok(())
    }
}

/// Bytes of all that a frame needs.
pub(crate) fn bytes(extent: &Extent) -> u64 {
    let sorted = if extent.sort_last { keys_bytes(extent) } else { bins_bytes(extent) };
    rounds_bytes(extent.sort_last, extent) + grids_bytes(extent) + sorted
}

/// Bytes of the bins of a frame, before its list: what must be zero before grids are counted.
pub(crate) fn bins_head_bytes(extent: &Extent) -> u64 {
    4 * (BINS + 2 * squares(extent, tile_bits(extent)))
}

/// Can a chunk of draws need more entries than the list has room for?
pub(crate) fn is_large(extent: &Extent) -> bool {
    squares(extent, tile_bits(extent)) * DRAWS > ENTRIES
}

fn tile_bits(extent: &Extent) -> u32 {
    if extent.tile_bits == 0 { MOST_BLOCK_BITS } else { extent.tile_bits }
}

/// Squares of `1 << bits` columns that a frame is cut into.
fn squares(extent: &Extent, bits: u32) -> u64 {
    let along = |samples: u32| u64::from(samples.div_ceil(1 << bits));
    along(extent.columns) * along(extent.rows)
}

/// Size of `rounds.wgsl`.
fn rounds_bytes(is_sort_last: bool, extent: &Extent) -> u64 {
    let blocks = squares(extent, tile_bits(extent).min(MOST_BLOCK_BITS));
    PROGRESS + if is_sort_last { 4 } else { 8 * blocks.max(1) }
}

/// Size of the grids of a chunk; see `grids.wgsl`.
fn grids_bytes(extent: &Extent) -> u64 {
    let vertices = (u64::from(extent.rate) + 1).pow(2);
    4 * (GRIDS + DRAWS * (GRID_HEAD + 9 * vertices))
}

/// Size of `bins.wgsl`.
fn bins_bytes(extent: &Extent) -> u64 {
    bins_head_bytes(extent) + 4 * squares(extent, tile_bits(extent)).max(ENTRIES)
}

fn keys_bytes(extent: &Extent) -> u64 {
    KEY * extent.samples
}

/// Puts a larger buffer in the place of one that is too small; says whether it did.
fn grow(
    device: &wgpu::Device,
    buffer: &mut wgpu::Buffer,
    bytes: u64,
    allocated: &AtomicU64,
) -> Result<bool, WgpuError> {
    if buffer.size() >= bytes {
        return Ok(false);
    }
    let errors = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let larger = memory(device, "draw", bytes, buffer.usage());
    if pollster::block_on(errors.pop()).is_some() {
        return Err(WgpuError::OutOfMemory { buffer: "draw", bytes });
    }
    allocated.fetch_add(bytes - buffer.size(), Ordering::Relaxed);
    *buffer = larger;
    Ok(true)
}
