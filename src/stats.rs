//! Statistics of one rendering as JSON that other programs can rely on.
//!
//! Fields are only ever added under the same `version`.

use micropoly_core::camera::Oracle;
use micropoly_core::memory::Sizes;
use micropoly_core::pattern::Window;
use micropoly_core::render::Load;
use serde::Serialize;

use crate::cull::Roots;
use crate::render::{Batch, RenderOptions, Rendering};
use crate::timed::Seconds;

/// The value of [`Stats::schema`].
pub const SCHEMA: &str = "micropoly-stats";
/// The value of [`Stats::version`].
pub const VERSION: u32 = 1;

/// What one rendering took.
#[derive(Clone, Debug, Serialize)]
pub struct Stats {
    /// Always [`SCHEMA`].
    pub schema: &'static str,
    /// Always [`VERSION`].
    pub version: u32,
    /// Version of the program.
    pub program: &'static str,
    /// The scene file.
    pub scene: String,
    /// Which backend rendered.
    pub backend: String,
    /// Which device.
    pub device: String,
    /// With which options.
    pub options: Options,
    /// Patches of the scene.
    pub patches: u64,
    /// Patches, by what became of them.
    pub roots: RootStats,
    /// Surfaces, by what became of them.
    pub surfaces: Surfaces,
    /// Micropolygons of all drawn surfaces.
    pub micropolygons: u64,
    /// Parts that the image was rendered in.
    pub parts: usize,
    /// Bytes that the device held.
    pub bytes_allocated: u64,
    /// Hash of the pixels before encoding.
    pub image_hash: String,
    /// Wall time by stage, in seconds.
    pub seconds: Seconds,
}

/// Counts of patches, in all parts of the image and all passes together.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RootStats {
    /// Patches that were bounded.
    pub taken: u64,
    /// Patches left out because they can touch no sample.
    pub outside: u64,
    /// Patches left out because they are behind what was drawn before.
    pub hidden: u64,
    /// Waves in which patches were taken; 0 where all were taken at once.
    pub waves: u64,
}

impl From<Roots> for RootStats {
    fn from(Roots { taken, outside, hidden, waves }: Roots) -> Self {
        Self { taken, outside, hidden, waves }
    }
}

/// Counts of surfaces.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Surfaces {
    /// Surfaces that were bounded.
    pub processed: u64,
    /// Surfaces that were diced.
    pub drawn: u64,
    /// Surfaces found invisible.
    pub culled: u64,
    /// Drawn surfaces that could not be split as far as the bound asks.
    pub depth_limited: u64,
    /// Largest number of surfaces that lay on the stack.
    pub max_stack: u64,
    /// The proven maximum of it; BREADTH has none.
    pub stack_bound: Option<u64>,
    /// Batches that were taken; of LOCAL, rounds.
    pub batches: u64,
    /// How LOCAL's groups shared the work.
    pub load: Option<LoadStats>,
}

/// Surfaces bounded by LOCAL's groups.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LoadStats {
    /// Number of groups.
    pub groups: u32,
    /// Of the group that bounded fewest.
    pub least: u32,
    /// Of a group on average.
    pub mean: f64,
    /// Of the group that bounded most.
    pub most: u32,
}

impl From<Load> for LoadStats {
    fn from(load: Load) -> Self {
        let Load { groups, least, most, total } = load;
        Self { groups, least, mean: total as f64 / f64::from(groups), most }
    }
}

/// Options, as they took effect.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Options {
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Largest extent of a drawn surface, pixels.
    pub bound: f32,
    /// Most micropolygons a side of a drawn surface.
    pub dice: u32,
    /// Length of a micropolygon in pixels.
    pub micropolygon_size: f32,
    /// When surfaces were split no further.
    pub oracle: &'static str,
    /// How far what was drawn might be from the surface, pixels, if they had to be flat.
    pub tolerance: Option<f32>,
    /// How grids meet.
    pub borders: &'static str,
    /// Levels.
    pub max_depth: u32,
    /// How the stack was worked off.
    pub scheduler: &'static str,
    /// Surfaces a batch.
    pub batch: u32,
    /// The memory budget in bytes, if one was given.
    pub memory: Option<u64>,
    /// Threads asked for; 0 = one a core.
    pub threads: usize,
    /// Were grids skipped that show only their back?
    pub cull_backfaces: bool,
    /// Rules by which surfaces were culled and split.
    pub profile: &'static str,
    /// Samples of a pixel.
    pub samples: u32,
    /// How samples became pixels.
    pub filter: &'static str,
    /// How far the filter reached, pixels.
    pub filter_radius: f64,
    /// From where colours came within a micropolygon.
    pub shading: &'static str,
    /// How grids got to their samples.
    pub rasteriser: &'static str,
    /// How what can be seen through was put into order.
    pub transparency: &'static str,
    /// Pixels a side of a tile; 0 = as the device liked it.
    pub tile: u32,
    /// Which patches were left out.
    pub cull: &'static str,
    /// The pixels that were rendered: left, top, right, bottom, if not all.
    pub crop: Option<[u32; 4]>,
}

impl Stats {
    /// Statistics of a rendering of `scene`; `seconds` may have more in it than the rendering knows.
    #[must_use]
    pub fn new(scene: &str, options: &RenderOptions, rendering: &Rendering, seconds: Seconds) -> Self {
        let Rendering { image, counts, sizes, bytes_allocated, device, .. } = rendering;
        Self {
            schema: SCHEMA,
            version: VERSION,
            program: env!("CARGO_PKG_VERSION"),
            scene: scene.to_owned(),
            backend: rendering.backend.name().to_owned(),
            device: device.clone(),
            options: effective(options, sizes),
            patches: u64::from(sizes.patches),
            roots: rendering.roots.into(),
            surfaces: Surfaces {
                processed: counts.processed,
                drawn: counts.drawn,
                culled: counts.culled,
                depth_limited: counts.depth_limited,
                max_stack: counts.max_stack,
                stack_bound: sizes.stack_bound(),
                batches: counts.batches,
                load: counts.load.map(LoadStats::from),
            },
            micropolygons: counts.micropolygons,
            parts: rendering.parts,
            bytes_allocated: *bytes_allocated,
            image_hash: image.hash(),
            seconds,
        }
    }
}

fn effective(options: &RenderOptions, sizes: &Sizes) -> Options {
    let frame = options.frame;
    Options {
        width: frame.width,
        height: frame.height,
        bound: frame.bound,
        dice: frame.rate,
        micropolygon_size: frame.size,
        oracle: frame.oracle.name(),
        tolerance: (frame.oracle == Oracle::Flatness).then_some(frame.tolerance),
        borders: frame.borders.name(),
        max_depth: frame.levels,
        scheduler: sizes.scheduler.name(),
        batch: sizes.batch,
        memory: match options.batch {
            Batch::Memory(bytes) => Some(bytes),
            Batch::Surfaces(_) => None,
        },
        threads: options.threads,
        cull_backfaces: frame.cull_backfaces,
        profile: frame.profile.name(),
        samples: frame.samples.count(),
        filter: options.filter.kernel.name(),
        filter_radius: options.filter.radius,
        shading: frame.shading.name(),
        rasteriser: frame.rasteriser.name(),
        transparency: options.transparency.name(),
        tile: frame.tile,
        cull: options.cull.name(),
        crop: options.crop.map(|Window { left, right, top, bottom }| [left, top, right, bottom]),
    }
}
