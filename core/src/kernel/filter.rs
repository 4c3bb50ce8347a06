//! filter: a pixel from the samples around it, weighted, and what its own nearest sample shows.
//!
//! Weights are fixed, since every pixel has the same pattern of samples: the host works them out
//! ([`crate::reconstruction`]). Beyond the image there are no samples: the others weigh more there.

use crate::abi::{Colour, Frame, Pixel, Sample, Tap};
use crate::kernel::sample::nearer;
use crate::num::{add, clamp, mul, recip};

/// The pixel in this column and row of the image.
///
/// `samples` and `colours` are those of all the frame's samples; a colour counts only where something is.
#[inline(always)]
#[must_use]
pub fn filter(
    frame: &Frame,
    taps: &[Tap],
    samples: &[Sample],
    colours: &[Colour],
    column: u32,
    row: u32,
) -> Pixel {
    let bits = frame.pattern_bits;
    let columns = ((frame.right - frame.left) << bits) as i32;
    let rows = ((frame.bottom - frame.top) << bits) as i32;
    let first_column = ((column - frame.left) << bits) as i32;
    let first_row = ((row - frame.top) << bits) as i32;
    let (mut rgba, mut total, mut count) = ([0.0; 4], 0.0, 0);
    for tap in &taps[..frame.taps as usize] {
        let (x, y) = (first_column + tap.column, first_row + tap.row);
        if (x as u32) < columns as u32 && (y as u32) < rows as u32 {
            let place = (y * columns + x) as usize;
            if samples[place].depth != 0 {
                for k in 0..4 {
                    rgba[k] = add(rgba[k], mul(tap.weight, colours[place].rgba[k]));
                }
            }
            total = add(total, tap.weight);
            count += 1;
        }
    }
    if count != frame.taps {
        let scale = recip(total);
        for value in &mut rgba {
            *value = mul(*value, scale);
        }
    }
    rgba[3] = clamp(rgba[3], 0.0, 1.0);
    own_samples(1 << bits, samples, (first_row * columns + first_column) as usize, columns as usize, rgba)
}

/// The pixel of this colour, with the nearest of its own `side × side` samples.
#[inline(always)]
fn own_samples(side: usize, samples: &[Sample], first: usize, columns: usize, rgba: [f32; 4]) -> Pixel {
    let (mut nearest, mut covered) = (Sample::default(), 0);
    for row in 0..side {
        for column in 0..side {
            let sample = samples[first + row * columns + column];
            if sample.depth != 0 {
                covered += 1;
                if nearest.depth == 0 || nearer(sample, nearest) {
                    nearest = sample;
                }
            }
        }
    }
    let Sample { depth, patch_id, u, v } = nearest;
    Pixel { rgba, depth, patch_id, u, v, covered }
}
