//! The stages that work sample by sample, or pixel by pixel: blend and filter.
#![allow(unsafe_code)] // only what `multiversion` generates

use micropoly_core::abi::{Colour, Frame, Pixel, Sample, Tap};
use micropoly_core::kernel::blend::{Layers, blend as blend_one};
use micropoly_core::kernel::filter::filter as filter_one;
use multiversion::multiversion;
use rayon::prelude::*;

use crate::device::CpuError;
use crate::stages::Buffers;

/// Samples that one thread blends at a time.
const BLEND_CHUNK: usize = 1 << 14;

pub(crate) fn blend(pool: &rayon::ThreadPool, buffers: Buffers<'_, '_>, count: u32) -> Result<(), CpuError> {
    let mut samples = buffers[0].view_mut::<Sample>()?;
    let colours = buffers[1].view::<Colour>()?;
    let (mut behind, mut front) = (buffers[2].view_mut::<Sample>()?, buffers[3].view_mut::<Sample>()?);
    let (mut layers, mut more) = (buffers[4].view_mut::<Colour>()?, buffers[5].view_mut::<u32>()?);
    let count = count as usize;
    let (samples, colours, layers) = (&mut samples[..count], &colours[..count], &mut layers[..count]);
    let (behind, front) = (&mut behind[..count], &mut front[..count]);
    let any = pool.install(|| {
        let found = samples.par_chunks_mut(BLEND_CHUNK).zip(colours.par_chunks(BLEND_CHUNK));
        let last = behind.par_chunks_mut(BLEND_CHUNK).zip(front.par_chunks_mut(BLEND_CHUNK));
        let all = found.zip(last).zip(layers.par_chunks_mut(BLEND_CHUNK));
        all.map(|(((samples, colours), (behind, front)), layers)| {
            let mut any = false;
            for k in 0..samples.len() {
                let before = Layers { behind: behind[k], front: front[k], colour: layers[k] };
                let (after, may_follow) = blend_one(before, samples[k], colours[k]);
                (behind[k], front[k], layers[k]) = (after.behind, after.front, after.colour);
                samples[k] = Sample::default();
                any |= may_follow;
            }
            any
        })
        .reduce(|| false, |a, b| a | b)
    });
    if any {
        more[0] = 1;
    }
    Ok(())
}

pub(crate) fn filter(pool: &rayon::ThreadPool, buffers: Buffers<'_, '_>) -> Result<(), CpuError> {
    let frame = buffers[0].view::<Frame>()?[0];
    let taps = buffers[1].view::<Tap>()?;
    let samples = buffers[2].view::<Sample>()?;
    let colours = buffers[3].view::<Colour>()?;
    let mut pixels = buffers[4].view_mut::<Pixel>()?;
    let (taps, samples, colours) = (&*taps, &*samples, &*colours);
    let shown = frame.shown_count() as usize;
    let width = (frame.shown_right - frame.shown_left) as usize;
    if shown == 0 {
        return Ok(());
    }
    let pixels = &mut pixels[..shown];
    pool.install(|| {
        pixels.par_chunks_mut(width).enumerate().for_each(|(index, pixels)| {
            filter_row(&frame, taps, samples, colours, frame.shown_top + index as u32, pixels);
        });
    });
    Ok(())
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn filter_row(
    frame: &Frame,
    taps: &[Tap],
    samples: &[Sample],
    colours: &[Colour],
    row: u32,
    pixels: &mut [Pixel],
) {
    for (column, pixel) in (frame.shown_left..).zip(pixels) {
        *pixel = filter_one(frame, taps, samples, colours, column, row);
    }
}
