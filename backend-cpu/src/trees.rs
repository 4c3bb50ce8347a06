//! The stages of trees in a device's memory. [`crate::CpuDevice::build_lbvh`] builds the same tree, and is made for the CPU.

use micropoly_core::abi::{AccelFrame, Bounds, Finding, Frustum, Node, Probe, SortKey, Triangle};
use micropoly_core::accel::extent::{Extent, bounds as box_of, with};
use micropoly_core::accel::morton::Grid;
use micropoly_core::accel::nearest::Around;
use micropoly_core::accel::query::seen;
use micropoly_core::accel::ray::{Ray, Shot};
use micropoly_core::accel::sort;
use micropoly_core::accel::tree::{EMPTY, fit, inner, link, node_count};
use micropoly_core::accel::walk::{Search, find};
use micropoly_core::stage::Stage;
use rayon::prelude::*;

use crate::device::CpuError;
use crate::stages::Buffers;

pub(crate) fn run(
    pool: &rayon::ThreadPool,
    stage: Stage,
    count: u32,
    buffers: Buffers<'_, '_>,
) -> Result<(), CpuError> {
    let frame = buffers[0].view::<AccelFrame>()?[0];
    match stage {
        Stage::AccelExtent => extent(pool, &frame, buffers),
        Stage::AccelCodes => codes(pool, &frame, buffers),
        Stage::AccelCount => {
            let (keys, mut counts) = (buffers[1].view::<SortKey>()?, buffers[2].view_mut::<u32>()?);
            (0..count).for_each(|block| sort::count(&frame, &keys, block, &mut counts));
            Ok(())
        }
        Stage::AccelScan => {
            sort::scan(&frame, &mut buffers[1].view_mut::<u32>()?);
            Ok(())
        }
        Stage::AccelScatter => {
            let (keys, counts) = (buffers[1].view::<SortKey>()?, buffers[2].view::<u32>()?);
            let mut sorted = buffers[3].view_mut::<SortKey>()?;
            (0..count).for_each(|block| sort::scatter(&frame, &keys, &counts, block, &mut sorted));
            Ok(())
        }
        Stage::AccelTree => tree(pool, &frame, buffers),
        Stage::AccelBoxes => boxes(&frame, buffers),
        Stage::AccelSee => see(pool, &frame, buffers),
        Stage::AccelFill => fill(&frame, buffers),
        Stage::AccelRays => rays(pool, &frame, buffers),
        Stage::AccelNearest => nearest(pool, &frame, buffers),
        _ => Err(CpuError::Bindings { stage: stage.name() }),
    }
}

fn extent(pool: &rayon::ThreadPool, frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (boxes, mut extent) = (buffers[1].view::<Bounds>()?, buffers[2].view_mut::<u32>()?);
    let boxes = &boxes[..frame.count as usize];
    let (own, _) = extent.as_chunks_mut::<6>();
    let both = |a: Extent, b: Extent| std::array::from_fn(|word| a[word].max(b[word]));
    let all = pool.install(|| boxes.par_iter().fold(Extent::default, with).reduce(Extent::default, both));
    own[0] = both(own[0], all);
    Ok(())
}

fn codes(pool: &rayon::ThreadPool, frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (boxes, extent) = (buffers[1].view::<Bounds>()?, buffers[2].view::<u32>()?);
    let mut keys = buffers[3].view_mut::<SortKey>()?;
    let count = frame.count as usize;
    let grid = Grid::with_bits(&box_of(extent.as_chunks().0[0]), frame.bits);
    let (boxes, keys) = (&boxes[..count], &mut keys[..count]);
    pool.install(|| {
        let each = keys.par_iter_mut().zip(boxes).enumerate();
        each.for_each(|(primitive, (key, bounds))| *key = SortKey::new(grid.code(bounds), primitive as u32));
    });
    Ok(())
}

fn tree(pool: &rayon::ThreadPool, frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let keys = buffers[1].view::<SortKey>()?;
    let (mut nodes, mut parents) = (buffers[2].view_mut::<Node>()?, buffers[3].view_mut::<u32>()?);
    let (count, all) = (frame.count as usize, node_count(frame.count) as usize);
    let keys = &keys[..count];
    let codes: Vec<u64> = keys.iter().map(SortKey::code).collect();
    let (above, leaves) = nodes[..all].split_at_mut(count - 1);
    for (leaf, key) in leaves.iter_mut().zip(keys) {
        *leaf = Node::leaf(key.primitive, EMPTY);
    }
    pool.install(|| {
        above.par_iter_mut().enumerate().for_each(|(index, node)| *node = inner(&codes, index as u32));
    });
    link(&nodes, &mut parents, count - 1);
    Ok(())
}

fn boxes(frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (boxes, parents) = (buffers[1].view::<Bounds>()?, buffers[2].view::<u32>()?);
    let (mut visits, mut nodes) = (buffers[3].view_mut::<u32>()?, buffers[4].view_mut::<Node>()?);
    let nodes = &mut nodes[..node_count(frame.count) as usize];
    fit(nodes, &parents, &boxes[..frame.count as usize], &mut visits);
    Ok(())
}

fn see(pool: &rayon::ThreadPool, frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (nodes, frusta) = (buffers[1].view::<Node>()?, buffers[2].view::<Frustum>()?);
    let mut counts = buffers[3].view_mut::<u32>()?;
    let (nodes, frusta, counts) = (&*nodes, &*frusta, &mut counts[..frame.counts as usize]);
    pool.install(|| {
        let each = counts.par_iter_mut().enumerate();
        each.for_each(|(block, count)| *count = seen(frame, nodes, frusta, block as u32).count() as u32);
    });
    Ok(())
}

fn fill(frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let (nodes, frusta) = (buffers[1].view::<Node>()?, buffers[2].view::<Frustum>()?);
    let (counts, mut out) = (buffers[3].view::<u32>()?, buffers[4].view_mut::<u32>()?);
    for block in 0..frame.counts {
        let places = &mut out[counts[block as usize] as usize..];
        for (place, primitive) in places.iter_mut().zip(seen(frame, &nodes, &frusta, block)) {
            *place = primitive;
        }
    }
    Ok(())
}

fn rays(pool: &rayon::ThreadPool, frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let triangles = buffers[2].view::<Triangle>()?;
    let triangles = &*triangles;
    search_all(pool, frame, buffers, |probe| Shot { ray: Ray::new(probe), triangles })
}

fn nearest(pool: &rayon::ThreadPool, frame: &AccelFrame, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let triangles = buffers[2].view::<Triangle>()?;
    let triangles = &*triangles;
    search_all(pool, frame, buffers, |probe| Around { probe: *probe, triangles })
}

fn search_all<S: Search>(
    pool: &rayon::ThreadPool,
    frame: &AccelFrame,
    buffers: Buffers<'_, '_>,
    search: impl Fn(&Probe) -> S + Sync,
) -> Result<(), CpuError> {
    let (nodes, probes) = (buffers[1].view::<Node>()?, buffers[3].view::<Probe>()?);
    let mut found = buffers[4].view_mut::<Finding>()?;
    let (nodes, count) = (&nodes[..node_count(frame.count) as usize], frame.questions as usize);
    let (probes, found) = (&probes[..count], &mut found[..count]);
    pool.install(|| {
        found.par_iter_mut().zip(probes).for_each(|(found, probe)| *found = find(&search(probe), nodes));
    });
    Ok(())
}
