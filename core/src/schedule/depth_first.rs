//! One patch on the host, depth first, without a device: for tools that look at what is drawn.

use crate::abi::{CULL, DRAW, DRAW_LIMITED, Draw, Frame, MAX_LEVELS, Object, Patch, Surface};
use crate::kernel::bound::bound_any;
use crate::memory::stack_min;

/// Everything that is drawn of a patch, and whether it should have been split deeper.
pub fn for_each_draw(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    patch_id: u32,
    mut each: impl FnMut(Draw, bool),
) {
    let mut stack = [Surface::default(); stack_min(MAX_LEVELS as u64) as usize];
    let mut count = 1;
    stack[0] = Surface::root(patch_id);
    while count > 0 {
        count -= 1;
        let surface = stack[count];
        let verdict = bound_any(frame, objects, patches, surface);
        match verdict.code {
            CULL => {}
            DRAW | DRAW_LIMITED => each(Draw::new(surface, verdict), verdict.code == DRAW_LIMITED),
            _ => {
                stack[count..count + 2].copy_from_slice(&surface.halves(verdict));
                count += 2;
            }
        }
    }
}
