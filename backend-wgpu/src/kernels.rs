//! The kernels' sources, and pipelines made from them.

use micropoly_core::stage::{Access, Stage};

use crate::error::WgpuError;

/// Changes a kernel file before it is compiled, given its name and source: for mutation tests. Nothing at all
/// in the place of a kernel's own file leaves that kernel out: it is opened faster, and does nothing.
pub type Edit<'a> = &'a dyn Fn(&str, &str) -> String;

/// A kernel that does nothing.
const NOTHING: &str = "@compute @workgroup_size(1) fn main() {}";

/// One WGSL file: its name and its source.
pub type File = (&'static str, &'static str);

macro_rules! files {
    ($($constant:ident: $name:literal,)*) => {
        $(const $constant: File = (concat!($name, ".wgsl"), include_str!(concat!("kernel/", $name, ".wgsl")));)*
    };
}

files! {
    GEN: "gen",
    NUM: "num",
    ITEMS: "items",
    SURFACE: "surface",
    BEZIER: "bezier",
    NET: "net",
    PROJECT: "project",
    BOUND: "bound",
    SEAM: "seam",
    DICE: "dice",
    SHADE: "shade",
    TRIANGLE: "triangle",
    CLIP: "clip",
    SAMPLE: "sample",
    SEED: "seed",
    TAKE: "take",
    FLUSH: "flush",
    SCAN: "scan",
    SPLIT: "split",
    DRAW: "draw",
    KNOWN_ANSWERS: "known_answers",
    ARRANGE: "arrange",
    ROUNDS: "rounds",
    ARRANGE_DRAW: "arrange_draw",
}

/// The files of a stage.
const fn files(stage: Stage) -> &'static [File] {
    match stage {
        Stage::Seed => &[GEN, ITEMS, SEED],
        Stage::Take => &[GEN, TAKE],
        Stage::Bound => &[GEN, ITEMS, NUM, SURFACE, BEZIER, NET, PROJECT, BOUND],
        Stage::Scan => &[GEN, SCAN],
        Stage::Split => &[GEN, ITEMS, SURFACE, SPLIT],
        Stage::Draw => &[
            GEN, ROUNDS, NUM, SURFACE, BEZIER, NET, PROJECT, DICE, SHADE, SEAM, TRIANGLE, CLIP, SAMPLE, DRAW,
        ],
        Stage::Flush => &[GEN, FLUSH],
        Stage::KnownAnswers => &[GEN, ITEMS, NUM, KNOWN_ANSWERS],
    }
}

/// What a kernel is made of: for tests that look into it or change it.
#[derive(Clone, Debug)]
pub struct KernelSource {
    /// Its name in error messages.
    pub name: &'static str,
    /// The stages that run it.
    pub stages: &'static [Stage],
    /// Its files in the order in which they are put together; the last is its own.
    pub files: &'static [File],
    /// Name and use of its buffers, in order.
    pub bindings: Vec<(&'static str, Access)>,
}

/// Every kernel of the backend.
#[must_use]
pub fn kernels() -> Vec<KernelSource> {
    Stage::ALL.iter().map(of_stage).chain([arranging(), arranging_draw()]).collect()
}

fn of_stage(stage: &'static Stage) -> KernelSource {
    let mut bindings: Vec<_> =
        stage.bindings().iter().map(|binding| (binding.name, binding.access)).collect();
    if *stage == Stage::Draw {
        bindings.push(("rounds", Access::Write));
    }
    KernelSource { name: stage.name(), stages: std::slice::from_ref(stage), files: files(*stage), bindings }
}

fn arranging() -> KernelSource {
    KernelSource {
        name: "arrange",
        stages: &[Stage::Bound, Stage::Split],
        files: &[GEN, ITEMS, ARRANGE],
        bindings: vec![("control", Access::Read), ("groups", Access::Write)],
    }
}

fn arranging_draw() -> KernelSource {
    KernelSource {
        name: "arrange_draw",
        stages: &[Stage::Draw],
        files: &[GEN, ROUNDS, ARRANGE_DRAW],
        bindings: vec![("frame", Access::Read), ("rounds", Access::Write), ("groups", Access::Write)],
    }
}

/// A compiled kernel and the layout of its bindings.
#[derive(Debug)]
pub(crate) struct Kernel {
    pub(crate) pipeline: wgpu::ComputePipeline,
    pub(crate) bindings: wgpu::BindGroupLayout,
}

/// The kernel of a stage.
pub(crate) fn stage(
    device: &wgpu::Device,
    stage: Stage,
    edit: Option<Edit<'_>>,
) -> Result<Kernel, WgpuError> {
    compile(device, &of_stage(&Stage::ALL[stage as usize]), edit)
}

/// The kernel that turns a batch into a number of groups.
pub(crate) fn arrange(device: &wgpu::Device, edit: Option<Edit<'_>>) -> Result<Kernel, WgpuError> {
    compile(device, &arranging(), edit)
}

/// The kernel that starts a round of the fused stage.
pub(crate) fn arrange_draw(device: &wgpu::Device, edit: Option<Edit<'_>>) -> Result<Kernel, WgpuError> {
    compile(device, &arranging_draw(), edit)
}

/// All files after each other; [`NOTHING`] if the kernel's own is edited away.
fn source(files: &[File], edit: Option<Edit<'_>>) -> String {
    let edited = |(name, text): &File| edit.map_or_else(|| (*text).to_owned(), |edit| edit(name, text));
    let texts: Vec<String> = files.iter().map(edited).collect();
    match texts.last() {
        Some(own) if own.is_empty() => NOTHING.to_owned(),
        _ => texts.concat(),
    }
}

fn compile(
    device: &wgpu::Device,
    kernel: &KernelSource,
    edit: Option<Edit<'_>>,
) -> Result<Kernel, WgpuError> {
    let access: Vec<Access> = kernel.bindings.iter().map(|&(_, access)| access).collect();
    let errors = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let built = create(device, kernel.name, &source(kernel.files, edit), &access);
    let internal = pollster::block_on(internal.pop());
    match pollster::block_on(errors.pop()).or(internal) {
        None => Ok(built),
        Some(error) => Err(WgpuError::Kernel { stage: kernel.name, reason: error.to_string() }),
    }
}

fn create(device: &wgpu::Device, name: &str, source: &str, access: &[Access]) -> Kernel {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let bindings = binding_layout(device, name, access);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(name),
        bind_group_layouts: &[Some(&bindings)],
        ..Default::default()
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(name),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("main"),
        // Every kernel writes its shared memory before it reads it.
        compilation_options: wgpu::PipelineCompilationOptions {
            zero_initialize_workgroup_memory: false,
            ..Default::default()
        },
        cache: None,
    });
    Kernel { pipeline, bindings }
}

fn binding_layout(device: &wgpu::Device, name: &str, access: &[Access]) -> wgpu::BindGroupLayout {
    let entry = |(place, access): (usize, &Access)| wgpu::BindGroupLayoutEntry {
        binding: place as u32,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: *access == Access::Read },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries: Vec<_> = access.iter().enumerate().map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(name), entries: &entries })
}
