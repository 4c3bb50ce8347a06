//! take: the next batch is the top of the stack (Weber 2014, Alg. 4.1), as much of it as is safe, and then roots.

use crate::abi::{Control, Limits, Surface};
use crate::schedule::adaptive::{Batch, next};

/// Takes the largest safe batch of up to `limits.batch` surfaces (see [`crate::schedule::adaptive`]). The draws
/// of the last batch now wait to be diced.
#[inline(always)]
#[must_use]
pub fn take(control: Control, limits: &Limits, stack: &[Surface]) -> Control {
    let Limits { patches, batch, levels, stack_room, .. } = *limits;
    let waiting = patches - control.next_root;
    let level_of = |entry: u32| stack[entry as usize].level();
    let Batch { base, roots } = next(control.stack, waiting, batch, levels, stack_room, level_of);
    Control {
        taken: roots + control.stack - base,
        roots,
        base,
        next_root: control.next_root + roots,
        waiting: control.waiting + control.fresh,
        fresh: 0,
        ..control
    }
}

/// The patch that is root number `number`.
#[inline(always)]
#[must_use]
pub fn patch_of(control: &Control, roots: &[u32], number: u32) -> u32 {
    if control.listed == 0 { number } else { roots[number as usize] }
}

/// Puts the batch's roots into it if there is a list of them: `bound`, which has no room for the list, finds them there.
#[inline(always)]
pub fn put_listed(control: &Control, roots: &[u32], batch: &mut [Surface]) {
    if control.listed == 0 {
        return;
    }
    for (item, surface) in (0..control.roots).zip(batch) {
        *surface = Surface::root(patch_of(control, roots, control.next_root - 1 - item));
    }
}

/// Surface number `item` of the batch, where `put` may lie: roots first, the first one last, as if they had lain on the
/// stack.
#[inline(always)]
#[must_use]
pub fn member(control: &Control, stack: &[Surface], put: Surface, item: u32) -> Surface {
    if item < control.roots {
        if control.listed == 0 { Surface::root(control.next_root - 1 - item) } else { put }
    } else {
        stack[(control.base + item - control.roots) as usize]
    }
}

/// Forgets the draws that have been diced.
#[inline(always)]
#[must_use]
pub fn flush(control: Control) -> Control {
    Control { waiting: 0, fresh: 0, ..control }
}
