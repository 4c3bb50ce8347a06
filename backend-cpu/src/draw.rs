//! draw, sort-middle: draws are counted into tiles of the image, sorted by tile, and each tile dices, shades and samples
//! its own, one grid after the other (Eisenacher & Loop 2010). A grid never leaves the cache; one that touches several
//! tiles is diced in each of them, and every sample has one writer.
#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use micropoly_core::abi::{Colour, Control, Draw, FLAG_LAYERS, Frame, Object, Patch, Sample};
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::kernel::sample::{Band, sample};
use micropoly_core::kernel::shade::shade;
use micropoly_core::kernel::triangle::samples_of;
use micropoly_core::patch::instance::{Instance, instance};
use micropoly_core::stage::Extent;
use multiversion::multiversion;
use rayon::prelude::*;

use crate::buffer::Claim;
use crate::device::CpuError;
use crate::stages::Buffers;

/// Rows of tiles a thread, where the tiles are as wide as the image: enough to share the work evenly, few enough that
/// little is diced twice.
const BANDS_A_THREAD: usize = 4;
/// Rows of samples of such a tile, at least.
const BAND_ROWS: usize = 32;
/// Most entries of the lists of all tiles; more draws than that are sorted in several passes.
const MOST_ENTRIES: usize = 1 << 16;

/// Time that the steps took, of all threads together, in nanoseconds.
#[derive(Debug, Default)]
pub(crate) struct Steps {
    count: AtomicU64,
    sort: AtomicU64,
    dice: AtomicU64,
    shade: AtomicU64,
    sample: AtomicU64,
}

impl Steps {
    /// Milliseconds of each, which start anew.
    pub(crate) fn take(&mut self) -> [(&'static str, f64); 5] {
        let steps = [
            ("count", &mut self.count),
            ("sort", &mut self.sort),
            ("dice", &mut self.dice),
            ("shade", &mut self.shade),
            ("sample", &mut self.sample),
        ];
        steps.map(|(name, step)| (name, std::mem::take(step.get_mut()) as f64 * 1e-6))
    }
}

/// Adds up the time from step to step, if anybody wants to know.
struct Clock<'a> {
    steps: Option<&'a Steps>,
    since: Option<Instant>,
}

impl<'a> Clock<'a> {
    fn start(steps: Option<&'a Steps>) -> Self {
        Self { steps, since: steps.map(|_| Instant::now()) }
    }

    fn lap(&mut self, step: impl FnOnce(&Steps) -> &AtomicU64) {
        if let (Some(steps), Some(since)) = (self.steps, self.since) {
            let now = Instant::now();
            step(steps).fetch_add((now - since).as_nanos() as u64, Ordering::Relaxed);
            self.since = Some(now);
        }
    }
}

/// What is to be drawn.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) objects: &'a [Object],
    pub(crate) patches: &'a [Patch],
    pub(crate) draws: &'a [Draw],
}

impl Scene<'_> {
    /// The record of a draw's patch, and its object.
    pub(crate) fn placed(&self, draw: Draw) -> (u32, &Object) {
        let Instance { record, object } = instance(self.frame, self.objects, self.patches, draw.patch_id);
        (record, &self.objects[object as usize])
    }
}

/// The draws of each tile, as numbers; kept from frame to frame.
#[derive(Debug)]
pub(crate) struct Lists {
    /// Where each tile's list starts, and where the last one ends.
    starts: Vec<u32>,
    list: Vec<u32>,
    claim: Claim,
}

impl Lists {
    pub(crate) fn new(allocated: &Arc<AtomicU64>) -> Self {
        Self { starts: Vec::new(), list: Vec::new(), claim: Claim::new(allocated) }
    }
}

/// Tiles, row after row.
struct Tiles<'a> {
    columns: usize,
    /// Columns and rows of samples of a tile.
    side: [usize; 2],
    lists: &'a mut Lists,
}

impl<'a> Tiles<'a> {
    fn new(frame: &Frame, threads: usize, lists: &'a mut Lists) -> Self {
        let extent = Extent::of(frame, 0);
        let (wide, high) = (extent.columns as usize, extent.rows as usize);
        let side = match frame.tile_bits {
            0 if threads == 1 => [wide, high],
            0 => [wide, high.div_ceil(BANDS_A_THREAD * threads).max(BAND_ROWS.min(high))],
            bits => [1 << bits; 2],
        };
        let (columns, rows) = (wide.div_ceil(side[0]), high.div_ceil(side[1]));
        lists.claim.raise_to(own_bytes(&extent));
        lists.starts.resize(columns * rows + 1, 0);
        Self { columns, side, lists }
    }

    /// Columns and rows of tiles that a draw can touch.
    fn touched(&self, frame: &Frame, draw: Draw) -> [usize; 4] {
        let [left, right, top, bottom] = samples_of(frame, draw);
        if left >= right || top >= bottom {
            return [0; 4];
        }
        let column = |sample: i32| (sample - frame.sample_left as i32) as usize / self.side[0];
        let row = |sample: i32| (sample - frame.sample_top as i32) as usize / self.side[1];
        [column(left), column(right - 1) + 1, row(top), row(bottom - 1) + 1]
    }

    /// Counts the draws of each tile; gives the number of draws whose entries fit the lists, one at least.
    fn count(&mut self, frame: &Frame, draws: &[Draw]) -> usize {
        self.lists.starts.fill(0);
        let mut entries = 0;
        for (index, draw) in draws.iter().enumerate() {
            let [left, right, top, bottom] = self.touched(frame, *draw);
            let more = (right - left) * (bottom - top);
            if index > 0 && entries + more > MOST_ENTRIES {
                return index;
            }
            entries += more;
            for row in top..bottom {
                for count in &mut self.lists.starts[row * self.columns..][left..right] {
                    *count += 1;
                }
            }
        }
        draws.len()
    }

    /// Turns counts into places (scan), and writes each draw's number into the lists of its tiles.
    fn write(&mut self, frame: &Frame, draws: &[Draw]) {
        let mut end = 0;
        for start in &mut self.lists.starts {
            end += *start;
            *start = end;
        }
        self.lists.list.resize(end as usize, 0);
        // From the last to the first, so that each start ends where its list begins, and lists are in order.
        for (index, draw) in draws.iter().enumerate().rev() {
            let [left, right, top, bottom] = self.touched(frame, *draw);
            for row in top..bottom {
                for column in left..right {
                    let start = &mut self.lists.starts[row * self.columns + column];
                    *start -= 1;
                    self.lists.list[*start as usize] = index as u32;
                }
            }
        }
    }

    fn list(&self, row: usize, column: usize) -> &[u32] {
        let tile = row * self.columns + column;
        let Lists { starts, list, .. } = &*self.lists;
        &list[starts[tile] as usize..starts[tile + 1] as usize]
    }

    /// Columns and rows of samples of a tile.
    fn limits(&self, frame: &Frame, row: usize, column: usize) -> [i32; 4] {
        let along = |first: u32, end: u32, side: usize, tile: usize| {
            let start = first as usize + tile * side;
            [start as i32, (start + side).min(end as usize) as i32]
        };
        let [left, right] = along(frame.sample_left, frame.sample_right, self.side[0], column);
        let [top, bottom] = along(frame.sample_top, frame.sample_bottom, self.side[1], row);
        [left, right, top, bottom]
    }
}

/// Bytes of the lists of all tiles.
pub(crate) fn own_bytes(extent: &Extent) -> u64 {
    let tile = 1_u64 << extent.tile_bits;
    let tiles = match extent.tile_bits {
        0 => u64::from(extent.rows), // bands of several rows each
        _ => u64::from(extent.columns).div_ceil(tile) * u64::from(extent.rows).div_ceil(tile),
    };
    (tiles + 1 + tiles.max(MOST_ENTRIES as u64)) * size_of::<u32>() as u64
}

pub(crate) fn draw(
    pool: &rayon::ThreadPool,
    threads: usize,
    buffers: Buffers<'_, '_>,
    lists: &mut Lists,
    steps: Option<&Steps>,
) -> Result<(), CpuError> {
    let frame = buffers[0].view::<Frame>()?[0];
    let objects = buffers[1].view::<Object>()?;
    let patches = buffers[2].view::<Patch>()?;
    let control = buffers[3].view::<Control>()?[0];
    let draws = buffers[4].view::<Draw>()?;
    let behind = buffers[5].view::<Sample>()?;
    let (mut samples, mut colours) = (buffers[6].view_mut::<Sample>()?, buffers[7].view_mut::<Colour>()?);
    let mut draws = &draws[..(control.waiting + control.fresh) as usize];
    if draws.is_empty() || frame.sample_left >= frame.sample_right || frame.sample_top >= frame.sample_bottom
    {
        return Ok(());
    }
    let (objects, patches, behind) = (&*objects, &*patches, &*behind);
    let (samples, colours) = (&mut *samples, &mut *colours);
    let pattern = Pattern::new(&frame);
    let mut tiles = Tiles::new(&frame, threads, lists);
    while !draws.is_empty() {
        let mut clock = Clock::start(steps);
        let fitting = tiles.count(&frame, draws);
        clock.lap(|steps| &steps.count);
        let (now, later) = draws.split_at(fitting);
        tiles.write(&frame, now);
        clock.lap(|steps| &steps.sort);
        draws = later;
        let scene = Scene { frame: &frame, objects, patches, draws: now };
        let tiles = &tiles;
        pool.install(|| {
            for_each_band(&frame, tiles.side[1], (behind, samples, colours), |row, mut band| {
                let mut grid = Grid::default();
                for column in 0..tiles.columns {
                    band.limits = tiles.limits(&frame, row, column);
                    draw_tile(scene, &pattern, tiles.list(row, column), &mut grid, &mut band, steps);
                }
            });
        });
    }
    Ok(())
}

/// The frame's samples, cut into bands of so many rows, each with one writer.
pub(crate) fn for_each_band(
    frame: &Frame,
    rows: usize,
    (behind, samples, colours): (&[Sample], &mut [Sample], &mut [Colour]),
    each: impl Fn(usize, Band<'_>) + Sync,
) {
    let chunk = rows * frame.place_row as usize;
    let behind = if frame.flags & FLAG_LAYERS == 0 { &[][..] } else { behind };
    let band = |(index, (samples, colours)): (usize, (&mut [Sample], &mut [Colour]))| {
        let top = frame.sample_top as i32 + (index * rows) as i32;
        if top >= frame.sample_bottom as i32 {
            return; // the buffers are larger than this frame
        }
        let behind = behind.get(index * chunk..).unwrap_or(&[]);
        let bottom = (top + rows as i32).min(frame.sample_bottom as i32);
        let band = Band {
            limits: [frame.sample_left as i32, frame.sample_right as i32, top, bottom],
            origin: [frame.sample_left as i32, top],
            first: frame.place_first as usize,
            column: frame.place_column as usize,
            row: frame.place_row as usize,
            behind,
            samples,
            colours,
        };
        each(index, band);
    };
    samples.par_chunks_mut(chunk).zip(colours.par_chunks_mut(chunk)).enumerate().for_each(band);
}

/// Dices, shades and samples all draws of a tile.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn draw_tile(
    scene: Scene<'_>,
    pattern: &Pattern,
    list: &[u32],
    grid: &mut Grid,
    band: &mut Band<'_>,
    steps: Option<&Steps>,
) {
    let mut clock = Clock::start(steps);
    for index in list {
        let draw = scene.draws[*index as usize];
        let (record, object) = scene.placed(draw);
        dice_any(scene.frame, scene.patches, record, object, draw, grid);
        clock.lap(|steps| &steps.dice);
        shade(scene.frame, object, grid);
        clock.lap(|steps| &steps.shade);
        sample(scene.frame, pattern, (draw, object.opacity), grid, band);
        clock.lap(|steps| &steps.sample);
    }
}
