//! deal: all surfaces that LOCAL's groups have left are dealt out anew, around the table, the lowest of all stacks
//! first. So no surface moves up, and every stack stays safe (`docs/proofs/stack.md`).

use crate::abi::{Control, Group, Surface};
use crate::kernel::take::patch_of;

/// Place of an entry of a group's stack in the order in which all are dealt.
#[inline(always)]
#[must_use]
pub fn rank(groups: &[Group], group: u32, entry: u32) -> u32 {
    let mut before = 0;
    for (other, Group { held, .. }) in (0..).zip(groups) {
        let lower = if *held < entry { *held } else { entry };
        before += lower + if other < group && *held > entry { 1 } else { 0 };
    }
    before
}

/// The group that a surface of this rank is dealt to, and its entry there: above the group's roots.
#[inline(always)]
#[must_use]
pub fn dealt_to(groups: &[Group], rank: u32) -> (u32, u32) {
    let players = groups.len() as u32;
    let group = rank % players;
    (group, rank / players + groups[group as usize].roots)
}

/// Root number `entry` of a group.
#[inline(always)]
#[must_use]
pub fn root(control: &Control, roots: &[u32], group: &Group, entry: u32) -> Surface {
    Surface::root(patch_of(control, roots, group.next_root - 1 - entry))
}
