//! The tessellator on OpenCL gives the CPU's bits: stage by stage, all pairs of levels, and with a caller's own steps.
//!
//! Runs on every OpenCL device there is; without one it fails, since nothing would be tested.

use std::ops::ControlFlow;
use std::sync::Arc;

use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_ocl::{OclDevice, OclError, OpenOptions, devices};
use micropoly_conformance::report::check_stage;
use micropoly_core::abi::{
    TESS_COORDINATES, TESS_EQUAL, TESS_EVEN, TESS_GIVEN, TESS_ISOLINES, TESS_LENGTH, TESS_ODD, TESS_PN,
    TESS_QUADS, TESS_STADLBAUER, TESS_TRIANGLES, TESS_UNIT, TessFrame, TessLevels, TessPatch, TessTotals,
    TessVertex,
};
use micropoly_core::backend::Device;
use micropoly_core::kernel::tess_evaluate::corners;
use micropoly_core::num::{add, float, max, mul, sub};
use micropoly_core::stage::Stage;
use micropoly_core::tess::stream::{TessInput, TessPlan};

/// Everything that an OpenCL compiler may be told to break.
const HOSTILE: &str = "-cl-fast-relaxed-math -cl-mad-enable -cl-denorms-are-zero";
/// The tessellator's stages.
const STAGES: [Stage; 3] = [Stage::TessControl, Stage::TessPlaces, Stage::TessEvaluate];
/// Inputs a stage.
const INPUTS: u64 = 40;
/// Bytes of a tessellation's buffers.
const MEMORY: u64 = 1 << 20;

fn tessellator() -> OpenOptions<'static> {
    OpenOptions { first: &STAGES, ..OpenOptions::default() }
}

/// Opens every device there is.
fn opened(options: &OpenOptions<'_>) -> Vec<OclDevice> {
    let count = devices().unwrap_or_else(|error| panic!("this test needs an OpenCL device: {error}")).len();
    (0..count)
        .map(|index| OclDevice::open(index, options).unwrap_or_else(|error| panic!("{error}")))
        .collect()
}

fn cpu() -> CpuDevice {
    CpuDevice::new(1).expect("threads")
}

#[test]
fn stages_have_the_bits_of_the_cpu() {
    let barrier = OpenOptions { barrier: true, ..tessellator() };
    let hostile = OpenOptions { build_options: HOSTILE.to_owned(), skip_check: true, ..barrier.clone() };
    for options in [tessellator(), barrier, hostile] {
        for mut device in opened(&options) {
            for stage in STAGES {
                let report = check_stage(&mut cpu(), &mut device, stage, INPUTS);
                assert!(report.agrees(), "{}, {options:?}: {report:?}", device.name());
            }
        }
    }
}

/// A chunk as it was read: what it comes to, bits of its vertices, and its indices.
#[derive(PartialEq)]
struct Read {
    totals: TessTotals,
    vertices: Vec<u32>,
    indices: Vec<u32>,
}

/// Tessellates, and reads all chunks.
fn chunks<D: Device>(device: &mut D, input: &TessInput<'_>, memory: u64) -> Result<Vec<Read>, D::Error> {
    let plan = TessPlan::new(input, memory)?;
    let buffers = plan.prepare(device)?;
    let mut all = Vec::new();
    plan.run(device, &buffers, |device, chunk| {
        let totals = chunk.totals;
        let mut vertices = vec![TessVertex::default(); totals.vertices as usize];
        let mut indices = vec![0; (corners(&input.frame) * totals.primitives) as usize];
        device.read(chunk.vertices, 0, &mut vertices)?;
        device.read(chunk.indices, 0, &mut indices)?;
        all.push(Read { totals, vertices: bytemuck::cast_slice(&vertices).to_vec(), indices });
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(all)
}

/// What was compared.
#[derive(Debug, Default)]
struct Compared {
    chunks: usize,
    vertices: u64,
    primitives: u64,
}

/// Compares chunk by chunk what both devices make of an input.
fn compare(
    cpu: &mut CpuDevice,
    device: &mut OclDevice,
    (input, memory): (&TessInput<'_>, u64),
    compared: &mut Compared,
) {
    let expected = chunks(cpu, input, memory).unwrap_or_else(|error| panic!("{error}"));
    let found = chunks(device, input, memory).unwrap_or_else(|error| panic!("{error}"));
    let frame = input.frame;
    assert_eq!(found.len(), expected.len(), "{frame:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.totals, expected.totals, "{}: {frame:?}", device.name());
        assert!(found == expected, "{} differs in {:?}: {frame:?}", device.name(), found.totals);
        compared.chunks += 1;
        compared.vertices += u64::from(found.totals.vertices);
        compared.primitives += u64::from(found.totals.primitives);
    }
}

/// A patch of every level across a level `a` along; `less` is taken off both.
fn pairs(a: u8, less: f32, domain: u32) -> Vec<TessLevels> {
    let a = f32::from(a) - less;
    (1..=64_u8)
        .map(|b| {
            let b = f32::from(b) - less;
            TessLevels { outer: [a, b, a, b], inner: [b, if domain == TESS_QUADS { a } else { b }] }
        })
        .collect()
}

fn compare_pairs(cpu: &mut CpuDevice, device: &mut OclDevice, frame: TessFrame) -> Compared {
    let mut compared = Compared::default();
    let frame = TessFrame { control: TESS_GIVEN, evaluation: TESS_COORDINATES, ..frame };
    let patches = vec![TessPatch::default(); 64];
    let less = if frame.spacing == TESS_EQUAL { 0.0 } else { 0.375 };
    for a in 1..=64 {
        let levels = pairs(a, less, frame.domain);
        let input = TessInput { frame, patches: &patches, levels: &levels, heights: &[] };
        compare(cpu, device, (&input, MEMORY), &mut compared);
    }
    compared
}

fn all_pairs_agree(spacing: u32) {
    for mut device in opened(&tessellator()) {
        for domain in [TESS_TRIANGLES, TESS_QUADS, TESS_ISOLINES] {
            for flags in [0, TESS_STADLBAUER] {
                let frame = TessFrame { domain, spacing, flags, ..TessFrame::default() };
                let compared = compare_pairs(&mut cpu(), &mut device, frame);
                println!(
                    "{}: domain {domain}, spacing {spacing}, flags {flags}: 4096 pairs, {compared:?}",
                    device.name()
                );
                assert!(compared.chunks > 64, "{compared:?}");
            }
        }
    }
}

#[test]
fn all_pairs_of_whole_levels_have_the_bits_of_the_cpu() {
    all_pairs_agree(TESS_EQUAL);
}

#[test]
fn all_pairs_of_fractional_levels_have_the_bits_of_the_cpu() {
    all_pairs_agree(TESS_EVEN);
    all_pairs_agree(TESS_ODD);
}

/// Patches are placed in several windows.
#[test]
fn many_patches_have_the_bits_of_the_cpu() {
    let patches = vec![TessPatch::default(); 140_000];
    let levels: Vec<TessLevels> = (0..patches.len())
        .map(|index| TessLevels { outer: [(index % 3) as f32; 4], inner: [(index % 2) as f32; 2] })
        .collect();
    let frame = TessFrame { control: TESS_GIVEN, evaluation: TESS_COORDINATES, ..TessFrame::default() };
    let input = TessInput { frame, patches: &patches, levels: &levels, heights: &[] };
    for mut device in opened(&tessellator()) {
        let mut compared = Compared::default();
        compare(&mut cpu(), &mut device, (&input, 70 << 20), &mut compared);
        println!("{}: {compared:?}", device.name());
        assert!(compared.chunks > 1, "{compared:?}");
    }
}

/// Levels by the patch's index, or by its first coordinate where that is larger.
const OWN_LEVELS: &str = "
static TessLevels levels_of(__constant TessFrame *frame, __global const TessPatch *patches,
                            __global const TessLevels *levels, uint index) {
    const uint zero = frame->zero;
    const float outer = add(1.5f, mul(0.75f, number((int)index)));
    const float inner = max(patches[index].points[0], outer);
    const TessLevels own = {{outer, outer, outer, outer}, {inner, outer}};
    return own;
}
";

fn own_levels(index: u32, patch: &TessPatch) -> TessLevels {
    let outer = add(1.5, mul(0.75, float(index as i32)));
    TessLevels { outer: [outer; 4], inner: [max(patch.points[0], outer), outer] }
}

/// A bulge over the coordinates, as high as the patch has it.
const OWN_EVALUATION: &str = "
static TessVertex evaluated(__constant TessFrame *frame, __global const TessPatch *patches,
                            __global const float *heights, uint index, uint3 coordinates) {
    const uint zero = frame->zero;
    const float3 at = shares(zero, coordinates);
    const float bulge = mul(mul(at.x, sub(1.0f, at.x)), patches[index].points[1]);
    const TessVertex vertex = {{at.x, at.y, bulge}, {0.0f, 0.0f, heights[0]}, {at.z, number((int)index)}};
    return vertex;
}
";

fn own_evaluation(index: u32, patch: &TessPatch, coordinates: [u32; 3]) -> TessVertex {
    let [u, v, w] = coordinates.map(|c| mul(float(c as i32), 1.0 / TESS_UNIT as f32));
    let bulge = mul(mul(u, sub(1.0, u)), patch.points[1]);
    TessVertex { position: [u, v, bulge], normal: [0.0, 0.0, 3.0], uv: [w, float(index as i32)] }
}

/// Patches whose numbers are anyhow.
fn some_patches() -> Vec<TessPatch> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut patches = vec![TessPatch::default(); 40];
    for patch in &mut patches {
        patch.points.fill_with(|| 60.0 * random.f32());
        patch.uv.fill_with(|| random.f32());
    }
    patches
}

#[test]
fn a_callers_own_steps_have_the_bits_of_the_same_on_the_cpu() {
    let patches = some_patches();
    for [own_control, own_evaluate] in [[true, true], [true, false], [false, true]] {
        let options = OpenOptions {
            tess_control: own_control.then(|| OWN_LEVELS.to_owned()),
            tess_evaluate: own_evaluate.then(|| OWN_EVALUATION.to_owned()),
            ..OpenOptions::default()
        };
        let mut cpu = cpu();
        cpu.control_tessellation(own_control.then(|| Arc::new(own_levels) as _));
        cpu.evaluate_tessellation(own_evaluate.then(|| Arc::new(own_evaluation) as _));
        for (domain, evaluation) in [(TESS_TRIANGLES, TESS_PN), (TESS_QUADS, 0), (TESS_ISOLINES, 0)] {
            let frame = TessFrame {
                domain,
                evaluation,
                control: TESS_LENGTH,
                factor: 9.0,
                eye: [20.0, 90.0, 40.0],
                columns: 1,
                rows: 1,
                scale: 1.0,
                ..TessFrame::default()
            };
            let input = TessInput { frame, patches: &patches, levels: &[], heights: &[3.0] };
            for mut device in opened(&options) {
                let mut compared = Compared::default();
                compare(&mut cpu, &mut device, (&input, MEMORY), &mut compared);
                assert!(compared.vertices > 1000, "{compared:?}");
            }
        }
    }
}

/// What the built-in steps are made of is there for a caller's own.
#[test]
fn a_callers_own_steps_may_use_the_built_in_ones() {
    let control =
        "static TessLevels levels_of(__constant TessFrame *frame, __global const TessPatch *patches,
                                               __global const TessLevels *levels, uint index) {
        return levels_by_frame(frame, patches + index);
    }";
    let evaluate = "static TessVertex evaluated(__constant TessFrame *frame, __global const TessPatch *patches,
                                                __global const float *heights, uint index, uint3 coordinates) {
        const TessSurface surface = new_tess_surface(frame, patches + index);
        return evaluate(frame, patches + index, &surface, heights, coordinates);
    }";
    let options = OpenOptions {
        tess_control: Some(control.to_owned()),
        tess_evaluate: Some(evaluate.to_owned()),
        ..OpenOptions::default()
    };
    let frame = TessFrame {
        evaluation: TESS_PN,
        control: TESS_LENGTH,
        factor: 9.0,
        columns: 2,
        rows: 2,
        scale: 0.5,
        ..TessFrame::default()
    };
    let input = TessInput { frame, patches: &some_patches(), levels: &[], heights: &[1.0, 0.5, -0.25, 0.0] };
    for mut device in opened(&options) {
        compare(&mut cpu(), &mut device, (&input, MEMORY), &mut Compared::default());
    }
}

fn refused(options: &OpenOptions<'_>) -> OclError {
    OclDevice::open(0, options).expect_err("must be refused")
}

#[test]
fn an_own_step_that_does_not_compile_is_an_error_with_what_it_must_define() {
    let control =
        |source: &str| OpenOptions { tess_control: Some(source.to_owned()), ..OpenOptions::default() };
    let evaluate =
        |source: &str| OpenOptions { tess_evaluate: Some(source.to_owned()), ..OpenOptions::default() };
    let cases = [
        (
            control("static float something_else(void) { return 1.0f; }"),
            "levels_of(__constant TessFrame *frame",
        ),
        (control(&OWN_LEVELS.replace("number(", "nonesuch(")), "levels_of(__constant TessFrame *frame"),
        (evaluate("this is no C"), "evaluated(__constant TessFrame *frame"),
        (
            evaluate(&OWN_EVALUATION.replace("uint3 coordinates", "uint3 ")),
            "evaluated(__constant TessFrame *frame",
        ),
    ];
    for (options, wanted) in cases {
        let error = refused(&options);
        assert!(matches!(error, OclError::OwnStep { .. }), "{error}");
        let text = error.to_string();
        println!("{text}");
        assert!(text.contains(wanted) && text.contains("error"), "{text}");
    }
}

/// A device that draws is not slower to open: whoever needs a part builds it.
#[test]
fn a_part_is_built_when_it_is_needed() {
    let spoil = |spoilt: &'static str| {
        move |name: &str, source: &str| {
            if name == spoilt { "no C".to_owned() } else { source.to_owned() }
        }
    };
    let (no_tessellator, no_frame) = (spoil("tess_strip.cl"), spoil("bound.cl"));
    let options = OpenOptions { edit: Some(&no_tessellator), ..OpenOptions::default() };
    let mut device = OclDevice::open(0, &options).unwrap_or_else(|error| panic!("{error}"));
    let input = TessInput { frame: TessFrame::default(), patches: &[], levels: &[], heights: &[] };
    let error = chunks(&mut device, &input, MEMORY).map(|_| ()).expect_err("must be refused");
    assert!(matches!(error, OclError::Build { .. }), "{error}");
    let error = refused(&OpenOptions { first: &STAGES, ..options });
    assert!(matches!(error, OclError::Build { .. }), "{error}");
    let options = OpenOptions { edit: Some(&no_frame), ..tessellator() };
    OclDevice::open(0, &options).unwrap_or_else(|error| panic!("{error}"));
}
