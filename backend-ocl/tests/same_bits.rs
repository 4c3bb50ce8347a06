//! OpenCL gives the CPU's bits: every scene, several batches, dice rates and compiler options.
//!
//! Runs on every OpenCL device there is; without one it fails, since nothing would be tested.

use micropoly::{Borders, FrameOptions, Oracle, Profile, Rasteriser, Samples, Scene, Shading};
use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_ocl::{OclDevice, OclError, OpenOptions, devices};
use micropoly_conformance::report::check_stage;
use micropoly_conformance::{Case, Schedule, run, run_scheduled};
use micropoly_core::abi::{Control, FLAG_LAYERS, MeshVertex, Shared};
use micropoly_core::backend::Device;
use micropoly_core::known;
use micropoly_core::memory::stack_min;
use micropoly_core::schedule::Scheduler;
use micropoly_core::stage::{Extent, Items, Stage};

/// Everything that an OpenCL compiler may be told to break.
const HOSTILE: &str = "-cl-fast-relaxed-math -cl-mad-enable -cl-denorms-are-zero";
const SCENES: [&str; 8] =
    ["teapot", "eyesplit", "spheres", "still-life", "gregory", "displaced", "copies", "shapes.rib"];
const SMALL: FrameOptions = FrameOptions {
    width: 320,
    height: 180,
    bound: 16.0,
    rate: 16,
    size: 1.0,
    oracle: Oracle::Size,
    tolerance: 0.5,
    borders: Borders::Watertight,
    levels: 23,
    cull_backfaces: false,
    whole: false,
    profile: Profile::Conservative,
    samples: Samples::One,
    shading: Shading::Flat,
    rasteriser: Rasteriser::SortMiddle,
    tile: 0,
};
/// The same image, sort-last.
const LAST: FrameOptions = FrameOptions { rasteriser: Rasteriser::SortLast, ..SMALL };

fn case(scene: &str, options: &FrameOptions) -> Case {
    let file = if scene.contains('.') { scene.to_owned() } else { format!("{scene}.toml") };
    let path = format!("{}/../scenes/{file}", env!("CARGO_MANIFEST_DIR"));
    let device = Scene::load(path).expect("a scene").for_device(options).expect("a drawable scene");
    Case {
        name: format!("{scene} {options:?}"),
        frame: device.frame,
        objects: device.objects,
        patches: device.patches,
        patch_count: device.patch_count,
    }
}

/// Number of devices; fails where there is none.
fn device_count() -> usize {
    devices().unwrap_or_else(|error| panic!("this test needs an OpenCL device: {error}")).len()
}

/// Renders on every device and on the CPU.
fn compare(case: &Case, batches: &[u32], options: &OpenOptions<'_>) {
    let mut cpu = CpuDevice::new(1).expect("threads");
    let expected = run(&mut cpu, case, 4096).expect("renders");
    for index in 0..device_count() {
        let mut device = OclDevice::open(index, options).unwrap_or_else(|error| panic!("{error}"));
        for &batch in batches {
            let outcome = run(&mut device, case, batch).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(
                outcome,
                expected,
                "{}: {} differs, batch {batch}, {options:?}",
                case.name,
                device.name()
            );
        }
    }
}

#[test]
fn all_scenes_have_the_bits_of_the_cpu() {
    for scene in SCENES {
        compare(&case(scene, &SMALL), &[500, 4096], &OpenOptions::default());
    }
}

#[test]
fn other_dice_rates_have_the_bits_of_the_cpu() {
    for (rate, bound) in [(8, 8.0), (7, 7.0), (16, 20.0), (2, 20.0), (1, 3.0)] {
        compare(&case("teapot", &FrameOptions { rate, bound, ..SMALL }), &[4096], &OpenOptions::default());
    }
}

#[test]
fn flatness_has_the_bits_of_the_cpu() {
    for scene in ["teapot", "gregory", "eyesplit", "copies", "shapes.rib"] {
        for tolerance in [0.25, 2.0] {
            let options = FrameOptions { oracle: Oracle::Flatness, tolerance, ..SMALL };
            compare(&case(scene, &options), &[4096], &OpenOptions::default());
        }
    }
}

#[test]
fn other_borders_have_the_bits_of_the_cpu() {
    for borders in [Borders::Naive, Borders::Fixed] {
        for scene in ["teapot", "gregory"] {
            let options = FrameOptions { borders, ..SMALL };
            compare(&case(scene, &options), &[4096], &OpenOptions::default());
        }
    }
}

#[test]
fn small_micropolygons_have_the_bits_of_the_cpu() {
    let options = FrameOptions { size: 0.5, bound: 8.0, ..SMALL };
    for scene in ["teapot", "hair"] {
        compare(&case(scene, &options), &[4096], &OpenOptions::default());
    }
}

/// Behind the eye too, surfaces are bounded, and corners that strayed may be cut off.
#[test]
fn a_mesh_that_is_whole_has_the_bits_of_the_cpu() {
    for scene in ["teapot", "eyesplit", "gregory", "copies", "shapes.rib"] {
        let options = FrameOptions { whole: true, ..SMALL };
        compare(&case(scene, &options), &[4096], &OpenOptions::default());
    }
}

/// One group with hardly any stack, some with stacks that they fill, and many.
fn compare_local(case: &Case, options: &OpenOptions<'_>) {
    let expected = run(&mut CpuDevice::new(1).expect("threads"), case, 4096).expect("renders");
    let least = stack_min(u64::from(case.frame.levels)) as u32;
    for index in 0..device_count() {
        let mut device = OclDevice::open(index, options).unwrap_or_else(|error| panic!("{error}"));
        for (batch, capacity) in [(64, least), (1000, 16 * least + 50), (5000, 0)] {
            let schedule = Schedule { scheduler: Scheduler::Local, batch, capacity };
            let outcome =
                run_scheduled(&mut device, case, schedule).unwrap_or_else(|error| panic!("{error}"));
            let name = device.name();
            assert_eq!(outcome, expected, "{}: {name} differs, batch {batch}, {options:?}", case.name);
        }
    }
}

#[test]
fn local_schedules_have_the_bits_of_the_cpu() {
    for scene in SCENES {
        compare_local(&case(scene, &SMALL), &OpenOptions::default());
    }
}

#[test]
fn local_schedules_have_the_bits_of_the_cpu_behind_the_barrier() {
    let barrier = OpenOptions { barrier: true, ..OpenOptions::default() };
    let hostile = OpenOptions { build_options: HOSTILE.to_owned(), skip_check: true, ..barrier.clone() };
    for options in [barrier, hostile] {
        compare_local(&case("gregory", &SMALL), &options);
    }
}

#[test]
fn webers_rules_have_the_bits_of_the_cpu() {
    let options = FrameOptions { profile: Profile::Weber2014, ..SMALL };
    for scene in ["teapot", "gregory"] {
        compare(&case(scene, &options), &[4096], &OpenOptions::default());
    }
}

#[test]
fn backface_culling_has_the_bits_of_the_cpu() {
    let options = FrameOptions { cull_backfaces: true, ..SMALL };
    compare(&case("teapot", &options), &[4096], &OpenOptions::default());
}

#[test]
fn an_image_that_ends_within_tiles_has_the_bits_of_the_cpu() {
    let options = FrameOptions { width: 211, height: 97, ..SMALL };
    compare(&case("still-life", &options), &[4096], &OpenOptions::default());
}

/// A tile that holds few draws and few hits at once goes through them in many pieces, and looks twice.
#[test]
fn the_room_of_a_tile_changes_no_bits() {
    let edit = |name: &str, source: &str| match name {
        "sample.cl" => {
            let edited = source.replace("LISTED 128u", "LISTED 3u").replace("HITS 1024u", "HITS 40u");
            assert_eq!(edited.len(), source.len() - 4, "both are edited");
            edited
        }
        _ => source.to_owned(),
    };
    let options = OpenOptions { edit: Some(&edit), ..OpenOptions::default() };
    for scene in SCENES {
        compare(&case(scene, &SMALL), &[4096], &options);
    }
}

/// Where there is no room for the lists of all tiles each tile looks at all draws.
#[test]
fn the_room_of_the_lists_changes_no_bits() {
    let edit = |name: &str, source: &str| match name {
        "sort_middle.cl" => {
            let edited = source.replace("LIST_ROOM 1048576u", "LIST_ROOM 100u");
            assert_eq!(edited.len(), source.len() - 4, "it is edited");
            edited
        }
        _ => source.to_owned(),
    };
    let options = OpenOptions { edit: Some(&edit), ..OpenOptions::default() };
    for scene in ["teapot", "eyesplit"] {
        compare(&case(scene, &SMALL), &[4096], &options);
    }
}

#[test]
fn tiles_of_any_size_have_the_bits_of_the_cpu() {
    for tile in [4, 8, 16, 32] {
        compare(&case("still-life", &FrameOptions { tile, ..SMALL }), &[4096], &OpenOptions::default());
    }
}

#[test]
fn many_samples_a_pixel_have_the_bits_of_the_cpu() {
    let shading = Shading::Smooth;
    for samples in [Samples::Four, Samples::SixtyFour] {
        let options = FrameOptions { width: 160, height: 90, samples, shading, ..SMALL };
        for scene in ["teapot", "eyesplit"] {
            compare(&case(scene, &options), &[4096], &OpenOptions::default());
        }
    }
}

#[test]
fn sort_last_has_the_bits_of_the_cpu() {
    for scene in SCENES {
        compare(&case(scene, &LAST), &[500, 4096], &OpenOptions::default());
    }
    let many = FrameOptions { samples: Samples::Sixteen, shading: Shading::Smooth, ..LAST };
    compare(&case("eyesplit", &many), &[4096], &OpenOptions::default());
}

/// What can be seen through is found layer by layer.
fn see_through(scene: &str, options: &FrameOptions) -> Case {
    let mut case = case(scene, options);
    for object in &mut case.objects {
        object.opacity = 0.5;
    }
    case.frame.flags |= FLAG_LAYERS;
    case
}

#[test]
fn layers_have_the_bits_of_the_cpu() {
    for options in [SMALL, FrameOptions { shading: Shading::Smooth, ..LAST }] {
        compare(&see_through("teapot", &options), &[4096], &OpenOptions::default());
    }
}

#[test]
fn more_draws_than_a_chunk_have_the_bits_of_the_cpu() {
    for options in [SMALL, LAST] {
        let case = case("teapot", &FrameOptions { bound: 2.0, rate: 2, ..options });
        let drawn = run(&mut CpuDevice::new(1).expect("threads"), &case, 4096).expect("renders").drawn;
        assert!(drawn > 4 * 2048, "{drawn} drawn");
        compare(&case, &[300, 4096], &OpenOptions::default());
    }
}

/// All that a device has for itself is counted, and kept for the next frame.
#[test]
fn own_buffers_are_counted_and_kept() {
    for (index, options) in (0..device_count()).flat_map(|index| [(index, SMALL), (index, LAST)]) {
        let mut device =
            OclDevice::open(index, &OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        let mut kept_after = |rate| {
            let case = case("teapot", &FrameOptions { rate, ..options });
            run(&mut device, &case, 4096).unwrap_or_else(|error| panic!("{error}"));
            (device.bytes_allocated(), device.own_bytes(Extent::of(&case.frame, case.frame.sample_count())))
        };
        let at_8 = kept_after(8);
        assert_eq!(kept_after(2).0, at_8.0);
        let at_16 = kept_after(16);
        assert_eq!((at_8.0, at_16.0), (at_8.1, at_16.1));
        assert!(at_16 > at_8 && at_8.0 > 2048 * 9 * 81 * 4, "{at_8:?}, {at_16:?}");
    }
}

#[test]
fn a_buffer_is_cleared_after_all_stages() {
    for index in 0..device_count() {
        let mut device =
            OclDevice::open(index, &OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        let buffer = device.allocate("control", Control::LAYOUT, 1).expect("memory");
        let some = Control { stack: 3, overflow: 7, waiting: 5, ..Control::default() };
        device.write(&buffer, &[some]).expect("writes");
        device.dispatch(Stage::Flush, Items::Count(1), &[&buffer]).expect("runs");
        device.clear(&buffer).expect("clears");
        let mut after = [some];
        device.read(&buffer, 0, &mut after).expect("reads");
        assert_eq!(after, [Control::default()]);
    }
}

#[test]
fn the_barrier_changes_no_bits() {
    let options = OpenOptions { barrier: true, ..OpenOptions::default() };
    compare(&case("spheres", &SMALL), &[4096], &options);
}

#[test]
fn a_hostile_compiler_changes_no_bits_behind_the_barrier() {
    let options = OpenOptions {
        build_options: HOSTILE.to_owned(),
        barrier: true,
        skip_check: true, // denormals are flushed, as asked for; no kernel produces any
        ..OpenOptions::default()
    };
    for scene in SCENES {
        compare(&case(scene, &SMALL), &[4096], &options);
    }
    compare(&see_through("gregory", &LAST), &[4096], &options);
}

/// Bits of all vertices, and all indices.
fn mesh<D: Device>(
    device: &mut D,
    case: &Case,
    schedule: Schedule,
) -> Result<(Vec<MeshVertex>, Vec<u32>), D::Error> {
    let plan = case.plan(schedule)?;
    let mut buffers = plan.prepare(device, &case.objects, &case.patches)?;
    let mesh = plan.tessellate(device, &mut buffers)?;
    let mut vertices = vec![MeshVertex::default(); mesh.totals.vertices as usize];
    let mut indices = vec![0; 3 * mesh.totals.triangles as usize];
    device.read(&mesh.vertices, 0, &mut vertices)?;
    device.read(&mesh.indices, 0, &mut indices)?;
    Ok((vertices, indices))
}

#[test]
fn meshes_of_frames_have_the_bits_of_the_cpu() {
    let options = FrameOptions { whole: true, ..SMALL };
    for (scene, batch) in [("teapot", 300), ("eyesplit", 64), ("gregory", 4096), ("displaced", 1000)] {
        let (case, schedule) = (case(scene, &options), Schedule::of_batch(batch));
        let mut cpu = CpuDevice::new(1).expect("threads");
        let (vertices, indices) = mesh(&mut cpu, &case, schedule).expect("a mesh");
        assert!(!indices.is_empty(), "{scene}");
        for index in 0..device_count() {
            let mut device =
                OclDevice::open(index, &OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"));
            let found = mesh(&mut device, &case, schedule).unwrap_or_else(|error| panic!("{error}"));
            let same_bits =
                bytemuck::cast_slice::<_, u32>(&found.0) == bytemuck::cast_slice::<_, u32>(&vertices);
            assert!(same_bits && found.1 == indices, "{scene}: {} differs", device.name());
        }
    }
}

#[test]
fn meshes_have_the_bits_of_the_cpu_behind_the_barrier() {
    let barrier = OpenOptions { barrier: true, ..OpenOptions::default() };
    let hostile = OpenOptions { build_options: HOSTILE.to_owned(), skip_check: true, ..barrier.clone() };
    for options in [OpenOptions::default(), barrier, hostile] {
        for index in 0..device_count() {
            let mut device = OclDevice::open(index, &options).unwrap_or_else(|error| panic!("{error}"));
            let mut cpu = CpuDevice::new(1).expect("threads");
            for stage in [Stage::MeshPlaces, Stage::Mesh] {
                let report = check_stage(&mut cpu, &mut device, stage, 20);
                assert!(report.agrees(), "{}, {options:?}: {report:?}", device.name());
            }
        }
    }
}

#[test]
fn a_hostile_compiler_is_found_out() {
    let hostile =
        |barrier| OpenOptions { build_options: HOSTILE.to_owned(), barrier, ..OpenOptions::default() };
    for index in 0..device_count() {
        for barrier in [false, true] {
            match OclDevice::open(index, &hostile(barrier)) {
                Ok(device) => println!("{}: no operation differs, barrier {barrier}", device.name()),
                Err(OclError::WrongAnswer { device, mismatch }) => {
                    println!("{device}: {} differs, barrier {barrier}", mismatch.operation());
                }
                Err(error) => panic!("{error}"),
            }
        }
    }
}

#[test]
fn every_device_gives_the_known_answers() {
    for index in 0..device_count() {
        for barrier in [false, true] {
            let options = OpenOptions { barrier, skip_check: true, ..OpenOptions::default() };
            let mut device = OclDevice::open(index, &options).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(known::check(&mut device).expect("runs"), None, "{}", device.name());
        }
    }
}

#[test]
fn a_wrong_kernel_is_refused() {
    let edit = |name: &str, source: &str| match name {
        "num.cl" => source.replace("exact(a + b)", "exact(a - b)"),
        _ => source.to_owned(),
    };
    let options = OpenOptions { edit: Some(&edit), ..OpenOptions::default() };
    for index in 0..device_count() {
        let error = OclDevice::open(index, &options).expect_err("must be refused").to_string();
        assert!(error.contains("is refused: it computes a + b otherwise"), "{error}");
    }
}

#[test]
fn what_is_too_large_is_refused_with_its_numbers() {
    for index in 0..device_count() {
        let mut device =
            OclDevice::open(index, &OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        let limit = device.info().max_allocation;
        let error = device.allocate("stack", u32::LAYOUT, limit).expect_err("too large").to_string();
        assert!(error.contains("stack") && error.contains(&limit.to_string()), "{error}");
        assert_eq!(device.bytes_allocated(), 0);
    }
}
