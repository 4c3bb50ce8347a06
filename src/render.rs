//! Rendering a scene: choice of device, the plan, the image, the statistics.

use std::time::Instant;

use micropoly_core::abi::{Frame, Patch, Sample, Shared};
use micropoly_core::backend::Device;
use micropoly_core::camera::FrameOptions;
use micropoly_core::memory::{Area, DEFAULT_BATCH, Room, Sizes};
use micropoly_core::pattern::Window;
use micropoly_core::reconstruction::Filter;
use micropoly_core::render::{Counts, FramePlan};
use micropoly_core::schedule::Scheduler;
use micropoly_core::stage::Extent;

use crate::backend::Backend;
use crate::canvas::Canvas;
use crate::cull::{Cull, Roots};
use crate::error::{Error, Result};
use crate::film::Film;
use crate::image::Image;
use crate::order::Ordered;
use crate::passes::Passes;
use crate::scene::Scene;
use crate::shot::{Blur, Shot};
use crate::timed::{Seconds, Timed};

/// How many surfaces are worked on at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Batch {
    /// So many.
    Surfaces(u32),
    /// As many as fit into so many bytes together with everything else that the device holds. BREADTH, which
    /// takes all there are, ends in an error once it would need more.
    Memory(u64),
}

impl Batch {
    /// Most bytes that the device may hold.
    pub(crate) const fn budget(self) -> u64 {
        match self {
            Self::Surfaces(_) => u64::MAX,
            Self::Memory(bytes) => bytes,
        }
    }
}

impl Default for Batch {
    fn default() -> Self {
        Self::Surfaces(DEFAULT_BATCH)
    }
}

/// How what can be seen through is put into order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Transparency {
    /// Sample by sample, a layer after the other: exact for everything.
    #[default]
    Layers,
    /// All triangles at once, in one pass: only polygons, which may cut each other.
    Order(Ordering),
}

impl Transparency {
    /// Its name, on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Layers => "layers",
            Self::Order(_) => "order",
        }
    }
}

/// How triangles are sorted (see [`micropoly_core::accel::bsp`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ordering {
    /// Cells of the grid along each axis, if they are not to be chosen from the scene.
    pub grid: Option<u32>,
    /// Triangles are not cut that reach beyond a plane by no more than this share of the scene's longest side; 0 is exact.
    pub tolerance: f64,
}

/// Everything that can be chosen about a rendering.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderOptions {
    /// What renders. The image does not depend on it.
    pub backend: Backend,
    /// Number or part of the name of a device of the backend; its first one if there is nothing here.
    pub device: Option<String>,
    /// Image size, bound, dice rate, depth, samples.
    pub frame: FrameOptions,
    /// How samples become pixels.
    pub filter: Filter,
    /// Shutter and lens, if not the scene's own.
    pub blur: Option<Blur>,
    /// How what can be seen through is put into order.
    pub transparency: Transparency,
    /// The part of the image that is wanted, if not all of it: the same pixels as without.
    pub crop: Option<Window>,
    /// Batch size or memory budget. The image does not depend on it.
    pub batch: Batch,
    /// How the stack is worked off. The image does not depend on it.
    pub scheduler: Scheduler,
    /// Entries of ADAPTIVE's stack; 0 = as many as it takes to be hardly ever slower than with more. The image
    /// does not depend on it.
    pub capacity: u32,
    /// Which patches are left out before they are bounded. The image does not depend on it.
    pub cull: Cull,
    /// Patches that are drawn before depths are looked at again for [`Cull::Occlusion`]; 0 = as many as pay. The image does not
    /// depend on it; what is culled does.
    pub wave: u32,
    /// Threads of the CPU backend; 0 = one a core. The image does not depend on it.
    pub threads: usize,
    /// Keep linear values, too: [`Rendering::film`].
    pub film: bool,
}

impl RenderOptions {
    /// The part of the image that is rendered.
    ///
    /// # Errors
    /// [`Error::Scene`] if it is empty or not inside the image.
    pub fn window(&self) -> Result<Window> {
        let FrameOptions { width, height, .. } = self.frame;
        let whole = Window::whole(width, height);
        let window = self.crop.unwrap_or(whole);
        let Window { left, right, top, bottom } = window;
        if left < right && right <= width && top < bottom && bottom <= height {
            return Ok(window);
        }
        let problem =
            format!("the crop window {left},{top},{right},{bottom} is empty or reaches beyond the image");
        Err(Error::scene(
            problem,
            format!("choose left and top from 0, right up to {width}, bottom up to {height}"),
        ))
    }
}

/// How far a rendering is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Share of the work, from 0 to 1; where things can be seen through, of the layer in work.
    pub share: f64,
    /// What was counted so far in the part of the image that is in work.
    pub counts: &'a Counts,
}

/// An image, and what it took.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The image.
    pub image: Image,
    /// Its linear values, if they were asked for.
    pub film: Option<Film>,
    /// What was counted on the way, in all parts of the image and all passes together.
    pub counts: Counts,
    /// What became of patches.
    pub roots: Roots,
    /// Parts that the image was rendered in, so that it fits the memory; a surface on the border of two is counted in both.
    pub parts: usize,
    /// Buffer sizes, and so the proven bounds.
    pub sizes: Sizes,
    /// Bytes that the device held.
    pub bytes_allocated: u64,
    /// Which backend it was.
    pub backend: Backend,
    /// Name of the device.
    pub device: String,
    /// What a user should be told about the choice of the device.
    pub notes: Vec<String>,
    /// Wall time by stage.
    pub seconds: Seconds,
}

/// Renders on any device.
///
/// # Errors
/// [`Error::Scene`], [`Error::Plan`] (among them a level of BREADTH beyond the budget) or [`Error::Device`].
pub fn render_on<D: Device>(
    device: &mut D,
    device_name: String,
    scene: &Scene,
    options: &RenderOptions,
    progress: impl FnMut(&Progress<'_>),
) -> Result<Rendering> {
    let start = Instant::now();
    let patches = scene.device_patches();
    let made = start.elapsed().as_secs_f64();
    let subject = Subject { scene, shot: Shot::of(scene), patches: &patches };
    let mut rendering = render_from(device, device_name, subject, options, progress)?;
    rendering.seconds.setup += made;
    Ok(rendering)
}

/// What is rendered: a scene at some moment, and its patches, which are all.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) shot: Shot,
    pub(crate) patches: &'a [Patch],
}

/// As [`render_on`], at any moment.
pub(crate) fn render_from<D: Device>(
    device: &mut D,
    device_name: String,
    subject: Subject<'_>,
    options: &RenderOptions,
    progress: impl FnMut(&Progress<'_>),
) -> Result<Rendering> {
    let start = Instant::now();
    let scene = subject.scene;
    let job = Passes::new(subject, options)?;
    let (plan, regions, mut notes) = job.plan_on(device)?;
    let mut device = Timed::new(device);
    let failed = |error: D::Error| Error::on_device(&error);
    let mut buffers = plan.prepare(&mut device, &job.views[0].1, subject.patches).map_err(failed)?;
    let setup = start.elapsed().as_secs_f64();
    let mut canvas = Canvas::new(job.window, scene.background, options.film);
    let mut culling = job.culling();
    let on = (&mut canvas, &mut culling);
    let (counts, order) = job.run(&mut device, &plan, &mut buffers, &regions, on, progress)?;
    notes.extend(order.as_ref().map(Ordered::note));
    let resolving = Instant::now();
    let bytes_allocated = device.bytes_allocated();
    let film = options.film.then(|| canvas.film(subject, &options.frame)).transpose()?;
    let resolve = device.seconds.resolve + canvas.seconds + resolving.elapsed().as_secs_f64();
    let draw = device.seconds.draw + order.as_ref().map_or(0.0, Ordered::seconds);
    let seconds = Seconds { setup, draw, resolve, cull: culling.seconds, ..device.seconds };
    Ok(Rendering {
        image: canvas.image(),
        film,
        counts,
        roots: culling.roots,
        parts: regions.len(),
        sizes: *plan.sizes(),
        bytes_allocated,
        device: device_name,
        seconds,
        backend: options.backend,
        notes,
    })
}

/// The plan of a frame that is subdivided on a device, and what a user should be told about it.
pub(crate) fn plan_on<D: Device>(
    device: &D,
    scene: &Scene,
    options: &RenderOptions,
    frame: Frame,
) -> Result<(FramePlan, Vec<String>)> {
    let area = Area::of(&frame);
    let room = room_on(device, Extent::of(&frame, area.samples));
    let sizes = chosen_sizes(scene, options, room, area)?;
    let notes = note_on(options, &sizes, room).into_iter().collect();
    let plan = FramePlan::with_sizes(frame, sizes).map_err(Error::Plan)?.within(options.batch.budget());
    Ok((plan, notes))
}

/// Sizes with the largest batch that was asked for and that fits the budget and the device.
pub(crate) fn chosen_sizes(scene: &Scene, options: &RenderOptions, room: Room, area: Area) -> Result<Sizes> {
    let count = |len: usize| u32::try_from(len).unwrap_or(u32::MAX);
    let FrameOptions { width, height, levels, .. } = options.frame;
    let batch = match options.batch {
        Batch::Surfaces(batch) => batch,
        Batch::Memory(_) => DEFAULT_BATCH,
    };
    let (patches, records) = (count(scene.patch_count()), count(scene.record_count()));
    let objects = count(scene.objects.len());
    let (scheduler, capacity) = (options.scheduler, options.capacity);
    if capacity > 0 && !scheduler.has_capacity() {
        let problem = format!("the size of the stack of the {} scheduler cannot be chosen", scheduler.name());
        return Err(Error::scene(problem, "leave out --stack, or use --scheduler adaptive or local"));
    }
    let listed = options.cull.listed(patches);
    let sizes =
        Sizes { patches, records, objects, listed, batch, scheduler, capacity, levels, width, height, area }
            .checked();
    sizes.and_then(|sizes| sizes.fitted(Room { bytes: options.batch.budget(), ..room })).map_err(Error::Plan)
}

/// What the plan would allocate for a scene on a device without limits of its own.
///
/// # Errors
/// [`Error::Plan`] if it cannot be rendered so.
pub fn sizes_for(scene: &Scene, options: &RenderOptions) -> Result<Sizes> {
    let subject = Subject { scene, shot: Shot::of(scene), patches: &[] };
    Passes::new(subject, options)?.fitted(|_| Room::UNLIMITED).map(|(sizes, _)| sizes)
}

/// What the device leaves to the plan.
pub(crate) fn room_on<D: Device>(device: &D, extent: Extent) -> Room {
    Room {
        taken: device.own_bytes(extent),
        buffer_bytes: device.max_buffer_bytes(Sample::LAYOUT),
        patch_bytes: device.max_buffer_bytes(Patch::LAYOUT),
        ..Room::UNLIMITED
    }
}

/// Tells a user whose batch does not fit the device.
pub(crate) fn note_on(options: &RenderOptions, sizes: &Sizes, room: Room) -> Option<String> {
    let has_batch = !matches!(options.scheduler, Scheduler::Stack | Scheduler::Breadth);
    match options.batch {
        Batch::Surfaces(asked) if has_batch && asked > sizes.batch => Some(format!(
            "batches of {} surfaces instead of {asked}, so that no buffer is larger than the {} bytes that the \
             device binds at once; the image is the same",
            sizes.batch, room.buffer_bytes
        )),
        _ => None,
    }
}

/// Entries that are read at once.
const BLOCK: usize = 1 << 16;

/// The first entries of a buffer.
pub(crate) fn read_all<D: Device, T: Shared>(
    device: &mut D,
    buffer: &D::Buffer,
    count: usize,
) -> std::result::Result<Vec<T>, D::Error> {
    let mut all = vec![T::zeroed(); count];
    for (index, block) in all.chunks_mut(BLOCK).enumerate() {
        device.read(buffer, (index * BLOCK) as u64, block)?;
    }
    Ok(all)
}
