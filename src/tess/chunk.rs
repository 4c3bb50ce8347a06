//! A chunk of a tessellation in main memory.

use std::ops::ControlFlow;

use micropoly_core::abi::{TessRecord, TessVertex};
use micropoly_core::backend::Device;
use micropoly_core::kernel::tess_evaluate::corners;
use micropoly_core::tess::stream::{Chunk, TessCounts, TessInput, TessPlan};

use crate::error::{Error, Result};

/// Whole patches of a mesh.
#[derive(Debug)]
pub struct HostChunk {
    /// Its first patch.
    pub first: usize,
    /// What is known of each of its patches; those that were dropped have no vertices.
    pub records: Vec<TessRecord>,
    /// Vertices.
    pub vertices: Vec<TessVertex>,
    /// Indices, from the chunk's first vertex on.
    pub indices: Vec<u32>,
    /// Indices of a primitive.
    pub corners: usize,
    /// Vertices of all chunks before.
    pub before: u64,
}

/// Tessellates within so many bytes of the device's memory; `each` is given chunk by chunk, and ends it by an error.
///
/// # Errors
/// [`Error::Plan`] if the input contradicts itself or the memory is too small; [`Error::Device`]; what `each` reports.
pub fn each_chunk<D: Device>(
    device: &mut D,
    input: &TessInput<'_>,
    memory: u64,
    each: impl FnMut(HostChunk) -> Result<()>,
) -> Result<TessCounts> {
    each_chunk_of(device, input, memory, |_| Ok(()), each)
}

/// As [`each_chunk`]; `begin` is told how large the whole mesh is before any of it is made, and may end it, too.
///
/// # Errors
/// As [`each_chunk`], and what `begin` reports.
pub fn each_chunk_of<D: Device>(
    device: &mut D,
    input: &TessInput<'_>,
    memory: u64,
    begin: impl FnOnce(TessCounts) -> Result<()>,
    mut each: impl FnMut(HostChunk) -> Result<()>,
) -> Result<TessCounts> {
    let corners = corners(&input.frame) as usize;
    let plan = TessPlan::new(input, memory).map_err(Error::Plan)?;
    let failed = |error: D::Error| Error::on_device(&error);
    let buffers = plan.prepare(device).map_err(failed)?;
    begin(buffers.counts())?;
    let mut outcome = Ok(());
    let counts = plan.run(device, &buffers, |device, chunk| {
        outcome = each(read(device, chunk, corners)?);
        Ok(if outcome.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) })
    });
    outcome.and(counts.map_err(failed))
}

/// Tessellates without reading the mesh; returns when the device has made all of it.
///
/// # Errors
/// As [`each_chunk`].
pub fn count<D: Device>(device: &mut D, input: &TessInput<'_>, memory: u64) -> Result<TessCounts> {
    let plan = TessPlan::new(input, memory).map_err(Error::Plan)?;
    let run = |device: &mut D| {
        let buffers = plan.prepare(device)?;
        plan.run(device, &buffers, wait)
    };
    run(device).map_err(|error: D::Error| Error::on_device(&error))
}

/// Returns when the device has made a chunk.
pub(super) fn wait<D: Device>(
    device: &mut D,
    chunk: &Chunk<'_, D::Buffer>,
) -> std::result::Result<ControlFlow<()>, D::Error> {
    device.read(chunk.vertices, 0, &mut [TessVertex::default()])?;
    Ok(ControlFlow::Continue(()))
}

fn read<D: Device>(
    device: &mut D,
    chunk: &Chunk<'_, D::Buffer>,
    corners: usize,
) -> std::result::Result<HostChunk, D::Error> {
    let totals = chunk.totals;
    let mut read = HostChunk {
        first: totals.first as usize,
        records: vec![TessRecord::default(); (totals.end - totals.first) as usize],
        vertices: vec![TessVertex::default(); totals.vertices as usize],
        indices: vec![0; corners * totals.primitives as usize],
        corners,
        before: chunk.before,
    };
    device.read(chunk.records, u64::from(totals.first), &mut read.records)?;
    device.read(chunk.vertices, 0, &mut read.vertices)?;
    device.read(chunk.indices, 0, &mut read.indices)?;
    Ok(read)
}
