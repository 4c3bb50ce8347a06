//! Reconstruction filters: with which weights samples make a pixel. Host side, in f64.

use crate::abi::{MAX_SAMPLES, SUBPIXELS, Tap};
use crate::pattern::Samples;

/// Largest radius of a filter in pixels.
pub const MAX_RADIUS: f64 = 4.0;
/// Smallest radius of a filter in pixels: all of the pixel's own samples count.
pub const MIN_RADIUS: f64 = 0.5;
/// Most samples that a pixel can be made of.
pub const MAX_TAPS: usize = 81 * MAX_SAMPLES as usize;

/// The shape of a filter: a product of two curves, one along columns and one along rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// All samples count alike.
    #[default]
    Box,
    /// Falls evenly to 0 at the radius.
    Triangle,
    /// A bell, e^(-2 x²) for a radius of 2, less its value at the radius.
    Gaussian,
    /// The cubic of Mitchell & Netravali 1988 with B = C = 1/3, which sharpens.
    Mitchell,
}

impl Kernel {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Box, Self::Triangle, Self::Gaussian, Self::Mitchell];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Triangle => "triangle",
            Self::Gaussian => "gaussian",
            Self::Mitchell => "mitchell",
        }
    }

    /// The radius in pixels that it is usually given.
    #[must_use]
    pub const fn usual_radius(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::Triangle => 1.0,
            Self::Gaussian => 1.5,
            Self::Mitchell => 2.0,
        }
    }

    /// Its value at `x` radii from the middle, without a scale.
    fn value(self, x: f64) -> f64 {
        let x = x.abs();
        if x >= 1.0 {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Triangle => 1.0 - x,
            Self::Gaussian => libm::exp(-8.0 * x * x) - libm::exp(-8.0),
            Self::Mitchell => mitchell(2.0 * x),
        }
    }
}

/// For `x` from 0 to 2.
fn mitchell(x: f64) -> f64 {
    if x < 1.0 {
        (21.0 * x * x * x - 36.0 * x * x + 16.0) / 18.0
    } else {
        (-7.0 * x * x * x + 36.0 * x * x - 60.0 * x + 32.0) / 18.0
    }
}

/// A filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// Its shape.
    pub kernel: Kernel,
    /// How far it reaches from a pixel's middle, in pixels.
    pub radius: f64,
}

impl Default for Filter {
    fn default() -> Self {
        Self::of(Kernel::default())
    }
}

impl Filter {
    /// A filter of this shape with its usual radius.
    #[must_use]
    pub const fn of(kernel: Kernel) -> Self {
        Self { kernel, radius: kernel.usual_radius() }
    }

    /// Can it be used?
    #[must_use]
    pub fn is_sound(&self) -> bool {
        (MIN_RADIUS..=MAX_RADIUS).contains(&self.radius)
    }

    /// Pixels around a pixel whose samples may count for it.
    #[must_use]
    pub fn margin(&self) -> u32 {
        libm::ceil((self.radius - 0.5).clamp(0.0, MAX_RADIUS)) as u32
    }

    /// The samples that a pixel is made of, row after row, into `taps`, which has room for [`MAX_TAPS`]; gives their
    /// number. Their weights add up to 1.
    pub fn taps(&self, samples: Samples, taps: &mut [Tap]) -> usize {
        let (margin, bits) = (self.margin() as i32, samples.bits());
        let side = 1_i32 << bits;
        let mut count = 0;
        let mut sum = 0.0;
        for row in -margin * side..(margin + 1) * side {
            for column in -margin * side..(margin + 1) * side {
                let weight = self.weight(samples, column, row);
                if weight != 0.0 {
                    taps[count] = Tap { weight: weight as f32, column, row };
                    count += 1;
                    sum += weight;
                }
            }
        }
        for tap in &mut taps[..count] {
            tap.weight = (self.weight(samples, tap.column, tap.row) / sum) as f32;
        }
        count
    }

    /// Of the sample so many columns and rows from the pixel's first.
    fn weight(&self, samples: Samples, column: i32, row: i32) -> f64 {
        let (bits, mask) = (samples.bits(), (1 << samples.bits()) - 1);
        let [x, y] = samples.offset(((row & mask) << bits | (column & mask)) as u32);
        let from_middle = |pixel: i32, offset: i32| {
            f64::from(pixel * SUBPIXELS + offset - SUBPIXELS / 2) / f64::from(SUBPIXELS)
        };
        let along = |k: i32, offset: i32| self.kernel.value(from_middle(k >> bits, offset) / self.radius);
        along(column, x) * along(row, y)
    }
}
