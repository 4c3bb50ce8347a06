//! Culling of whole patches changes no bit of an image, and what it culls depends on nothing but scene and options.

#![allow(clippy::disallowed_methods)] // what is worked out here need not be the same bits everywhere

use glam::{DVec3, Vec3};
use micropoly::core::abi::{Frame, Sample};
use micropoly::core::backend::Device;
use micropoly::core::camera::{Camera, Material};
use micropoly::core::cull::{Outline, Sight};
use micropoly::core::kernel::triangle::place;
use micropoly::core::memory::Sizes;
use micropoly::core::pattern::Region;
use micropoly::core::render::FramePlan;
use micropoly::cull::Cull;
use micropoly::generate::{Generator, generate};
use micropoly::{
    Backend, Batch, BezierPatch, Blur, FrameOptions, Rasteriser, RenderOptions, Rendering, Samples, Scene,
    SceneObject, Scheduler, Shape, Shot, Window, render, render_frames,
};
use micropoly_backend_cpu::CpuDevice;

/// Patches a wave: so few that there are many waves in small scenes, too.
const WAVES: [u32; 3] = [1, 7, 60];

fn options(samples: Samples) -> RenderOptions {
    let frame = FrameOptions { width: 96, height: 54, samples, ..FrameOptions::default() };
    RenderOptions { frame, backend: Backend::Cpu, film: true, ..RenderOptions::default() }
}

fn rendered(scene: &Scene, options: &RenderOptions) -> Rendering {
    render(scene, options, |_| {}).expect("renders")
}

/// Renders with and without culling; gives the most patches that were found hidden.
fn compare(scene: &Scene, options: &RenderOptions) -> u64 {
    let expected = rendered(scene, options);
    let ways = WAVES
        .map(|wave| (Cull::Occlusion, wave))
        .into_iter()
        .chain([(Cull::Frustum, 0), (Cull::Occlusion, 0)]);
    let hidden = ways.map(|(cull, wave)| {
        let found = rendered(scene, &RenderOptions { cull, wave, ..options.clone() });
        let what = format!("{}, {cull:?}, waves of {wave}, {:?}", scene.name, options.frame.samples);
        assert!(found.film == expected.film && found.image == expected.image, "{what}: another image");
        let roots = found.roots;
        let all = roots.taken + roots.outside + roots.hidden;
        assert_eq!(all % scene.patch_count() as u64, 0, "{what}: {roots:?}");
        assert!(found.counts.drawn <= expected.counts.drawn, "{what}");
        assert_eq!(roots.taken, found.counts.roots_taken, "{what}");
        roots.hidden
    });
    hidden.max().unwrap_or(0)
}

/// A city of fewer blocks.
fn city(blocks: u32) -> Scene {
    let text = std::fs::read_to_string("scenes/city.toml").expect("a scene");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("city.toml");
    std::fs::write(&path, text.replace("count = 200000", &format!("count = {blocks}"))).expect("writes");
    Scene::load(&path).expect("a scene")
}

fn scene(name: &str) -> Scene {
    Scene::load(format!("scenes/{name}")).expect("a scene")
}

#[test]
fn scenes_look_the_same() {
    for name in [
        "teapot.toml",
        "eyesplit.toml",
        "gregory.toml",
        "still-life.toml",
        "displaced.toml",
        "copies.toml",
        "shapes.rib",
    ] {
        for samples in [Samples::One, Samples::Four] {
            let mut scene = scene(name);
            scene.blur = Blur::default();
            compare(&scene, &options(samples));
        }
    }
    for samples in [Samples::One, Samples::Sixteen] {
        assert!(compare(&city(900), &options(samples)) > 500);
    }
}

#[test]
fn layers_and_blurred_scenes_look_the_same() {
    compare(&scene("spinning.toml"), &options(Samples::Four));
    let mut glass = scene("glass.toml");
    glass.blur = Blur::default();
    compare(&glass, &options(Samples::One));
    // Behind half a wall of glass, and then behind a whole one.
    for opacity in [0.5, 1.0] {
        let mut scene = city(100);
        let corner = |k: usize| [(k / 4) as f32 * 4.0 - 2.0, (k % 4) as f32 * 0.5 - 2.0, 1.0];
        let pane = BezierPatch { points: std::array::from_fn(corner) };
        let material = Material { colour: Vec3::ONE, specular: 0.0, gloss: 0, opacity };
        scene.objects.push(SceneObject::new(Shape::of_bezier(vec![pane]), material));
        scene.objects[0].material.opacity = 1.5 - opacity;
        assert!(compare(&scene, &options(Samples::One)) > 0, "{opacity}");
    }
}

#[test]
fn parts_and_ways_to_render_do_not_matter() {
    let scene = city(400);
    let mut options = options(Samples::Four);
    options.crop = Some(Window { left: 13, right: 90, top: 5, bottom: 41 });
    options.frame.cull_backfaces = true;
    compare(&scene, &options);
    for rasteriser in Rasteriser::ALL {
        options.frame.rasteriser = rasteriser;
        options.batch = Batch::Memory(
            rendered(&scene, &RenderOptions { batch: Batch::Surfaces(1), ..options.clone() }).bytes_allocated,
        );
        compare(&scene, &options);
    }
}

#[test]
fn what_is_culled_depends_on_nothing_else() {
    let scene = city(400);
    let culled = |scheduler, batch, threads| {
        let frame = FrameOptions { width: 160, height: 90, ..FrameOptions::default() };
        let (cull, wave, batch) = (Cull::Occlusion, 100, Batch::Surfaces(batch));
        let options =
            RenderOptions { frame, cull, wave, scheduler, batch, threads, ..RenderOptions::default() };
        let found = rendered(&scene, &RenderOptions { backend: Backend::Cpu, ..options });
        let counts = found.counts;
        (
            found.image.hash(),
            found.roots,
            [counts.processed, counts.drawn, counts.culled, counts.micropolygons],
        )
    };
    let expected = culled(Scheduler::Adaptive, 4096, 1);
    assert!(expected.1.hidden > 500, "{:?}", expected.1);
    for scheduler in Scheduler::ALL {
        for (batch, threads) in [(1, 1), (33, 2), (1000, 3)] {
            assert_eq!(culled(scheduler, batch, threads), expected, "{scheduler:?}, batches of {batch}");
        }
    }
}

#[test]
fn frames_of_a_path_look_the_same() {
    let scene = city(4000);
    let shots: Vec<Shot> =
        [0.0, 80.0, 120.0, 300.0].map(|frame| Shot::at(&scene, frame).expect("a frame")).into();
    let hashes = |cull| {
        let mut hashes = Vec::new();
        let options = RenderOptions { cull, wave: 500, ..options(Samples::One) };
        render_frames(&scene, &options, &shots, |_, rendering| {
            hashes.push(rendering.image.hash());
            Ok(())
        })
        .expect("renders");
        hashes
    };
    assert_eq!(hashes(Cull::Occlusion), hashes(Cull::None));
}

/// Patches before a camera at z = 6 that looks down the z axis.
fn before_the_camera(patches: Vec<BezierPatch>, random: &mut fastrand::Rng) -> Scene {
    let mut scene = Scene::around("random".into(), Shape::of_bezier(patches)).expect("a scene");
    let near = [0.1, 3.0, 5.5][random.usize(0..3)];
    scene.camera = Camera::look_at(DVec3::Z * 6.0, DVec3::ZERO, DVec3::Y, 40.0, near).expect("a view");
    scene
}

/// A sheet of any slope, flat or not, far and near, also behind the eye; now and then it is seen from the side.
fn sheet(random: &mut fastrand::Rng) -> BezierPatch {
    let mut any = |scale: f32| (random.f32() * 2.0 - 1.0) * scale;
    let (middle, size) = ([any(2.5), any(1.5), any(6.5)], any(1.0).abs().powi(2) + 0.01);
    let slopes = [any(1.0), any(1.0)];
    let bumps: [f32; 16] = std::array::from_fn(|_| any(0.2));
    let upright = any(1.0) > 0.8;
    BezierPatch {
        points: std::array::from_fn(|k| {
            let (u, v) = ((k / 4) as f32 / 1.5 - 1.0, (k % 4) as f32 / 1.5 - 1.0);
            let z = slopes[0] * u + slopes[1] * v + bumps[k];
            let [x, z] = if upright { [z * 0.01, u] } else { [u, z] };
            [middle[0] + size * x, middle[1] + size * v, middle[2] + size * z]
        }),
    }
}

/// A flat rectangle from one corner to the other, in the plane z = `depth`.
fn rectangle(depth: f32, [left, bottom]: [f32; 2], [right, top]: [f32; 2]) -> BezierPatch {
    let at = |k: usize| {
        let (u, v) = ((k / 4) as f32 / 3.0, (k % 4) as f32 / 3.0);
        [left + (right - left) * u, bottom + (top - bottom) * v, depth]
    };
    BezierPatch { points: std::array::from_fn(at) }
}

#[test]
fn random_scenes_look_the_same() {
    let mut random = fastrand::Rng::with_seed(11);
    let mut hidden = 0;
    for _ in 0..60 {
        let count = random.usize(2..120);
        let patches = (0..count).map(|_| sheet(&mut random)).collect();
        let scene = before_the_camera(patches, &mut random);
        hidden += compare(&scene, &options([Samples::One, Samples::Four][random.usize(0..2)]));
    }
    assert!(hidden > 200, "{hidden}");
}

/// Walls with slits, some narrower than a sample, some with a sample in them, and behind them sheets at hardly another depth,
/// or at the very same.
#[test]
fn what_is_seen_through_slits_stays() {
    let mut random = fastrand::Rng::with_seed(12);
    let mut hidden = 0;
    for _ in 0..60 {
        let mut patches = Vec::new();
        let (mut left, right) = (-4.0, 4.0);
        while left < right {
            let width = random.f32() * 0.9 + 0.05;
            patches.push(rectangle(0.0, [left, -3.0], [left + width, 3.0]));
            left += width + random.f32().powi(4) * 0.1;
        }
        for _ in 0..60 {
            let corner = [random.f32() * 6.0 - 3.0, random.f32() * 4.0 - 2.0];
            let size = random.f32().powi(3) + 0.02;
            let behind = [0.0, f32::EPSILON, 1e-6, 1e-4, 0.5][random.usize(0..5)];
            patches.push(rectangle(-behind, corner, corner.map(|c| c + size)));
        }
        random.shuffle(&mut patches);
        let scene = before_the_camera(patches, &mut random);
        hidden += compare(&scene, &options([Samples::One, Samples::Four][random.usize(0..2)]));
    }
    assert!(hidden > 200, "{hidden}");
}

/// The samples of one patch alone.
fn alone(
    device: &mut CpuDevice,
    (frame, scene): (Frame, &micropoly::DeviceScene),
    patch: u32,
) -> Vec<Sample> {
    let (patches, objects) = (scene.patch_count as u32, scene.objects.len() as u32);
    let plan = FramePlan::new(frame, patches, objects, 64).expect("a plan");
    let sizes = Sizes { records: scene.patches.len() as u32, listed: 1, ..*plan.sizes() };
    let plan = FramePlan::with_sizes(frame, sizes).expect("a plan");
    let mut buffers = plan.prepare(device, &scene.objects, &scene.patches).expect("buffers");
    plan.run_listed(device, &mut buffers, &[patch], |_| {}).expect("runs");
    let mut samples = vec![Sample::default(); frame.sample_count() as usize];
    device.read(&buffers.samples, 0, &mut samples).expect("reads");
    samples
}

/// Checks the outlines of some patches; gives how many samples lie in them, and how many patches really have.
fn check_outlines(scene: &Scene, frame: FrameOptions, step: usize) -> (u64, u64) {
    let mut device = CpuDevice::new(1).expect("threads");
    let seen = scene.for_device(&frame).expect("a scene");
    let whole = Window::whole(frame.width, frame.height);
    let region = Region { samples: frame.samples, window: Window { left: 5, ..whole }, shown: whole };
    let frame = Frame { flags: seen.frame.flags & !micropoly::core::abi::FLAG_LAYERS, ..seen.frame }
        .with_region(region, 0);
    let (mut covered, mut owned) = (0, 0);
    for patch in (0..seen.patch_count as u32).step_by(step) {
        let outline = Outline::of(&frame, &Sight::of_patch(&frame, &seen.objects, &seen.patches, patch));
        let samples = alone(&mut device, (frame, &seen), patch);
        let mut inside = 0;
        if let Some(Outline { columns, rows, nearest }) = outline {
            covered += u64::from((columns[1] - columns[0]) * (rows[1] - rows[0]));
            for row in rows[0]..rows[1] {
                for column in columns[0]..columns[1] {
                    let at = [frame.sample_left + column, frame.sample_top + row].map(|c| c as i32);
                    let sample = samples[place(&frame, at[0], at[1])];
                    assert!(
                        sample.depth <= nearest,
                        "{}, patch {patch}: {sample:?}, {outline:?}",
                        scene.name
                    );
                    inside += u64::from(sample.depth > 0);
                }
            }
        }
        let all = samples.iter().filter(|sample| sample.depth > 0).count() as u64;
        assert_eq!(inside, all, "{}, patch {patch} is seen outside of {outline:?}", scene.name);
        owned += all;
    }
    (covered, owned)
}

#[test]
fn outlines_hold_all_that_is_drawn() {
    let small = FrameOptions { width: 64, height: 40, samples: Samples::Four, ..FrameOptions::default() };
    for name in [
        "teapot.toml",
        "eyesplit.toml",
        "gregory.toml",
        "still-life.toml",
        "displaced.toml",
        "copies.toml",
        "shapes.rib",
        "glass.toml",
    ] {
        let mut scene = scene(name);
        scene.blur = Blur::default();
        let step = scene.patch_count().div_ceil(60);
        check_outlines(&scene, small, step);
    }
    let mut random = fastrand::Rng::with_seed(13);
    for _ in 0..10 {
        let patches = (0..20).map(|_| sheet(&mut random)).collect();
        check_outlines(&before_the_camera(patches, &mut random), small, 1);
    }
}

#[test]
fn outlines_are_tight() {
    let mut random = fastrand::Rng::with_seed(14);
    let fine = FrameOptions { width: 64, height: 40, ..FrameOptions::default() };
    let sheets = (0..60).map(|_| {
        let corner = [random.f32() * 2.0 - 1.0, random.f32() - 0.5];
        rectangle(random.f32(), corner, corner.map(|c| c + 0.5))
    });
    let patches = sheets.collect();
    let (covered, owned) =
        check_outlines(&before_the_camera(patches, &mut fastrand::Rng::with_seed(1)), fine, 1);
    assert!(owned > 0 && covered * 100 < owned * 112, "{covered} samples, {owned} owned");
}

#[test]
fn all_that_is_generated_looks_the_same() {
    for kind in [Generator::Spheres, Generator::Hair, Generator::Columns] {
        let patches = generate(kind, 60, 3);
        let scene = Scene::around(format!("{kind:?}"), Shape::of_bezier(patches)).expect("a scene");
        compare(&scene, &options(Samples::One));
    }
}

/// Patches take no part in culling that is not asked for.
#[test]
fn by_default_all_are_taken() {
    let scene = scene("teapot.toml");
    let found = rendered(&scene, &options(Samples::One));
    assert_eq!((found.roots.taken, found.roots.waves), (scene.patch_count() as u64, 0));
    assert_eq!(found.sizes.root_entries(), 1);
}
