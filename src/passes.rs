//! An image in passes: parts of it, one after the other, so that all samples of a part fit the memory; for each of them
//! layers, while something can be seen through; for each layer the moments of a blurred image.

use micropoly_core::abi::{Frame, Object, Patch, Tap};
use micropoly_core::backend::Device;
use micropoly_core::error::PlanError;
use micropoly_core::memory::{Area, Room, Sizes};
use micropoly_core::pattern::{Region, Samples, Tuple, Window, tuples};
use micropoly_core::reconstruction::{MAX_RADIUS, MAX_TAPS, MIN_RADIUS};
use micropoly_core::render::{Buffers, Counts, FramePlan};
use micropoly_core::stage::Extent;

use crate::canvas::Canvas;
use crate::cull::{Culling, View};
use crate::error::{Error, Result};
use crate::render::{Progress, RenderOptions, Subject, chosen_sizes, note_on, room_on};
use crate::scene::Scene;

/// Samples of a part of the image, about: enough for any device to be busy, few enough to stay in a CPU's last cache.
const PART: u64 = 1 << 19;
/// With one sample a pixel and no blur, memory is the only reason for parts.
const SHARP_PART: u64 = 1 << 22;
/// Parts do not get smaller than that to fit the memory.
const LEAST_PART: u64 = 1 << 10;

/// All that is known of an image before it is rendered.
pub(crate) struct Passes<'a> {
    scene: &'a Scene,
    options: &'a RenderOptions,
    patches: &'a [Patch],
    /// The pixels that are wanted.
    pub(crate) window: Window,
    /// One view, or one a tuple.
    pub(crate) views: Vec<(Frame, Vec<Object>)>,
    tuples: Vec<Tuple>,
    taps: Vec<Tap>,
}

impl<'a> Passes<'a> {
    pub(crate) fn new(subject: Subject<'a>, options: &'a RenderOptions) -> Result<Self> {
        let Subject { scene, shot, patches } = subject;
        let window = options.window()?;
        let samples = options.frame.samples;
        let blur = options.blur.unwrap_or(scene.blur);
        if !blur.is_sound() {
            let remedy = "the shutter must be 0 or more, the lens's f-number, focus and sensor above 0";
            return Err(Error::scene("a shutter or a lens that cannot be", remedy));
        }
        let tuples: Vec<Tuple> =
            if shot.is_blurred(scene, &blur) { tuples(samples).collect() } else { Vec::new() };
        let sharp = [(0.0, [0.0; 2])];
        let moments: Vec<(f64, [f64; 2])> = tuples.iter().map(|tuple| (tuple.time, tuple.lens)).collect();
        let moments = if moments.is_empty() { &sharp[..] } else { &moments };
        let mut views = Vec::with_capacity(moments.len());
        for moment in moments {
            views.push(shot.view(scene, &options.frame, &blur, *moment)?);
        }
        Ok(Self { scene, options, patches, window, views, tuples, taps: taps(options)? })
    }

    /// What leaves patches out.
    pub(crate) fn culling(&self) -> Culling<'a> {
        let RenderOptions { cull, wave, .. } = *self.options;
        Culling::new(cull, wave, self.patches, self.scene.patch_count() as u32)
    }

    fn samples(&self) -> Samples {
        self.options.frame.samples
    }

    /// The parts of the image, of about so many samples.
    fn regions(&self, most: u64) -> Vec<Region> {
        let (samples, margin) = (self.samples(), self.options.filter.margin());
        let (width, height) = (self.options.frame.width, self.options.frame.height);
        let parts = self.window.parts(most / u64::from(samples.count()));
        parts.map(|shown| Region { samples, window: shown.widened(margin, width, height), shown }).collect()
    }

    /// The frame of a part, with all its samples, in the first view.
    fn frame(&self, region: Region) -> Frame {
        self.frame_in(&self.views[0].0, region)
    }

    /// The same in any view.
    fn frame_in(&self, view: &Frame, region: Region) -> Frame {
        let frame = Frame { taps: self.taps.len() as u32, ..*view };
        frame.with_region(region, self.options.frame.tile)
    }

    /// Sizes that fit a device, and the parts of the image; `room` says what there is for the largest of them.
    pub(crate) fn fitted(&self, room: impl Fn(Extent) -> Room) -> Result<(Sizes, Vec<Region>)> {
        let is_plain = self.tuples.is_empty() && self.samples() == Samples::One;
        let mut most = if is_plain { SHARP_PART } else { PART };
        loop {
            let regions = self.regions(most);
            let areas = regions.iter().map(|region| Area::of(&self.frame(*region)));
            let area = areas.fold(Area::default(), Area::and);
            let extents = regions.iter().map(|region| Extent::of(&self.frame(*region), area.samples));
            let extent = extents.reduce(larger).unwrap_or_default();
            match chosen_sizes(self.scene, self.options, room(extent), area) {
                Err(Error::Plan(PlanError::Budget { .. } | PlanError::TooLarge { .. }))
                    if most > LEAST_PART =>
                {
                    most /= 4;
                }
                other => return other.map(|sizes| (sizes, regions)),
            }
        }
    }

    /// A plan that fits a device, the parts of the image, and what a user should be told.
    pub(crate) fn plan_on<D: Device>(&self, device: &D) -> Result<(FramePlan, Vec<Region>, Vec<String>)> {
        let (sizes, regions) = self.fitted(|extent| room_on(device, extent))?;
        let frame = self.frame(regions[0]);
        let notes = note_on(self.options, &sizes, room_on(device, Extent::of(&frame, 0)));
        let plan = FramePlan::with_sizes(frame, sizes).map_err(Error::Plan)?;
        Ok((plan.within(self.options.batch.budget()), regions, notes.into_iter().collect()))
    }

    /// Renders all parts onto the canvas.
    pub(crate) fn run<D: Device>(
        &self,
        device: &mut D,
        plan: &FramePlan,
        buffers: &mut Buffers<D::Buffer>,
        regions: &[Region],
        (canvas, culling): (&mut Canvas, &mut Culling<'_>),
        mut progress: impl FnMut(&Progress<'_>),
    ) -> Result<Counts> {
        let failed = |error: D::Error| Error::on_device(&error);
        let mut counts = Counts::default();
        for (index, region) in regions.iter().enumerate() {
            let mut inner = |share: f64, counts: &Counts| {
                progress(&Progress { share: (index as f64 + share) / regions.len() as f64, counts });
            };
            if index > 0 {
                plan.clear(device, buffers).map_err(failed)?; // new buffers are clear
            }
            loop {
                counts = counts
                    .and(self.layer(device, plan, buffers, (*region, culling), &mut inner).map_err(failed)?);
                if !self.scene.is_transparent() || !plan.blend(device, buffers).map_err(failed)? {
                    break;
                }
            }
            let whole = self.frame(*region);
            let aimed = plan.aimed(device, buffers, whole, &self.views[0].1).map_err(failed)?;
            aimed.filter(device, buffers, &self.taps).map_err(failed)?;
            canvas.take(device, &buffers.pixels, region.shown).map_err(failed)?;
        }
        Ok(counts)
    }

    /// Finds one layer of a part of the image: once, or at all moments.
    fn layer<D: Device>(
        &self,
        device: &mut D,
        plan: &FramePlan,
        buffers: &mut Buffers<D::Buffer>,
        (region, culling): (Region, &mut Culling<'_>),
        progress: &mut impl FnMut(f64, &Counts),
    ) -> std::result::Result<Counts, D::Error> {
        let mut counts = Counts::default();
        for (index, (view, objects)) in self.views.iter().enumerate() {
            let whole = self.frame_in(view, region);
            let tuple = self.tuples.get(index);
            let frame = tuple.map_or(whole, |tuple| whole.with_tuple(self.samples(), *tuple));
            let plan = plan.aimed(device, buffers, frame, objects)?;
            let view = View { number: index, frame, objects };
            let own = culling.run(device, &plan, buffers, &view, |share, own| {
                progress((index as f64 + share) / self.views.len() as f64, own);
            })?;
            counts = counts.and(own);
        }
        Ok(counts)
    }
}

/// The larger of two extents.
fn larger(a: Extent, b: Extent) -> Extent {
    if u64::from(a.columns) * u64::from(a.rows) >= u64::from(b.columns) * u64::from(b.rows) { a } else { b }
}

/// The samples that a pixel is made of.
fn taps(options: &RenderOptions) -> Result<Vec<Tap>> {
    let filter = options.filter;
    if !filter.is_sound() {
        let problem = format!("a filter with a radius of {} pixels is not possible", filter.radius);
        return Err(Error::scene(
            problem,
            format!("choose a radius from {MIN_RADIUS} to {MAX_RADIUS} pixels"),
        ));
    }
    let mut taps = vec![Tap::default(); MAX_TAPS];
    let count = filter.taps(options.frame.samples, &mut taps);
    taps.truncate(count);
    Ok(taps)
}
