//! draw, sort-last: threads sample grids wherever they are, and merge what they find by atomic maxima and minima; see
//! `core/src/kernel/sort_last.rs`.
#![allow(unsafe_code)] // only what `multiversion` generates

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use micropoly_core::abi::{Colour, Control, Draw, FLAG_LAYERS, Frame, Object, Patch, Sample};
use micropoly_core::kernel::blend::is_behind;
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::kernel::sample::{Target, sample};
use micropoly_core::kernel::shade::shade;
use micropoly_core::kernel::sort_last::{NOBODY, Turn, merge, shown};
use micropoly_core::kernel::triangle::{place, samples_of};
use micropoly_core::stage::Extent;
use multiversion::multiversion;
use rayon::prelude::*;

use crate::buffer::Claim;
use crate::device::CpuError;
use crate::draw::{Scene, for_each_band};
use crate::stages::Buffers;

/// Draws whose grids are in memory at the same time.
const CHUNK: usize = 1024;
/// Rows of samples that a thread merges at a time.
const MERGE_ROWS: usize = 16;

/// Depth, patch, u and v of a sample.
#[derive(Debug)]
struct Key([AtomicU32; 4]);

impl Key {
    fn new() -> Self {
        Self([NOBODY.depth, NOBODY.patch_id, NOBODY.u, NOBODY.v].map(AtomicU32::new))
    }

    fn sample(&self) -> Sample {
        let [depth, patch_id, u, v] = [0, 1, 2, 3].map(|k| self.0[k].load(Ordering::Relaxed));
        Sample { depth, patch_id, u, v }
    }

    fn forget(&self) {
        for (word, nobody) in self.0.iter().zip([NOBODY.depth, NOBODY.patch_id, NOBODY.u, NOBODY.v]) {
            word.store(nobody, Ordering::Relaxed);
        }
    }

    fn take(&self, turn: Turn, new: Sample) {
        match turn {
            Turn::Depth => self.0[0].fetch_max(new.depth, Ordering::Relaxed),
            Turn::Patch => self.0[1].fetch_min(new.patch_id, Ordering::Relaxed),
            Turn::U => self.0[2].fetch_min(new.u, Ordering::Relaxed),
            Turn::V => self.0[3].fetch_min(new.v, Ordering::Relaxed),
            Turn::Colour => return,
        };
    }
}

/// A key a sample, kept from frame to frame; all are [`NOBODY`] between two chunks.
#[derive(Debug)]
pub(crate) struct Keys {
    keys: Vec<Key>,
    grids: Vec<Grid>,
    claim: Claim,
}

impl Keys {
    pub(crate) fn new(allocated: &Arc<AtomicU64>) -> Self {
        Self { keys: Vec::new(), grids: Vec::new(), claim: Claim::new(allocated) }
    }

    /// Makes room for all that a frame can need, once for all its draws.
    fn fit(&mut self, extent: &Extent) {
        self.claim.raise_to(own_bytes(extent));
        let samples = extent.samples as usize;
        self.keys.resize_with(samples.max(self.keys.len()), Key::new);
        self.grids.resize_with(CHUNK, Grid::default);
    }
}

/// Bytes of keys and grids.
pub(crate) fn own_bytes(extent: &Extent) -> u64 {
    extent.samples * size_of::<Key>() as u64 + (CHUNK * size_of::<Grid>()) as u64
}

/// One thread's view of the keys in one turn.
struct Merge<'a> {
    frame: &'a Frame,
    turn: Turn,
    keys: &'a [Key],
    behind: &'a [Sample],
}

impl Target for Merge<'_> {
    #[inline(always)]
    fn limits(&self) -> [i32; 4] {
        limits(self.frame)
    }

    #[inline(always)]
    fn put(&mut self, column: i32, row: i32, new: Sample, _: Colour) {
        let place = place(self.frame, column, row);
        if self.frame.flags & FLAG_LAYERS != 0 && !is_behind(new, self.behind[place]) {
            return;
        }
        let key = &self.keys[place];
        if self.turn.concerns(new, key.sample()) {
            key.take(self.turn, new);
        }
    }
}

fn limits(frame: &Frame) -> [i32; 4] {
    [frame.sample_left, frame.sample_right, frame.sample_top, frame.sample_bottom].map(|k| k as i32)
}

/// The last turn, in a band of rows.
struct Show<'a> {
    limits: [i32; 4],
    /// Place of the band's first row of samples.
    start: usize,
    frame: &'a Frame,
    keys: &'a [Key],
    samples: &'a [Sample],
    colours: &'a mut [Colour],
}

impl Target for Show<'_> {
    #[inline(always)]
    fn limits(&self) -> [i32; 4] {
        self.limits
    }

    #[inline(always)]
    fn put(&mut self, column: i32, row: i32, new: Sample, colour: Colour) {
        let place = place(self.frame, column, row);
        let here = place - self.start;
        if let Some(colour) = shown(new, self.keys[place].sample(), self.samples[here], colour) {
            self.colours[here] = colour;
        }
    }
}

pub(crate) fn sort_last(
    pool: &rayon::ThreadPool,
    buffers: Buffers<'_, '_>,
    extent: &Extent,
    keys: &mut Keys,
) -> Result<(), CpuError> {
    let frame = buffers[0].view::<Frame>()?[0];
    let objects = buffers[1].view::<Object>()?;
    let patches = buffers[2].view::<Patch>()?;
    let control = buffers[3].view::<Control>()?[0];
    let draws = buffers[4].view::<Draw>()?;
    let behind = buffers[5].view::<Sample>()?;
    let (mut samples, mut colours) = (buffers[6].view_mut::<Sample>()?, buffers[7].view_mut::<Colour>()?);
    let draws = &draws[..(control.waiting + control.fresh) as usize];
    if draws.is_empty() || extent.columns == 0 || extent.rows == 0 {
        return Ok(());
    }
    let (objects, patches, behind) = (&*objects, &*patches, &*behind);
    let (samples, colours) = (&mut *samples, &mut *colours);
    keys.fit(extent);
    let Keys { keys, grids, .. } = keys;
    let keys = &keys[..samples.len()];
    let pattern = Pattern::new(&frame);
    for draws in draws.chunks(CHUNK) {
        let scene = Scene { frame: &frame, objects, patches, draws };
        pool.install(|| {
            draws.par_iter().zip(&mut *grids).for_each(|(draw, grid)| dice_one(scene, *draw, grid));
            for turn in [Turn::Depth, Turn::Patch, Turn::U, Turn::V] {
                draws.par_iter().zip(&*grids).for_each(|(draw, grid)| {
                    let mut target = Merge { frame: &frame, turn, keys, behind };
                    merge_one(scene, &pattern, *draw, grid, &mut target);
                });
            }
            for_each_band(&frame, MERGE_ROWS, (&[], samples, colours), |index, band| {
                let start = index * MERGE_ROWS * frame.place_row as usize;
                let (samples, colours, limits) = (band.samples, band.colours, band.limits);
                let mut target = Show { limits, start, frame: &frame, keys, samples: &*samples, colours };
                show_all(scene, &pattern, grids, &mut target);
                for (key, sample) in keys[start..].iter().zip(samples) {
                    *sample = merge(key.sample(), *sample).0;
                    key.forget();
                }
            });
        });
    }
    Ok(())
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn dice_one(scene: Scene<'_>, draw: Draw, grid: &mut Grid) {
    let (record, object) = scene.placed(draw);
    dice_any(scene.frame, scene.patches, record, object, draw, grid);
    shade(scene.frame, object, grid);
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn merge_one(scene: Scene<'_>, pattern: &Pattern, draw: Draw, grid: &Grid, target: &mut Merge<'_>) {
    sample(scene.frame, pattern, (draw, scene.placed(draw).1.opacity), grid, target);
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn show_all(scene: Scene<'_>, pattern: &Pattern, grids: &[Grid], target: &mut Show<'_>) {
    for (draw, grid) in scene.draws.iter().zip(grids) {
        let [_, _, top, bottom] = samples_of(scene.frame, *draw);
        if top < target.limits[3] && bottom > target.limits[2] {
            sample(scene.frame, pattern, (*draw, scene.placed(*draw).1.opacity), grid, target);
        }
    }
}
