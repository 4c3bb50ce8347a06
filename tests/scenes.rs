//! The scenes in the repository show what they should.

use std::path::Path;
use std::sync::Arc;

use micropoly::bench::{Plan, Views, spike};
use micropoly::core::camera::{Camera, Light, Material};
use micropoly::devices::all_of;
use micropoly::generate::{Generator, generate};
use micropoly::{
    Backend, BezierPatch, Blur, FrameOptions, Image, RenderOptions, Rendering, Scene, SceneObject, Scheduler,
    Shape, render,
};

fn render_at(scene: &Scene, width: u32, height: u32, bound: f32) -> Rendering {
    let frame = FrameOptions { width, height, bound, ..FrameOptions::default() };
    render(scene, &RenderOptions { frame, ..RenderOptions::default() }, |_| {}).expect("renders")
}

fn pixel(image: &Image, column: u32, row: u32) -> [u8; 3] {
    let at = (row * image.width + column) as usize * 3;
    [image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]]
}

/// One ball of radius 1 around the origin, black sky, even light.
fn ball(camera: Camera) -> Scene {
    let mut patches = generate(Generator::Spheres, 1, 1);
    // The first generated ball, moved to the origin and scaled to radius 1.
    let (low, high) = patches
        .iter()
        .flat_map(|patch| patch.points)
        .fold(([f32::MAX; 3], [f32::MIN; 3]), |(low, high), p| {
            ([0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k])))
        });
    for point in patches.iter_mut().flat_map(|patch| &mut patch.points) {
        *point = [0, 1, 2].map(|k| (2.0 * point[k] - low[k] - high[k]) / (high[k] - low[k]));
    }
    let material = Material { colour: glam::Vec3::ONE, specular: 0.0, gloss: 0, opacity: 1.0 };
    Scene {
        name: "ball".into(),
        camera,
        path: None,
        blur: Blur::default(),
        background: glam::Vec3::ZERO,
        ambient: glam::Vec3::splat(0.5),
        lights: vec![Light::Point { position: glam::DVec3::ZERO, colour: glam::Vec3::splat(0.5) }],
        objects: vec![SceneObject::new(Shape::of_bezier(patches), material)],
        notes: Vec::new(),
    }
}

fn random_direction(random: &mut fastrand::Rng) -> glam::DVec3 {
    let axis = |random: &mut fastrand::Rng| random.f64() * 2.0 - 1.0;
    glam::DVec3::new(axis(random), axis(random), axis(random)).normalize_or(glam::DVec3::X)
}

#[test]
fn a_closed_surface_has_no_pinholes_from_inside() {
    let mut random = fastrand::Rng::with_seed(40);
    for round in 0..60 {
        let eye = random_direction(&mut random) * 0.9 * random.f64();
        let target = eye + random_direction(&mut random);
        let camera =
            Camera::look_at(eye, target, glam::DVec3::new(0.3, 0.2, 0.9), 70.0, 0.01).expect("a view");
        let image = render_at(&ball(camera), 320, 180, [8.0, 3.0, 20.0][round % 3]).image;
        assert_eq!(holes(&image), 0, "round {round}: camera at {eye}, looking at {target}");
    }
}

/// The ball of Gregory patches, radius 1 at their borders and 0.93 in their middles, black sky, even light.
fn gregory_ball() -> Scene {
    let mut scene = Scene::load("scenes/gregory.toml").expect("a scene");
    (scene.background, scene.ambient) = (glam::Vec3::ZERO, glam::Vec3::ONE);
    scene
}

/// The face points of all patches moved by up to `apart`: every border keeps its place.
fn crumple(scene: &mut Scene, random: &mut fastrand::Rng, apart: f32) {
    for patch in &mut Arc::make_mut(&mut scene.objects[0].shape).gregory {
        for point in &mut patch.points[12..] {
            *point = point.map(|c| c + apart * (2.0 * random.f32() - 1.0));
        }
    }
}

fn holes(image: &Image) -> usize {
    image.rgb.chunks_exact(3).filter(|rgb| *rgb == [0, 0, 0]).count()
}

#[test]
fn a_closed_surface_of_gregory_patches_has_no_pinholes_from_inside() {
    let mut random = fastrand::Rng::with_seed(43);
    for round in 0..120 {
        let mut scene = gregory_ball();
        crumple(&mut scene, &mut random, [0.0, 0.1, 0.3][round / 3 % 3]);
        // Not so far out that a crumpled patch could be behind the eye.
        let eye = random_direction(&mut random) * 0.5 * random.f64();
        let target = eye + random_direction(&mut random);
        scene.camera =
            Camera::look_at(eye, target, glam::DVec3::new(0.3, 0.2, 0.9), 70.0, 0.01).expect("a view");
        let image = render_at(&scene, 320, 180, [8.0, 3.0, 20.0][round % 3]).image;
        assert_eq!(holes(&image), 0, "round {round}: camera at {eye}, looking at {target}");
    }
}

/// Looks at the middle of a scene from outside: the image of a sphere of radius `inner` is covered, nothing beyond
/// that of one of radius `outer` is.
fn assert_filled(scene: &mut Scene, random: &mut fastrand::Rng, round: usize, [inner, outer]: [f64; 2]) {
    let eye = random_direction(random) * (outer + 0.04 + 4.0 * random.f64());
    scene.camera =
        Camera::look_at(eye, glam::DVec3::ZERO, glam::DVec3::new(0.3, 0.2, 0.9), 70.0, 0.01).expect("a view");
    let image = render_at(scene, 320, 180, [8.0, 3.0, 20.0][round % 3]).image;
    let focal = scene.camera.focal(180);
    for (column, row) in (0..180).flat_map(|row| (0..320).map(move |column| (column, row))) {
        let (x, y) = (f64::from(column) + 0.5 - 160.0, f64::from(row) + 0.5 - 90.0);
        // Squared distance of the pixel's ray from the centre of the ball.
        let sine = (x * x + y * y) / (x * x + y * y + focal * focal);
        let covered = pixel(&image, column, row) != [0, 0, 0];
        let distance = eye.length() * sine.sqrt();
        assert!(covered || distance > inner, "round {round}: a hole at ({column}, {row})");
        assert!(!covered || distance < outer, "round {round}: too far out at ({column}, {row})");
    }
}

#[test]
fn a_closed_surface_has_no_pinholes_from_outside() {
    let mut random = fastrand::Rng::with_seed(41);
    let camera = Camera::look_at(glam::DVec3::X, glam::DVec3::ZERO, glam::DVec3::Z, 70.0, 0.01);
    let mut scene = ball(camera.expect("a view"));
    for round in 0..60 {
        assert_filled(&mut scene, &mut random, round, [0.99, 1.01]);
    }
}

#[test]
fn a_closed_surface_of_gregory_patches_has_no_pinholes_from_outside() {
    let mut random = fastrand::Rng::with_seed(44);
    for round in 0..60 {
        assert_filled(&mut gregory_ball(), &mut random, round, [0.92, 1.01]);
    }
}

#[test]
fn eyesplit_is_a_plane_to_the_horizon() {
    let scene = Scene::load("scenes/eyesplit.toml").expect("a scene");
    let Rendering { image, counts, .. } = render_at(&scene, 1280, 720, 8.0);
    assert!(counts.processed < 150_000, "{} surfaces", counts.processed);
    let sky = pixel(&image, 0, 0);
    let horizon = (0..720).find(|&row| pixel(&image, 640, row) != sky).expect("a plane");
    assert!((20..40).contains(&horizon), "the horizon is at row {horizon}");
    for (column, row) in (0..720).flat_map(|row| (0..1280).map(move |column| (column, row))) {
        let is_sky = pixel(&image, column, row) == sky;
        assert!(is_sky == (row < horizon), "({column}, {row})");
    }
}

#[test]
fn a_camera_inside_a_surface_sees_it_to_the_near_plane() {
    // The eye lies on the surface of the ball: half of every direction is covered, the rest is clipped.
    let eye = glam::DVec3::new(0.0, 0.0, 0.999);
    let camera = Camera::look_at(eye, glam::DVec3::new(1.0, 0.0, 0.999), glam::DVec3::Z, 90.0, 1.0e-3)
        .expect("a view");
    let image = render_at(&ball(camera), 320, 180, 8.0).image;
    assert_ne!(pixel(&image, 160, 170), [0, 0, 0], "below the horizon is the inside of the ball");
    let holes = (100..180).flat_map(|row| (0..320).map(move |column| (column, row)));
    assert_eq!(holes.filter(|&(column, row)| pixel(&image, column, row) == [0, 0, 0]).count(), 0);
}

#[test]
fn the_teapot_stands_upright_and_lit() {
    let scene = Scene::load("scenes/teapot.toml").expect("a scene");
    assert_eq!(scene.patch_count(), 32);
    let Rendering { image, counts, .. } = render_at(&scene, 640, 360, 8.0);
    assert_eq!(counts.depth_limited, 0);
    assert_eq!(counts.processed, counts.drawn * 2 - 32 + 2 * counts.culled, "a binary forest");
    let sky = pixel(&image, 0, 0);
    let covered = |row: u32| (0..640).filter(|&column| pixel(&image, column, row) != sky).count();
    let rows: Vec<u32> = (0..360).filter(|&row| covered(row) > 0).collect();
    let (top, bottom) = (rows[0], rows[rows.len() - 1]);
    let knob = covered(top + (bottom - top) / 20);
    let belly = covered(top + (bottom - top) * 2 / 3);
    assert!(knob > 0 && belly > 4 * knob, "the knob ({knob} pixels wide) is above the belly ({belly})");
    let brightness = |row: u32| -> u32 {
        (0..640).filter(|&c| pixel(&image, c, row) != sky).map(|c| u32::from(pixel(&image, c, row)[0])).sum()
    };
    let mean = |row: u32| brightness(row) / covered(row) as u32;
    assert!(mean(bottom - 5) < mean(top + (bottom - top) / 2), "the light comes from above");
}

#[test]
fn every_point_of_the_teapot_is_the_published_one() {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/micropolis/teapot.mscene");
    if !reference.is_file() {
        println!("skipped every_point_of_the_teapot_is_the_published_one: no {}", reference.display());
        return;
    }
    let published = Scene::load(&reference).expect("a scene");
    let patches = micropoly::bpt::load("scenes/teapot.bpt".as_ref()).expect("patches");
    assert_eq!(patches.len(), published.patch_count());
    let points = |patches: &[BezierPatch]| -> Vec<f32> {
        patches.iter().flat_map(|patch| patch.points).flatten().collect()
    };
    for (a, b) in points(&patches).into_iter().zip(points(&published.objects[0].shape.bezier)) {
        assert!((a - b).abs() < 1.0e-6, "{a} is not {b}");
    }
}

#[test]
fn the_flight_through_the_city_begins_at_its_camera_and_has_its_spike_at_frame_300() {
    let city = Scene::load("scenes/city.toml").expect("a scene");
    assert_eq!(city.camera_at(0.0).expect("a camera"), city.camera);
    let plan = Plan {
        devices: all_of(Backend::Cpu).expect("a CPU"),
        schedulers: vec![Scheduler::Breadth],
        batches: Vec::new(),
        views: Views::Path(7),
        repeat: 1,
        options: RenderOptions {
            frame: FrameOptions { bound: 8.0, ..FrameOptions::default() },
            ..RenderOptions::default()
        },
    };
    let rows = plan.run(&city, |_| {}).expect("runs");
    let spike = spike(&rows).expect("BREADTH was measured");
    assert_eq!(spike.frame, Some(300.0));
    let others = rows.iter().filter(|row| row.frame != spike.frame);
    let most = others.map(|row| row.memory).max().expect("other views");
    assert!(spike.memory > 2 * most, "{} bytes, and {most} elsewhere", spike.memory);
}
