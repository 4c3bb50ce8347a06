//! local: a group works on a stack of its own, in local memory, for some batches: take, bound, scan and split
//! (LOCAL after Weber 2014, sec. 4.4, and Tzeng, Patney & Owens 2010). What it has left goes back to be dealt.

use crate::abi::{
    Control, Draw, Frame, Group, LOCAL_BATCH, LOCAL_DRAWS, LOCAL_STACK, Limits, Object, Patch, Slot, Surface,
    Verdict,
};
use crate::kernel::bound_lanes::{Lanes, bound_lanes};
use crate::kernel::scan::scan;
use crate::kernel::split::{Outcome, split};
use crate::kernel::take::take;

/// A group's own memory.
#[derive(Clone, Debug)]
pub struct LocalMemory {
    /// Its stack.
    pub stack: [Surface; LOCAL_STACK as usize],
    batch: [Surface; LOCAL_BATCH as usize],
    verdicts: [Verdict; LOCAL_BATCH as usize],
    slots: [Slot; LOCAL_BATCH as usize],
    lanes: Lanes,
}

impl Default for LocalMemory {
    fn default() -> Self {
        Self {
            stack: [Surface::default(); LOCAL_STACK as usize],
            batch: [Surface::default(); LOCAL_BATCH as usize],
            verdicts: [Verdict::default(); LOCAL_BATCH as usize],
            slots: [Slot::default(); LOCAL_BATCH as usize],
            lanes: Lanes::default(),
        }
    }
}

/// Works a group's round off: `memory.stack` holds its surfaces before and after, `draws` what it drew.
///
/// `draws` must have room for [`LOCAL_DRAWS`].
#[inline(always)]
#[must_use]
pub fn local(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    group: Group,
    memory: &mut LocalMemory,
    draws: &mut [Draw],
) -> Group {
    let (batch, stack_room, levels) = (LOCAL_BATCH, group.room, frame.levels);
    let limits = Limits { patches: 0, batch, stack_room, levels, draw_room: LOCAL_DRAWS, groups: 1 };
    let mut control = Control { stack: group.stack, peak: group.stack, ..Control::default() };
    for _ in 0..group.batches {
        if control.stack == 0 {
            break;
        }
        control = take(control, &limits, &memory.stack);
        let (base, taken) = (control.base as usize, control.taken as usize);
        let LocalMemory { stack, batch, verdicts, slots, lanes } = memory;
        let (batch, verdicts, slots) = (&mut batch[..taken], &mut verdicts[..taken], &mut slots[..taken]);
        batch.copy_from_slice(&stack[base..base + taken]);
        bound_lanes(frame, objects, patches, batch, verdicts, lanes);
        control = scan(control, verdicts, slots, limits.stack_room, limits.draw_room);
        for index in 0..taken {
            match split(&control, batch[index], verdicts[index], slots[index]) {
                Outcome::Culled => {}
                Outcome::Drawn(place, draw) => draws[place as usize] = draw,
                Outcome::Split(place, halves) => stack[place as usize..][..2].copy_from_slice(&halves),
            }
        }
    }
    Group {
        held: control.stack,
        draws: control.waiting + control.fresh,
        processed: control.processed,
        culled: control.culled,
        limited: control.limited,
        micropolygons: control.micropolygons,
        peak: control.peak,
        load: group.load + control.processed,
        ..group
    }
}
