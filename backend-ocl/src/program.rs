//! The kernels' sources, put together and built.

use micropoly_core::abi::{Colour, Control, Draw, Frame, Layout, Object, Patch, Sample, Shared};
use micropoly_core::stage::{Access, Binding, Stage};
use opencl3::context::Context;
use opencl3::kernel::Kernel;
use opencl3::program::Program;

use crate::device::OpenOptions;
use crate::error::OclError;

/// Work-items a work-group, in every kernel.
pub(crate) const GROUP: usize = 64;

macro_rules! files {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!("kernel/", $name)))),*]
    };
}

/// Name and source of every kernel file of the stages of a frame, in the order in which they are put together.
pub const FILES: &[(&str, &str)] = files! {
    "gen.cl" "num.cl" "counts.cl" "bezier.cl" "surface.cl" "border.cl" "net.cl" "gregory.cl" "rational.cl" "owner.cl"
    "half.cl" "instance.cl" "project.cl" "weber.cl" "take.cl" "flat.cl" "sides.cl" "bound.cl" "grids.cl"
    "dice.cl" "dice_gregory.cl" "dice_rational.cl" "dice_any.cl" "displace.cl" "shade.cl" "triangle.cl" "clip.cl"
    "blend.cl" "sample.cl" "near.cl" "general.cl" "arrange_draw.cl" "draw.cl" "sort_middle.cl" "tiles.cl" "sort_last.cl"
    "filter.cl" "mesh.cl" "flush.cl" "scan.cl" "mesh_places.cl" "split.cl" "local.cl" "balance.cl" "deal.cl"
    "known_answers.cl"
};

/// The same of the tessellator's stages.
pub const TESS_FILES: &[(&str, &str)] = files! {
    "gen.cl" "num.cl" "counts.cl" "bezier.cl" "tess_level.cl" "tess_division.cl" "tess_strip.cl" "tess_topology.cl"
    "tess_corner.cl" "tess_edges.cl" "tess_levels.cl" "tess_control.cl" "tess_places.cl" "tess_surface.cl"
    "tess_vertex.cl" "tess_evaluated.cl" "tess_evaluate.cl" "known_answers.cl"
};

/// The same of the stages of trees and BSP-grids.
pub const ACCEL_FILES: &[(&str, &str)] = files! {
    "gen.cl" "num.cl" "counts.cl" "accel_box.cl" "accel_extent.cl" "accel_codes.cl" "accel_sort.cl" "accel_count.cl"
    "accel_scan.cl" "accel_scatter.cl" "accel_tree.cl" "accel_boxes.cl" "accel_query.cl" "accel_see.cl" "accel_fill.cl"
    "accel_ray.cl" "accel_point.cl" "accel_walk.cl" "accel_rays.cl" "accel_nearest.cl"
    "bsp_sides.cl" "bsp_place.cl" "bsp_cells.cl" "bsp_rank.cl" "known_answers.cl"
};

/// The file whose place a caller's own levels take.
const LEVELS_FILE: &str = "tess_levels.cl";
/// The file whose place a caller's own evaluation takes.
const EVALUATED_FILE: &str = "tess_evaluated.cl";

/// What a caller's own control must define.
const LEVELS_OF: &str = "static TessLevels levels_of(__constant TessFrame *frame, __global const TessPatch *patches, __global const TessLevels *levels, uint index)";
/// What a caller's own evaluation must define.
const EVALUATED: &str = "static TessVertex evaluated(__constant TessFrame *frame, __global const TessPatch *patches, __global const float *heights, uint index, uint3 coordinates)";

/// Kernels that are built together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Those of the stages of a frame.
    Frame,
    /// The tessellator's.
    Tessellator,
    /// Those of trees and BSP-grids.
    Accel,
}

impl Part {
    /// All.
    pub const ALL: [Self; 3] = [Self::Frame, Self::Tessellator, Self::Accel];

    /// The one that has a stage. Known answers are in all.
    #[must_use]
    pub const fn of(stage: Stage) -> Self {
        match stage {
            Stage::TessControl | Stage::TessPlaces | Stage::TessEvaluate => Self::Tessellator,
            Stage::AccelExtent
            | Stage::AccelCodes
            | Stage::AccelCount
            | Stage::AccelScan
            | Stage::AccelScatter
            | Stage::AccelTree
            | Stage::AccelBoxes
            | Stage::AccelSee
            | Stage::AccelFill
            | Stage::AccelRays
            | Stage::AccelNearest
            | Stage::BspSides
            | Stage::BspCells
            | Stage::BspRank => Self::Accel,
            _ => Self::Frame,
        }
    }

    /// Name and source of its files, in the order in which they are put together.
    #[must_use]
    pub const fn files(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Frame => FILES,
            Self::Tessellator => TESS_FILES,
            Self::Accel => ACCEL_FILES,
        }
    }

    /// Has it this kernel?
    #[must_use]
    pub fn has(self, which: Which) -> bool {
        match which {
            Which::Stage(Stage::KnownAnswers) => true,
            Which::Stage(stage) => Self::of(stage) == self,
            _ => self == Self::Frame,
        }
    }
}

/// The kernels: one a stage, and those into which the stages that draw are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// A stage other than those that draw.
    Stage(Stage),
    /// The next chunk of draws.
    ArrangeDraw,
    /// Dices and shades a chunk.
    Draw,
    /// Counts the draws of a chunk that can touch each tile.
    CountTiles,
    /// Places of the tiles' lists.
    ScanTiles,
    /// Draws to the lists of their tiles.
    WriteTiles,
    /// Samples a chunk tile by tile.
    Tiles(Kind),
    /// A turn of sort-last over a chunk.
    SortLast,
    /// What sort-last found in a chunk becomes samples.
    MergeKeys,
}

/// A kind of grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Small and whole: 32-bit integers do, nothing is clipped.
    Near,
    /// Any other.
    General,
}

/// What a kernel takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// A buffer: its name, the layout of its entries, and what the kernel does with it.
    Buffer(&'static str, Layout, Access),
    /// A number: its name.
    Number(&'static str),
}

const fn read<T: Shared>(name: &'static str) -> Argument {
    Argument::Buffer(name, T::LAYOUT, Access::Read)
}

const fn write<T: Shared>(name: &'static str) -> Argument {
    Argument::Buffer(name, T::LAYOUT, Access::Write)
}

impl Which {
    /// All kernels.
    pub const ALL: [Self; 39] = [
        Self::Stage(Stage::Take),
        Self::Stage(Stage::Bound),
        Self::Stage(Stage::Scan),
        Self::Stage(Stage::Split),
        Self::Stage(Stage::Local),
        Self::Stage(Stage::Balance),
        Self::Stage(Stage::Deal),
        Self::Stage(Stage::Blend),
        Self::Stage(Stage::Filter),
        Self::Stage(Stage::MeshPlaces),
        Self::Stage(Stage::Mesh),
        Self::Stage(Stage::TessControl),
        Self::Stage(Stage::TessPlaces),
        Self::Stage(Stage::TessEvaluate),
        Self::Stage(Stage::AccelExtent),
        Self::Stage(Stage::AccelCodes),
        Self::Stage(Stage::AccelCount),
        Self::Stage(Stage::AccelScan),
        Self::Stage(Stage::AccelScatter),
        Self::Stage(Stage::AccelTree),
        Self::Stage(Stage::AccelBoxes),
        Self::Stage(Stage::AccelSee),
        Self::Stage(Stage::AccelFill),
        Self::Stage(Stage::AccelRays),
        Self::Stage(Stage::AccelNearest),
        Self::Stage(Stage::BspSides),
        Self::Stage(Stage::BspCells),
        Self::Stage(Stage::BspRank),
        Self::Stage(Stage::Flush),
        Self::Stage(Stage::KnownAnswers),
        Self::ArrangeDraw,
        Self::Draw,
        Self::CountTiles,
        Self::ScanTiles,
        Self::WriteTiles,
        Self::Tiles(Kind::Near),
        Self::Tiles(Kind::General),
        Self::SortLast,
        Self::MergeKeys,
    ];

    /// Its place in [`Which::ALL`].
    pub(crate) fn index(self) -> usize {
        Self::ALL.iter().position(|which| *which == self).expect("every kernel is in the list")
    }

    /// Its name in the source, and in messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stage(Stage::Take) => "stage_take",
            Self::Stage(Stage::Bound) => "stage_bound",
            Self::Stage(Stage::Scan) => "stage_scan",
            Self::Stage(Stage::Split) => "stage_split",
            Self::Stage(Stage::Local) => "stage_local",
            Self::Stage(Stage::Balance) => "stage_balance",
            Self::Stage(Stage::Deal) => "stage_deal",
            Self::Stage(Stage::Blend) => "stage_blend",
            Self::Stage(Stage::Filter) => "stage_filter",
            Self::Stage(Stage::MeshPlaces) => "stage_mesh_places",
            Self::Stage(Stage::Mesh) => "stage_mesh",
            Self::Stage(Stage::TessControl) => "stage_tess_control",
            Self::Stage(Stage::TessPlaces) => "stage_tess_places",
            Self::Stage(Stage::TessEvaluate) => "stage_tess_evaluate",
            Self::Stage(Stage::AccelExtent) => "stage_accel_extent",
            Self::Stage(Stage::AccelCodes) => "stage_accel_codes",
            Self::Stage(Stage::AccelCount) => "stage_accel_count",
            Self::Stage(Stage::AccelScan) => "stage_accel_scan",
            Self::Stage(Stage::AccelScatter) => "stage_accel_scatter",
            Self::Stage(Stage::AccelTree) => "stage_accel_tree",
            Self::Stage(Stage::AccelBoxes) => "stage_accel_boxes",
            Self::Stage(Stage::AccelSee) => "stage_accel_see",
            Self::Stage(Stage::AccelFill) => "stage_accel_fill",
            Self::Stage(Stage::AccelRays) => "stage_accel_rays",
            Self::Stage(Stage::AccelNearest) => "stage_accel_nearest",
            Self::Stage(Stage::BspSides) => "stage_bsp_sides",
            Self::Stage(Stage::BspCells) => "stage_bsp_cells",
            Self::Stage(Stage::BspRank) => "stage_bsp_rank",
            Self::Stage(Stage::Flush) => "stage_flush",
            Self::Stage(Stage::KnownAnswers) => "stage_known_answers",
            Self::ArrangeDraw => "arrange_draw",
            Self::Stage(Stage::Draw) | Self::Draw => "stage_draw",
            Self::CountTiles => "count_tiles",
            Self::ScanTiles => "scan_tiles",
            Self::WriteTiles => "write_tiles",
            Self::Tiles(Kind::Near) => "tiles_near",
            Self::Tiles(Kind::General) => "tiles_general",
            Self::Stage(Stage::SortLast) | Self::SortLast => "stage_sort_last",
            Self::MergeKeys => "merge_keys",
        }
    }

    /// What it takes, in order: buffers, then numbers.
    #[must_use]
    pub fn arguments(self) -> Vec<Argument> {
        match self {
            Self::Stage(stage) => {
                let buffer = |b: &Binding| Argument::Buffer(b.name, b.layout, b.access);
                let is_counted = matches!(stage, Stage::Blend | Stage::Filter | Stage::KnownAnswers);
                let count = is_counted.then_some(Argument::Number("count"));
                stage.bindings().iter().map(buffer).chain(count).collect()
            }
            Self::ArrangeDraw => {
                vec![read::<Control>("control"), write::<u32>("grids"), Argument::Number("chunk")]
            }
            Self::Draw => vec![
                read::<Frame>("frame"),
                read::<Object>("objects"),
                read::<Patch>("patches"),
                read::<Draw>("draws"),
                write::<u32>("grids"),
            ],
            Self::CountTiles | Self::WriteTiles => {
                vec![read::<Frame>("frame"), read::<u32>("grids"), write::<u32>("lists")]
            }
            Self::ScanTiles => vec![read::<Frame>("frame"), write::<u32>("lists")],
            Self::Tiles(_) => vec![
                read::<Frame>("frame"),
                read::<Draw>("draws"),
                read::<u32>("grids"),
                read::<u32>("lists"),
                read::<Sample>("behind"),
                write::<Sample>("samples"),
                write::<Colour>("colours"),
            ],
            Self::SortLast => vec![
                read::<Frame>("frame"),
                read::<Draw>("draws"),
                read::<u32>("grids"),
                read::<Sample>("behind"),
                read::<Sample>("samples"),
                write::<Colour>("colours"),
                write::<Sample>("keys"),
                Argument::Number("turn"),
            ],
            Self::MergeKeys => {
                vec![read::<Frame>("frame"), write::<Sample>("samples"), write::<Sample>("keys")]
            }
        }
    }
}

/// A part that is yet to be built.
#[derive(Debug)]
pub(crate) struct Unbuilt {
    pub(crate) part: Part,
    source: String,
    options: String,
    /// What the caller's own steps in it must define.
    own: Vec<&'static str>,
}

impl Unbuilt {
    pub(crate) fn new(part: Part, options: &OpenOptions<'_>) -> Self {
        let own = match part {
            Part::Frame | Part::Accel => Vec::new(),
            Part::Tessellator => options.own_steps().map(|(_, defines, _)| defines).collect(),
        };
        Self { part, source: source(part, options), options: compiler_options(options), own }
    }

    /// Builds its kernels.
    pub(crate) fn build(&self, context: &Context, device: &str) -> Result<Vec<(Which, Kernel)>, OclError> {
        let program = Program::create_and_build_from_source(context, &self.source, &self.options)
            .map_err(|log| self.refused(device.to_owned(), log))?;
        let own = Which::ALL.into_iter().filter(|which| self.part.has(*which));
        own.map(|which| Ok((which, Kernel::create(&program, which.name())?)))
            .collect::<Result<_, _>>()
            .map_err(OclError::driver("looking up the kernels"))
    }

    fn refused(&self, device: String, log: String) -> OclError {
        if self.own.is_empty() {
            OclError::Build { device, log }
        } else {
            OclError::OwnStep { device, defines: self.own.join(" and "), log }
        }
    }
}

impl OpenOptions<'_> {
    /// The caller's own steps: the file whose place they take, what they must define, and their source.
    fn own_steps(&self) -> impl Iterator<Item = (&'static str, &'static str, &str)> {
        let levels = self.tess_control.as_deref().map(|source| (LEVELS_FILE, LEVELS_OF, source));
        let evaluated = self.tess_evaluate.as_deref().map(|source| (EVALUATED_FILE, EVALUATED, source));
        levels.into_iter().chain(evaluated)
    }
}

/// All files, each after a line that names it in compiler reports.
fn source(part: Part, options: &OpenOptions<'_>) -> String {
    let named = |&(name, source): &(&str, &str)| {
        let own = options.own_steps().find(|(file, ..)| *file == name);
        let (name, source) = own.map_or((name, source), |(file, _, source)| (own_name(file), source));
        let edited = options.edit.map_or_else(|| source.to_owned(), |edit| edit(name, source));
        format!("#line 1 \"{name}\"\n{edited}\n")
    };
    part.files().iter().map(named).collect::<String>().replace('\0', " ")
}

/// What compiler reports call the caller's own step in the place of a file.
fn own_name(file: &str) -> &'static str {
    if file == LEVELS_FILE { "your tess_control" } else { "your tess_evaluate" }
}

fn compiler_options(options: &OpenOptions<'_>) -> String {
    let barrier = if options.barrier { "-D BARRIER" } else { "" };
    format!("-cl-std=CL1.2 -D GROUP={GROUP}u {barrier} {}", options.build_options).replace('\0', " ")
}
