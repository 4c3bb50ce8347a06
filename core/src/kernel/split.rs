//! split: children stay where their parent was, in order (Weber 2014, Alg. 4.1); the rest is to be drawn.

use crate::abi::{CULL, Control, Draw, SPLIT_U, SPLIT_V, Slot, Surface, Verdict};

/// What becomes of one surface.
pub enum Outcome {
    /// Nothing.
    Culled,
    /// It goes to this place of the draw buffer.
    Drawn(u32, Draw),
    /// Its halves go to this place of the stack and the next.
    Split(u32, [Surface; 2]),
}

/// Carries out the verdict on one surface of the batch.
#[inline(always)]
#[must_use]
pub fn split(control: &Control, surface: Surface, verdict: Verdict, slot: Slot) -> Outcome {
    let place = control.base + 2 * slot.splits;
    match verdict.code {
        CULL => Outcome::Culled,
        SPLIT_U | SPLIT_V => Outcome::Split(place, surface.halves(verdict)),
        _ => Outcome::Drawn(control.waiting + slot.draws, Draw::new(surface, verdict)),
    }
}
