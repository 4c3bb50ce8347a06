//! Meshes of closed scenes are closed, and so are their images, whatever the camera.

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

use glam::{DAffine3, DVec3, Vec3};
use micropoly::core::camera::{Borders, Material};
use micropoly::core::displacement::Displacement;
use micropoly::core::num::dot3;
use micropoly::generate::{Generator, generate};
use micropoly::mesh::{Format, Mesh};
use micropoly::{
    Backend, Batch, BezierPatch, Camera, FrameOptions, RenderOptions, Scene, SceneObject, Scheduler, Shape,
    render,
};

const CAMERAS: u64 = 200;

fn scene_of(patches: Vec<BezierPatch>) -> Scene {
    let mut scene = Scene::around("closed".into(), Shape::of_bezier(patches)).expect("a scene");
    (scene.background, scene.ambient) = (Vec3::ZERO, Vec3::ONE);
    scene
}

/// A torus of 4 × 8 patches around the z axis.
fn torus() -> Vec<BezierPatch> {
    // A quarter and an eighth of a circle of radius 1; ends that are shared are the same numbers.
    let ring = |count: usize| -> Vec<[[f64; 2]; 4]> {
        let at = |k: usize| libm::sincos(std::f64::consts::TAU * (k % count) as f64 / count as f64);
        let handle = 4.0 / 3.0 * libm::tan(std::f64::consts::TAU / count as f64 / 4.0);
        (0..count)
            .map(|k| {
                let ((sa, ca), (sb, cb)) = (at(k), at(k + 1));
                [
                    [ca, sa],
                    [ca - handle * sa, sa + handle * ca],
                    [cb + handle * sb, sb - handle * cb],
                    [cb, sb],
                ]
            })
            .collect()
    };
    let mut patches = Vec::new();
    for around in ring(8) {
        for tube in ring(4) {
            let mut points = [[0.0; 3]; 16];
            for (k, point) in points.iter_mut().enumerate() {
                let ([x, y], [out, up]) = (around[k / 4], tube[k % 4]);
                let radius = 1.0 + 0.4 * out;
                *point = [x * radius, y * radius, 0.4 * up].map(|c| c as f32);
            }
            patches.push(BezierPatch { points });
        }
    }
    patches
}

fn balls() -> Vec<BezierPatch> {
    generate(Generator::Spheres, 4, 1)
}

fn teapot() -> Vec<BezierPatch> {
    micropoly::bpt::load("scenes/teapot.bpt".as_ref()).expect("patches")
}

/// Anywhere around or inside of a scene, and its size.
fn look_around(scene: &Scene, random: &mut fastrand::Rng) -> (Camera, DVec3) {
    let (low, high) = scene.bounds();
    let (middle, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
    let mut anywhere = || DVec3::from_array([0; 3].map(|_| random.f64() * 2.0 - 1.0));
    let eye = middle + anywhere() * radius * 1.5;
    let target = middle + anywhere() * radius;
    let up = DVec3::new(0.1, 0.2, 1.0);
    (Camera::look_at(eye, target, up, 50.0, radius * 0.02).expect("a view"), eye)
}

fn small() -> FrameOptions {
    FrameOptions { width: 96, height: 64, whole: true, ..FrameOptions::default() }
}

fn mesh_of(scene: &Scene, frame: &FrameOptions) -> Mesh {
    let options = RenderOptions { frame: *frame, backend: Backend::Cpu, ..RenderOptions::default() };
    Mesh::of(scene, &options).expect("a mesh").0
}

#[test]
fn every_backend_batch_and_scheduler_gives_the_same_mesh() {
    for name in ["gregory", "teapot", "displaced"] {
        let scene = Scene::load(format!("scenes/{name}.toml")).expect("a scene");
        let frame = FrameOptions { size: 3.0, bound: 48.0, ..small() };
        let expected = mesh_of(&scene, &frame);
        let backends = Backend::ALL.into_iter().filter(|backend| backend.is_built());
        for backend in backends {
            for (scheduler, batch) in
                [(Scheduler::Adaptive, 100), (Scheduler::Bounded, 4096), (Scheduler::Local, 64)]
            {
                let batch = Batch::Surfaces(batch);
                let options = RenderOptions { frame, backend, scheduler, batch, ..RenderOptions::default() };
                let (mesh, _) = Mesh::of(&scene, &options).expect("a mesh");
                assert!(mesh == expected, "{name}: another mesh on {backend:?} by {}", scheduler.name());
            }
        }
    }
}

#[test]
fn meshes_without_a_bound_or_too_large_to_count_are_refused() {
    let scene = Scene::load("scenes/teapot.toml").expect("a scene");
    let backend = Backend::Cpu;
    let breadth = RenderOptions { backend, scheduler: Scheduler::Breadth, ..RenderOptions::default() };
    let refusal = Mesh::of(&scene, &breadth).expect_err("no bound");
    assert!(refusal.to_string().contains("breadth"), "{refusal}");
    let many = RenderOptions { backend, batch: Batch::Surfaces(1 << 23), ..RenderOptions::default() };
    let too_many = Mesh::of(&scene, &many).expect_err("too many vertices to count");
    assert!(too_many.to_string().contains("batch"), "{too_many}");
}

fn assert_closed(mut scene: Scene, options: &FrameOptions) {
    let mut random = fastrand::Rng::with_seed(70);
    for round in 0..CAMERAS {
        (scene.camera, _) = look_around(&scene, &mut random);
        let mesh = mesh_of(&scene, options);
        assert_eq!((mesh.open_edges(), mesh.limited), (0, 0), "camera {round}");
        assert!(mesh.triangles.len() > 100, "camera {round}");
    }
}

/// The scene with bumps on all objects.
fn bumpy(mut scene: Scene, height: f32, frequency: f32) -> Scene {
    for object in &mut scene.objects {
        object.displacement = Some(Displacement { height, frequency, octaves: 3 });
    }
    scene
}

#[test]
fn displaced_scenes_are_closed_from_anywhere() {
    assert_closed(bumpy(scene_of(torus()), 0.1, 6.0), &small());
    assert_closed(bumpy(scene_of(balls()), 0.05, 20.0), &FrameOptions { rate: 5, bound: 5.0, ..small() });
    assert_closed(bumpy(Scene::load("scenes/gregory.toml").expect("a scene"), 0.3, 3.0), &small());
}

#[test]
fn a_torus_is_closed_from_anywhere() {
    assert_closed(scene_of(torus()), &small());
}

#[test]
fn balls_are_closed_from_anywhere_at_other_rates_too() {
    assert_closed(scene_of(balls()), &FrameOptions { rate: 5, bound: 5.0, ..small() });
}

#[test]
fn gregory_patches_are_closed_from_anywhere() {
    assert_closed(Scene::load("scenes/gregory.toml").expect("a scene"), &small());
}

/// The ends of an edge of a patch and the points between them, whichever way it runs.
fn edges(patch: &BezierPatch) -> [[[u32; 3]; 4]; 4] {
    let bits = |k: usize| patch.points[k].map(|c| (c + 0.0).to_bits());
    [[0, 4, 8, 12], [3, 7, 11, 15], [0, 1, 2, 3], [12, 13, 14, 15]].map(|edge| {
        let edge = edge.map(bits);
        let [a, b, c, d] = edge;
        edge.min([d, c, b, a])
    })
}

#[test]
fn the_teapot_is_open_at_its_rims_only() {
    let patches = teapot();
    let mut count: HashMap<_, u32> = HashMap::new();
    for edge in patches.iter().flat_map(edges) {
        *count.entry(edge).or_default() += 1;
    }
    let on_rim = |patch: u32, [u, v]: [f32; 2]| {
        let at = [v == 0.0, v == 1.0, u == 0.0, u == 1.0];
        edges(&patches[patch as usize]).iter().zip(at).any(|(edge, at)| at && count[edge] == 1)
    };
    let mut scene = scene_of(patches.clone());
    let mut random = fastrand::Rng::with_seed(71);
    for round in 0..CAMERAS {
        (scene.camera, _) = look_around(&scene, &mut random);
        let mesh = mesh_of(&scene, &small());
        let mut open: HashMap<_, (i32, bool)> = HashMap::new();
        for triangle in &mesh.triangles {
            for k in 0..3 {
                let ends = [triangle[k] as usize, triangle[(k + 1) % 3] as usize];
                let [from, to] = ends.map(|end| mesh.positions[end].map(f32::to_bits));
                let rim = ends.iter().all(|end| on_rim(mesh.patches[*end], mesh.uvs[*end]));
                let way = if from < to { 1 } else { -1 };
                let entry = open.entry(if from < to { (from, to) } else { (to, from) }).or_default();
                *entry = (entry.0 + way, entry.1 || rim);
            }
        }
        let elsewhere = open.values().filter(|(balance, rim)| *balance != 0 && !rim).count();
        assert_eq!(elsewhere, 0, "camera {round}");
    }
}

/// Black pixels: the sky, or holes.
fn black(scene: &Scene, frame: FrameOptions) -> Vec<bool> {
    let image =
        render(scene, &RenderOptions { frame, ..RenderOptions::default() }, |_| {}).expect("renders").image;
    image.rgb.chunks_exact(3).map(|rgb| rgb == [0, 0, 0]).collect()
}

#[test]
fn images_have_no_hole_inside_the_silhouette_at_any_rate_and_bound() {
    assert_no_lonely_holes(scene_of(torus()), 120);
}

#[test]
fn images_of_what_is_displaced_have_none_either() {
    // Steep, but not so that the silhouette frays.
    assert_no_lonely_holes(bumpy(scene_of(torus()), 0.04, 5.0), 60);
}

fn assert_no_lonely_holes(mut scene: Scene, views: usize) {
    let mut random = fastrand::Rng::with_seed(72);
    let (mut holes, mut naive) = (0, 0);
    for round in 0..views {
        // From far enough outside, so that the silhouette is that of the whole.
        let direction = DVec3::from_array([0; 3].map(|_| random.f64() * 2.0 - 1.0)).normalize_or(DVec3::X);
        let eye = direction * (1.6 + 3.0 * random.f64());
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::new(0.1, 0.2, 1.0), 60.0, 0.01);
        scene.camera = camera.expect("a view");
        let (rate, bound) = [(16, 16.0), (1, 20.0), (1, 60.0), (3, 8.0), (7, 3.0), (16, 5.0)][round % 6];
        let frame = FrameOptions { width: 320, height: 180, rate, bound, ..FrameOptions::default() };
        // A pixel that no neighbour shares the sky with is a hole: the torus shows no sky so narrow.
        let lonely = |frame| {
            let black = black(&scene, frame);
            let at = |x: usize, y: usize| black[y * 320 + x];
            let inner = (1..179).flat_map(|y| (1..319).map(move |x| (x, y)));
            inner
                .filter(|&(x, y)| {
                    at(x, y) && !at(x - 1, y) && !at(x + 1, y) && !at(x, y - 1) && !at(x, y + 1)
                })
                .count()
        };
        holes += lonely(frame);
        naive += lonely(FrameOptions { borders: Borders::Naive, ..frame });
    }
    assert!(naive > 0, "there must be something to see");
    assert_eq!(holes, 0);
}

#[test]
fn the_inside_of_a_ball_has_no_hole_at_any_rate_and_bound() {
    assert_no_holes_inside(|scene| scene, 0.5, 120);
}

#[test]
fn the_inside_of_a_ball_with_bumps_has_none_either() {
    // From where no bump can reach the eye.
    assert_no_holes_inside(|scene| bumpy(scene, 0.1, 5.0), 0.4, 60);
}

fn assert_no_holes_inside(change: impl Fn(Scene) -> Scene, around: f64, views: usize) {
    let mut patches = generate(Generator::Spheres, 1, 1);
    let (low, high) = scene_of(patches.clone()).bounds();
    for point in patches.iter_mut().flat_map(|patch| &mut patch.points) {
        let unit = (Vec3::from(*point).as_dvec3() - (low + high) * 0.5) / ((high - low) * 0.5);
        *point = unit.as_vec3().to_array();
    }
    let mut scene = change(scene_of(patches));
    let mut random = fastrand::Rng::with_seed(73);
    for round in 0..views {
        let mut anywhere = || DVec3::from_array([0; 3].map(|_| random.f64() * 2.0 - 1.0));
        let eye = anywhere() * around;
        let camera = Camera::look_at(eye, eye + anywhere(), DVec3::new(0.3, 0.2, 0.9), 70.0, 0.01);
        scene.camera = camera.expect("a view");
        let (rate, bound) = [(16, 16.0), (1, 20.0), (1, 60.0), (3, 8.0), (7, 3.0), (16, 5.0)][round % 6];
        let frame = FrameOptions { width: 320, height: 180, rate, bound, ..FrameOptions::default() };
        let holes = black(&scene, frame).into_iter().filter(|black| *black).count();
        assert_eq!(holes, 0, "round {round}: rate {rate}, bound {bound}");
    }
}

#[test]
fn objects_are_placed_in_the_world_and_triangles_face_as_their_normals_do() {
    let mut scene = scene_of(balls());
    let to_world = DAffine3::from_scale_rotation_translation(
        DVec3::new(-2.0, 1.0, 3.0), // a mirror too
        glam::DQuat::from_rotation_x(0.7),
        DVec3::new(10.0, 20.0, 30.0),
    );
    let material = Material { colour: Vec3::ONE, specular: 0.0, gloss: 0, opacity: 1.0 };
    let SceneObject { shape, .. } = scene.objects.remove(0);
    scene.objects = vec![SceneObject { to_world, ..SceneObject::new(shape, material) }];
    (scene.camera, _) = look_around(&scene, &mut fastrand::Rng::with_seed(74));
    let mesh = mesh_of(&scene, &small());
    assert_eq!(mesh.open_edges(), 0);
    let vector = |at: u32, list: &[[f32; 3]]| Vec3::from(list[at as usize]);
    let mut agree = 0;
    for [a, b, c] in &mesh.triangles {
        let [p, q, r] = [a, b, c].map(|at| vector(*at, &mesh.positions));
        let face = (q - p).cross(r - p);
        agree += i32::from(dot3(face.to_array(), mesh.normals[*a as usize]) > 0.0);
    }
    let share = f64::from(agree) / mesh.triangles.len() as f64;
    assert!(share > 0.99, "{share} of the triangles face as their normals say");
}

fn tessellate(output: &Path, more: &[&str]) -> (i32, String) {
    let program = env!("CARGO_BIN_EXE_micropoly");
    let output = Command::new(program)
        .args(["tessellate", "scenes/gregory.toml", "--check", "-o"])
        .arg(output)
        .args(more)
        .output()
        .expect("starts");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn files_hold_the_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = FrameOptions { size: 12.0, bound: 192.0, whole: true, ..FrameOptions::default() };
    let mesh = mesh_of(&Scene::load("scenes/gregory.toml").expect("a scene"), &options);
    for end in ["obj", "ply", "glb"] {
        let path = folder.path().join(format!("mesh.{end}"));
        let (code, text) = tessellate(&path, &["--micropolygon-size=12"]);
        assert!(code == 0 && text.contains("open edges    0"), "{end}: {text}");
        assert!(text.contains(&format!("triangles     {}", mesh.triangles.len())), "{end}: {text}");
        let own = folder.path().join(format!("own.{end}"));
        mesh.save(&own, Format::of(&own).expect("a format")).expect("is written");
        let bytes = std::fs::read(&path).expect("a file");
        assert!(bytes == std::fs::read(&own).expect("a file"), "{end}");
        assert!(bytes.len() > mesh.triangles.len() * 12, "{end}");
    }
    let text = std::fs::read_to_string(folder.path().join("mesh.obj")).expect("a file");
    assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count(), mesh.triangles.len());
    assert_eq!(text.lines().filter(|line| line.starts_with("vn ")).count(), mesh.normals.len());
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, more, what) in [
        ("mesh.stl", &[][..], ".obj, .ply or .glb"),
        ("no/such/mesh.ply", &[], "no folder"),
        ("mesh.ply", &["--micropolygon-size=0"], "pixels"),
        ("mesh.ply", &["--dice=0"], "--dice"),
    ] {
        let (code, text) = tessellate(&folder.path().join(name), more);
        assert!(code == 1 || code == 2, "{name}: {text}");
        assert!(text.contains(what) && !text.contains("panicked"), "{name}: {text}");
    }
    let shallow = tessellate(&folder.path().join("mesh.ply"), &["--max-depth=1", "--res=4000x4000"]);
    assert!(shallow.0 == 0 && shallow.1.contains("may be open"), "{}", shallow.1);
}
