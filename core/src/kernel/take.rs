//! take: the next batch is the top of the stack (Weber 2014, Alg. 4.1), as much of it as is safe.

use crate::abi::{Control, Limits, Surface};
use crate::schedule::adaptive::base;

/// Takes the largest safe batch of up to `limits.batch` surfaces (see [`crate::schedule::adaptive`]). The draws
/// of the last batch now wait to be diced.
#[inline(always)]
#[must_use]
pub fn take(control: Control, limits: &Limits, stack: &[Surface]) -> Control {
    let Limits { batch, levels, stack_room, .. } = *limits;
    let base = base(control.stack, batch, levels, stack_room, |entry| stack[entry as usize].level());
    let low = if base < control.low { base } else { control.low };
    let taken = control.stack - base;
    Control { taken, base, low, waiting: control.waiting + control.fresh, fresh: 0, ..control }
}

/// Forgets the draws that have been diced.
#[inline(always)]
#[must_use]
pub fn flush(control: Control) -> Control {
    Control { waiting: 0, fresh: 0, ..control }
}
