//! One frame as a plan: buffers, uploads and the order of stages, on any device.

use crate::abi::{
    Colour, Control, Draw, Frame, Group, Layout, Limits, Object, Patch, Pixel, Sample, Shared, Slot, Surface,
    Tap, Verdict,
};
use crate::backend::Device;
use crate::error::PlanError;
use crate::memory::{Area, MAX_STACK, Sizes};
use crate::schedule::{Bounded, Scheduler, Step};
use crate::stage::{Extent, Items, Stage};

/// What a frame counted. Independent of device, batch and threads, but for `max_stack`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Surfaces that were bounded.
    pub processed: u64,
    /// Surfaces that were diced.
    pub drawn: u64,
    /// Surfaces found invisible.
    pub culled: u64,
    /// Drawn surfaces that were larger than the bound but could not be split any further.
    pub depth_limited: u64,
    /// Micropolygons of all drawn surfaces.
    pub micropolygons: u64,
    /// Largest number of surfaces that lay on the stack.
    pub max_stack: u64,
    /// Roots that have been taken: a measure of progress.
    pub roots_taken: u64,
    /// Batches that were taken, empty ones included; of LOCAL, rounds.
    pub batches: u64,
    /// How LOCAL's groups shared the work.
    pub load: Option<Load>,
}

/// Surfaces bounded by each of LOCAL's groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Load {
    /// Number of groups.
    pub groups: u32,
    /// Of the group that bounded fewest.
    pub least: u32,
    /// Of the group that bounded most.
    pub most: u32,
    /// Of all groups.
    pub total: u64,
}

impl Load {
    /// How far, as a share of the mean, the load of any group is from it.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        let mean = self.total as f64 / f64::from(self.groups);
        let apart = f64::from(self.most) - mean;
        if self.total == 0 { 0.0 } else { apart.max(mean - f64::from(self.least)) / mean }
    }
}

impl Counts {
    /// Those of this run and those of another one, of the same scene.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            processed: self.processed + other.processed,
            drawn: self.drawn + other.drawn,
            culled: self.culled + other.culled,
            depth_limited: self.depth_limited + other.depth_limited,
            micropolygons: self.micropolygons + other.micropolygons,
            max_stack: self.max_stack.max(other.max_stack),
            roots_taken: self.roots_taken + other.roots_taken,
            batches: self.batches + other.batches,
            load: other.load.or(self.load),
        }
    }

    fn add(&mut self, control: &Control) {
        self.processed += u64::from(control.processed);
        self.drawn += u64::from(control.drawn);
        self.culled += u64::from(control.culled);
        self.depth_limited += u64::from(control.limited);
        self.micropolygons += u64::from(control.micropolygons);
        self.max_stack = u64::from(control.peak);
        self.roots_taken = u64::from(control.next_root);
    }
}

/// The buffers of one frame.
#[derive(Debug)]
pub struct Buffers<B> {
    pub(crate) frame: B,
    pub(crate) objects: B,
    pub(crate) patches: B,
    roots: B,
    limits: B,
    pub(crate) control: B,
    stack: B,
    batch: B,
    verdicts: B,
    slots: B,
    pub(crate) draws: B,
    groups: B,
    dealt: B,
    fresh: B,
    /// The nearest micropolygon at each sample, row after row from the top.
    pub samples: B,
    /// Its colour.
    pub colours: B,
    /// What was found there at the last layer, if anything can be seen through.
    pub behind: B,
    front: B,
    layers: B,
    more: B,
    taps: B,
    /// Pixels, row after row from the top; written by [`FramePlan::filter`].
    pub pixels: B,
}

/// A frame to be rendered: its sizes are checked, its memory is known.
#[derive(Clone, Copy, Debug)]
pub struct FramePlan {
    sizes: Sizes,
    frame: Frame,
    /// Are surfaces diced and sampled, or only subdivided?
    draws: bool,
    /// Bytes that the device may hold while buffers grow.
    budget: u64,
}

impl FramePlan {
    /// Plans a frame of `patches` and `objects` with batches of `batch` surfaces and the default scheduler.
    ///
    /// # Errors
    /// [`PlanError::Invalid`] if a size or option is out of range.
    pub const fn new(frame: Frame, patches: u32, objects: u32, batch: u32) -> Result<Self, PlanError> {
        let Frame { width, height, levels, .. } = frame;
        let (scheduler, capacity) = (Scheduler::Adaptive, 0);
        let (records, area) = (patches, Area::of(&frame));
        Self::with_sizes(
            frame,
            Sizes {
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
            },
        )
    }

    /// Plans a frame with these sizes, which must be the frame's own; only the area may be larger, for other regions.
    ///
    /// # Errors
    /// [`PlanError::Invalid`] if a size or option is out of range.
    pub const fn with_sizes(frame: Frame, sizes: Sizes) -> Result<Self, PlanError> {
        let Frame { levels, width, height, .. } = frame;
        let area = sizes.area.and(Area::of(&frame));
        let sizes = Sizes { levels, width, height, area, ..sizes };
        match sizes.checked() {
            Ok(sizes) => Ok(Self { sizes, frame, draws: true, budget: u64::MAX }),
            Err(error) => Err(error),
        }
    }

    /// The same plan without pictures: surfaces are bounded and split, and what is to be drawn is counted. For
    /// measuring subdivision alone.
    #[must_use]
    pub const fn without_drawing(self) -> Self {
        Self { draws: false, ..self }
    }

    /// The same plan with a limit in bytes for all buffers together, those included that the device needs for
    /// itself. BREADTH keeps to it as it grows; for the other schedulers [`Sizes::fitted`] has seen to it.
    #[must_use]
    pub const fn within(self, budget: u64) -> Self {
        Self { budget, ..self }
    }

    /// Sizes of all buffers.
    #[must_use]
    pub const fn sizes(&self) -> &Sizes {
        &self.sizes
    }

    /// Reserves all buffers and uploads the scene; records of what some kinds need besides lie behind all patches.
    ///
    /// # Errors
    /// What the device reports.
    pub fn prepare<D: Device>(
        &self,
        device: &mut D,
        objects: &[Object],
        patches: &[Patch],
    ) -> Result<Buffers<D::Buffer>, D::Error> {
        let sizes = &self.sizes;
        let mut reserve = |name, layout: Layout, entries: u64| device.allocate(name, layout, entries);
        let batch = sizes.batch_entries();
        let buffers = Buffers {
            frame: reserve("frame", Frame::LAYOUT, 1)?,
            objects: reserve("objects", Object::LAYOUT, u64::from(sizes.objects))?,
            patches: reserve("patches", Patch::LAYOUT, sizes.patch_entries())?,
            roots: reserve("roots", u32::LAYOUT, sizes.root_entries())?,
            limits: reserve("limits", Limits::LAYOUT, 1)?,
            control: reserve("control", Control::LAYOUT, 1)?,
            stack: reserve("stack", Surface::LAYOUT, sizes.stack_entries())?,
            batch: reserve("batch", Surface::LAYOUT, batch)?,
            verdicts: reserve("verdicts", Verdict::LAYOUT, batch)?,
            slots: reserve("slots", Slot::LAYOUT, batch)?,
            draws: reserve("draws", Draw::LAYOUT, sizes.draw_entries())?,
            groups: reserve("groups", Group::LAYOUT, sizes.group_entries())?,
            dealt: reserve("dealt", Surface::LAYOUT, sizes.dealt_entries())?,
            fresh: reserve("fresh", Draw::LAYOUT, sizes.fresh_entries())?,
            samples: reserve("samples", Sample::LAYOUT, sizes.area.samples)?,
            colours: reserve("colours", Colour::LAYOUT, sizes.area.samples)?,
            behind: reserve("behind", Sample::LAYOUT, sizes.area.layer_entries())?,
            front: reserve("front", Sample::LAYOUT, sizes.area.layer_entries())?,
            layers: reserve("layers", Colour::LAYOUT, sizes.area.layer_entries())?,
            more: reserve("more", u32::LAYOUT, 1)?,
            taps: reserve("taps", Tap::LAYOUT, u64::from(sizes.area.taps.max(1)))?,
            pixels: reserve("pixels", Pixel::LAYOUT, sizes.area.pixels.max(1))?,
        };
        device.write(&buffers.frame, &[self.frame])?;
        device.write(&buffers.objects, objects)?;
        device.write(&buffers.patches, patches)?;
        Ok(buffers)
    }

    const fn limits(&self, roots: u32) -> Limits {
        let stack = match self.sizes.scheduler {
            Scheduler::Local => self.sizes.group_stack(),
            _ => self.sizes.stack_entries(),
        };
        Limits {
            patches: roots,
            batch: self.sizes.batch,
            stack_room: stack as u32,
            draw_room: self.sizes.draw_entries() as u32,
            levels: self.sizes.levels,
            groups: self.sizes.group_entries() as u32,
        }
    }

    /// Aims at another frame: another view, region or moment of the same scene, which needs no larger buffers.
    ///
    /// # Errors
    /// What the device reports.
    pub fn aimed<D: Device>(
        &self,
        device: &mut D,
        buffers: &Buffers<D::Buffer>,
        frame: Frame,
        objects: &[Object],
    ) -> Result<Self, D::Error> {
        device.write(&buffers.frame, &[frame])?;
        device.write(&buffers.objects, objects)?;
        Ok(Self { frame, ..*self })
    }

    /// Forgets all samples and layers.
    ///
    /// # Errors
    /// What the device reports.
    pub fn clear<D: Device>(&self, device: &mut D, buffers: &Buffers<D::Buffer>) -> Result<(), D::Error> {
        device.clear(&buffers.samples)?;
        if self.sizes.area.layered {
            device.clear(&buffers.behind)?;
            device.clear(&buffers.front)?;
            device.clear(&buffers.layers)?;
        }
        Ok(())
    }

    /// Puts the layer in `buffers.samples` behind those before it; says whether another one may follow.
    ///
    /// # Errors
    /// What the device reports.
    pub fn blend<D: Device>(&self, device: &mut D, b: &Buffers<D::Buffer>) -> Result<bool, D::Error> {
        device.clear(&b.more)?;
        let blend = [&b.samples, &b.colours, &b.behind, &b.front, &b.layers, &b.more];
        device.dispatch(Stage::Blend, Items::Count(self.sizes.area.samples as u32), &blend)?;
        let mut more = [0_u32];
        device.read(&b.more, 0, &mut more)?;
        Ok(more != [0])
    }

    /// Filters all samples of the frame, or if it has layers what became of them, into `buffers.pixels`.
    ///
    /// # Errors
    /// What the device reports.
    pub fn filter<D: Device>(
        &self,
        device: &mut D,
        b: &Buffers<D::Buffer>,
        taps: &[Tap],
    ) -> Result<(), D::Error> {
        device.write(&b.taps, taps)?;
        let (samples, colours) =
            if self.sizes.area.layered { (&b.front, &b.layers) } else { (&b.samples, &b.colours) };
        let filter = [&b.frame, &b.taps, samples, colours, &b.pixels];
        device.dispatch(Stage::Filter, Items::Count(self.frame.shown_count() as u32), &filter)
    }

    /// Renders the frame into `buffers.samples` and `buffers.colours`; `progress` sees the counts so far.
    /// Only BREADTH changes other buffers than those: they grow.
    ///
    /// # Errors
    /// What the device reports; [`PlanError::Overflow`] if a buffer ran full, [`PlanError::Level`] if BREADTH
    /// needs more than its budget.
    pub fn run<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
        progress: impl FnMut(&Counts),
    ) -> Result<Counts, D::Error> {
        self.run_into(device, buffers, progress, |device, b| self.draw(device, b))
    }

    /// The same of these patches only, no more than [`Sizes::listed`]; samples of earlier runs stay where nothing is nearer.
    ///
    /// # Errors
    /// As [`FramePlan::run`].
    pub fn run_listed<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
        roots: &[u32],
        progress: impl FnMut(&Counts),
    ) -> Result<Counts, D::Error> {
        device.write(&buffers.roots, roots)?;
        let control = Control { listed: 1, ..Control::default() };
        self.run_roots(device, buffers, (control, roots.len() as u32), progress, |device, b| {
            self.draw(device, b)
        })
    }

    /// As [`FramePlan::run`]; `draw` does something with all that lies in the draw buffer.
    pub(crate) fn run_into<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
        progress: impl FnMut(&Counts),
        draw: impl FnMut(&mut D, &Buffers<D::Buffer>) -> Result<(), D::Error>,
    ) -> Result<Counts, D::Error> {
        self.run_roots(device, buffers, (Control::default(), self.sizes.patches), progress, draw)
    }

    /// Works so many roots off, from these counts on.
    fn run_roots<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
        (control, roots): (Control, u32),
        progress: impl FnMut(&Counts),
        draw: impl FnMut(&mut D, &Buffers<D::Buffer>) -> Result<(), D::Error>,
    ) -> Result<Counts, D::Error> {
        let limits = self.limits(roots);
        device.write(&buffers.control, &[control])?;
        device.write(&buffers.limits, &[limits])?;
        match self.sizes.scheduler {
            Scheduler::Breadth => self.run_by_level(device, buffers, limits, progress, draw),
            _ => self.run_by_batch(device, buffers, roots, progress, draw),
        }
    }

    /// Surfaces that the draw buffer holds; with BREADTH it grows.
    pub(crate) const fn draws_at_once(&self) -> u64 {
        self.sizes.draw_entries()
    }

    fn run_by_batch<D: Device>(
        &self,
        device: &mut D,
        buffers: &Buffers<D::Buffer>,
        roots: u32,
        mut progress: impl FnMut(&Counts),
        mut draw: impl FnMut(&mut D, &Buffers<D::Buffer>) -> Result<(), D::Error>,
    ) -> Result<Counts, D::Error> {
        let mut counts = Counts::default();
        let mut schedule = Bounded::new(roots, self.sizes.batches_a_draw());
        loop {
            match schedule.step() {
                Step::Batch => {
                    self.batch(device, buffers)?;
                    counts.batches += 1;
                }
                Step::Draw => {
                    draw(device, buffers)?;
                    flush(device, buffers)?;
                }
                Step::Ask => {
                    let control = ask(device, buffers)?;
                    counts.add(&control);
                    progress(&counts);
                    schedule.answer(&control);
                }
                Step::Done => {
                    counts.load = self.load(device, buffers)?;
                    return Ok(counts);
                }
            }
        }
    }

    /// How LOCAL's groups shared the work.
    fn load<D: Device>(&self, device: &mut D, b: &Buffers<D::Buffer>) -> Result<Option<Load>, D::Error> {
        if self.sizes.scheduler != Scheduler::Local {
            return Ok(None);
        }
        let groups = self.sizes.groups();
        let mut load = Load { groups, least: u32::MAX, most: 0, total: 0 };
        let mut some = [Group::default(); 64];
        for first in (0..groups).step_by(some.len()) {
            let some = &mut some[..(groups - first).min(64) as usize];
            device.read(&b.groups, u64::from(first), some)?;
            for group in some {
                load.least = load.least.min(group.load);
                load.most = load.most.max(group.load);
                load.total += u64::from(group.load);
            }
        }
        Ok(Some(load))
    }

    /// BREADTH: a level is a batch. The host asks after each, and makes room for the next.
    fn run_by_level<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
        mut limits: Limits,
        mut progress: impl FnMut(&Counts),
        mut draw: impl FnMut(&mut D, &Buffers<D::Buffer>) -> Result<(), D::Error>,
    ) -> Result<Counts, D::Error> {
        let mut counts = Counts::default();
        loop {
            let control = ask(device, buffers)?;
            counts.add(&control);
            progress(&counts);
            let count = control.stack + limits.patches - control.next_root;
            if count == 0 {
                return Ok(counts);
            }
            self.make_room(device, buffers, &mut limits, count, control.stack)?;
            run_batch(device, buffers)?;
            counts.batches += 1;
            draw(device, buffers)?;
            flush(device, buffers)?;
        }
    }

    /// Lets a level of `count` surfaces, `held` of them on the stack, be one batch: twice as many may come of it.
    fn make_room<D: Device>(
        &self,
        device: &mut D,
        b: &mut Buffers<D::Buffer>,
        limits: &mut Limits,
        count: u32,
        held: u32,
    ) -> Result<(), D::Error> {
        let room = 2 * u64::from(count);
        if room > MAX_STACK {
            let (option, value) = ("surface stack", room);
            return Err(PlanError::Invalid { option, value, least: 1, most: MAX_STACK }.into());
        }
        let batch = (count > limits.batch || count > limits.draw_room).then_some(u64::from(count));
        let stack = (room > u64::from(limits.stack_room)).then_some(room);
        let needed = self.other_bytes(device) + bytes_while_growing(limits, batch, stack);
        if needed > self.budget {
            return Err(PlanError::Level { surfaces: u64::from(count), have: self.budget, needed }.into());
        }
        if let Some(entries) = batch {
            b.batch = device.allocate("batch", Surface::LAYOUT, entries)?;
            b.verdicts = device.allocate("verdicts", Verdict::LAYOUT, entries)?;
            b.slots = device.allocate("slots", Slot::LAYOUT, entries)?;
            b.draws = device.allocate("draws", Draw::LAYOUT, entries)?;
            (limits.batch, limits.draw_room) = (count, count);
        }
        if let Some(entries) = stack {
            let larger = device.allocate("stack", Surface::LAYOUT, entries)?;
            device.copy(&b.stack, &larger, u64::from(held))?;
            b.stack = larger;
            limits.stack_room = entries as u32;
        }
        // A level is all there is, so its children are safe without any more room.
        device.write(&b.limits, &[Limits { levels: 1, ..*limits }])
    }

    /// One batch, or one round of LOCAL's groups.
    fn batch<D: Device>(&self, device: &mut D, b: &Buffers<D::Buffer>) -> Result<(), D::Error> {
        match self.sizes.scheduler {
            Scheduler::Local => run_round(device, b, self.sizes.groups()),
            _ => run_batch(device, b),
        }
    }

    /// Bytes that the device holds beside the buffers that grow.
    fn other_bytes<D: Device>(&self, device: &D) -> u64 {
        let own = if self.draws { device.own_bytes(self.extent()) } else { 0 };
        self.sizes.fixed_bytes() + self.sizes.local_bytes() + own
    }

    fn draw<D: Device>(&self, device: &mut D, b: &Buffers<D::Buffer>) -> Result<(), D::Error> {
        if !self.draws {
            return Ok(());
        }
        let extent = self.extent();
        let stage = if extent.sort_last { Stage::SortLast } else { Stage::Draw };
        let draw =
            [&b.frame, &b.objects, &b.patches, &b.control, &b.draws, &b.behind, &b.samples, &b.colours];
        device.dispatch(stage, Items::Image(extent), &draw)
    }

    const fn extent(&self) -> Extent {
        Extent::of(&self.frame, self.sizes.area.samples)
    }
}

/// Forgets what lies in the draw buffer.
fn flush<D: Device>(device: &mut D, b: &Buffers<D::Buffer>) -> Result<(), D::Error> {
    device.dispatch(Stage::Flush, Items::Count(1), &[&b.control])
}

/// Most bytes that the buffers which grow hold at once while those that must grow do so, one after the other: a
/// new buffer is there before the old one goes.
fn bytes_while_growing(now: &Limits, batch: Option<u64>, stack: Option<u64>) -> u64 {
    let buffers = [
        (Surface::LAYOUT, now.batch, batch),
        (Verdict::LAYOUT, now.batch, batch),
        (Slot::LAYOUT, now.batch, batch),
        (Draw::LAYOUT, now.draw_room, batch),
        (Surface::LAYOUT, now.stack_room, stack),
    ];
    let buffers = buffers.map(|(layout, entries, larger)| {
        let bytes = |entries: u64| entries * layout.size as u64;
        (bytes(u64::from(entries)), larger.map(bytes))
    });
    let mut held: u64 = buffers.iter().map(|&(bytes, _)| bytes).sum();
    let mut most = held;
    for (old, larger) in buffers {
        if let Some(new) = larger {
            most = most.max(held + new);
            held = held + new - old;
        }
    }
    most
}

fn run_batch<D: Device>(device: &mut D, b: &Buffers<D::Buffer>) -> Result<(), D::Error> {
    let take = [&b.limits, &b.roots, &b.stack, &b.batch, &b.control];
    device.dispatch(Stage::Take, Items::Count(1), &take)?;
    let bound = [&b.frame, &b.objects, &b.patches, &b.control, &b.stack, &b.batch, &b.verdicts];
    device.dispatch(Stage::Bound, Items::Taken, &bound)?;
    let scan = [&b.limits, &b.verdicts, &b.slots, &b.control];
    device.dispatch(Stage::Scan, Items::Taken, &scan)?;
    let split = [&b.control, &b.batch, &b.verdicts, &b.slots, &b.stack, &b.draws];
    device.dispatch(Stage::Split, Items::Taken, &split)
}

/// A round of LOCAL; in the first one the groups have nothing to do yet.
fn run_round<D: Device>(device: &mut D, b: &Buffers<D::Buffer>, groups: u32) -> Result<(), D::Error> {
    let local = [&b.frame, &b.objects, &b.patches, &b.dealt, &b.groups, &b.stack, &b.fresh];
    device.dispatch(Stage::Local, Items::Groups(groups), &local)?;
    device.dispatch(Stage::Balance, Items::Count(1), &[&b.limits, &b.groups, &b.control])?;
    let deal = [&b.control, &b.roots, &b.groups, &b.stack, &b.fresh, &b.dealt, &b.draws];
    device.dispatch(Stage::Deal, Items::Groups(groups), &deal)
}

/// Reads the counts and starts them anew.
fn ask<D: Device>(device: &mut D, b: &Buffers<D::Buffer>) -> Result<Control, D::Error> {
    let mut control = [Control::default()];
    device.read(&b.control, 0, &mut control)?;
    let [control] = control;
    if control.overflow > 0 {
        let excess = u64::from(control.overflow);
        return Err(PlanError::Overflow { buffer: "surface stack or draw", excess }.into());
    }
    let rest = Control { processed: 0, culled: 0, drawn: 0, limited: 0, micropolygons: 0, ..control };
    device.write(&b.control, &[rest])?;
    Ok(control)
}
