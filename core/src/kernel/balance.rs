//! balance: LOCAL's groups are counted, and told what each will have in its next round. No atomics: loads are equal
//! because surfaces are dealt out anew, as by donation in Weber 2014, sec. 4.4, but to all at once.

use crate::abi::{Control, Group, LOCAL_BATCH, LOCAL_BATCHES, Limits};

/// So many of `total` things are dealt to player `index` of `players`, one by one around the table.
#[inline(always)]
#[must_use]
pub const fn share(total: u32, index: u32, players: u32) -> u32 {
    (total + players - 1 - index) / players
}

/// So many of `total` things are dealt to the players before `index`, if each gets hers at once.
#[inline(always)]
#[must_use]
pub const fn share_before(total: u32, index: u32, players: u32) -> u32 {
    let rest = total % players;
    index * (total / players) + if index < rest { index } else { rest }
}

/// Counts of all groups together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Surfaces left on their stacks.
    pub held: u32,
    /// Surfaces drawn.
    pub draws: u32,
    /// Surfaces bounded.
    pub processed: u32,
    /// Surfaces culled.
    pub culled: u32,
    /// Drawn surfaces that would have been split at a deeper level.
    pub limited: u32,
    /// Micropolygons of the drawn surfaces.
    pub micropolygons: u32,
    /// Sum of the largest numbers on their stacks.
    pub peak: u32,
}

impl Totals {
    /// Of all groups.
    #[must_use]
    pub fn of(groups: &[Group]) -> Self {
        groups.iter().fold(Self::default(), |sum, group| Self {
            held: sum.held + group.held,
            draws: sum.draws + group.draws,
            processed: sum.processed + group.processed,
            culled: sum.culled + group.culled,
            limited: sum.limited + group.limited,
            micropolygons: sum.micropolygons.wrapping_add(group.micropolygons),
            peak: sum.peak + group.peak,
        })
    }
}

/// Roots that all groups together are given: as many as fill a batch of each, if their stacks stay safe.
///
/// A stack of `d` surfaces, of any levels, stays safe above `r` roots if `r + d` is at most `capacity - levels + 1`.
#[inline(always)]
#[must_use]
pub const fn roots_given(limits: &Limits, held: u32, waiting: u32) -> u32 {
    let dealt = share(held, 0, limits.groups);
    let wanted = LOCAL_BATCH.saturating_sub(dealt);
    let room = (limits.stack_room + 1).saturating_sub(limits.levels + dealt);
    let each = if wanted < room { wanted } else { room };
    let most = each * limits.groups;
    if waiting < most { waiting } else { most }
}

/// Batches that each group may take before loads are balanced again: the more there is to do, the more.
#[inline(always)]
#[must_use]
pub const fn batches(limits: &Limits, surfaces: u32) -> u32 {
    let width = LOCAL_BATCH * limits.groups;
    let full = surfaces.div_ceil(width);
    if full < 1 {
        1
    } else if full > LOCAL_BATCHES {
        LOCAL_BATCHES
    } else {
        full
    }
}

/// The counts after a round, and what the groups together will have in the next.
#[inline(always)]
#[must_use]
pub const fn counted(control: Control, limits: &Limits, all: Totals) -> Control {
    let roots = roots_given(limits, all.held, limits.patches - control.next_root);
    let waiting = control.waiting + control.fresh;
    Control {
        stack: all.held + roots,
        taken: all.processed,
        roots,
        base: 0,
        next_root: control.next_root + roots,
        waiting,
        fresh: all.draws,
        peak: if all.peak > control.peak { all.peak } else { control.peak },
        processed: control.processed + all.processed,
        culled: control.culled + all.culled,
        drawn: control.drawn + all.draws,
        limited: control.limited + all.limited,
        micropolygons: control.micropolygons.wrapping_add(all.micropolygons),
        overflow: (waiting + all.draws).saturating_sub(limits.draw_room),
        listed: control.listed,
    }
}

/// What one group will have in its next round; `after` are the counts after the last one, `draws_before` what the
/// groups before it drew.
#[inline(always)]
#[must_use]
pub const fn arranged(
    group: Group,
    index: u32,
    after: &Control,
    limits: &Limits,
    draws_before: u32,
) -> Group {
    let roots = share(after.roots, index, limits.groups);
    let first_root = after.next_root - after.roots + share_before(after.roots, index, limits.groups);
    let is_first_round = after.next_root == after.roots;
    Group {
        stack: share(after.stack - after.roots, index, limits.groups) + roots,
        roots,
        next_root: first_root + roots,
        batches: batches(limits, after.stack),
        room: limits.stack_room,
        first_draw: draws_before,
        load: if is_first_round { 0 } else { group.load },
        ..group
    }
}

/// Counts the groups' last round and arranges their next.
#[must_use]
pub fn balance(control: Control, limits: &Limits, groups: &mut [Group]) -> Control {
    let after = counted(control, limits, Totals::of(groups));
    let mut draws_before = 0;
    for (index, group) in (0..).zip(groups) {
        let draws = group.draws;
        *group = arranged(*group, index, &after, limits, draws_before);
        draws_before += draws;
    }
    after
}
