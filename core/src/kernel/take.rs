//! take: the next batch is the top of the stack (Weber 2014, Alg. 4.1).

use crate::abi::Control;

/// Takes the top `batch` surfaces, or all there are. The draws of the last batch now wait to be diced.
#[inline(always)]
#[must_use]
pub fn take(control: Control, batch: u32) -> Control {
    let taken = if control.stack < batch { control.stack } else { batch };
    let base = control.stack - taken;
    let low = if base < control.low { base } else { control.low };
    Control { taken, base, low, waiting: control.waiting + control.fresh, fresh: 0, ..control }
}

/// Forgets the draws that have been diced.
#[inline(always)]
#[must_use]
pub fn flush(control: Control) -> Control {
    Control { waiting: 0, fresh: 0, ..control }
}
