//! known_answers: single operations of the exact arithmetic, to find out whether a device computes as it must.

use crate::abi::Question;
use crate::num::{add, float, floor, flush, max, min, mul, recip, round, rsqrt, sub, unit_scale};

/// Names of the operations, by number.
pub const OPERATIONS: [&str; 18] = [
    "a + b",
    "a - b",
    "a × b",
    "a × b + c (fused?)",
    "(a + b) - a (simplified?)",
    "(a × b) × c (regrouped?)",
    "a × b + a × c (factored out?)",
    "min",
    "max",
    "1 / a",
    "1 / √a",
    "round",
    "floor",
    "integer to float",
    "flush",
    "unit scale",
    "integer a × b",
    "integer a >> b",
];

/// The answer that every device must give, as bits.
#[inline(always)]
#[must_use]
pub fn answer(question: Question) -> u32 {
    let Question { operation, a, b, c } = question;
    let (x, y, z) = (f32::from_bits(a), f32::from_bits(b), f32::from_bits(c));
    match operation {
        0 => add(x, y).to_bits(),
        1 => sub(x, y).to_bits(),
        2 => mul(x, y).to_bits(),
        3 => add(mul(x, y), z).to_bits(),
        4 => sub(add(x, y), x).to_bits(),
        5 => mul(mul(x, y), z).to_bits(),
        6 => add(mul(x, y), mul(x, z)).to_bits(),
        7 => min(x, y).to_bits(),
        8 => max(x, y).to_bits(),
        9 => recip(x).to_bits(),
        10 => rsqrt(x).to_bits(),
        11 => round(x) as u32,
        12 => floor(x) as u32,
        13 => float(a as i32).to_bits(),
        14 => flush(x).to_bits(),
        15 => unit_scale(x).to_bits(),
        16 => a.wrapping_mul(b),
        _ => ((a as i32) >> (b & 31)) as u32,
    }
}
