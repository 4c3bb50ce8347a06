//! What the fused stage needs for itself: the grids of a chunk of draws, and how far its tiles are.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::device::memory;
use crate::error::WgpuError;

/// Draws a chunk; as `CHUNK` in `grids.wgsl`.
pub(crate) const DRAWS: u64 = 2048;
/// Pixels a side of a tile; as `TILE` there.
const TILE: u32 = 16;
/// Words before the first grid; as `GRIDS` there.
const GRIDS: u64 = 8 + 2 * DRAWS / 64;
/// Words of a grid before its vertices; as `GRID_HEAD` there.
const GRID_HEAD: u64 = 3;
/// Places in `rounds.wgsl`, in bytes: was a loop cut, chunks begun, is anything left, progress.
pub(crate) const TRUNCATED: u64 = 8;
pub(crate) const BEGUN: u64 = 12;
pub(crate) const UNFINISHED: u64 = 20;
const PROGRESS: u64 = 28;

/// Draws, near and general, that a tile samples in one dispatch: the first words of `rounds.wgsl`. A GPU does
/// all at once; llvmpipe goes in rounds, far from its limit of 65535 loop iterations (see `tiles.wgsl`).
const ALL_AT_ONCE: [u32; 2] = [u32::MAX; 2];
const IN_ROUNDS: [u32; 2] = [128, 1];

/// Buffers of the fused stage.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// Does a tile need several dispatches?
    pub(crate) in_rounds: bool,
    /// See `grids.wgsl`.
    pub(crate) grids: wgpu::Buffer,
    /// See `rounds.wgsl`.
    pub(crate) rounds: wgpu::Buffer,
    allocated: Arc<AtomicU64>,
}

impl Chunk {
    /// Buffers too small for anything; [`Chunk::fit`] makes them larger.
    pub(crate) fn new(device: &wgpu::Device, in_rounds: bool, allocated: &Arc<AtomicU64>) -> Self {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        Self {
            in_rounds,
            grids: memory(device, "grids", 4, usage),
            rounds: memory(device, "rounds", PROGRESS, usage),
            allocated: Arc::clone(allocated),
        }
    }

    /// Makes room for an image of this size and grids of this rate.
    pub(crate) fn fit(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        image: (u32, u32),
        rate: u32,
    ) -> Result<(), WgpuError> {
        let budget = if self.in_rounds { IN_ROUNDS } else { ALL_AT_ONCE };
        if grow(device, &mut self.rounds, rounds_bytes(image), &self.allocated)? {
            queue.write_buffer(&self.rounds, 0, bytemuck::cast_slice(&budget));
        }
        grow(device, &mut self.grids, grids_bytes(rate), &self.allocated)?;
        Ok(())
    }
}

/// Bytes of all that a chunk needs for an image of this size and grids of this rate.
pub(crate) fn bytes(image: (u32, u32), rate: u32) -> u64 {
    rounds_bytes(image) + grids_bytes(rate)
}

/// Size of `rounds.wgsl`.
fn rounds_bytes((width, height): (u32, u32)) -> u64 {
    PROGRESS + 8 * u64::from(width.div_ceil(TILE)) * u64::from(height.div_ceil(TILE))
}

/// Size of the grids of a chunk; see `grids.wgsl`.
fn grids_bytes(rate: u32) -> u64 {
    let vertices = (u64::from(rate) + 1).pow(2);
    4 * (GRIDS + DRAWS * (GRID_HEAD + 9 * vertices))
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
