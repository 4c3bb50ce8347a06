//! ADAPTIVE: the largest batch that fits whatever becomes of it. Any stack of
//! [`stack_min`](crate::memory::stack_min) entries or more is enough; `docs/proofs/stack.md` has the proof.
//!
//! Entries count from 0 at the bottom. A stack is *safe* if `entry + levels - level <= capacity` for every
//! entry: there is room to finish the entry depth first, on top of all that lies below it. Roots wait beside the
//! stack, not on it: a batch that takes all of the stack may take roots too, which then are its first surfaces.

/// A batch: the stack's entries from `base` to the top, and so many roots before them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Batch {
    /// Position of the lowest entry.
    pub base: u32,
    /// Roots; only if `base` is 0.
    pub roots: u32,
}

/// The lowest base from which a batch may reach up to this entry and split it.
///
/// All below it in the batch may be split as well, so it moves up by as many entries as those are, and may
/// not move by more than what its stack has left. Kernels take the maximum of this over a batch.
#[inline(always)]
#[must_use]
pub const fn lowest(entry: u32, level: u32, levels: u32, capacity: u32) -> u32 {
    if level + 1 >= levels {
        return 0; // never split
    }
    let left = capacity.saturating_sub(entry).saturating_sub(levels - level);
    entry.saturating_sub(left)
}

/// Most roots that a batch of all entries may have before this one, so that it can still be split.
///
/// In a batch, entry `e` has `e` entries and the roots below it, and ends up to twice as high. Kernels take the
/// minimum of this over a batch.
#[inline(always)]
#[must_use]
pub const fn roots_below(entry: u32, level: u32, levels: u32, capacity: u32) -> u32 {
    if level + 1 >= levels {
        return u32::MAX; // never split
    }
    (capacity.saturating_sub(levels - level) / 2).saturating_sub(entry)
}

/// Most roots that a batch may have: the highest of them has all others below it.
#[inline(always)]
#[must_use]
pub const fn roots_above_none(levels: u32, capacity: u32) -> u32 {
    roots_below(0, 0, levels, capacity).saturating_add(1)
}

/// Is a batch of so many surfaces safe, whatever their levels are? The test that needs no look at them.
#[inline(always)]
#[must_use]
pub const fn is_safe(stack: u32, taken: u32, levels: u32, capacity: u32) -> bool {
    taken.saturating_add(levels).saturating_sub(2) <= capacity.saturating_sub(stack)
}

/// The next batch of at most `batch` surfaces: the smallest base, and then the most of the `waiting` roots,
/// after which the stack is safe even if all is split that may be.
///
/// The stack must be safe, as an empty one is. Then the batch is not empty unless everything is done, and every
/// later stack fits `capacity`, which must be [`stack_min`](crate::memory::stack_min) or more.
#[inline(always)]
#[must_use]
pub fn next(
    stack: u32,
    waiting: u32,
    batch: u32,
    levels: u32,
    capacity: u32,
    level_of: impl Fn(u32) -> u32,
) -> Batch {
    let first = stack.saturating_sub(batch);
    let spare = batch.saturating_sub(stack);
    let wanted = if waiting < spare { waiting } else { spare };
    if is_safe(stack + wanted, stack - first + wanted, levels, capacity) {
        return Batch { base: first, roots: wanted };
    }
    let base =
        (first..stack).fold(first, |base, entry| base.max(lowest(entry, level_of(entry), levels, capacity)));
    if base > 0 {
        return Batch { base, roots: 0 };
    }
    let most = wanted.min(roots_above_none(levels, capacity));
    let roots = (0..stack)
        .fold(most, |roots, entry| roots.min(roots_below(entry, level_of(entry), levels, capacity)));
    Batch { base, roots }
}
