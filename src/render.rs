//! Rendering a scene: choice of device, the plan, the image, the statistics.

use std::time::Instant;

use micropoly_core::abi::{Frame, Patch, Sample, Shared};
use micropoly_core::backend::Device;
use micropoly_core::camera::{Camera, FrameOptions};
use micropoly_core::memory::{DEFAULT_BATCH, Room, Sizes};
use micropoly_core::render::{Buffers, Counts, FramePlan};
use micropoly_core::schedule::Scheduler;

use crate::backend::Backend;
use crate::error::{Error, Result};
use crate::film::Film;
use crate::image::{Encoder, Image};
use crate::scene::Scene;
use crate::timed::{Seconds, Timed};

/// Rows that are read from the device and encoded at once.
const RESOLVE_ROWS: u32 = 16;

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
    const fn budget(self) -> u64 {
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

/// Everything that can be chosen about a rendering.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderOptions {
    /// What renders. The image does not depend on it.
    pub backend: Backend,
    /// Number or part of the name of a device of the backend; its first one if there is nothing here.
    pub device: Option<String>,
    /// Image size, bound, dice rate, depth.
    pub frame: FrameOptions,
    /// Batch size or memory budget. The image does not depend on it.
    pub batch: Batch,
    /// How the stack is worked off. The image does not depend on it.
    pub scheduler: Scheduler,
    /// Entries of ADAPTIVE's stack; 0 = as many as it takes to be hardly ever slower than with more. The image
    /// does not depend on it.
    pub capacity: u32,
    /// Threads of the CPU backend; 0 = one a core. The image does not depend on it.
    pub threads: usize,
    /// Keep linear values, too: [`Rendering::film`].
    pub film: bool,
}

/// An image, and what it took.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The image.
    pub image: Image,
    /// Its linear values, if they were asked for.
    pub film: Option<Film>,
    /// What was counted on the way.
    pub counts: Counts,
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
    progress: impl FnMut(&Counts),
) -> Result<Rendering> {
    let start = Instant::now();
    let patches = scene.device_patches();
    let made = start.elapsed().as_secs_f64();
    let mut rendering =
        render_from(device, device_name, (scene, &scene.camera, &patches), options, progress)?;
    rendering.seconds.setup += made;
    Ok(rendering)
}

/// As [`render_on`], of these patches of the scene, which are all, seen by any camera.
pub(crate) fn render_from<D: Device>(
    device: &mut D,
    device_name: String,
    (scene, camera, patches): (&Scene, &Camera, &[Patch]),
    options: &RenderOptions,
    progress: impl FnMut(&Counts),
) -> Result<Rendering> {
    let start = Instant::now();
    let (frame, objects) = scene.view(camera, &options.frame)?;
    let (plan, notes) = plan_on(device, scene, options, frame)?;
    let sizes = *plan.sizes();
    let mut device = Timed::new(device);
    let failed = |error: D::Error| Error::on_device(&error);
    let mut buffers = plan.prepare(&mut device, &objects, patches).map_err(failed)?;
    let setup = start.elapsed().as_secs_f64();
    let counts = plan.run(&mut device, &mut buffers, progress).map_err(failed)?;
    let bytes_allocated = device.bytes_allocated();
    let resolving = Instant::now();
    let image = resolve(&mut device, &buffers.colours, scene, &options.frame).map_err(failed)?;
    let film = options.film.then(|| film_of(&mut device, &buffers, scene, &options.frame));
    let film = film.transpose().map_err(failed)?;
    let seconds = Seconds { setup, resolve: resolving.elapsed().as_secs_f64(), ..device.seconds };
    Ok(Rendering {
        image,
        film,
        counts,
        sizes,
        bytes_allocated,
        device: device_name,
        seconds,
        backend: options.backend,
        notes,
    })
}

/// The plan of a frame on a device, and what a user should be told about it.
pub(crate) fn plan_on<D: Device>(
    device: &D,
    scene: &Scene,
    options: &RenderOptions,
    frame: Frame,
) -> Result<(FramePlan, Vec<String>)> {
    let room = room_on(device, &options.frame);
    let sizes = chosen_sizes(scene, options, room)?;
    let notes = note_on(options, &sizes, room).into_iter().collect();
    let plan = FramePlan::with_sizes(frame, sizes).map_err(Error::Plan)?.within(options.batch.budget());
    Ok((plan, notes))
}

/// Sizes with the largest batch that was asked for and that fits the budget and the device.
fn chosen_sizes(scene: &Scene, options: &RenderOptions, room: Room) -> Result<Sizes> {
    let count = |len: usize| u32::try_from(len).unwrap_or(u32::MAX);
    let FrameOptions { width, height, levels, .. } = options.frame;
    let batch = match options.batch {
        Batch::Surfaces(batch) => batch,
        Batch::Memory(_) => DEFAULT_BATCH,
    };
    let (patches, faces) = (count(scene.patch_count()), count(scene.gregory_count()));
    let objects = count(scene.objects.len());
    let (scheduler, capacity) = (options.scheduler, options.capacity);
    if capacity > 0 && !scheduler.has_capacity() {
        let problem = format!("the size of the stack of the {} scheduler cannot be chosen", scheduler.name());
        return Err(Error::scene(problem, "leave out --stack, or use --scheduler adaptive or local"));
    }
    let sizes =
        Sizes { patches, faces, objects, batch, scheduler, capacity, levels, width, height }.checked();
    sizes.and_then(|sizes| sizes.fitted(Room { bytes: options.batch.budget(), ..room })).map_err(Error::Plan)
}

/// What the plan would allocate for a scene on a device without limits of its own.
///
/// # Errors
/// [`Error::Plan`] if it cannot be rendered so.
pub fn sizes_for(scene: &Scene, options: &RenderOptions) -> Result<Sizes> {
    chosen_sizes(scene, options, Room::UNLIMITED)
}

/// What the device leaves to the plan.
fn room_on<D: Device>(device: &D, options: &FrameOptions) -> Room {
    let FrameOptions { width, height, rate, .. } = *options;
    Room {
        taken: device.own_bytes(width, height, rate),
        buffer_bytes: device.max_buffer_bytes(Sample::LAYOUT),
        patch_bytes: device.max_buffer_bytes(Patch::LAYOUT),
        ..Room::UNLIMITED
    }
}

/// Tells a user whose batch does not fit the device.
fn note_on(options: &RenderOptions, sizes: &Sizes, room: Room) -> Option<String> {
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

/// Linear values of all samples.
fn film_of<D: Device>(
    device: &mut D,
    buffers: &Buffers<D::Buffer>,
    scene: &Scene,
    options: &FrameOptions,
) -> std::result::Result<Film, D::Error> {
    let FrameOptions { width, height, .. } = *options;
    let count = width as usize * height as usize;
    let colours = read_all(device, &buffers.colours, count)?;
    let samples = read_all(device, &buffers.samples, count)?;
    Ok(Film { width, height, background: scene.background, colours, samples })
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

fn resolve<D: Device>(
    device: &mut D,
    colours: &D::Buffer,
    scene: &Scene,
    options: &FrameOptions,
) -> std::result::Result<Image, D::Error> {
    let FrameOptions { width, height, .. } = *options;
    let encoder = Encoder::new(scene.background);
    let mut rgb = Vec::with_capacity(width as usize * height as usize * 3);
    let mut block = vec![bytemuck::Zeroable::zeroed(); (width * RESOLVE_ROWS.min(height)) as usize];
    for row in (0..height).step_by(RESOLVE_ROWS as usize) {
        let rows = RESOLVE_ROWS.min(height - row);
        let block = &mut block[..(width * rows) as usize];
        device.read(colours, u64::from(row) * u64::from(width), block)?;
        encoder.append(block, &mut rgb);
    }
    Ok(Image { width, height, rgb })
}
