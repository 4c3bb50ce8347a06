//! The box about all primitives, so that it does not matter who looks at which of them when.
//!
//! Floats become integers that are larger where they are, and of those only the largest is ever kept: devices do so in one step
//! that nothing can come between.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;

/// Of each axis the largest number, negated in all its bits, for what is lowest; then the largest for what is highest. All are
/// 0 where there is nothing.
pub type Extent = [u32; 6];

/// A finite float's bits as a number that is larger where the float is.
#[inline(always)]
#[must_use]
pub const fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The float that has such a number.
#[inline(always)]
#[must_use]
pub const fn unordered(number: u32) -> f32 {
    f32::from_bits(if number >> 31 == 1 { number & 0x7fff_ffff } else { !number })
}

/// The extent with another box in it.
#[inline(always)]
#[must_use]
pub fn with(extent: Extent, bounds: &Bounds) -> Extent {
    core::array::from_fn(|word| {
        let own = if word < 3 { !ordered(bounds.low[word]) } else { ordered(bounds.high[word - 3]) };
        if own > extent[word] { own } else { extent[word] }
    })
}

/// The box, of something.
#[inline(always)]
#[must_use]
pub fn bounds([a, b, c, d, e, f]: Extent) -> Bounds {
    Bounds { low: [!a, !b, !c].map(unordered), high: [d, e, f].map(unordered) }
}
