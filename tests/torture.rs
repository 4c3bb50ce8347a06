//! Extreme but legal scenes: they end in an image, whatever their numbers, and the same one every time.

use micropoly::core::camera::{Camera, Light, Material};
use micropoly::{Batch, BezierPatch, Blur, FrameOptions, RenderOptions, Scene, SceneObject, Shape, render};

/// A number of any sign and magnitude between 10^`low` and 10^`high`, or zero.
fn extreme(random: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    let magnitude = (std::f64::consts::LN_10 * (low + (high - low) * random.f64())).exp();
    [magnitude, -magnitude, magnitude, -magnitude, 0.0][random.usize(0..5)]
}

fn extreme_scene(random: &mut fastrand::Rng) -> Option<Scene> {
    let size = [1.0, 1.0e-6, 1.0e-3, 1.0e6, 1.0e11][random.usize(0..5)];
    let (low, high) = [(-1.0, 0.0), (-30.0, 0.0), (-3.0, 0.0)][random.usize(0..3)];
    let mut number = || size * extreme(random, low, high);
    let eye = glam::DVec3::new(number(), number(), number());
    let target = glam::DVec3::new(number(), number(), number());
    let patches = (0..3)
        .map(|_| BezierPatch {
            points: [(); 16].map(|()| [number() as f32, number() as f32, number() as f32]),
        })
        .collect();
    let fov = [0.001, 1.0, 50.0, 179.0][random.usize(0..4)];
    let near = [1.0e-6, 1.0e-3, 0.1, 10.0, 1.0e12][random.usize(0..5)];
    let camera = Camera::look_at(eye, target, glam::DVec3::new(0.1, 0.2, 1.0), fov, near)?;
    let material =
        Material { colour: glam::Vec3::ONE, specular: 1.0, gloss: random.u32(0..=10), opacity: 1.0 };
    let light = Light::Point { position: target, colour: glam::Vec3::splat(random.f32()) };
    Some(Scene {
        name: "extreme".into(),
        camera,
        path: None,
        blur: Blur::default(),
        background: glam::Vec3::ZERO,
        ambient: glam::Vec3::splat(0.1),
        lights: vec![light],
        objects: vec![SceneObject::new(Shape::of_bezier(patches), material)],
        notes: Vec::new(),
    })
}

#[test]
fn extreme_scenes_render_and_do_not_depend_on_the_batch() {
    let mut random = fastrand::Rng::with_seed(50);
    let (mut rendered, mut covered) = (0, 0);
    for round in 0..400 {
        let Some(scene) = extreme_scene(&mut random) else { continue };
        let frame = FrameOptions {
            width: random.u32(1..=80),
            height: random.u32(1..=50),
            bound: [0.5, 8.0, 100.0][random.usize(0..3)],
            rate: 1 << random.u32(0..=4),
            levels: random.u32(1..=16),
            cull_backfaces: random.u8(0..4) == 0,
            ..FrameOptions::default()
        };
        let with = |batch: u32, threads: usize| {
            let options =
                RenderOptions { frame, batch: Batch::Surfaces(batch), threads, ..RenderOptions::default() };
            render(&scene, &options, |_| {}).expect("renders")
        };
        let (one, other) = (with(512, 1), with(random.u32(1..5000), 2));
        assert_eq!(one.image, other.image, "round {round}");
        assert_eq!(one.counts.processed, other.counts.processed, "round {round}");
        assert!(other.counts.max_stack <= other.sizes.stack_entries(), "round {round}");
        rendered += 1;
        covered += usize::from(one.image.rgb.iter().any(|&value| value > 0));
    }
    assert!(rendered > 300 && covered > 100, "{rendered} rendered, {covered} not black");
}
