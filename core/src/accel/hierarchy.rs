//! The tree over sorted codes, each inner node by itself (Karras 2012, sec. 4).
//!
//! Of `n` primitives there are `n - 1` inner nodes, numbered from 0 with the root, and behind them `n` leaves, in the order of
//! the codes. Equal codes are told apart by their place in that order.

/// An inner node: what it spans, and where it is cut in two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// First leaf.
    pub first: u32,
    /// Last leaf.
    pub last: u32,
    /// Last leaf of the first half.
    pub split: u32,
}

impl Span {
    /// Numbers of its two children among `n` leaves' nodes.
    #[inline(always)]
    #[must_use]
    pub const fn children(&self, n: u32) -> [u32; 2] {
        let leaf = n - 1;
        [
            if self.first == self.split { leaf + self.split } else { self.split },
            if self.last == self.split + 1 { leaf + self.split + 1 } else { self.split + 1 },
        ]
    }
}

/// How many leading bits the codes of two leaves share; -1 if there is no second one.
#[inline(always)]
#[must_use]
pub fn common(codes: &[u64], a: u32, b: i64) -> i32 {
    if b < 0 || b >= codes.len() as i64 {
        return -1;
    }
    let (x, y) = (codes[a as usize], codes[b as usize]);
    if x == y {
        return 64 + (a ^ b as u32).leading_zeros() as i32;
    }
    (x ^ y).leading_zeros() as i32
}

/// Inner node `index` of the tree over these codes, of which there are at least two.
#[inline(always)]
#[must_use]
pub fn span(codes: &[u64], index: u32) -> Span {
    let at = i64::from(index);
    let (after, before) = (common(codes, index, at + 1), common(codes, index, at - 1));
    // Its leaves lie on the side where they have more in common.
    let way = if after > before { 1 } else { -1 };
    let outside = if after > before { before } else { after };
    let mut most = 2;
    while common(codes, index, at + most * way) > outside {
        most *= 2;
    }
    let mut length = 0;
    let mut step = most / 2;
    while step > 0 {
        if common(codes, index, at + (length + step) * way) > outside {
            length += step;
        }
        step /= 2;
    }
    let end = at + length * way;
    let (first, last) = (at.min(end) as u32, at.max(end) as u32);
    Span { first, last, split: split(codes, first, last) }
}

/// Last leaf of the first half of those from `first` to `last`, of which there are at least two: where codes differ first.
#[inline(always)]
#[must_use]
pub fn split(codes: &[u64], first: u32, last: u32) -> u32 {
    let shared = common(codes, first, i64::from(last));
    let (mut low, mut high) = (first, last);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if common(codes, first, i64::from(middle)) > shared { low = middle } else { high = middle }
    }
    low
}
