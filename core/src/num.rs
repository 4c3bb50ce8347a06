//! The only arithmetic kernels may use: the same bits on every device.
//!
//! f32 `+ - ×`, comparison, in-range conversion and integers are exact or rounded to nearest even
//! everywhere; all else (division, roots, floor) is built from them here. Device kernels mirror these
//! functions by name and keep the compiler from fusing them.
#![allow(clippy::float_arithmetic)] // this is the one place for it

/// `a + b`, rounded once.
#[inline(always)]
#[must_use]
pub const fn add(a: f32, b: f32) -> f32 {
    a + b
}

/// `a - b`, rounded once.
#[inline(always)]
#[must_use]
pub const fn sub(a: f32, b: f32) -> f32 {
    a - b
}

/// `a × b`, rounded once.
#[inline(always)]
#[must_use]
pub const fn mul(a: f32, b: f32) -> f32 {
    a * b
}

/// The smaller of two numbers; `b` when they are equal.
#[inline(always)]
#[must_use]
pub const fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers; `b` when they are equal.
#[inline(always)]
#[must_use]
pub const fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `x` moved into `low ..= high`.
#[inline(always)]
#[must_use]
pub const fn clamp(x: f32, low: f32, high: f32) -> f32 {
    min(max(x, low), high)
}

/// `|x|`: the sign bit cleared.
#[inline(always)]
#[must_use]
pub const fn abs(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & 0x7fff_ffff)
}

/// `-x`: the sign bit flipped.
#[inline(always)]
#[must_use]
pub const fn neg(x: f32) -> f32 {
    f32::from_bits(x.to_bits() ^ 0x8000_0000)
}

/// `1 / x` for positive `x` in 1e-37 ..= 1e37, within 2 units in the last place; of a negative one the same, negative.
///
/// An integer seed (relative error 12 %), then three Newton steps that each square the error.
#[inline(always)]
#[must_use]
pub const fn recip(x: f32) -> f32 {
    let mut y = f32::from_bits(0x7ef3_11c7_u32.wrapping_sub(x.to_bits()));
    y = mul(y, sub(2.0, mul(x, y)));
    y = mul(y, sub(2.0, mul(x, y)));
    mul(y, sub(2.0, mul(x, y)))
}

/// `1 / √x` for positive `x` in 1e-37 ..= 1e37, within 3 units in the last place.
///
/// An integer seed (relative error 3.4 %), then three Newton steps.
#[inline(always)]
#[must_use]
pub const fn rsqrt(x: f32) -> f32 {
    let half = mul(0.5, x);
    let mut y = f32::from_bits(0x5f37_5a86_u32.wrapping_sub(x.to_bits() >> 1));
    y = mul(y, sub(1.5, mul(mul(half, y), y)));
    y = mul(y, sub(1.5, mul(mul(half, y), y)));
    mul(y, sub(1.5, mul(mul(half, y), y)))
}

/// `√x` for positive `x` in 1e-37 ..= 1e37, within 4 units in the last place.
#[inline(always)]
#[must_use]
pub const fn sqrt(x: f32) -> f32 {
    mul(x, rsqrt(x))
}

/// The nearest integer, ties to even, for `|x|` ≤ 2²².
///
/// Adding 1.5 · 2²³ leaves the integer in the low bits of the mantissa: no conversion is needed.
#[inline(always)]
#[must_use]
pub const fn round(x: f32) -> i32 {
    add(x, 12_582_912.0).to_bits() as i32 - 0x4b40_0000
}

/// Largest integer not above `x`, for `|x|` < 2³¹.
#[inline(always)]
#[must_use]
pub const fn floor(x: f32) -> i32 {
    let towards_zero = x as i32;
    if towards_zero as f32 > x { towards_zero - 1 } else { towards_zero }
}

/// An integer below 2²⁴ in magnitude as a float: exact.
#[inline(always)]
#[must_use]
pub const fn float(x: i32) -> f32 {
    x as f32
}

/// `x` with everything below 2⁻⁶³ taken as zero, so that products of it never reach the denormals.
#[inline(always)]
#[must_use]
pub const fn flush(x: f32) -> f32 {
    if x.to_bits() & 0x7fff_ffff < 0x2000_0000 { 0.0 } else { x }
}

/// [`flush`], component by component.
#[inline(always)]
#[must_use]
pub const fn flush3(a: [f32; 3]) -> [f32; 3] {
    [flush(a[0]), flush(a[1]), flush(a[2])]
}

/// The power of two that scales `x` > 0 into 1 ..< 2; 0 for zero, denormals and anything from 2¹²⁶ up.
#[inline(always)]
#[must_use]
pub const fn unit_scale(x: f32) -> f32 {
    let exponent = (x.to_bits() >> 23) & 0xff;
    if exponent == 0 || exponent > 253 { 0.0 } else { f32::from_bits((254 - exponent) << 23) }
}

/// `a · b`, summed from the left.
#[inline(always)]
#[must_use]
pub const fn dot3(a: [f32; 3], b: [f32; 3]) -> f32 {
    add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]))
}

/// `a × b`.
#[inline(always)]
#[must_use]
pub const fn cross3(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        sub(mul(a[1], b[2]), mul(a[2], b[1])),
        sub(mul(a[2], b[0]), mul(a[0], b[2])),
        sub(mul(a[0], b[1]), mul(a[1], b[0])),
    ]
}

/// `a + b`, component by component.
#[inline(always)]
#[must_use]
pub const fn add3(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [add(a[0], b[0]), add(a[1], b[1]), add(a[2], b[2])]
}

/// `a` with every component multiplied by `s`.
#[inline(always)]
#[must_use]
pub const fn scale3(a: [f32; 3], s: f32) -> [f32; 3] {
    [mul(a[0], s), mul(a[1], s), mul(a[2], s)]
}

/// The largest magnitude among the components.
#[inline(always)]
#[must_use]
pub const fn largest3(a: [f32; 3]) -> f32 {
    max(max(abs(a[0]), abs(a[1])), abs(a[2]))
}
