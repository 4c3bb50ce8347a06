//! Signs of sums of products that are wider than a word.

/// What something is along each axis, or at each corner. Unlike the standard library's `from_fn`, all of it is inlined.
#[inline(always)]
pub(super) fn each<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// `a × b`.
#[inline(always)]
#[must_use]
pub const fn cross(a: [i64; 3], b: [i64; 3]) -> [i128; 3] {
    [minor(a, b, 1, 2), minor(a, b, 2, 0), minor(a, b, 0, 1)]
}

#[inline(always)]
const fn minor(a: [i64; 3], b: [i64; 3], i: usize, j: usize) -> i128 {
    a[i] as i128 * b[j] as i128 - a[j] as i128 * b[i] as i128
}

/// Sign of `a · b`: -1, 0 or 1. No product may exceed 2¹⁹⁰.
#[inline(always)]
#[must_use]
pub const fn dot_sign(a: [i128; 3], b: [i64; 3]) -> i32 {
    let sum = wide_add(wide_add(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
    if sum.high < 0 { -1 } else { (sum.high != 0 || sum.low != 0) as i32 }
}

/// `high · 2⁶⁴ + low`.
#[derive(Clone, Copy)]
struct Wide {
    high: i128,
    low: u64,
}

#[inline(always)]
const fn product(a: i128, b: i64) -> Wide {
    let low = (a as u64) as i128 * b as i128;
    Wide { high: (a >> 64) * b as i128 + (low >> 64), low: low as u64 }
}

#[inline(always)]
const fn wide_add(a: Wide, b: Wide) -> Wide {
    let (low, carry) = a.low.overflowing_add(b.low);
    Wide { high: a.high + b.high + carry as i128, low }
}
