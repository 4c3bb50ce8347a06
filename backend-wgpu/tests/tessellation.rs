//! The tessellator gives exactly the CPU's bits, and takes steps of the caller's own. Needs a Vulkan driver; Mesa's software
//! one will do.

use std::sync::Arc;

use micropoly::tess::chunk::{HostChunk, each_chunk};
use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_wgpu::{WgpuDevice, WgpuError};
use micropoly_conformance::corpus::ROUNDS;
use micropoly_conformance::report::check_stage;
use micropoly_core::abi::{
    TESS_COORDINATES, TESS_EQUAL, TESS_GIVEN, TESS_ISOLINES, TESS_ODD, TESS_QUADS, TESS_STADLBAUER,
    TESS_TRIANGLES, TESS_UNIT, TessFrame, TessLevels, TessPatch, TessRecord, TessVertex,
};
use micropoly_core::backend::Device;
use micropoly_core::num::{add, float, max, mul};
use micropoly_core::stage::Stage;
use micropoly_core::tess::stream::{TessCounts, TessInput};

const MEMORY: u64 = 80 << 20;

fn cpu() -> CpuDevice {
    CpuDevice::new(0).expect("threads")
}

fn open() -> WgpuDevice {
    WgpuDevice::open(0, None).unwrap_or_else(|error| panic!("these tests need a GPU or lavapipe: {error}"))
}

/// Words of a chunk: its records, its vertices and its indices.
type Words = [Vec<u32>; 3];

fn words(chunk: &HostChunk) -> Words {
    [
        bytemuck::cast_slice::<TessRecord, u32>(&chunk.records).to_vec(),
        bytemuck::cast_slice::<TessVertex, u32>(&chunk.vertices).to_vec(),
        chunk.indices.clone(),
    ]
}

/// All chunks of a tessellation.
fn chunks<D: Device>(device: &mut D, input: &TessInput<'_>) -> (TessCounts, Vec<Words>) {
    let mut all = Vec::new();
    let counts = each_chunk(device, input, MEMORY, |chunk| {
        all.push(words(&chunk));
        Ok(())
    });
    (counts.expect("tessellates"), all)
}

/// Compares chunk by chunk; gives what there was to be compared.
fn compare(input: &TessInput<'_>, device: &mut WgpuDevice) -> TessCounts {
    let (expected, on_cpu) = chunks(&mut cpu(), input);
    let (found, on_gpu) = chunks(device, input);
    assert_eq!(found, expected, "{:?}", input.frame);
    for (at, (found, expected)) in on_gpu.iter().zip(&on_cpu).enumerate() {
        for (found, expected) in found.iter().zip(expected) {
            let first = found.iter().zip(expected).position(|(found, expected)| found != expected);
            assert_eq!(first, None, "first word that differs in chunk {at}, {:?}", input.frame);
        }
    }
    found
}

#[test]
fn the_corpus_has_the_same_bits() {
    let (mut reference, mut device) = (cpu(), open());
    for stage in [Stage::TessControl, Stage::TessPlaces, Stage::TessEvaluate] {
        let report = check_stage(&mut reference, &mut device, stage, ROUNDS);
        assert!(report.agrees(), "{report:?}");
    }
}

/// Outer levels take turns, the inner one is the second of the pair; on quadrilaterals both, exchanged.
fn pair(domain: u32, a: u32, b: u32) -> TessLevels {
    let [a, b] = [a, b].map(|level| level as f32);
    TessLevels { outer: [a, b, a, b], inner: [b, if domain == TESS_QUADS { a } else { 1.0 }] }
}

/// Every pair of whole levels, in every domain and both profiles.
#[test]
fn every_pair_of_levels_has_the_same_bits() {
    let mut device = open();
    let (mut compared, mut vertices, mut primitives) = (0, 0, 0);
    for domain in [TESS_TRIANGLES, TESS_QUADS, TESS_ISOLINES] {
        let levels: Vec<TessLevels> =
            (1..=64).flat_map(|a| (1..=64).map(move |b| pair(domain, a, b))).collect();
        let patches = vec![TessPatch::default(); levels.len()];
        for flags in [0, TESS_STADLBAUER] {
            let (control, evaluation, spacing) = (TESS_GIVEN, TESS_COORDINATES, TESS_EQUAL);
            let frame = TessFrame { domain, flags, control, evaluation, spacing, ..TessFrame::default() };
            let counts =
                compare(&TessInput { frame, patches: &patches, levels: &levels, heights: &[] }, &mut device);
            compared += levels.len();
            vertices += counts.vertices;
            primitives += counts.primitives;
        }
    }
    println!("{compared} patches with {vertices} vertices and {primitives} primitives are equal");
}

/// More pieces than one dimension of a dispatch has groups, and more patches than are placed at once.
#[test]
fn many_pieces_are_spread_over_two_dimensions() {
    let patches = vec![TessPatch::default(); 140_000];
    let frame = TessFrame {
        domain: TESS_QUADS,
        spacing: TESS_ODD,
        evaluation: TESS_COORDINATES,
        outer: [1.0; 4],
        inner: [1.0; 2],
        ..TessFrame::default()
    };
    let counts = compare(&TessInput { frame, patches: &patches, levels: &[], heights: &[] }, &mut open());
    assert_eq!((counts.vertices, counts.primitives), (560_000, 280_000));
}

/// A row of patches, each with another place and size.
fn row_of_patches(count: u32) -> Vec<TessPatch> {
    let patch = |index: u32| {
        let mut patch = TessPatch::default();
        let places = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for (corner, [x, y]) in places.into_iter().enumerate() {
            patch.points[3 * corner..3 * corner + 3].copy_from_slice(&[x + index as f32, y, 0.1 * x]);
            patch.points[14 + 3 * corner] = 1.0;
        }
        patch.uv[0] = index as f32;
        patch
    };
    (0..count).map(patch).collect()
}

const OWN_LEVELS: &str = "
fn levels_of(index: u32) -> TessLevels {
    let level = own_level(index);
    var asked = built_in_levels(index);
    asked.outer = array<f32, 4>(level, level, max(level, tess_patches[index].uv[0]), level);
    return asked;
}

fn own_level(index: u32) -> f32 {
    return add(mul(float(i32(index)), 0.75), 1.0);
}";

const OWN_VERTEX: &str = "
fn evaluated(index: u32, coordinates: vec3<u32>) -> TessVertex {
    let x = mul(float(i32(coordinates.x)), OWN_STEP);
    let y = mul(float(i32(coordinates.y)), OWN_STEP);
    var own = vertex_of(vec3<f32>(x, y, mul(x, y)), vec3<f32>(0.0, 0.0, 1.0), vec2<f32>(y, x));
    own.position[2] = add(own.position[2], tess_patches[index].uv[0]);
    return own;
}

const OWN_STEP: f32 = 1.0 / f32(TESS_UNIT); // the end of the file";

fn own_levels(frame: &TessFrame) -> impl Fn(u32, &TessPatch) -> TessLevels + Send + Sync + 'static {
    let inner = frame.inner;
    move |index, patch| {
        let level = add(mul(float(index as i32), 0.75), 1.0);
        TessLevels { outer: [level, level, max(level, patch.uv[0]), level], inner }
    }
}

fn own_vertex(_: u32, patch: &TessPatch, [u, v, _]: [u32; 3]) -> TessVertex {
    let [x, y] = [u, v].map(|c| mul(float(c as i32), 1.0 / TESS_UNIT as f32));
    let position = [x, y, add(mul(x, y), patch.uv[0])];
    TessVertex { position, normal: [0.0, 0.0, 1.0], uv: [y, x] }
}

#[test]
fn steps_of_the_callers_own_have_the_same_bits_until_they_are_put_back() {
    let patches = row_of_patches(40);
    let (mut here, mut there) = (cpu(), open());
    for domain in [TESS_TRIANGLES, TESS_QUADS, TESS_ISOLINES] {
        let frame = TessFrame { domain, outer: [3.0; 4], inner: [5.0, 2.0], ..TessFrame::default() };
        let input = TessInput { frame, patches: &patches, levels: &[], heights: &[] };
        let ours = chunks(&mut here, &input);
        assert!(chunks(&mut there, &input) == ours);

        here.control_tessellation(Some(Arc::new(own_levels(&frame))));
        there.control_tessellation(Some(OWN_LEVELS)).expect("compiles");
        let controlled = chunks(&mut here, &input);
        assert!(controlled != ours);
        assert!(chunks(&mut there, &input) == controlled);

        here.evaluate_tessellation(Some(Arc::new(own_vertex)));
        there.evaluate_tessellation(Some(OWN_VERTEX)).expect("compiles");
        let evaluated = chunks(&mut here, &input);
        assert!(evaluated != controlled);
        assert!(chunks(&mut there, &input) == evaluated);

        here.control_tessellation(None);
        here.evaluate_tessellation(None);
        there.control_tessellation(None).expect("ours");
        there.evaluate_tessellation(None).expect("ours");
        assert!(chunks(&mut there, &input) == ours);
        assert!(chunks(&mut here, &input) == ours);
    }
}

/// Ours is then still there.
#[test]
fn a_step_that_does_not_compile_is_an_error() {
    let mut device = open();
    let wrong = "fn levels_of(index: u32) -> TessLevels { return levels[index].outer; }";
    let missing = "fn level_of_all() -> f32 { return 1.0; }";
    for own in [wrong, missing, "not WGSL", ""] {
        let error = device.control_tessellation(Some(own)).expect_err("no levels");
        assert!(matches!(error, WgpuError::Own { stage: "tess_control", .. }), "{error}");
        assert!(error.to_string().contains("fn levels_of(index: u32) -> TessLevels"), "{error}");
    }
    let error = device.evaluate_tessellation(Some(OWN_LEVELS)).expect_err("no vertices");
    let told = error.to_string();
    assert!(matches!(error, WgpuError::Own { stage: "tess_evaluate", .. }), "{told}");
    assert!(told.contains("fn evaluated(index: u32, coordinates: vec3<u32>) -> TessVertex"), "{told}");
    let patches = row_of_patches(3);
    let frame = TessFrame { outer: [2.0; 4], inner: [2.0; 2], ..TessFrame::default() };
    compare(&TessInput { frame, patches: &patches, levels: &[], heights: &[] }, &mut device);
}
