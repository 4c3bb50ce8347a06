//! The kernels' sources, and pipelines made from them.

use micropoly_core::stage::{Access, Stage};

use crate::error::WgpuError;

/// Changes a kernel file before it is compiled, given its name and source: for mutation tests.
pub type Edit<'a> = &'a dyn Fn(&str, &str) -> String;

/// One WGSL file.
type File = (&'static str, &'static str);

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
    let mut access: Vec<Access> = stage.bindings().iter().map(|binding| binding.access).collect();
    if stage == Stage::Draw {
        access.push(Access::Write); // the rounds
    }
    compile(device, stage.name(), &source(files(stage), edit), &access)
}

/// The kernel that turns a batch into a number of groups.
pub(crate) fn arrange(device: &wgpu::Device, edit: Option<Edit<'_>>) -> Result<Kernel, WgpuError> {
    compile(device, "arrange", &source(&[GEN, ITEMS, ARRANGE], edit), &[Access::Read, Access::Write])
}

/// The kernel that starts a round of the fused stage.
pub(crate) fn arrange_draw(device: &wgpu::Device, edit: Option<Edit<'_>>) -> Result<Kernel, WgpuError> {
    let access = [Access::Read, Access::Write, Access::Write];
    compile(device, "arrange_draw", &source(&[GEN, ROUNDS, ARRANGE_DRAW], edit), &access)
}

fn source(files: &[File], edit: Option<Edit<'_>>) -> String {
    files
        .iter()
        .map(|(name, text)| edit.map_or_else(|| (*text).to_owned(), |edit| edit(name, text)))
        .collect()
}

fn compile(
    device: &wgpu::Device,
    name: &'static str,
    source: &str,
    access: &[Access],
) -> Result<Kernel, WgpuError> {
    let errors = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let kernel = create(device, name, source, access);
    let internal = pollster::block_on(internal.pop());
    match pollster::block_on(errors.pop()).or(internal) {
        None => Ok(kernel),
        Some(error) => Err(WgpuError::Kernel { stage: name, reason: error.to_string() }),
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
