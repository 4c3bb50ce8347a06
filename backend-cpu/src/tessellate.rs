//! The tessellator's stages, patch by patch; control and evaluation may be the caller's own.
#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use std::fmt;
use std::mem::take;
use std::sync::Arc;

use micropoly_core::abi::{TessFrame, TessLevels, TessPatch, TessRecord, TessTotals, TessVertex};
use micropoly_core::kernel::tess_control::{control, record};
use micropoly_core::kernel::tess_evaluate::{Evaluation, Span, built_in, corners, indices, vertices};
use micropoly_core::kernel::tess_places::places as place_patches;
use multiversion::multiversion;
use rayon::prelude::*;

use crate::buffer::CpuBuffer;
use crate::device::CpuError;
use crate::stages::Buffers;

/// A caller's own control: number of a patch and the patch to its levels. Where patches share an edge, it must have the
/// same level in all of them.
pub type Levels = dyn Fn(u32, &TessPatch) -> TessLevels + Send + Sync;

/// A caller's own evaluation: number of a patch, the patch, and coordinates in units of 2⁻¹⁶ to a vertex.
pub type Evaluate = dyn Fn(u32, &TessPatch, [u32; 3]) -> TessVertex + Send + Sync;

/// The steps that are the caller's own.
#[derive(Clone, Default)]
pub(crate) struct OwnSteps {
    pub(crate) levels: Option<Arc<Levels>>,
    pub(crate) evaluate: Option<Arc<Evaluate>>,
}

impl fmt::Debug for OwnSteps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { levels, evaluate } = self;
        f.debug_struct("OwnSteps")
            .field("levels", &levels.is_some())
            .field("evaluate", &evaluate.is_some())
            .finish()
    }
}

pub(crate) fn tess_control(
    pool: &rayon::ThreadPool,
    buffers: Buffers<'_, '_>,
    own: &OwnSteps,
) -> Result<(), CpuError> {
    let frame = buffers[0].view::<TessFrame>()?[0];
    let (patches, levels) = (buffers[1].view::<TessPatch>()?, buffers[2].view::<TessLevels>()?);
    let mut records = buffers[3].view_mut::<TessRecord>()?;
    let (patches, levels, records) = (&*patches, &*levels, &mut *records);
    let (count, levels_of) = (frame.patch_count as usize, own.levels.as_deref());
    pool.install(|| {
        let each =
            (0_u32..frame.patch_count).into_par_iter().zip(&mut records[..count]).zip(&patches[..count]);
        each.for_each(|((index, out), patch)| {
            *out = match levels_of {
                Some(levels_of) => record(&frame, &levels_of(index, patch)),
                None => control(&frame, patch, levels, index),
            };
        });
    });
    Ok(())
}

pub(crate) fn tess_places(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let frame = buffers[0].view::<TessFrame>()?[0];
    let mut records = buffers[1].view_mut::<TessRecord>()?;
    let totals = &mut buffers[2].view_mut::<TessTotals>()?[0];
    *totals = place_patches(&frame, &mut records, *totals);
    Ok(())
}

/// A patch, and where its mesh goes.
struct Job<'a> {
    index: u32,
    vertices: &'a mut [TessVertex],
    indices: &'a mut [u32],
}

pub(crate) fn tess_evaluate(
    pool: &rayon::ThreadPool,
    buffers: &[&CpuBuffer],
    own: &OwnSteps,
) -> Result<(), CpuError> {
    let frame = buffers[0].view::<TessFrame>()?[0];
    let (patches, heights) = (buffers[1].view::<TessPatch>()?, buffers[2].view::<f32>()?);
    let records = buffers[3].view::<TessRecord>()?;
    let totals = buffers[4].view::<TessTotals>()?[0];
    let (mut vertices, mut indices) = (buffers[5].view_mut::<TessVertex>()?, buffers[6].view_mut::<u32>()?);
    let (patches, heights, records) = (&*patches, &*heights, &*records);
    let (mut vertices, mut indices): (&mut [TessVertex], &mut [u32]) = (&mut vertices, &mut indices);
    let corners = corners(&frame) as usize;
    let mut jobs = Vec::with_capacity((totals.end - totals.first) as usize);
    for index in totals.first..totals.end {
        let record = &records[index as usize];
        let (own_vertices, rest) = take(&mut vertices).split_at_mut(record.vertices as usize);
        vertices = rest;
        let (own_indices, rest) = take(&mut indices).split_at_mut(corners * record.primitives as usize);
        indices = rest;
        jobs.push(Job { index, vertices: own_vertices, indices: own_indices });
    }
    let evaluate = own.evaluate.as_deref();
    pool.install(|| {
        jobs.into_par_iter().for_each(|job| {
            let (record, patch) = (&records[job.index as usize], &patches[job.index as usize]);
            match evaluate {
                Some(evaluate) => by_caller(&frame, patch, record, job, evaluate),
                None => by_frame(&frame, patch, heights, record, job),
            }
        });
    });
    Ok(())
}

/// The caller's own evaluation of one patch.
struct ByCaller<'a> {
    index: u32,
    patch: &'a TessPatch,
    evaluate: &'a Evaluate,
}

impl Evaluation for ByCaller<'_> {
    const IS_PURE: bool = false;

    fn at(&self, coordinates: [u32; 3]) -> TessVertex {
        (self.evaluate)(self.index, self.patch, coordinates)
    }
}

fn by_caller(frame: &TessFrame, patch: &TessPatch, record: &TessRecord, job: Job<'_>, evaluate: &Evaluate) {
    let topology = record.topology(frame);
    let whole = Span { first: 0, end: record.vertices };
    vertices(&topology, whole, job.vertices, &ByCaller { index: job.index, patch, evaluate });
    let whole = Span { first: 0, end: record.primitives };
    indices(frame, &topology, record.first_vertex, whole, job.indices);
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn by_frame(frame: &TessFrame, patch: &TessPatch, heights: &[f32], record: &TessRecord, job: Job<'_>) {
    let topology = record.topology(frame);
    built_in(frame, patch, heights, &topology, Span { first: 0, end: record.vertices }, job.vertices);
    let whole = Span { first: 0, end: record.primitives };
    indices(frame, &topology, record.first_vertex, whole, job.indices);
}
