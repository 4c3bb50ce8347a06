//! Every scene gives exactly the CPU's bits. Needs a Vulkan driver; Mesa's software one will do.

use micropoly::{Borders, FrameOptions, Oracle, Profile, Scene};
use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_wgpu::{WgpuDevice, WgpuError, devices, wgpu};
use micropoly_conformance::stages::{Input, run_stage};
use micropoly_conformance::{Case, Outcome, Schedule, run, run_scheduled};
use micropoly_core::abi::{
    Colour, Control, DRAW, Draw, FLAG_FLAT, FLAG_LAYERS, FLAG_SMOOTH, FLAG_SORT_LAST, FLAG_WEBER, Frame,
    Group, MeshPlace, MeshTotals, MeshVertex, Object, Patch, Question, Sample, Shared, Surface, Verdict,
};
use micropoly_core::adjacency::{find_owners, room_needed};
use micropoly_core::backend::Device;
use micropoly_core::border::Side;
use micropoly_core::displacement::Displacement;
use micropoly_core::kernel::known_answers::answer;
use micropoly_core::memory::stack_min;
use micropoly_core::pattern::{Region, Samples};
use micropoly_core::schedule::Scheduler;
use micropoly_core::stage::{Extent, Items, Stage};
use micropoly_core::tessellate::MeshBuffers;

fn open() -> WgpuDevice {
    WgpuDevice::open(0, None).unwrap_or_else(|error| panic!("these tests need a GPU or lavapipe: {error}"))
}

fn case(scene: &str, options: FrameOptions) -> Case {
    let file = if scene.contains('.') { scene.to_owned() } else { format!("{scene}.toml") };
    let path = format!("{}/../scenes/{file}", env!("CARGO_MANIFEST_DIR"));
    let device = Scene::load(path).expect("a scene").for_device(&options).expect("a drawable scene");
    Case {
        name: format!("{scene}, {options:?}"),
        frame: device.frame,
        objects: device.objects,
        patches: device.patches,
        patch_count: device.patch_count,
    }
}

/// A scene with bumps on all of it.
fn displaced(scene: &str, options: FrameOptions) -> Case {
    let mut case = case(scene, options);
    let bumps = Displacement { height: 0.05, frequency: 4.0, octaves: 3 };
    case.objects.iter_mut().for_each(|object| *object = object.displaced(&bumps, 2.0));
    let mut room = vec![0; room_needed(&case.patches)];
    find_owners(&mut case.patches, &mut room);
    Case { name: format!("displaced {}", case.name), ..case }
}

fn small() -> FrameOptions {
    FrameOptions { width: 320, height: 180, ..FrameOptions::default() }
}

fn on_cpu(case: &Case) -> Outcome {
    run(&mut CpuDevice::new(1).expect("threads"), case, 4096).expect("renders")
}

fn assert_same(case: &Case, batches: &[u32]) {
    let expected = on_cpu(case);
    let mut device = open();
    for &batch in batches {
        let found = run(&mut device, case, batch).expect("renders");
        assert_eq!(found, expected, "{}, batch {batch}", case.name);
    }
}

#[test]
fn devices_are_listed_and_one_opens() {
    assert!(!devices().is_empty(), "no Vulkan driver: apt install mesa-vulkan-drivers libvulkan1");
    assert_eq!(open().name(), devices()[0].name);
}

#[test]
fn the_teapot_has_the_same_bits() {
    assert_same(&case("teapot", small()), &[500, 4096]);
}

#[test]
fn the_eye_split_has_the_same_bits() {
    assert_same(&case("eyesplit", small()), &[500, 4096]);
}

#[test]
fn the_spheres_have_the_same_bits() {
    assert_same(&case("spheres", small()), &[500, 4096]);
}

#[test]
fn the_still_life_has_the_same_bits() {
    assert_same(&case("still-life", small()), &[500, 4096]);
}

/// Kernels of their own: see `bound_any.wgsl` and `dice_gregory.wgsl`.
#[test]
fn gregory_patches_and_webers_rules_have_the_same_bits() {
    let weber = FrameOptions { profile: Profile::Weber2014, rate: 8, bound: 8.0, ..small() };
    assert_same(&case("gregory", small()), &[500, 4096]);
    assert_same(&case("gregory", weber), &[500]);
    assert_same(&case("teapot", weber), &[4096]);
}

/// The vertices of edges are evaluated on the nets of other patches: see `owner.wgsl`.
#[test]
fn displaced_patches_have_the_same_bits() {
    assert_same(&case("displaced", small()), &[500, 4096]);
    assert_same(&case("displaced", FrameOptions { borders: Borders::Naive, rate: 7, ..small() }), &[4096]);
    assert_same(&displaced("gregory", small()), &[4096]);
}

/// Objects that have the same patches, and rational ones.
#[test]
fn copies_and_shapes_have_the_same_bits() {
    for scene in ["copies", "shapes.rib"] {
        assert_same(&case(scene, small()), &[4096]);
        assert_same(&case(scene, FrameOptions { whole: true, ..small() }), &[4096]);
    }
}

/// Kernels of their own, on a device that is asked for small surfaces before and after.
#[test]
fn flat_surfaces_have_the_same_bits() {
    let flat = |tolerance| FrameOptions { oracle: Oracle::Flatness, tolerance, ..small() };
    let mut device = open();
    for scene in ["teapot", "gregory", "eyesplit", "copies", "shapes.rib"] {
        for options in [flat(0.25), small(), flat(2.0)] {
            let case = case(scene, options);
            assert_eq!(run(&mut device, &case, 4096).expect("renders"), on_cpu(&case), "{}", case.name);
        }
    }
}

/// The same buffer has a frame with flat surfaces, then one by Weber's rules, which know none, then one with small ones.
#[test]
fn what_a_frame_asks_for_is_what_was_written_last() {
    let case = case("gregory", small());
    let mut frames = [case.frame; 4];
    for (frame, flags) in frames.iter_mut().zip([0, FLAG_FLAT, FLAG_FLAT | FLAG_WEBER, 0]) {
        frame.flags = flags;
    }
    let expected = verdicts(&mut CpuDevice::new(1).expect("threads"), &case, &frames);
    assert!(expected[0] != expected[1] && expected[1] != expected[2], "verdicts differ");
    assert_eq!(verdicts(&mut open(), &case, &frames), expected);
}

/// The verdicts on all patches, with one frame after the other in the same buffer.
fn verdicts<D: Device>(device: &mut D, case: &Case, frames: &[Frame]) -> Vec<Vec<Verdict>> {
    let count = case.patch_count as u32;
    let surfaces: Vec<Surface> = (0..count).map(Surface::root).collect();
    let mut found = vec![Verdict::default(); surfaces.len()];
    let frame = filled(device, "frame", &frames[..1]);
    let objects = filled(device, "objects", &case.objects);
    let patches = filled(device, "patches", &case.patches);
    let control = filled(device, "control", &[Control { taken: count, ..Control::default() }]);
    let (stack, batch) = (filled(device, "stack", &surfaces), filled(device, "batch", &surfaces));
    let verdicts = filled(device, "verdicts", &found);
    let mut all = Vec::new();
    for one in frames {
        device.write(&frame, &[*one]).expect("writes");
        let buffers = [&frame, &objects, &patches, &control, &stack, &batch, &verdicts];
        device.dispatch(Stage::Bound, Items::Taken, &buffers).expect("runs");
        device.read(&verdicts, 0, &mut found).expect("reads");
        all.push(found.clone());
    }
    all
}

fn filled<D: Device, T: Shared>(device: &mut D, name: &'static str, data: &[T]) -> D::Buffer {
    let buffer = device.allocate(name, T::LAYOUT, data.len() as u64).expect("allocates");
    device.write(&buffer, data).expect("writes");
    buffer
}

/// One group and many, stacks as small as they can be and as large as they are without a capacity.
#[test]
fn groups_with_stacks_of_their_own_give_the_same_bits() {
    let weber = FrameOptions { profile: Profile::Weber2014, rate: 8, bound: 8.0, ..small() };
    let mut device = open();
    let displaced = displaced("gregory", small());
    for case in [case("teapot", small()), case("gregory", small()), case("eyesplit", weber), displaced] {
        let (expected, least) = (on_cpu(&case), stack_min(u64::from(case.frame.levels)) as u32);
        for (batch, capacity) in [(1, least), (64, 0), (1000, 16 * least + 50), (20_000, 0)] {
            let schedule = Schedule { scheduler: Scheduler::Local, batch, capacity };
            let found = run_scheduled(&mut device, &case, schedule).expect("renders");
            assert_eq!(found, expected, "{}, batch {batch}, capacity {capacity}", case.name);
        }
    }
}

/// As fine as grids can be, and as short as they then are on screen.
#[test]
fn large_grids_have_the_same_bits() {
    assert_same(&case("teapot", FrameOptions { size: 0.5, bound: 8.0, ..small() }), &[4096]);
}

#[test]
fn small_grids_have_the_same_bits() {
    assert_same(&case("teapot", FrameOptions { rate: 2, bound: 20.0, ..small() }), &[4096]);
}

/// Rates that are no powers of two, in grids of the same kind.
#[test]
fn odd_grids_have_the_same_bits() {
    assert_same(&case("teapot", FrameOptions { rate: 7, bound: 7.0, ..small() }), &[4096]);
    assert_same(&case("gregory", FrameOptions { rate: 7, bound: 7.0, ..small() }), &[4096]);
}

#[test]
fn all_borders_have_the_same_bits() {
    for borders in [Borders::Naive, Borders::Fixed] {
        assert_same(&case("teapot", FrameOptions { borders, ..small() }), &[4096]);
        assert_same(&case("gregory", FrameOptions { borders, rate: 5, bound: 5.0, ..small() }), &[4096]);
    }
}

/// A mesh that is to be whole is bounded by kernels for any patch, although all are Bezier patches.
#[test]
fn whole_meshes_have_the_same_bits() {
    assert_same(&case("teapot", FrameOptions { whole: true, ..small() }), &[4096]);
    assert_same(&case("gregory", FrameOptions { whole: true, ..small() }), &[4096]);
}

#[test]
fn culled_backfaces_leave_the_same_bits() {
    assert_same(&case("teapot", FrameOptions { cull_backfaces: true, ..small() }), &[4096]);
}

/// Micropolygons of hundreds of pixels, whose edge functions need 64 bits, and clipped ones.
#[test]
fn large_micropolygons_have_the_same_bits() {
    let tiny = FrameOptions { width: 160, height: 90, rate: 1, ..FrameOptions::default() };
    assert_same(&case("teapot", FrameOptions { levels: 1, ..tiny }), &[4096]);
    assert_same(&case("eyesplit", FrameOptions { levels: 3, ..tiny }), &[7]);
}

/// Tiles of all sizes, and both rasterisers; colours between vertices; layers, where one object can be seen through.
#[test]
fn samples_and_layers_have_the_same_bits() {
    let tiny = FrameOptions { width: 96, height: 54, ..FrameOptions::default() };
    let mut device = open();
    for (scene, samples, tile, flags) in [
        ("teapot", Samples::Four, 4, FLAG_SMOOTH),
        ("eyesplit", Samples::Sixteen, 0, FLAG_SMOOTH | FLAG_LAYERS),
        ("gregory", Samples::SixtyFour, 32, FLAG_LAYERS),
        ("still-life", Samples::One, 8, FLAG_LAYERS),
    ] {
        let mut case = case(scene, tiny);
        case.objects[0].opacity = 0.5;
        case.frame = case.frame.with_region(Region::whole(tiny.width, tiny.height, samples), tile);
        for flags in [flags, flags | FLAG_SORT_LAST] {
            case.frame.flags |= flags;
            let expected = on_cpu(&case);
            assert_eq!(run(&mut device, &case, 4096).expect("renders"), expected, "{}, {flags}", case.name);
        }
    }
}

/// Draws that all touch all tiles: so many at once that the lists have no room for them.
#[test]
fn draws_that_lists_have_no_room_for_have_the_same_bits() {
    let (side, count) = (256, 300);
    let case = case("teapot", FrameOptions { width: side, height: side, ..FrameOptions::default() });
    let frame = case.frame.with_region(Region::whole(side, side, Samples::One), 4);
    let pixels = (side * side) as usize;
    let everywhere = side << 16;
    let draw = |index| Draw { columns: everywhere, rows: everywhere, ..whole(index % 32, [1, 2]) };
    let draws: Vec<Draw> = (0..count).map(draw).collect();
    let input = Input {
        stage: Stage::Draw,
        items: Items::Image(Extent::of(&frame, pixels as u64)),
        buffers: vec![
            words(&[frame]),
            words(&case.objects),
            words(&case.patches),
            words(&[Control { waiting: count, ..Control::default() }]),
            words(&draws),
            words(&[Sample::default()]),
            words(&vec![Sample::default(); pixels]),
            words(&vec![Colour::default(); pixels]),
        ],
    };
    let expected = run_stage(&mut CpuDevice::new(1).expect("threads"), &input).expect("runs");
    assert!(run_stage(&mut open(), &input).expect("runs") == expected);
}

fn words<T: Shared>(entries: &[T]) -> Vec<u32> {
    bytemuck::cast_slice(entries).to_vec()
}

/// More groups than one dimension of a dispatch has.
#[test]
fn many_items_are_spread_over_two_dimensions() {
    let count = 5_000_000;
    let mut device = open();
    let frame = device.allocate("frame", Frame::LAYOUT, 1).expect("memory");
    let asked = device.allocate("questions", Question::LAYOUT, u64::from(count)).expect("memory");
    let answered = device.allocate("answers", u32::LAYOUT, u64::from(count)).expect("memory");
    let questions: Vec<Question> = (0..count).map(|a| Question { operation: 16, a, b: 3, c: 0 }).collect();
    device.write(&asked, &questions).expect("writes");
    device.dispatch(Stage::KnownAnswers, Items::Count(count), &[&frame, &asked, &answered]).expect("runs");
    let mut answers = vec![0; count as usize];
    device.read(&answered, 0, &mut answers).expect("reads");
    assert!(answers.iter().zip(&questions).all(|(found, question)| *found == answer(*question)));
}

/// Groups of LOCAL that keep what they have.
#[test]
fn many_groups_are_spread_over_two_dimensions() {
    let count = 70_000;
    let mut device = open();
    let mut reserve = |name, layout, entries| device.allocate(name, layout, entries).expect("memory");
    let frame = reserve("frame", Frame::LAYOUT, 1);
    let objects = reserve("objects", Object::LAYOUT, 1);
    let patches = reserve("patches", Patch::LAYOUT, 1);
    let groups = reserve("groups", Group::LAYOUT, u64::from(count));
    let [dealt, stack] = ["dealt", "stack"].map(|name| reserve(name, Surface::LAYOUT, u64::from(count)));
    let fresh = reserve("fresh", Draw::LAYOUT, 1);
    device.write(&groups, &vec![Group { stack: 1, room: 1, ..Group::default() }; 70_000]).expect("writes");
    let surfaces: Vec<Surface> = (1..=count).map(Surface::root).collect();
    device.write(&dealt, &surfaces).expect("writes");
    let buffers = [&frame, &objects, &patches, &dealt, &groups, &stack, &fresh];
    device.dispatch(Stage::Local, Items::Groups(count), &buffers).expect("runs");
    let mut found = vec![Surface::default(); surfaces.len()];
    device.read(&stack, 0, &mut found).expect("reads");
    assert!(found == surfaces);
    let error =
        device.dispatch(Stage::Local, Items::Groups(count - 1), &buffers).expect_err("more are there");
    assert!(matches!(error, WgpuError::Bindings { stage: "local" }), "{error}");
}

/// Words of a mesh's vertices, and its indices.
type Words = (Vec<u32>, Vec<u32>);

/// The mesh that `draws` of a scene come to, but for the last draw.
fn mesh<D: Device>(device: &mut D, (objects, patches): (&[Object], &[Patch]), draws: &[Draw]) -> Words {
    let count = draws.len() as u32 - 1;
    let sizes = draws[..count as usize].iter().map(|draw| (draw.vertices(), draw.triangles()));
    let (vertices, triangles) = sizes.fold((0, 0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
    let mut reserve = |name, layout, entries: usize| {
        device.allocate(name, layout, entries as u64).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    let buffers = (
        reserve("frame", Frame::LAYOUT, 1),
        reserve("objects", Object::LAYOUT, objects.len()),
        reserve("patches", Patch::LAYOUT, patches.len()),
        reserve("control", Control::LAYOUT, 1),
        reserve("draws", Draw::LAYOUT, draws.len()),
        reserve("places", MeshPlace::LAYOUT, draws.len()),
        reserve("totals", MeshTotals::LAYOUT, 1),
        reserve("vertices", MeshVertex::LAYOUT, vertices as usize),
        reserve("indices", u32::LAYOUT, 3 * triangles as usize),
    );
    let (frame, placed, stored, control, drawn, places, totals, vertex, index) = &buffers;
    device.write(placed, objects).expect("writes");
    device.write(stored, patches).expect("writes");
    device.write(drawn, draws).expect("writes");
    device.write(control, &[Control { waiting: 5, fresh: count - 5, ..Control::default() }]).expect("writes");
    device.dispatch(Stage::MeshPlaces, Items::Count(1), &[control, drawn, places, totals]).expect("runs");
    let mesh = [frame, placed, stored, drawn, places, vertex, index];
    device.dispatch(Stage::Mesh, Items::Count(count), &mesh).expect("runs");
    let mut found = [MeshTotals::default()];
    device.read(totals, 0, &mut found).expect("reads");
    assert_eq!(found, [MeshTotals { vertices, triangles }]);
    let mut all_vertices = vec![MeshVertex::default(); vertices as usize];
    device.read(vertex, 0, &mut all_vertices).expect("reads");
    let mut indices = vec![0; 3 * triangles as usize];
    device.read(index, 0, &mut indices).expect("reads");
    (bytemuck::cast_slice(&all_vertices).to_vec(), indices)
}

/// A draw of a whole patch.
fn whole(patch_id: u32, rates: [u32; 2]) -> Draw {
    let verdict = Verdict { code: DRAW, ..Verdict::default() }.with_sides([Side::LIVE; 4], rates);
    Draw::new(Surface::root(patch_id), verdict)
}

/// More draws than one dimension of a dispatch has groups; the groups that are too many leave all alone.
#[test]
fn meshes_of_many_draws_are_spread_over_two_dimensions() {
    let Case { objects, patches, .. } = case("teapot", small());
    let mut draws: Vec<Draw> = (0..70_000).map(|index| whole(1 + index % 30, [1, 1 + index % 2])).collect();
    draws.push(whole(0, [16, 16]));
    let expected = mesh(&mut CpuDevice::new(1).expect("threads"), (&objects, &patches), &draws);
    assert!(mesh(&mut open(), (&objects, &patches), &draws) == expected);
}

/// Control points of a mesh stay as they are, except that -0 becomes 0.
#[test]
fn meshes_have_no_negative_zeros() {
    let Case { objects, mut patches, .. } = case("gregory", small());
    patches.iter_mut().for_each(|patch| patch.z = [-0.0; 16]);
    let count = patches.len() as u32;
    let draws: Vec<Draw> = (0..count).map(|patch_id| whole(patch_id, [3, 2])).collect();
    let expected = mesh(&mut CpuDevice::new(1).expect("threads"), (&objects, &patches), &draws);
    assert!(expected.0.chunks(9).all(|vertex| vertex[2] == 0), "z is 0");
    assert!(mesh(&mut open(), (&objects, &patches), &draws) == expected);
}

/// Patches that one binding has no room for lie in two, for meshes too.
#[test]
fn meshes_of_patches_in_two_pieces_have_the_same_bits() {
    let Case { objects, patches, .. } = case("spheres", small());
    let count = patches.len() as u32;
    let draws: Vec<Draw> = (0..50).chain(count - 50..count).map(|patch_id| whole(patch_id, [5, 8])).collect();
    let expected = mesh(&mut CpuDevice::new(1).expect("threads"), (&objects, &patches), &draws);
    let mut device = open();
    device.limit_buffers(250_000);
    assert!(patches.len() as u64 * Patch::LAYOUT.size as u64 > 250_000);
    assert!(mesh(&mut device, (&objects, &patches), &draws) == expected);
}

#[test]
fn a_mesh_of_more_draws_than_there_are_is_an_error() {
    let mut device = open();
    let mut reserve = |name, layout| device.allocate(name, layout, 3).expect("memory");
    let (frame, objects) = (reserve("frame", Frame::LAYOUT), reserve("objects", Object::LAYOUT));
    let patches = reserve("patches", Patch::LAYOUT);
    let (draws, places) = (reserve("draws", Draw::LAYOUT), reserve("places", MeshPlace::LAYOUT));
    let (vertices, indices) = (reserve("vertices", MeshVertex::LAYOUT), reserve("indices", u32::LAYOUT));
    let buffers = [&frame, &objects, &patches, &draws, &places, &vertices, &indices];
    device.dispatch(Stage::Mesh, Items::Count(0), &buffers).expect("nothing to do");
    let error = device.dispatch(Stage::Mesh, Items::Count(4), &buffers).expect_err("more than there are");
    assert!(matches!(error, WgpuError::Bindings { stage: "mesh" }), "{error}");
}

/// A whole frame, by batches whose draws follow each other; then as its user copies it.
#[test]
fn tessellated_frames_have_the_same_bits() {
    let mut device = open();
    let bumpy = case("displaced", FrameOptions { whole: true, ..small() });
    let expected = tessellated(&mut CpuDevice::new(1).expect("threads"), &bumpy).1;
    assert!(tessellated(&mut device, &bumpy).1 == expected);
    let case = case("gregory", FrameOptions { whole: true, ..small() });
    let expected = tessellated(&mut CpuDevice::new(1).expect("threads"), &case).1;
    let (mesh, found) = tessellated(&mut device, &case);
    assert!(found == expected);
    let bytes = u64::from(mesh.totals.triangles) * 12;
    let (label, usage) = (None, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let wanted = wgpu::BufferDescriptor { label, size: bytes, usage, mapped_at_creation: false };
    let copy = device.device().create_buffer(&wanted);
    let mut encoder = device.device().create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(mesh.indices.raw(), 0, &copy, 0, bytes);
    device.submit();
    device.queue().submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |done| done.expect("maps"));
    device.device().poll(wgpu::PollType::wait_indefinitely()).expect("waits");
    let copied = copy.get_mapped_range(..).expect("is mapped");
    assert!(bytemuck::cast_slice::<u8, u32>(&copied) == expected.1);
    assert!(mesh.vertices.raw().usage().contains(wgpu::BufferUsages::VERTEX));
    assert!(mesh.indices.raw().usage().contains(wgpu::BufferUsages::INDEX));
}

fn tessellated<D: Device>(device: &mut D, case: &Case) -> (MeshBuffers<D::Buffer>, Words) {
    let plan = case.plan(Schedule::of_batch(500)).expect("a plan");
    let mut buffers = plan.prepare(device, &case.objects, &case.patches).expect("memory");
    let mesh = plan.tessellate(device, &mut buffers).expect("tessellates");
    let mut vertices = vec![MeshVertex::default(); mesh.totals.vertices as usize];
    device.read(&mesh.vertices, 0, &mut vertices).expect("reads");
    let mut indices = vec![0; 3 * mesh.totals.triangles as usize];
    device.read(&mesh.indices, 0, &mut indices).expect("reads");
    (mesh, (bytemuck::cast_slice(&vertices).to_vec(), indices))
}

#[test]
fn a_buffer_beyond_the_limits_is_an_error() {
    let error = open().allocate("stack", Surface::LAYOUT, 1 << 24).expect_err("too large");
    assert_eq!(
        error.to_string(),
        "the stack buffer of 536870912 bytes is larger than the 134217728 bytes that wgpu allows; \
         use a smaller batch, image or scene, or the CPU"
    );
}

/// Patches that one binding has no room for lie in two.
#[test]
fn patches_in_two_pieces_give_the_same_bits() {
    let tiny = FrameOptions { width: 96, height: 54, ..FrameOptions::default() };
    for case in [case("spheres", tiny), displaced("spheres", tiny)] {
        let mut device = open();
        device.limit_buffers(250_000);
        assert!(case.patches.len() as u64 * Patch::LAYOUT.size as u64 > 250_000);
        assert_eq!(run(&mut device, &case, 500).expect("renders"), on_cpu(&case), "{}", case.name);
    }
}

/// llvmpipe ends loops after 65535 iterations; that may fail, but must not give other bits.
#[test]
fn a_loop_that_the_driver_cuts_is_an_error() {
    let start = "let list = list_of(block);";
    let spin = "var spin = 0u; while spin < 70000u + ZERO { spin += 1u + ZERO; }";
    let endless = |file: &str, source: &str| match file {
        "tiles.wgsl" => {
            assert!(source.contains(start));
            source.replace(start, &format!("{spin} {start}"))
        }
        _ => source.to_owned(),
    };
    let case = case("spheres", small());
    let mut device = WgpuDevice::open(0, Some(&endless)).expect("opens");
    match run(&mut device, &case, 4096) {
        Ok(outcome) => assert_eq!(outcome, on_cpu(&case)),
        Err(error) => assert!(error.to_string().contains("ended a loop early"), "{error}"),
    }
}

#[test]
fn an_inexact_kernel_is_refused_by_operation() {
    let fused = |file: &str, source: &str| match file {
        "num.wgsl" => source.replace("exactly(a + b)", "exactly(a + b + 1e-6)"),
        _ => source.to_owned(),
    };
    let error = WgpuDevice::open(0, Some(&fused)).expect_err("refused");
    assert!(matches!(&error, WgpuError::Inexact { .. }), "{error}");
    assert!(error.to_string().contains("a + b"), "{error}");
}

#[test]
fn a_kernel_that_does_not_compile_is_an_error() {
    let broken = |file: &str, source: &str| match file {
        "scan.wgsl" => source.replace("fn commit", "fn commit commit"),
        _ => source.to_owned(),
    };
    let error = WgpuDevice::open(0, Some(&broken)).expect_err("refused");
    assert!(matches!(error, WgpuError::Kernel { stage: "scan", .. }), "{error}");
}

/// A device that a program has opened for itself, with these limits.
fn callers(required_limits: wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    let adapter = pollster::block_on(wgpu::Instance::default().request_adapter(&Default::default()));
    let wanted = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    pollster::block_on(adapter.expect("an adapter").request_device(&wanted)).expect("opens")
}

#[test]
fn a_device_of_the_callers_gives_the_same_bits_unless_its_limits_are_too_small() {
    let (device, queue) = callers(wgpu::Limits::defaults());
    let mut device = WgpuDevice::on(device, queue).expect("WebGPU's defaults will do");
    for case in [case("teapot", small()), displaced("gregory", small())] {
        assert_eq!(run(&mut device, &case, 4096).expect("renders"), on_cpu(&case), "{}", case.name);
    }
    let (device, queue) = callers(wgpu::Limits::downlevel_defaults());
    let error = WgpuDevice::on(device, queue).expect_err("four buffers are too few");
    assert!(error.to_string().contains("max_storage_buffers_per_shader_stage is 4"), "{error}");
}
