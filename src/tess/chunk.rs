//! A chunk of a tessellation in main memory.

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

/// Tessellates within so many bytes of the device's memory; `each` is given chunk by chunk.
///
/// # Errors
/// [`Error::Plan`] if the input contradicts itself or the memory is too small; [`Error::Device`]; what `each` reports.
pub fn each_chunk<D: Device>(
    device: &mut D,
    input: &TessInput<'_>,
    memory: u64,
    mut each: impl FnMut(HostChunk) -> Result<()>,
) -> Result<TessCounts> {
    let corners = corners(&input.frame) as usize;
    let plan = TessPlan::new(input, memory).map_err(Error::Plan)?;
    let failed = |error: D::Error| Error::on_device(&error);
    let buffers = plan.prepare(device, input).map_err(failed)?;
    let mut outcome = Ok(());
    let counts = plan.run(device, &buffers, |device, chunk| {
        if outcome.is_ok() {
            outcome = each(read(device, chunk, corners)?);
        }
        Ok(())
    });
    outcome.and(counts.map_err(failed))
}

fn read<D: Device>(
    device: &mut D,
    chunk: &Chunk<'_, D::Buffer>,
    corners: usize,
) -> core::result::Result<HostChunk, D::Error> {
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
