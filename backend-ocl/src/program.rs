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
        /// Name and source of every kernel file, in the order in which they are put together.
        pub const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("kernel/", $name)))),*];
    };
}

files! {
    "gen.cl" "num.cl" "counts.cl" "bezier.cl" "surface.cl" "border.cl" "net.cl" "gregory.cl" "rational.cl" "owner.cl"
    "half.cl" "instance.cl" "project.cl" "weber.cl" "take.cl" "flat.cl" "sides.cl" "bound.cl" "grids.cl"
    "dice.cl" "dice_gregory.cl" "dice_rational.cl" "dice_any.cl" "displace.cl" "shade.cl" "triangle.cl" "clip.cl"
    "blend.cl" "sample.cl" "near.cl" "general.cl" "arrange_draw.cl" "draw.cl" "sort_middle.cl" "tiles.cl" "sort_last.cl"
    "filter.cl" "mesh.cl" "flush.cl" "scan.cl" "mesh_places.cl" "split.cl" "local.cl" "balance.cl" "deal.cl"
    "known_answers.cl"
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
    pub const ALL: [Self; 22] = [
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

/// Builds all kernels, in the order of [`Which::ALL`].
pub(crate) fn build(
    context: &Context,
    device: &str,
    options: &OpenOptions<'_>,
) -> Result<Vec<Kernel>, OclError> {
    let program =
        Program::create_and_build_from_source(context, &source(options), &compiler_options(options))
            .map_err(|log| OclError::Build { device: device.to_owned(), log })?;
    Which::ALL
        .iter()
        .map(|which| Kernel::create(&program, which.name()))
        .collect::<Result<_, _>>()
        .map_err(OclError::driver("looking up the kernels"))
}

/// All files, each after a line that names it in compiler reports.
fn source(options: &OpenOptions<'_>) -> String {
    let edited = |name, source: &str| match options.edit {
        Some(edit) => edit(name, source),
        None => source.to_owned(),
    };
    let named = |&(name, source)| format!("#line 1 \"{name}\"\n{}\n", edited(name, source));
    FILES.iter().map(named).collect::<String>().replace('\0', " ")
}

fn compiler_options(options: &OpenOptions<'_>) -> String {
    let barrier = if options.barrier { "-D BARRIER" } else { "" };
    format!("-cl-std=CL1.2 -D GROUP={GROUP}u {barrier} {}", options.build_options).replace('\0', " ")
}
