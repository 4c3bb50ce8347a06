//! The kernels' sources, put together and built.

use micropoly_core::stage::Stage;
use opencl3::context::Context;
use opencl3::kernel::Kernel;
use opencl3::program::Program;

use crate::device::OpenOptions;
use crate::error::OclError;

/// Work-items a work-group, in every stage.
pub(crate) const GROUP: usize = 64;

macro_rules! files {
    ($($name:literal)*) => {
        /// Name and source of every kernel file, in the order in which they are put together.
        pub const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("kernel/", $name)))),*];
    };
}

files! {
    "gen.cl" "num.cl" "bezier.cl" "surface.cl" "net.cl" "project.cl" "bound.cl" "dice.cl" "seam.cl"
    "shade.cl" "triangle.cl" "clip.cl" "sample.cl" "draw.cl" "seed.cl" "take.cl" "scan.cl" "split.cl"
    "known_answers.cl"
}

/// Builds all kernels, one a stage in the order of [`Stage::ALL`].
pub(crate) fn build(
    context: &Context,
    device: &str,
    options: &OpenOptions<'_>,
) -> Result<Vec<Kernel>, OclError> {
    let program =
        Program::create_and_build_from_source(context, &source(options), &compiler_options(options))
            .map_err(|log| OclError::Build { device: device.to_owned(), log })?;
    Stage::ALL
        .iter()
        .map(|stage| Kernel::create(&program, &format!("stage_{}", stage.name())))
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
