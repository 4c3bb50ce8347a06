//! Each stage as a loop over its function in core, but for those that draw (`draw.rs`, `sort_last.rs`) and those over
//! samples and pixels (`pixels.rs`). Surfaces are bounded in chunks.
#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use micropoly_core::abi::{
    Control, Draw, Frame, Limits, MeshPlace, MeshTotals, MeshVertex, Object, Patch, Question, Slot, Surface,
    Verdict,
};
use micropoly_core::kernel::bound_lanes::{Lanes, bound_lanes};
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::known_answers::answer as known_answer;
use micropoly_core::kernel::mesh::{self, QUAD_INDICES};
use micropoly_core::kernel::scan::scan as scan_batch;
use micropoly_core::kernel::split::{Outcome, split as split_one};
use micropoly_core::kernel::take::{self as taking, member, put_listed};
use multiversion::multiversion;
use rayon::prelude::*;

use crate::buffer::CpuBuffer;
use crate::device::CpuError;

/// Surfaces that one thread bounds at a time.
const BOUND_CHUNK: usize = 256;

pub(crate) type Buffers<'a, 'b> = &'a [&'b CpuBuffer];

pub(crate) fn take(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let limits = buffers[0].view::<Limits>()?[0];
    let (roots, stack) = (buffers[1].view::<u32>()?, buffers[2].view::<Surface>()?);
    let mut batch = buffers[3].view_mut::<Surface>()?;
    let control = &mut buffers[4].view_mut::<Control>()?[0];
    *control = taking::take(*control, &limits, &stack);
    put_listed(control, &roots, &mut batch);
    Ok(())
}

pub(crate) fn flush(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let control = &mut buffers[0].view_mut::<Control>()?[0];
    *control = taking::flush(*control);
    Ok(())
}

pub(crate) fn bound(pool: &rayon::ThreadPool, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let frame = buffers[0].view::<Frame>()?[0];
    let objects = buffers[1].view::<Object>()?;
    let patches = buffers[2].view::<Patch>()?;
    let control = buffers[3].view::<Control>()?[0];
    let stack = buffers[4].view::<Surface>()?;
    let (mut batch, mut verdicts) = (buffers[5].view_mut::<Surface>()?, buffers[6].view_mut::<Verdict>()?);
    let (objects, patches) = (&*objects, &*patches);
    let batch = &mut batch[..control.taken as usize];
    for (item, surface) in (0..).zip(&mut *batch) {
        *surface = member(&control, &stack, *surface, item);
    }
    let taken = &*batch;
    let verdicts = &mut verdicts[..taken.len()];
    if taken.len() <= BOUND_CHUNK {
        bound_chunk(&frame, objects, patches, taken, verdicts); // done before another thread wakes up
        return Ok(());
    }
    pool.install(|| {
        taken
            .par_chunks(BOUND_CHUNK)
            .zip(verdicts.par_chunks_mut(BOUND_CHUNK))
            .for_each(|(surfaces, verdicts)| bound_chunk(&frame, objects, patches, surfaces, verdicts));
    });
    Ok(())
}

pub(crate) fn known_answers(buffers: Buffers<'_, '_>, count: u32) -> Result<(), CpuError> {
    let questions = buffers[1].view::<Question>()?;
    let mut answers = buffers[2].view_mut::<u32>()?;
    for (question, answer) in questions.iter().zip(answers.iter_mut()).take(count as usize) {
        *answer = known_answer(*question);
    }
    Ok(())
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn bound_chunk(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    surfaces: &[Surface],
    verdicts: &mut [Verdict],
) {
    bound_lanes(frame, objects, patches, surfaces, verdicts, &mut Lanes::default());
}

pub(crate) fn scan(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let limits = buffers[0].view::<Limits>()?[0];
    let verdicts = buffers[1].view::<Verdict>()?;
    let mut slots = buffers[2].view_mut::<Slot>()?;
    let control = &mut buffers[3].view_mut::<Control>()?[0];
    let taken = control.taken as usize;
    *control =
        scan_batch(*control, &verdicts[..taken], &mut slots[..taken], limits.stack_room, limits.draw_room);
    Ok(())
}

pub(crate) fn split(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let control = buffers[0].view::<Control>()?[0];
    let batch = buffers[1].view::<Surface>()?;
    let verdicts = buffers[2].view::<Verdict>()?;
    let slots = buffers[3].view::<Slot>()?;
    let (mut stack, mut draws) = (buffers[4].view_mut::<Surface>()?, buffers[5].view_mut::<Draw>()?);
    if control.overflow > 0 {
        return Ok(()); // the plan reports it when it next asks
    }
    for index in 0..control.taken as usize {
        match split_one(&control, batch[index], verdicts[index], slots[index]) {
            Outcome::Culled => {}
            Outcome::Drawn(place, draw) => draws[place as usize] = draw,
            Outcome::Split(place, halves) => stack[place as usize..][..2].copy_from_slice(&halves),
        }
    }
    Ok(())
}

pub(crate) fn mesh_places(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let control = buffers[0].view::<Control>()?[0];
    let draws = buffers[1].view::<Draw>()?;
    let mut places = buffers[2].view_mut::<MeshPlace>()?;
    let totals = &mut buffers[3].view_mut::<MeshTotals>()?[0];
    *totals = mesh::places(&control, &draws, &mut places, *totals);
    Ok(())
}

/// Draws that are meshed before they are put into their places.
const MESH_CHUNK: usize = 4096;

pub(crate) fn mesh(pool: &rayon::ThreadPool, buffers: Buffers<'_, '_>, count: u32) -> Result<(), CpuError> {
    let frame = buffers[0].view::<Frame>()?[0];
    let objects = buffers[1].view::<Object>()?;
    let patches = buffers[2].view::<Patch>()?;
    let draws = buffers[3].view::<Draw>()?;
    let places = buffers[4].view::<MeshPlace>()?;
    let (mut vertices, mut indices) = (buffers[5].view_mut::<MeshVertex>()?, buffers[6].view_mut::<u32>()?);
    let (objects, patches) = (&*objects, &*patches);
    let (draws, places) = (&draws[..count as usize], &places[..count as usize]);
    for (draws, places) in draws.chunks(MESH_CHUNK).zip(places.chunks(MESH_CHUNK)) {
        let parts: Vec<_> = pool.install(|| {
            let each = draws.par_iter().zip(places);
            each.map_init(Grid::default, |grid, (draw, place)| {
                mesh_one(&frame, objects, patches, *draw, *place, grid)
            })
            .collect()
        });
        for (place, (own_vertices, own_indices)) in places.iter().zip(parts) {
            vertices[place.vertex as usize..][..own_vertices.len()].copy_from_slice(&own_vertices);
            indices[3 * place.triangle as usize..][..own_indices.len()].copy_from_slice(&own_indices);
        }
    }
    Ok(())
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn mesh_one(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    draw: Draw,
    place: MeshPlace,
    grid: &mut Grid,
) -> (Vec<MeshVertex>, Vec<u32>) {
    let mut vertices = vec![MeshVertex::default(); draw.vertices() as usize];
    let mut indices = vec![0; draw.triangles() as usize * QUAD_INDICES / 2];
    mesh::dice_in_place(frame, objects, patches, draw, grid);
    mesh::mesh(draw, place, grid, &mut vertices, &mut indices);
    (vertices, indices)
}
