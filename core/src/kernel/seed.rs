//! seed: one root surface a patch; the first patch lies on top of the stack.

use crate::abi::{Control, Surface};

/// The stack's entry at `position` of `patches` before the first batch.
///
/// The stack is worked off from its top, so the first patches of a scene are drawn first.
#[inline(always)]
#[must_use]
pub const fn seed(position: u32, patches: u32) -> Surface {
    Surface::root(patches - 1 - position)
}

/// The counts before the first batch.
#[must_use]
pub fn start(patches: u32) -> Control {
    Control { stack: patches, peak: patches, low: patches, ..Control::default() }
}
