//! Morton codes: coordinates bit by bit in turns, so that what is near in order is near in space.
#![deny(clippy::float_arithmetic)]

use super::bounds::Bounds;
use crate::num::{add, floor, max, mul, sub, unit_scale};

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
    precision: Precision,
}

impl Grid {
    /// The grid whose cells codes count. All axes have cells of the same size, a power of two, so that nothing is rounded but
    /// the place within the box.
    #[must_use]
    pub const fn new(bounds: &Bounds, precision: Precision) -> Self {
        let low = [mul(bounds.low[0], SMALL), mul(bounds.low[1], SMALL), mul(bounds.low[2], SMALL)];
        let sides = [
            sub(mul(bounds.high[0], SMALL), low[0]),
            sub(mul(bounds.high[1], SMALL), low[1]),
            sub(mul(bounds.high[2], SMALL), low[2]),
        ];
        // The largest side becomes 1 to 2.
        let scale = unit_scale(max(max(sides[0], sides[1]), sides[2]));
        Self { low, scale, precision }
    }

    /// Code of the centre of a box.
    #[inline(always)]
    #[must_use]
    pub const fn code(&self, bounds: &Bounds) -> u64 {
        spread(self.cell(bounds, 0)) << 2 | spread(self.cell(bounds, 1)) << 1 | spread(self.cell(bounds, 2))
    }

    #[inline(always)]
    const fn cell(&self, bounds: &Bounds, axis: usize) -> u32 {
        let centre = add(mul(bounds.low[axis], HALF_SMALL), mul(bounds.high[axis], HALF_SMALL));
        let place = mul(sub(centre, self.low[axis]), self.scale);
        let cells = (1 << (self.precision.bits() - 1)) as f32;
        let cell = floor(mul(max(place, 0.0), cells)) as u32;
        let last = (1 << self.precision.bits()) - 1;
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
