//! Arguments and options, checked as they are read.

use std::path::PathBuf;
use std::sync::Mutex;

use bytesize::ByteSize;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum, value_parser};
use micropoly::bench::Views;
use micropoly::cage::{MOST_LEVELS, Options};
use micropoly::core::abi::{MAX_LEVELS, MAX_RATE, MAX_RESOLUTION};
use micropoly::core::accel::bsp::polygon::MOST_SLABS;
use micropoly::core::memory::{DEFAULT_BATCH, MAX_BATCH};
use micropoly::core::reconstruction::{MAX_RADIUS, MIN_RADIUS};
use micropoly::cull::Cull;
use micropoly::diff::Thresholds;
use micropoly::mesh::Format;
use micropoly::{
    Backend, Batch, Blur, Borders, Error, Filter, FrameOptions, Kernel, Lens, Oracle, Ordering, Profile,
    Rasteriser, Reading, RenderOptions, Samples, Scene, Scheduler, Shading, Transparency, Window, extension,
};

#[cfg(feature = "cpu")]
use super::accel::AccelArguments;
use super::eval::{BoundaryChoice, EvalArguments};
use super::levels::LevelArguments;
use super::progress::Progress;
use super::tess_pattern::TessPatternArguments;

/// Reyes micropolygon renderer: the same bits on every device.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a PNG or EXR file.
    Render(RenderArguments),
    /// Write a scene as a mesh of triangles, as fine as its camera needs them, without a crack.
    Tessellate(TessellateArguments),
    /// Say what is in a scene and how much memory a frame of it can need.
    Info(InfoArguments),
    /// List every device of every backend, with driver and limits.
    Devices,
    /// Compare two pictures, value by value; exit code 3 says that they differ by more than is allowed.
    Diff(DiffArguments),
    /// Find out, device by device and stage by stage, whether all devices give the same bits.
    Conform(ConformArguments),
    /// Say where the surface of a cage is at some of its places.
    Eval(EvalArguments),
    /// Say what the tessellator makes of levels: lines of JSON in, lines of JSON out, to be compared with drivers.
    TessPattern(TessPatternArguments),
    /// Build a tree over the triangles of a mesh, and ask it what is seen.
    #[cfg(feature = "cpu")]
    Accel(AccelArguments),
    /// Measure subdivision: scheduler × batch × scene × backend (Weber 2014, Table 7.2).
    Bench(BenchArguments),
}

/// What is read, and how.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// Scene file (.toml, .mscene, .rib) or file of geometry (.obj, .bpt).
    pub(crate) scene: PathBuf,
    /// Levels of refinement of Catmull-Clark cages around what is not regular.
    #[arg(long, value_name = "N", default_value_t = Options::default().levels,
          value_parser = value_parser!(u32).range(0..=i64::from(MOST_LEVELS)))]
    cc_levels: u32,
    /// How the surfaces of cages end. [default: as the file says, else edge_and_corner]
    #[arg(long, value_enum)]
    boundary: Option<BoundaryChoice>,
    /// Draw the polygons of .obj files as they are, not as Catmull-Clark cages.
    #[arg(long, conflicts_with_all = ["cc_levels", "boundary"])]
    polygons: bool,
}

impl SceneArguments {
    /// Reads the scene, and says what of it is not drawn.
    pub(crate) fn load(&self, style: ProgressStyle) -> micropoly::Result<Scene> {
        let reading = Reading {
            cage: Options { levels: self.cc_levels },
            boundary: self.boundary.map(Into::into),
            polygons: self.polygons,
        };
        let progress = Mutex::new(Progress::new(style, 100, "per cent"));
        let scene = Scene::load_with(&self.scene, &reading, &|share| {
            if let Ok(mut progress) = progress.lock() {
                progress.update((share * 100.0) as u64, || "refining".to_owned());
            }
        })?;
        if let Ok(mut progress) = progress.lock() {
            progress.finish();
        }
        for note in &scene.notes {
            eprintln!("note: {note}");
        }
        Ok(scene)
    }
}

#[derive(Debug, Args)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Image file to write: .png, or .exr with linear colour, coverage, depth, normal, uv, patch and number of samples. With
    /// --frames, # in its name stands for the number of the frame (#### for at least four digits).
    #[arg(short, long, value_name = "FILE", value_parser = image_path)]
    pub(crate) output: PathBuf,
    /// Bits a value: 8 or 16 in PNG files, 16 or 32 in EXR files.
    #[arg(long, value_name = "8|16|32", value_parser = bits)]
    pub(crate) bits: Option<u32>,
    /// Render these frames of the animation (the camera's path, objects that move), A to B, both included.
    #[arg(long, value_name = "A..B", value_parser = frames, conflicts_with = "stats")]
    pub(crate) frames: Option<(u32, u32)>,
    /// Render only these pixels: those from column X0 and row Y0 up to, but without, column X1 and row Y1. They are the
    /// same as in the whole image.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<Window>,
    /// How samples become pixels; mitchell sharpens.
    #[arg(long, value_enum, default_value_t = FilterChoice::Box)]
    filter: FilterChoice,
    /// How far the filter reaches from the middle of a pixel, in pixels, from 0.5 to 4. [default: box 0.5, triangle 1,
    /// gaussian 1.5, mitchell 2]
    #[arg(long, value_name = "PIXELS", value_parser = radius)]
    filter_radius: Option<f64>,
    /// How long the shutter is open, in frames: what moves is blurred. [default: the scene's, else 0]
    #[arg(long, value_name = "FRAMES", value_parser = shutter)]
    shutter: Option<f64>,
    /// The lens's f-number: what is not in focus is blurred, the more the smaller it is. [default: the scene's, else no
    /// lens]
    #[arg(long, value_name = "N", value_parser = above_zero)]
    fstop: Option<f64>,
    /// Distance that is in focus, in scene units. [default: the scene's]
    #[arg(long, value_name = "DISTANCE", value_parser = above_zero)]
    focus: Option<f64>,
    /// Which patches are left out before they are bounded. The image does not depend on it.
    #[arg(long, value_enum, default_value_t = CullChoice::None)]
    cull: CullChoice,
    /// Patches that --cull occlusion draws before it looks again at what they hide. The image does not depend on it. [default:
    /// as many as pay]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u32).range(1..))]
    wave: Option<u32>,
    #[command(flatten)]
    transparency: TransparencyArguments,
    #[command(flatten)]
    pub(crate) frame: FrameArguments,
    /// Write statistics as JSON to this file; - writes to standard output.
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// How to show progress on standard error: a bar on a terminal, plain lines, or nothing.
    #[arg(long, value_enum, default_value_t = ProgressStyle::Auto)]
    pub(crate) progress: ProgressStyle,
    /// What to render on. The image does not depend on it.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,
    /// Number or part of the name of a device of the backend (see `micropoly devices`).
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
}

impl RenderArguments {
    pub(crate) fn options(&self) -> RenderOptions {
        let (device, crop) = (self.device.clone(), self.crop);
        let filter = Filter::of(self.filter.into());
        let filter = Filter { radius: self.filter_radius.unwrap_or(filter.radius), ..filter };
        let transparency = self.transparency.chosen();
        let (cull, wave) = (self.cull.into(), self.wave.unwrap_or(0));
        RenderOptions {
            backend: self.backend.into(),
            device,
            crop,
            filter,
            transparency,
            cull,
            wave,
            ..self.frame.options()
        }
    }

    /// Shutter and lens: the scene's own, but for what was given.
    pub(crate) fn blur(&self, scene: &Scene) -> Result<Blur, Error> {
        let own = scene.blur;
        let fstop = self.fstop.or(own.lens.map(|lens| lens.fstop));
        let focus = self.focus.or(own.lens.map(|lens| lens.focus));
        let lens = match (fstop, focus) {
            (Some(fstop), Some(focus)) => Some(Lens { fstop, focus }),
            (None, None) => None,
            _ => {
                let problem = "a lens needs an f-number and a distance in focus, and the scene has neither";
                return Err(Error::scene(problem, "give both --fstop and --focus"));
            }
        };
        Ok(Blur { shutter: self.shutter.unwrap_or(own.shutter), lens, ..own })
    }
}

/// How what can be seen through is put into order.
#[derive(Debug, Args)]
struct TransparencyArguments {
    /// Layers are found sample by sample, as many passes as there are layers; order sorts the triangles of meshes drawn as
    /// polygons once and blends them in one pass.
    #[arg(long, value_enum, default_value_t = TransparencyChoice::Layers)]
    transparency: TransparencyChoice,
    /// Cells along each axis of the grid for --transparency order. The image does not depend on it. [default: chosen from
    /// the number of triangles]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(MOST_SLABS)))]
    bsp_grid: Option<u32>,
    /// Do not cut triangles that reach beyond a plane by no more than this share of the scene's longest side: faster, and no
    /// longer exact.
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = from_zero)]
    bsp_tolerance: f64,
}

impl TransparencyArguments {
    fn chosen(&self) -> Transparency {
        match self.transparency {
            TransparencyChoice::Layers => Transparency::Layers,
            TransparencyChoice::Order => {
                Transparency::Order(Ordering { grid: self.bsp_grid, tolerance: self.bsp_tolerance })
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TransparencyChoice {
    /// Whatever there is to see.
    Layers,
    /// Triangle meshes.
    Order,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("by_scene").multiple(true).args([
    "cc_levels", "boundary", "micropolygon_size", "dice", "max_depth", "visible", "oracle", "tolerance",
]))]
pub(crate) struct TessellateArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Mesh file to write (.obj, .ply or .glb), or `none`, which makes a mesh by levels and keeps it to itself.
    #[arg(short, long, value_name = "FILE", value_parser = mesh_path)]
    pub(crate) output: (PathBuf, Option<Format>),
    /// Size in pixels of the image that the mesh is meant for.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720", value_parser = resolution)]
    pub(crate) res: (u32, u32),
    /// Longest side of a micropolygon on screen, in pixels; each becomes two triangles.
    #[arg(long, value_name = "PIXELS", default_value = "1", allow_negative_numbers = true, value_parser = pixels)]
    micropolygon_size: f32,
    /// Most micropolygons a side of a surface, from 1 to 16.
    #[arg(long, value_name = "N", default_value = "16", allow_negative_numbers = true,
          value_parser = value_parser!(u32).range(1..=i64::from(MAX_RATE)))]
    dice: u32,
    #[command(flatten)]
    oracle: OracleArguments,
    /// Levels of subdivision: a patch is halved at most N - 1 times.
    #[arg(long, value_name = "N", default_value = "41", allow_negative_numbers = true,
          value_parser = value_parser!(u32).range(1..=i64::from(MAX_LEVELS)))]
    max_depth: u32,
    /// Only what the camera can see. Otherwise the mesh is whole, and what is out of view is as fine as if the
    /// camera had turned to it.
    #[arg(long)]
    visible: bool,
    /// Count the edges that are not shared by two triangles. The mesh is kept in main memory for that, with `-o none`, too.
    #[arg(long)]
    pub(crate) check: bool,
    /// What to tessellate on. The mesh does not depend on it.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    pub(crate) backend: BackendChoice,
    /// Number or part of the name of a device of the backend (see `micropoly devices`).
    #[arg(long, value_name = "N|NAME")]
    pub(crate) device: Option<String>,
    #[command(flatten)]
    pub(crate) levels: LevelArguments,
}

impl TessellateArguments {
    pub(crate) fn options(&self) -> RenderOptions {
        let device = self.device.clone();
        RenderOptions {
            frame: self.frame(),
            backend: self.backend.into(),
            device,
            ..RenderOptions::default()
        }
    }

    fn frame(&self) -> FrameOptions {
        let (width, height) = self.res;
        FrameOptions {
            width,
            height,
            bound: self.dice as f32 * self.micropolygon_size,
            rate: self.dice,
            size: self.micropolygon_size,
            oracle: self.oracle.oracle.into(),
            tolerance: self.oracle.tolerance(),
            levels: self.max_depth,
            whole: !self.visible,
            ..FrameOptions::default()
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    #[command(flatten)]
    pub(crate) frame: FrameArguments,
}

#[derive(Debug, Args)]
pub(crate) struct DiffArguments {
    /// A picture: PNG (8 or 16 bits) or EXR.
    pub(crate) first: PathBuf,
    /// Another one of the same size and kind.
    pub(crate) second: PathBuf,
    /// A pixel fails if one of its values differs by more than this; values of PNG files run from 0 to 1.
    #[arg(long, value_name = "X", default_value = "0", value_parser = from_zero)]
    fail: f64,
    /// So many per cent of the pixels may fail.
    #[arg(long, value_name = "P", default_value = "0", value_parser = from_zero)]
    fail_percent: f64,
    /// No value of any pixel may differ by more than this, however few do.
    #[arg(long, value_name = "X", default_value = "inf", value_parser = from_zero)]
    hard_fail: f64,
    /// Write a picture of the differences (.png): black where there is none, then blue, red, yellow, white.
    #[arg(long, value_name = "FILE", value_parser = png_path)]
    pub(crate) heat: Option<PathBuf>,
    /// The difference that is white in that picture.
    #[arg(long, value_name = "X", default_value = "0.1", value_parser = above_zero)]
    pub(crate) white: f64,
    /// Write the result as JSON to this file instead; - writes to standard output.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

impl DiffArguments {
    pub(crate) fn thresholds(&self) -> Thresholds {
        let Self { fail, fail_percent, hard_fail, .. } = *self;
        Thresholds { fail, fail_percent, hard_fail }
    }
}

pub(crate) fn from_zero(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| *x >= 0.0).ok_or_else(|| "give a number from 0".to_owned())
}

fn above_zero(text: &str) -> Result<f64, String> {
    from_zero(text)
        .ok()
        .filter(|x| *x > 0.0 && x.is_finite())
        .ok_or_else(|| "give a number above 0".to_owned())
}

#[derive(Debug, Args)]
pub(crate) struct ConformArguments {
    /// Scenes to render besides the built-in ones.
    pub(crate) scenes: Vec<PathBuf>,
    /// Which devices to compare with the CPU: `all`, or those of one backend, which must then have some.
    #[arg(long, value_enum, default_value_t = Compared::All)]
    pub(crate) backend: Compared,
    /// Write the report as JSON to this file; - writes to standard output.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write pictures of what differs (expected, actual, difference) to this folder.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub(crate) pictures: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct BenchArguments {
    /// Scenes to measure; without any, the built-in hair, columns, city and eye split.
    pub(crate) scenes: Vec<PathBuf>,
    /// Which devices to measure on: `all`, or those of one backend.
    #[arg(long, value_enum, default_value_t = Compared::Cpu)]
    pub(crate) backend: Compared,
    /// Measure dicing instead, on the CPU: lengths and number of micropolygons, and what watertight borders cost.
    #[arg(long, conflicts_with_all = ["path", "at", "plot", "csv"])]
    pub(crate) dicing: bool,
    /// Measure rasterising instead, step by step (Eisenacher & Loop 2010, Table 1): tile sizes × bound × samples, and
    /// sort-last to compare with. Without a scene: the built-in teapot.
    #[arg(long, conflicts_with_all = ["path", "at", "plot", "csv", "dicing"])]
    pub(crate) raster: bool,
    /// Measure culling of whole patches instead: each way to cull, and how many times fewer surfaces and less time that takes.
    /// Without a scene: scenes/city.toml.
    #[arg(long, conflicts_with_all = ["path", "at", "plot", "csv", "dicing", "raster"])]
    pub(crate) culling: bool,
    /// Measure how cages become patches instead: regular tori, tori with extraordinary vertices, and triangles.
    #[arg(long, conflicts_with_all = ["path", "at", "plot", "csv", "dicing", "raster", "culling", "scenes"])]
    pub(crate) cage: bool,
    /// Measure the tessellator instead: meshes × levels (Stadlbauer 2019, ch. 6), within --memory (256 MiB unless given).
    #[arg(long, conflicts_with_all = ["path", "at", "plot", "csv", "dicing", "raster", "culling", "cage", "scenes"])]
    pub(crate) tess: bool,
    /// Measure transparency order instead: grids × tolerances (Imre 2016, Table 6.1), of the meshes (.obj) that are given,
    /// or a built-in torus.
    #[cfg(feature = "cpu")]
    #[arg(long, conflicts_with_all = ["path", "at", "plot", "csv", "dicing", "raster", "cage", "tess"])]
    pub(crate) bsp: bool,
    /// Measure how trees over the triangles of this mesh are built instead, on the CPU, beside the `obvhs` crate's fastest
    /// preset.
    #[cfg(feature = "cpu")]
    #[arg(long, value_name = "MESH.obj",
          conflicts_with_all = ["path", "at", "plot", "csv", "dicing", "raster", "cage", "tess", "scenes"])]
    pub(crate) accel: Option<PathBuf>,
    /// Measure along the camera's path of each scene, and say at which frame breadth needs most memory: the
    /// spike view. Without a scene: the built-in city.
    #[arg(long, conflicts_with = "at")]
    pub(crate) path: bool,
    /// Views along the path, evenly spaced from its first frame to its last.
    #[arg(long, value_name = "N", default_value = "61", requires = "path",
          value_parser = value_parser!(u32).range(1..=100_000))]
    pub(crate) views: u32,
    /// Measure the view at this frame of the camera's path.
    #[arg(long = "frame", value_name = "T", allow_negative_numbers = true)]
    pub(crate) at: Option<f64>,
    /// Schedulers to measure, separated by commas.
    #[arg(
        long = "schedulers",
        value_enum,
        value_delimiter = ',',
        value_name = "LIST",
        default_value = "breadth,bounded,local,adaptive"
    )]
    pub(crate) chosen: Vec<SchedulerChoice>,
    /// Batch sizes of those schedulers that have one, separated by commas [default: 256,1024,4096,16384; along
    /// a path 4096].
    #[arg(long = "batches", value_delimiter = ',', value_name = "LIST",
          value_parser = value_parser!(u32).range(1..=i64::from(MAX_BATCH)))]
    batches: Vec<u32>,
    /// Runs of each; the shortest counts.
    #[arg(long, value_name = "N", default_value = "3", value_parser = value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,
    /// Write the table as JSON to this file; - writes to standard output.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write the table as comma-separated values to this file.
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Plot to this SVG file, a curve a scheduler, of the first scene: rate over memory (Weber 2014, Fig. 7.2), or
    /// along a path memory over frames (his Fig. 7.1).
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) frame: FrameArguments,
}

impl BenchArguments {
    pub(crate) const fn views(&self) -> Views {
        match (self.path, self.at) {
            (true, _) => Views::Path(self.views),
            (false, Some(frame)) => Views::Frame(frame),
            (false, None) => Views::Camera,
        }
    }

    pub(crate) fn batches(&self) -> Vec<u32> {
        match (self.batches.is_empty(), self.path) {
            (false, _) => self.batches.clone(),
            (true, false) => vec![256, 1024, 4096, 16384],
            (true, true) => vec![DEFAULT_BATCH],
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Compared {
    /// Every device that is found.
    All,
    /// The CPU, with another number of threads.
    Cpu,
    /// GPUs through wgpu.
    Wgpu,
    /// OpenCL devices.
    Ocl,
}

/// What a frame is to be like, and how it is worked on.
#[derive(Debug, Args)]
pub(crate) struct FrameArguments {
    /// Image size in pixels.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720", value_parser = resolution)]
    res: (u32, u32),
    /// Split surfaces until they are at most this many pixels long; unless given, as long as --dice micropolygons
    /// are. [8 for --profile weber2014]
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels)]
    bound: Option<f32>,
    /// Most micropolygons a side of a drawn surface, from 1 to 16. [default: 16; 8 for --profile weber2014]
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = value_parser!(u32).range(1..=i64::from(MAX_RATE)))]
    dice: Option<u32>,
    /// Length of a micropolygon in pixels; larger where --dice of them would not be as long as --bound.
    #[arg(long, value_name = "PIXELS", default_value = "1", allow_negative_numbers = true, value_parser = pixels)]
    micropolygon_size: f32,
    #[command(flatten)]
    oracle: OracleArguments,
    /// How the grids of neighbouring surfaces meet; all but watertight leave cracks, and are there to compare with.
    #[arg(long, value_enum, default_value_t = BordersChoice::Watertight)]
    borders: BordersChoice,
    /// Levels of subdivision: a patch is halved at most N - 1 times; where that is too few there can be cracks.
    /// [default: 41; 23 for --profile weber2014]
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = value_parser!(u32).range(1..=i64::from(MAX_LEVELS)))]
    max_depth: Option<u32>,
    /// Surfaces worked on at once. The image does not depend on it.
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with = "memory",
          value_parser = value_parser!(u32).range(1..=i64::from(MAX_BATCH)))]
    batch: Option<u32>,
    /// Memory that the device may use, for example 64MiB; breadth ends in an error once it needs more. The image
    /// does not depend on it.
    #[arg(long, value_name = "BYTES", allow_negative_numbers = true, value_parser = bytes)]
    pub(crate) memory: Option<u64>,
    /// How the stack of surfaces is worked off. The image does not depend on it.
    #[arg(long, value_enum, default_value_t = SchedulerChoice::Adaptive)]
    scheduler: SchedulerChoice,
    /// Entries of the stack for --scheduler adaptive or local; as many as there are levels are enough. The image
    /// does not depend on it.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u32).range(1..))]
    stack: Option<u32>,
    /// Threads of the CPU backend; 0 = one a core. The image does not depend on it.
    #[arg(long, value_name = "N", default_value = "0", allow_negative_numbers = true,
          value_parser = value_parser!(u16).range(0..=1024))]
    pub(crate) threads: u16,
    /// Rules by which surfaces are culled and split: those of Weber's program are for comparison, and leave holes.
    #[arg(long, value_enum, default_value_t = ProfileChoice::Conservative)]
    profile: ProfileChoice,
    /// Skip grids of micropolygons that show only their back (closed objects look the same).
    #[arg(long)]
    cull_backfaces: bool,
    /// Samples a pixel: 1, 4, 16 or 64.
    #[arg(long, value_name = "N", default_value = "1", value_parser = samples)]
    samples: Samples,
    /// One colour a micropolygon, or colours interpolated between its vertices.
    #[arg(long, value_enum, default_value_t = ShadingChoice::Flat)]
    shading: ShadingChoice,
    /// How grids of micropolygons get to their samples. The image does not depend on it.
    #[arg(long, value_enum, default_value_t = RasteriserChoice::SortMiddle)]
    rasteriser: RasteriserChoice,
    /// Pixels a side of a tile of the sort-middle rasteriser: 4, 8, 16 or 32. The image does not depend on it. [default:
    /// what suits the device]
    #[arg(long, value_name = "N", value_parser = tile)]
    tile: Option<u32>,
}

impl FrameArguments {
    fn is_weber(&self) -> bool {
        self.profile == ProfileChoice::Weber2014
    }

    /// To compare subdivision with what Weber published: surfaces of 8 pixels, unless others are asked for.
    pub(crate) fn options_as_published(&self) -> RenderOptions {
        let mut options = self.options();
        options.frame.bound = self.bound.unwrap_or(8.0);
        options
    }

    pub(crate) fn options(&self) -> RenderOptions {
        let (width, height) = self.res;
        let batch = match (self.batch, self.memory) {
            (Some(batch), _) => Batch::Surfaces(batch),
            (None, Some(bytes)) => Batch::Memory(bytes),
            (None, None) => Batch::default(),
        };
        let rate = self.dice.unwrap_or(if self.is_weber() { 8 } else { MAX_RATE });
        let bound = if self.is_weber() { 8.0 } else { rate as f32 * self.micropolygon_size };
        let frame = FrameOptions {
            width,
            height,
            bound: self.bound.unwrap_or(bound),
            rate,
            size: self.micropolygon_size,
            oracle: self.oracle.oracle.into(),
            tolerance: self.oracle.tolerance(),
            borders: self.borders.into(),
            levels: self.max_depth.unwrap_or(if self.is_weber() { 23 } else { MAX_LEVELS }),
            cull_backfaces: self.cull_backfaces,
            whole: false,
            profile: self.profile.into(),
            samples: self.samples,
            shading: self.shading.into(),
            rasteriser: self.rasteriser.into(),
            tile: self.tile.unwrap_or(0),
        };
        RenderOptions {
            frame,
            batch,
            scheduler: self.scheduler.into(),
            capacity: self.stack.unwrap_or(0),
            threads: usize::from(self.threads),
            ..RenderOptions::default()
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SchedulerChoice {
    /// One surface at a time, depth first.
    Stack,
    /// All surfaces of a level at once; memory grows with the scene.
    Breadth,
    /// Batches of fixed size (Weber 2014).
    Bounded,
    /// Groups with small stacks of their own, between which surfaces are dealt out again and again.
    Local,
    /// As many as are safe for the stack, however small it is.
    Adaptive,
}

impl Compared {
    /// The one backend that is meant, or none for all.
    pub(crate) const fn only(self) -> Option<Backend> {
        match self {
            Self::All => None,
            Self::Cpu => Some(Backend::Cpu),
            Self::Wgpu => Some(Backend::Wgpu),
            Self::Ocl => Some(Backend::Ocl),
        }
    }
}

impl From<SchedulerChoice> for Scheduler {
    fn from(choice: SchedulerChoice) -> Self {
        match choice {
            SchedulerChoice::Stack => Self::Stack,
            SchedulerChoice::Breadth => Self::Breadth,
            SchedulerChoice::Bounded => Self::Bounded,
            SchedulerChoice::Local => Self::Local,
            SchedulerChoice::Adaptive => Self::Adaptive,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProfileChoice {
    /// Nothing visible is lost.
    Conservative,
    /// As Weber's program of 2014 does it.
    #[value(name = "weber2014")]
    Weber2014,
}

/// When a surface is split no further.
#[derive(Debug, Args)]
struct OracleArguments {
    /// When a surface is split no further: when it is no longer than --bound or --dice allow, then it is diced; or when it is
    /// flat, then it is one micropolygon.
    #[arg(long, value_enum, default_value_t = OracleChoice::Size)]
    oracle: OracleChoice,
    /// How far what is drawn may be from the surface, for --oracle flatness. [default: 0.5]
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels, requires = "oracle")]
    tolerance: Option<f32>,
}

impl OracleArguments {
    fn tolerance(&self) -> f32 {
        self.tolerance.unwrap_or(FrameOptions::default().tolerance)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum OracleChoice {
    /// No longer than --bound.
    Size,
    /// As flat as --tolerance.
    Flatness,
}

impl From<OracleChoice> for Oracle {
    fn from(choice: OracleChoice) -> Self {
        match choice {
            OracleChoice::Size => Self::Size,
            OracleChoice::Flatness => Self::Flatness,
        }
    }
}

impl From<ProfileChoice> for Profile {
    fn from(choice: ProfileChoice) -> Self {
        match choice {
            ProfileChoice::Conservative => Self::Conservative,
            ProfileChoice::Weber2014 => Self::Weber2014,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BordersChoice {
    /// They have the same vertices on their common side: no cracks.
    Watertight,
    /// Each is regular up to its border.
    Naive,
    /// As naive, and all have as many micropolygons as --dice says (Weber 2014).
    Fixed,
}

impl From<BordersChoice> for Borders {
    fn from(choice: BordersChoice) -> Self {
        match choice {
            BordersChoice::Watertight => Self::Watertight,
            BordersChoice::Naive => Self::Naive,
            BordersChoice::Fixed => Self::Fixed,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShadingChoice {
    /// One colour a micropolygon.
    Flat,
    /// Colours are interpolated between vertices.
    Smooth,
}

impl From<ShadingChoice> for Shading {
    fn from(choice: ShadingChoice) -> Self {
        match choice {
            ShadingChoice::Flat => Self::Flat,
            ShadingChoice::Smooth => Self::Smooth,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RasteriserChoice {
    /// Sorted into tiles, whose samples are found together.
    SortMiddle,
    /// One by one, merged without locks.
    SortLast,
}

impl From<RasteriserChoice> for Rasteriser {
    fn from(choice: RasteriserChoice) -> Self {
        match choice {
            RasteriserChoice::SortMiddle => Self::SortMiddle,
            RasteriserChoice::SortLast => Self::SortLast,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CullChoice {
    /// None.
    None,
    /// Those that can touch no sample.
    Frustum,
    /// Those, too, that are behind what has been drawn before.
    Occlusion,
}

impl From<CullChoice> for Cull {
    fn from(choice: CullChoice) -> Self {
        match choice {
            CullChoice::None => Self::None,
            CullChoice::Frustum => Self::Frustum,
            CullChoice::Occlusion => Self::Occlusion,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FilterChoice {
    /// All samples count alike.
    Box,
    /// The nearer, the more.
    Triangle,
    /// A bell.
    Gaussian,
    /// A cubic that sharpens.
    Mitchell,
}

impl From<FilterChoice> for Kernel {
    fn from(choice: FilterChoice) -> Self {
        match choice {
            FilterChoice::Box => Self::Box,
            FilterChoice::Triangle => Self::Triangle,
            FilterChoice::Gaussian => Self::Gaussian,
            FilterChoice::Mitchell => Self::Mitchell,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProgressStyle {
    /// A bar if standard error is a terminal, else plain lines.
    Auto,
    /// A line now and then.
    Plain,
    /// Nothing.
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BackendChoice {
    /// The best that is there.
    Auto,
    /// The CPU.
    Cpu,
    /// A GPU through wgpu.
    Wgpu,
    /// An OpenCL device.
    Ocl,
}

impl From<BackendChoice> for Backend {
    fn from(choice: BackendChoice) -> Self {
        match choice {
            BackendChoice::Auto => Self::Auto,
            BackendChoice::Cpu => Self::Cpu,
            BackendChoice::Wgpu => Self::Wgpu,
            BackendChoice::Ocl => Self::Ocl,
        }
    }
}

fn png_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if extension(&path) == "png" {
        Ok(path)
    } else {
        Err("only PNG images can be written: choose a name that ends in .png".into())
    }
}

fn image_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match extension(&path).as_str() {
        "png" | "exr" => Ok(path),
        _ => Err("only PNG and EXR images can be written: choose a name that ends in .png or .exr".into()),
    }
}

fn crop(text: &str) -> Result<Window, String> {
    let numbers: Vec<u32> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match (numbers.as_slice(), text.split(',').count()) {
        (&[left, top, right, bottom], 4) if left < right && top < bottom => {
            Ok(Window { left, right, top, bottom })
        }
        _ => Err("write four numbers of pixels: left,top,right,bottom, for example 100,50,200,150".into()),
    }
}

fn samples(text: &str) -> Result<Samples, String> {
    let count = text.parse().ok();
    count.and_then(Samples::of_count).ok_or_else(|| "choose 1, 4, 16 or 64".to_owned())
}

fn tile(text: &str) -> Result<u32, String> {
    text.parse()
        .ok()
        .filter(|side| [4, 8, 16, 32].contains(side))
        .ok_or_else(|| "choose 4, 8, 16 or 32".to_owned())
}

fn radius(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|radius| (MIN_RADIUS..=MAX_RADIUS).contains(radius))
        .ok_or_else(|| format!("choose a number of pixels from {MIN_RADIUS} to {MAX_RADIUS}"))
}

fn shutter(text: &str) -> Result<f64, String> {
    from_zero(text).ok().filter(|s| *s <= 1.0e6).ok_or_else(|| "give a number of frames from 0".to_owned())
}

fn bits(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|bits| [8, 16, 32].contains(bits)).ok_or_else(|| "choose 8, 16 or 32".to_owned())
}

fn frames(text: &str) -> Result<(u32, u32), String> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    match (first.trim().parse(), last.trim().parse()) {
        (Ok(first), Ok(last)) if first <= last => Ok((first, last)),
        _ => Err("write two numbers, the first no larger than the second, for example 0..99".into()),
    }
}

pub(super) fn mesh_path(text: &str) -> Result<(PathBuf, Option<Format>), String> {
    let path = PathBuf::from(text);
    match Format::of(&path) {
        None if text != "none" => Err("choose a name that ends in .obj, .ply or .glb, or none".into()),
        format => Ok((path, format)),
    }
}

pub(super) fn resolution(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| {
        Some((width.trim().parse::<u32>().ok()?, height.trim().parse::<u32>().ok()?))
    });
    let allowed = 1..=MAX_RESOLUTION;
    match sides {
        None => Err("write width and height in pixels, for example 1280x720".into()),
        Some((width, height)) if allowed.contains(&width) && allowed.contains(&height) => Ok((width, height)),
        Some(_) => Err(format!("width and height must be 1 to {MAX_RESOLUTION} pixels each")),
    }
}

fn pixels(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (0.01..=1.0e6).contains(&value) => Ok(value),
        _ => Err("choose a number of pixels from 0.01 to 1000000".into()),
    }
}

pub(super) fn bytes(text: &str) -> Result<u64, String> {
    match text.parse::<ByteSize>() {
        Ok(size) => Ok(size.as_u64()),
        Err(_) => Err("write a number of bytes, for example 67108864, 64MiB or 1GB".into()),
    }
}
