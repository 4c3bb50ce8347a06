//! Keys in the order of their codes, digit by digit, least significant first: `count`, `scan` and `scatter` once a digit.
//!
//! A block of keys is a group's; each of its invocations has a run of them, so that equal digits stay in order.

use crate::abi::{AccelFrame, SORT_BITS, SORT_BLOCK, SORT_DIGITS, SortKey};

/// How many blocks so many keys are.
#[inline(always)]
#[must_use]
pub const fn blocks(keys: u32) -> u32 {
    keys.div_ceil(SORT_BLOCK)
}

/// How many digits codes with so many bits a coordinate have.
#[must_use]
pub const fn digits(bits: u32) -> u32 {
    (3 * bits).div_ceil(SORT_BITS)
}

/// The digit of a key above so many bits, of which [`SORT_BITS`] are a whole number of times.
#[inline(always)]
#[must_use]
pub const fn digit(key: &SortKey, shift: u32) -> u32 {
    let word = if shift < 32 { key.low } else { key.high };
    word >> (shift & 31) & (SORT_DIGITS - 1)
}

/// Keys of a block.
fn block_of(frame: &AccelFrame, block: u32) -> core::ops::Range<usize> {
    let (first, count) = ((block * SORT_BLOCK) as usize, frame.count as usize);
    first..count.min(first + SORT_BLOCK as usize)
}

/// How many keys of a block have which digit, to `counts`: digit by digit, and of each block by block.
pub fn count(frame: &AccelFrame, keys: &[SortKey], block: u32, counts: &mut [u32]) {
    let mut own = [0; SORT_DIGITS as usize];
    for key in &keys[block_of(frame, block)] {
        own[digit(key, frame.shift) as usize] += 1;
    }
    for (digit, count) in (0..).zip(own) {
        counts[(digit * blocks(frame.count) + block) as usize] = count;
    }
}

/// Replaces [`AccelFrame::counts`] counts by the sums of those before each; the sum of all comes behind them.
pub fn scan(frame: &AccelFrame, counts: &mut [u32]) {
    let mut before = 0_u32;
    for count in &mut counts[..frame.counts as usize] {
        before += core::mem::replace(count, before);
    }
    counts[frame.counts as usize] = before;
}

/// Puts the keys of a block into their places.
pub fn scatter(frame: &AccelFrame, keys: &[SortKey], counts: &[u32], block: u32, sorted: &mut [SortKey]) {
    let mut places = [0; SORT_DIGITS as usize];
    for (digit, place) in (0..).zip(&mut places) {
        *place = counts[(digit * blocks(frame.count) + block) as usize];
    }
    for key in &keys[block_of(frame, block)] {
        let place = &mut places[digit(key, frame.shift) as usize];
        sorted[*place as usize] = *key;
        *place += 1;
    }
}
