//! LOCAL's stages: groups are spread over threads, each thread has a group's local memory of its own.
#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use micropoly_core::abi::{Control, Draw, Frame, Group, LOCAL_DRAWS, Limits, Object, Patch, Surface};
use micropoly_core::kernel::balance::balance as balance_groups;
use micropoly_core::kernel::deal::{dealt_to, root};
use micropoly_core::kernel::local::{LocalMemory, local as work_off};
use multiversion::multiversion;
use rayon::prelude::*;

use crate::device::CpuError;
use crate::stages::Buffers;

pub(crate) fn local(pool: &rayon::ThreadPool, buffers: Buffers<'_, '_>, count: u32) -> Result<(), CpuError> {
    let frame = buffers[0].view::<Frame>()?[0];
    let (objects, patches) = (buffers[1].view::<Object>()?, buffers[2].view::<Patch>()?);
    let dealt = buffers[3].view::<Surface>()?;
    let mut groups = buffers[4].view_mut::<Group>()?;
    let (mut stack, mut fresh) = (buffers[5].view_mut::<Surface>()?, buffers[6].view_mut::<Draw>()?);
    let (stack, fresh) = (&mut *stack, &mut *fresh);
    let groups = &mut groups[..count as usize];
    let room = groups[0].room.max(1) as usize; // the same for all; before the first round there is none
    let (objects, patches, dealt) = (&*objects, &*patches, &*dealt);
    pool.install(|| {
        groups
            .par_iter_mut()
            .zip(dealt.par_chunks(room))
            .zip(stack.par_chunks_mut(room).zip(fresh.par_chunks_mut(LOCAL_DRAWS as usize)))
            .for_each_init(LocalMemory::default, |memory, ((group, dealt), (stack, draws))| {
                let count = group.stack as usize;
                memory.stack[..count].copy_from_slice(&dealt[..count]);
                *group = round(&frame, objects, patches, *group, memory, draws);
                let held = group.held as usize;
                stack[..held].copy_from_slice(&memory.stack[..held]);
            });
    });
    Ok(())
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn round(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    group: Group,
    memory: &mut LocalMemory,
    draws: &mut [Draw],
) -> Group {
    work_off(frame, objects, patches, group, memory, draws)
}

pub(crate) fn balance(buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let limits = buffers[0].view::<Limits>()?[0];
    let mut groups = buffers[1].view_mut::<Group>()?;
    let control = &mut buffers[2].view_mut::<Control>()?[0];
    *control = balance_groups(*control, &limits, &mut groups[..limits.groups as usize]);
    Ok(())
}

pub(crate) fn deal(buffers: Buffers<'_, '_>, count: u32) -> Result<(), CpuError> {
    let control = buffers[0].view::<Control>()?[0];
    let (roots, groups) = (buffers[1].view::<u32>()?, buffers[2].view::<Group>()?);
    let (stack, fresh) = (buffers[3].view::<Surface>()?, buffers[4].view::<Draw>()?);
    let (mut dealt, mut draws) = (buffers[5].view_mut::<Surface>()?, buffers[6].view_mut::<Draw>()?);
    if control.overflow > 0 {
        return Ok(()); // the plan reports it when it next asks
    }
    let groups = &groups[..count as usize];
    let most = groups.iter().map(|group| group.held).max().unwrap_or(0);
    // In the order of `deal::rank`: the lowest entries of all groups, then those above them, and so on.
    let held = (0..most).flat_map(|entry| {
        let hold = move |(_, group): &(usize, &Group)| group.held > entry;
        groups.iter().enumerate().filter(hold).map(move |(index, group)| at(group, index, entry))
    });
    for (rank, from) in (0..).zip(held) {
        let (target, entry) = dealt_to(groups, rank);
        dealt[at(&groups[target as usize], target as usize, entry)] = stack[from];
    }
    for (index, group) in groups.iter().enumerate() {
        for entry in 0..group.roots {
            dealt[at(group, index, entry)] = root(&control, &roots, group, entry);
        }
        let own = &fresh[index * LOCAL_DRAWS as usize..][..group.draws as usize];
        draws[(control.waiting + group.first_draw) as usize..][..own.len()].copy_from_slice(own);
    }
    Ok(())
}

/// Where an entry of a group's stack lies.
fn at(group: &Group, index: usize, entry: u32) -> usize {
    index * group.room as usize + entry as usize
}
