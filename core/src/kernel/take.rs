//! take: the next batch is the top of the stack (Weber 2014, Alg. 4.1), as much of it as is safe.
//!
//! A stack is safe if every entry could be worked off alone, depth first, without overflow: an entry of level l
//! at index i needs i + k - l entries of room. A batch is safe if the stack is so after all of it has split.

use crate::abi::{Control, Limits, Surface};

/// Takes the largest safe batch of up to `limits.batch` surfaces. The draws of the last batch now wait to be
/// diced.
#[inline(always)]
#[must_use]
pub fn take(control: Control, limits: &Limits, stack: &[Surface]) -> Control {
    let base = base(control.stack, limits, stack);
    let low = if base < control.low { base } else { control.low };
    let taken = control.stack - base;
    Control { taken, base, low, waiting: control.waiting + control.fresh, fresh: 0, ..control }
}

/// Index of the first surface of the batch.
#[inline(always)]
fn base(count: u32, limits: &Limits, stack: &[Surface]) -> u32 {
    let lowest = count.saturating_sub(limits.batch);
    if is_safe(count, count - lowest, limits) {
        return lowest;
    }
    (lowest..count).fold(lowest, |base, index| {
        let least = least_base(index, stack[index as usize].level(), limits);
        if least > base { least } else { base }
    })
}

/// Is a batch of so many certainly safe, whatever its levels are? Its children are of level 1 or more.
#[inline(always)]
#[must_use]
pub const fn is_safe(count: u32, taken: u32, limits: &Limits) -> bool {
    count + taken + limits.levels <= limits.stack_room + 2
}

/// Lowest base of a batch that may hold the entry at `index`: the upper of its children would come to lie at
/// 2 · index - base + 1. At worst the batch must begin above it.
#[inline(always)]
#[must_use]
pub const fn least_base(index: u32, level: u32, limits: &Limits) -> u32 {
    let needed = index + limits.levels - level;
    let free = limits.stack_room - index;
    let least = needed.saturating_sub(free);
    if least > index { index + 1 } else { least }
}

/// Forgets the draws that have been diced.
#[inline(always)]
#[must_use]
pub fn flush(control: Control) -> Control {
    Control { waiting: 0, fresh: 0, ..control }
}
