//! Bernstein weights and blossoms of cubic Bézier curves (Farin, Curves and Surfaces for CAGD, ch. 4-5).
//!
//! Weights are computed symmetrically: reversing a curve swaps summands that commute, so both directions
//! give the same bits; at 0 and 1 the weights are exactly 0 and 1.

use crate::abi::PARAM_STEP;
use crate::num::{add, float, mul, sub};

/// The parameter `t · 2⁻²⁴` as a float: exact for `t` up to 2²⁴ ([`PARAM_STEP`] is 2⁻²⁴).
#[inline(always)]
#[must_use]
pub const fn param(t: u32) -> f32 {
    mul(float(t as i32), PARAM_STEP)
}

/// Cubic Bernstein weights at `t`: (1-t)³, 3(1-t)²t, 3(1-t)t², t³.
#[inline(always)]
#[must_use]
pub const fn cubic(t: f32) -> [f32; 4] {
    let s = sub(1.0, t);
    let (ss, tt) = (mul(s, s), mul(t, t));
    [mul(ss, s), mul(3.0, mul(ss, t)), mul(3.0, mul(tt, s)), mul(tt, t)]
}

/// Three times the quadratic Bernstein weights at `t`: a cubic's derivative is their sum over the
/// differences of neighbouring control points.
#[inline(always)]
#[must_use]
pub const fn cubic_slope(t: f32) -> [f32; 3] {
    let s = sub(1.0, t);
    [mul(3.0, mul(s, s)), mul(6.0, mul(s, t)), mul(3.0, mul(t, t))]
}

/// Weighted sum of four numbers, outer and inner pairs first: reversing both lists gives the same bits.
#[inline(always)]
#[must_use]
pub const fn blend4(w: [f32; 4], c: [f32; 4]) -> f32 {
    add(add(mul(w[0], c[0]), mul(w[3], c[3])), add(mul(w[1], c[1]), mul(w[2], c[2])))
}

/// Weighted sum of three numbers, outer pair first: reversing both lists gives the same bits.
#[inline(always)]
#[must_use]
pub const fn blend3(w: [f32; 3], c: [f32; 3]) -> f32 {
    add(add(mul(w[0], c[0]), mul(w[2], c[2])), mul(w[1], c[1]))
}

/// Weights of the control points of the part `a ..= b` (units of 2⁻²⁴): row `k` holds the weights of the
/// four old control points in new control point `k`. All are ≥ 0 and each row sums to 1 but for rounding.
#[inline(always)]
#[must_use]
pub const fn blossom(a: u32, b: u32) -> [[f32; 4]; 4] {
    let (a, b) = (param(a), param(b));
    let (s, r) = (sub(1.0, a), sub(1.0, b));
    let (sr, sb, ar, ab) = (mul(s, r), mul(s, b), mul(a, r), mul(a, b));
    let mixed = add(sb, ar);
    [
        cubic(a),
        [mul(s, sr), add(mul(s, mixed), mul(a, sr)), add(mul(a, mixed), mul(s, ab)), mul(a, ab)],
        [mul(r, sr), add(mul(r, mixed), mul(b, sr)), add(mul(b, mixed), mul(r, ab)), mul(b, ab)],
        cubic(b),
    ]
}
