//! scan: count → prefix sum → places, so that outputs are ordered and nothing depends on timing.

use crate::abi::{CULL, Control, DRAW, DRAW_LIMITED, Slot, Verdict};

/// Places for the outputs of a batch, and the counts after it.
///
/// `verdicts` and `slots` have an entry a taken surface. `stack_room` and `draw_room` are the sizes of the
/// stack and of the draw buffer; what does not fit is reported in [`Control::overflow`] and nothing of this
/// batch may then be written.
#[must_use]
pub fn scan(
    control: Control,
    verdicts: &[Verdict],
    slots: &mut [Slot],
    stack_room: u32,
    draw_room: u32,
) -> Control {
    let (mut splits, mut draws, mut limited, mut micropolygons) = (0, 0, 0, 0);
    for (verdict, slot) in verdicts.iter().zip(slots) {
        *slot = Slot { splits, draws };
        match verdict.code {
            CULL => {}
            DRAW | DRAW_LIMITED => {
                let [along_u, along_v] = verdict.rates();
                draws += 1;
                limited += (verdict.code == DRAW_LIMITED) as u32;
                micropolygons = along_u.wrapping_mul(along_v).wrapping_add(micropolygons);
            }
            _ => splits += 1,
        }
    }
    let control = Control {
        limited: control.limited + limited,
        micropolygons: control.micropolygons.wrapping_add(micropolygons),
        ..control
    };
    commit(control, splits, draws, stack_room, draw_room)
}

/// The counts after a batch in which so many were split and drawn.
#[must_use]
pub fn commit(control: Control, splits: u32, draws: u32, stack_room: u32, draw_room: u32) -> Control {
    let stack = control.base + 2 * splits;
    let excess_stack = stack.saturating_sub(stack_room);
    let excess_draws = (control.waiting + draws).saturating_sub(draw_room);
    Control {
        stack,
        peak: if stack > control.peak { stack } else { control.peak },
        fresh: draws,
        processed: control.processed + control.taken,
        culled: control.culled + control.taken - draws - splits,
        drawn: control.drawn + draws,
        overflow: if excess_stack > excess_draws { excess_stack } else { excess_draws },
        ..control
    }
}
