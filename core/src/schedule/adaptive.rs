//! ADAPTIVE: the largest batch that fits whatever becomes of it. Any stack of
//! [`stack_min`](crate::memory::stack_min) entries or more is enough; `docs/proofs/stack.md` has the proof.
//!
//! Entries count from 0 at the bottom. A stack is *safe* if `entry + levels - level <= capacity` for every
//! entry: there is room to finish the entry depth first, on top of all that lies below it.

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

/// Is a batch of so many surfaces safe, whatever their levels are? The test that needs no look at them.
#[inline(always)]
#[must_use]
pub const fn is_safe(stack: u32, taken: u32, levels: u32, capacity: u32) -> bool {
    taken.saturating_add(levels).saturating_sub(2) <= capacity.saturating_sub(stack)
}

/// Where the next batch starts: the smallest base, at most `batch` below the top, after which the stack is
/// safe even if all is split that may be.
///
/// The stack must be safe, as it is from the roots on. Then the base is below the top, and every later stack
/// fits `capacity`.
#[inline(always)]
#[must_use]
pub fn base(stack: u32, batch: u32, levels: u32, capacity: u32, level_of: impl Fn(u32) -> u32) -> u32 {
    let first = stack.saturating_sub(batch);
    if is_safe(stack, stack - first, levels, capacity) {
        return first;
    }
    (first..stack).fold(first, |base, entry| base.max(lowest(entry, level_of(entry), levels, capacity)))
}
