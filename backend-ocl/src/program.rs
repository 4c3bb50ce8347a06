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
    "gen.cl" "num.cl" "counts.cl" "bezier.cl" "surface.cl" "border.cl" "net.cl" "gregory.cl" "owner.cl" "project.cl"
    "weber.cl" "take.cl" "sides.cl" "bound.cl" "grids.cl" "dice.cl" "dice_gregory.cl" "displace.cl" "shade.cl"
    "triangle.cl" "clip.cl" "sample.cl" "near.cl" "general.cl" "arrange_draw.cl" "draw.cl" "tiles.cl" "mesh.cl"
    "flush.cl" "scan.cl" "mesh_places.cl" "split.cl" "local.cl" "balance.cl" "deal.cl" "known_answers.cl"
}

/// The kernels: one a stage, and those into which the fused stage is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// A stage other than the fused one.
    Stage(Stage),
    /// The next chunk of draws.
    ArrangeDraw,
    /// Dices and shades a chunk.
    Draw,
    /// Samples a chunk tile by tile.
    Tiles(Kind),
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
    pub const ALL: [Self; 15] = [
        Self::Stage(Stage::Take),
        Self::Stage(Stage::Bound),
        Self::Stage(Stage::Scan),
        Self::Stage(Stage::Split),
        Self::Stage(Stage::Local),
        Self::Stage(Stage::Balance),
        Self::Stage(Stage::Deal),
        Self::Stage(Stage::MeshPlaces),
        Self::Stage(Stage::Mesh),
        Self::Stage(Stage::Flush),
        Self::Stage(Stage::KnownAnswers),
        Self::ArrangeDraw,
        Self::Draw,
        Self::Tiles(Kind::Near),
        Self::Tiles(Kind::General),
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
            Self::Stage(Stage::MeshPlaces) => "stage_mesh_places",
            Self::Stage(Stage::Mesh) => "stage_mesh",
            Self::Stage(Stage::Flush) => "stage_flush",
            Self::Stage(Stage::KnownAnswers) => "stage_known_answers",
            Self::ArrangeDraw => "arrange_draw",
            Self::Stage(Stage::Draw) | Self::Draw => "stage_draw",
            Self::Tiles(Kind::Near) => "tiles_near",
            Self::Tiles(Kind::General) => "tiles_general",
        }
    }

    /// What it takes, in order: buffers, then numbers.
    #[must_use]
    pub fn arguments(self) -> Vec<Argument> {
        match self {
            Self::Stage(stage) => {
                let buffer = |b: &Binding| Argument::Buffer(b.name, b.layout, b.access);
                let count = (stage == Stage::KnownAnswers).then_some(Argument::Number("count"));
                stage.bindings().iter().map(buffer).chain(count).collect()
            }
            Self::ArrangeDraw => vec![
                read::<Control>("control"),
                read::<Draw>("draws"),
                write::<u32>("grids"),
                Argument::Number("chunk"),
            ],
            Self::Draw => vec![
                read::<Frame>("frame"),
                read::<Object>("objects"),
                read::<Patch>("patches"),
                read::<Draw>("draws"),
                write::<u32>("grids"),
            ],
            Self::Tiles(_) => vec![
                read::<Frame>("frame"),
                read::<Draw>("draws"),
                read::<u32>("grids"),
                write::<Sample>("samples"),
                write::<Colour>("colours"),
            ],
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
