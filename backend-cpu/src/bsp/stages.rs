//! The stages that put pieces into order in a device's memory. [`crate::CpuDevice::sort_bsp`] finds the same order, and is made
//! for the CPU.

use micropoly_core::abi::{BspFrame, BspNode, BspPlane};
use micropoly_core::accel::bsp::cells::place_of;
use micropoly_core::accel::bsp::rank::rank;
use micropoly_core::stage::Stage;
use rayon::prelude::*;

use crate::device::CpuError;
use crate::stages::Buffers;

pub(crate) fn run(pool: &rayon::ThreadPool, stage: Stage, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let frame = buffers[0].view::<BspFrame>()?[0];
    match stage {
        Stage::BspSides => sides(pool, &frame, buffers),
        Stage::BspCells => cells(&frame, buffers),
        Stage::BspRank => ranks(&frame, buffers),
        _ => Err(CpuError::Bindings { stage: stage.name() }),
    }
}

fn sides(pool: &rayon::ThreadPool, frame: &BspFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (planes, mut is_before) = (buffers[1].view::<BspPlane>()?, buffers[2].view_mut::<u32>()?);
    let count = frame.planes as usize;
    let (planes, is_before) = (&planes[..count], &mut is_before[..count]);
    pool.install(|| {
        let each = is_before.par_iter_mut().zip(planes);
        each.for_each(|(is_before, plane)| *is_before = u32::from(plane.is_before(frame.eye)));
    });
    Ok(())
}

fn cells(frame: &BspFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (first_pieces, mut counts) = (buffers[1].view::<u32>()?, buffers[2].view_mut::<u32>()?);
    for cell in 0..frame.cells {
        let index = cell as usize;
        counts[place_of(frame, cell) as usize] = first_pieces[index + 1] - first_pieces[index];
    }
    Ok(())
}

fn ranks(frame: &BspFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let nodes = buffers[1].view::<BspNode>()?;
    let (first_nodes, first_pieces) = (buffers[2].view::<u32>()?, buffers[3].view::<u32>()?);
    let (is_before, counts) = (buffers[4].view::<u32>()?, buffers[5].view::<u32>()?);
    let (mut places, mut order) = (buffers[6].view_mut::<u32>()?, buffers[7].view_mut::<u32>()?);
    for cell in 0..frame.cells {
        let index = cell as usize;
        let own = first_nodes[index] as usize..first_nodes[index + 1] as usize;
        let start = counts[place_of(frame, cell) as usize] as usize;
        let before = |triangle: usize| is_before[triangle] != 0;
        rank(&nodes[own.clone()], before, first_pieces[index], &mut places[own], &mut order[start..]);
    }
    Ok(())
}
