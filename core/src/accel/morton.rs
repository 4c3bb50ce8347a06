//! Morton codes: coordinates bit by bit in turns, so that what is near in order is near in space.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use crate::abi::SortKey;
use crate::num::{add, floor, flush, flush3, max, mul, scale3, sub, unit_scale};

/// How fine codes are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 10 bits an axis.
    #[default]
    Bits30,
    /// 21 bits an axis.
    Bits63,
}

impl Precision {
    /// Bits of a coordinate.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Bits30 => 10,
            Self::Bits63 => 21,
        }
    }
}

/// Centres are halved so often that no difference of them can exceed the range of floats.
const SMALL: f32 = 1.0 / 32.0;
const HALF_SMALL: f32 = 0.5 * SMALL;

/// A cubic grid over a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    low: [f32; 3],
    scale: f32,
    bits: u32,
}

impl Grid {
    /// The grid whose cells codes count. All axes have cells of the same size, a power of two, so that nothing is rounded but
    /// the place within the box. What is nearer to 0 than 2⁻⁶³ is taken to be there.
    #[must_use]
    pub const fn new(bounds: &Bounds, precision: Precision) -> Self {
        Self::with_bits(bounds, precision.bits())
    }

    /// The same with so many bits a coordinate.
    #[must_use]
    pub const fn with_bits(bounds: &Bounds, bits: u32) -> Self {
        let low = scale3(flush3(bounds.low), SMALL);
        let high = scale3(flush3(bounds.high), SMALL);
        let sides = [sub(high[0], low[0]), sub(high[1], low[1]), sub(high[2], low[2])];
        // The largest side becomes 1 to 2.
        let scale = unit_scale(max(max(sides[0], sides[1]), sides[2]));
        Self { low, scale, bits }
    }

    /// Code of the centre of a box.
    #[inline(always)]
    #[must_use]
    pub const fn code(&self, bounds: &Bounds) -> u64 {
        spread(self.cell(bounds, 0)) << 2 | spread(self.cell(bounds, 1)) << 1 | spread(self.cell(bounds, 2))
    }

    #[inline(always)]
    const fn cell(&self, bounds: &Bounds, axis: usize) -> u32 {
        let centre = add(mul(flush(bounds.low[axis]), HALF_SMALL), mul(flush(bounds.high[axis]), HALF_SMALL));
        let place = mul(sub(centre, self.low[axis]), self.scale);
        let cells = (1_u32 << (self.bits - 1)) as f32;
        let cell = floor(mul(max(place, 0.0), cells)) as u32;
        let last = (1 << self.bits) - 1;
        if cell < last { cell } else { last }
    }
}

/// 21 bits, with two zeros between any two of them.
#[inline(always)]
const fn spread(x: u32) -> u64 {
    let mut x = x as u64;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

impl SortKey {
    /// Of a primitive with this code.
    #[inline(always)]
    #[must_use]
    pub const fn new(code: u64, primitive: u32) -> Self {
        Self { low: code as u32, high: (code >> 32) as u32, primitive }
    }

    /// Its code.
    #[inline(always)]
    #[must_use]
    pub const fn code(&self) -> u64 {
        (self.high as u64) << 32 | self.low as u64
    }
}
