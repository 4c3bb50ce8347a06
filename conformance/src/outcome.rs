//! Rendering a case and boiling the result down to what must be equal everywhere.

use std::fmt;

use micropoly_core::abi::{Colour, Frame, Object, Patch, Pixel, Sample, Tap};
use micropoly_core::backend::Device;
use micropoly_core::error::PlanError;
use micropoly_core::memory::{Area, Sizes, stack_min};
use micropoly_core::pattern::Samples;
use micropoly_core::reconstruction::{Filter, MAX_TAPS};
use micropoly_core::render::{Buffers, Counts, FramePlan};
use micropoly_core::schedule::Scheduler;
use serde::Serialize;

use crate::witness::Witness;

/// Entries that are read from the device at once.
const BLOCK: usize = 1 << 16;

/// A scene as devices read it, with a name for reports.
#[derive(Clone, Debug)]
pub struct Case {
    /// What reports call it.
    pub name: String,
    /// Camera, lights and limits.
    pub frame: Frame,
    /// Transforms and materials.
    pub objects: Vec<Object>,
    /// Records of all patches, and behind them what some kinds of patches need besides.
    pub patches: Vec<Patch>,
    /// Number of patches: more than there are records of them where objects have the same ones.
    pub patch_count: usize,
}

impl Case {
    /// Plans its frame.
    ///
    /// # Errors
    /// What the plan reports.
    pub fn plan(&self, schedule: Schedule) -> Result<FramePlan, PlanError> {
        let Schedule { scheduler, batch, capacity } = schedule;
        let count = |len: usize| u32::try_from(len).unwrap_or(u32::MAX);
        let (patches, records) = (count(self.patch_count), count(self.patches.len()));
        let objects = count(self.objects.len());
        let frame = self.filtered();
        let Frame { levels, width, height, .. } = frame;
        let area = Area::of(&frame);
        let sizes = Sizes {
            patches,
            records,
            objects,
            listed: 0,
            batch,
            scheduler,
            capacity,
            levels,
            width,
            height,
            area,
        };
        FramePlan::with_sizes(frame, sizes)
    }

    /// The samples that a pixel is made of, by the default filter.
    fn taps(&self) -> Vec<Tap> {
        let count = 1 << (2 * self.frame.pattern_bits);
        let mut taps = vec![Tap::default(); MAX_TAPS];
        let count = Filter::default().taps(Samples::of_count(count).unwrap_or_default(), &mut taps);
        taps.truncate(count);
        taps
    }

    /// Its frame, with the default filter.
    fn filtered(&self) -> Frame {
        Frame { taps: self.taps().len() as u32, ..self.frame }
    }
}

/// How a case is worked off: it must make no difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// The scheduler.
    pub scheduler: Scheduler,
    /// Surfaces a batch.
    pub batch: u32,
    /// Entries of the stack, as in [`Sizes::capacity`].
    pub capacity: u32,
}

impl Schedule {
    /// The default scheduler with a batch of this size.
    #[must_use]
    pub fn of_batch(batch: u32) -> Self {
        Self { scheduler: Scheduler::default(), batch, capacity: 0 }
    }

    /// Every scheduler; those that can do with less at their least, a little above it and as they like it.
    #[must_use]
    pub fn all(case: &Case) -> Vec<Self> {
        let least = stack_min(u64::from(case.frame.levels)) as u32;
        [
            (Scheduler::Stack, 1, 0),
            (Scheduler::Breadth, 1, 0),
            (Scheduler::Bounded, 100, 0),
            (Scheduler::Bounded, 5000, 0),
            (Scheduler::Local, 64, least),
            (Scheduler::Local, 1000, 16 * least + 50),
            (Scheduler::Local, 5000, 0),
            (Scheduler::Adaptive, 100, 0),
            (Scheduler::Adaptive, 5000, least),
            (Scheduler::Adaptive, 64, least + 70),
        ]
        .map(|(scheduler, batch, capacity)| Self { scheduler, batch, capacity })
        .to_vec()
    }
}

impl fmt::Display for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scheduler, batch, capacity } = self;
        match (scheduler, capacity) {
            (Scheduler::Stack | Scheduler::Breadth, _) => write!(f, "{}", scheduler.name()),
            (_, 0) => write!(f, "{}, batch {batch}", scheduler.name()),
            _ => write!(f, "{}, batch {batch}, stack {capacity}", scheduler.name()),
        }
    }
}

/// What must be equal on every device, for every batch and number of threads.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Outcome {
    /// Hash of all samples, depth and identity; of the first layer where things can be seen through.
    pub samples: String,
    /// Hash of all colours, before they are filtered.
    pub colours: String,
    /// Hash of all pixels, filtered.
    pub pixels: String,
    /// Samples that something covers.
    pub covered: u64,
    /// Stands for the set of surfaces that were diced, and the pixels they could touch.
    pub drawn_set: String,
    /// Surfaces that were bounded.
    pub processed: u64,
    /// Surfaces that were diced.
    pub drawn: u64,
    /// Surfaces found invisible.
    pub culled: u64,
    /// Drawn surfaces that could not be split far enough.
    pub depth_limited: u64,
    /// Micropolygons of all drawn surfaces.
    pub micropolygons: u64,
}

/// Renders a case in batches of `batch` surfaces, with the default scheduler.
///
/// # Errors
/// What the plan or the device reports.
pub fn run<D: Device>(device: &mut D, case: &Case, batch: u32) -> Result<Outcome, D::Error> {
    run_scheduled(device, case, Schedule::of_batch(batch))
}

/// Renders a case with any scheduler.
///
/// # Errors
/// What the plan or the device reports.
pub fn run_scheduled<D: Device>(
    device: &mut D,
    case: &Case,
    schedule: Schedule,
) -> Result<Outcome, D::Error> {
    let Found { plan, buffers, counts, drawn_set, samples, covered, colours } =
        render(device, case, schedule)?;
    Ok(Outcome {
        samples,
        colours,
        pixels: hash_pixels(device, &buffers, plan.sizes().area.pixels)?,
        covered,
        drawn_set,
        processed: counts.processed,
        drawn: counts.drawn,
        culled: counts.culled,
        depth_limited: counts.depth_limited,
        micropolygons: counts.micropolygons,
    })
}

/// A case that was rendered, and what is to be known before layers are put together.
pub(crate) struct Found<B> {
    pub(crate) plan: FramePlan,
    pub(crate) buffers: Buffers<B>,
    counts: Counts,
    drawn_set: String,
    samples: String,
    covered: u64,
    colours: String,
}

/// Renders a case down to its pixels.
pub(crate) fn render<D: Device>(
    device: &mut D,
    case: &Case,
    schedule: Schedule,
) -> Result<Found<D::Buffer>, D::Error> {
    let plan = case.plan(schedule)?;
    let mut buffers = plan.prepare(device, &case.objects, &case.patches)?;
    let mut witness = Witness::new(device);
    let mut counts = plan.run(&mut witness, &mut buffers, |_| {})?;
    let drawn_set = witness.drawn_set();
    let (samples, covered) = hash_samples(device, &buffers, plan.sizes().area.samples)?;
    let colours = hash_colours(device, &buffers, plan.sizes().area.samples)?;
    while plan.sizes().area.layered && plan.blend(device, &buffers)? {
        counts = counts.and(plan.run(device, &mut buffers, |_| {})?);
    }
    plan.filter(device, &buffers, &case.taps())?;
    Ok(Found { plan, buffers, counts, drawn_set, samples, covered, colours })
}

fn hash_samples<D: Device>(
    device: &mut D,
    buffers: &Buffers<D::Buffer>,
    pixels: u64,
) -> Result<(String, u64), D::Error> {
    let (mut hasher, mut covered) = (blake3::Hasher::new(), 0);
    let mut block = vec![Sample::default(); BLOCK];
    for first in (0..pixels).step_by(BLOCK) {
        let block = &mut block[..BLOCK.min((pixels - first) as usize)];
        device.read(&buffers.samples, first, block)?;
        for sample in block.iter() {
            covered += u64::from(sample.depth > 0);
            for word in [sample.depth, sample.patch_id, sample.u, sample.v] {
                hasher.update(&word.to_le_bytes());
            }
        }
    }
    Ok((hasher.finalize().to_hex().to_string(), covered))
}

fn hash_pixels<D: Device>(
    device: &mut D,
    buffers: &Buffers<D::Buffer>,
    pixels: u64,
) -> Result<String, D::Error> {
    let mut hasher = blake3::Hasher::new();
    let mut block = vec![Pixel::default(); BLOCK];
    for first in (0..pixels).step_by(BLOCK) {
        let block = &mut block[..BLOCK.min((pixels - first) as usize)];
        device.read(&buffers.pixels, first, block)?;
        for word in bytemuck::cast_slice::<_, u32>(block) {
            hasher.update(&word.to_le_bytes());
        }
    }
    Ok(hasher.finalize().to_hex().to_string())
}

fn hash_colours<D: Device>(
    device: &mut D,
    buffers: &Buffers<D::Buffer>,
    pixels: u64,
) -> Result<String, D::Error> {
    let mut hasher = blake3::Hasher::new();
    let mut block = vec![Colour::default(); BLOCK];
    for first in (0..pixels).step_by(BLOCK) {
        let block = &mut block[..BLOCK.min((pixels - first) as usize)];
        device.read(&buffers.colours, first, block)?;
        for value in block.iter().flat_map(|colour| colour.rgba) {
            hasher.update(&value.to_bits().to_le_bytes());
        }
    }
    Ok(hasher.finalize().to_hex().to_string())
}
