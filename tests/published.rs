//! The figures that Weber published (2014, Table 7.2), and what our own profile makes of the same scenes.
//!
//! The scenes are not part of the repository; where they are missing these tests say so and pass.

use std::path::{Path, PathBuf};

use micropoly::core::abi::PARAM_ONE;
use micropoly::core::camera::Profile;
use micropoly::core::kernel::dice_gregory::evaluate_gregory;
use micropoly::core::patch::{Faces, Net};
use micropoly::{Counts, DeviceScene, FrameOptions, RenderOptions, Rendering, Scene, Scheduler, render};

fn original(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/micropolis").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped {test}: no {}", path.display());
    None
}

/// Renders as in the thesis, 1280×720 at 8 pixels and 23 levels, all surfaces of a level at once.
fn rendered(path: &Path, profile: Profile) -> Rendering {
    let levels = if profile == Profile::Weber2014 { 23 } else { FrameOptions::default().levels };
    let frame = FrameOptions { profile, rate: 1, bound: 8.0, levels, ..FrameOptions::default() };
    let options = RenderOptions { frame, scheduler: Scheduler::Breadth, ..RenderOptions::default() };
    render(&Scene::load(path).expect("a scene"), &options, |_| {}).expect("renders")
}

fn counts(path: &Path, profile: Profile) -> Counts {
    rendered(path, profile).counts
}

#[test]
fn webers_profile_gives_his_figures() {
    for (name, processed, most) in [
        ("teapot.mscene", 22_172, 5030),
        ("hair.mscene", 430_958, 150_958),
        ("columns.mscene", 293_178, 38_712),
        ("eye_split.mscene", 3_901_533, 1_950_752),
    ] {
        let Some(path) = original("webers_profile_gives_his_figures", name) else { continue };
        let counts = counts(&path, Profile::Weber2014);
        assert_eq!((counts.processed, counts.max_stack), (processed, most), "{name}");
    }
}

#[test]
fn our_profile_draws_hardly_more() {
    for name in [
        "teapot.mscene",
        "hair.mscene",
        "columns.mscene",
        "spheres.mscene",
        "teapot_greg.mscene",
        "gregory.toml",
    ] {
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        let path = if own.is_file() { Some(own) } else { original("our_profile_draws_hardly_more", name) };
        let Some(path) = path else { continue };
        let (ours, his) = (counts(&path, Profile::Conservative), counts(&path, Profile::Weber2014));
        let ratio = ours.drawn as f64 / his.drawn as f64;
        assert!(ratio <= 1.05, "{name}: {} drawn, he: {}", ours.drawn, his.drawn);
        assert_eq!(ours.depth_limited, 0, "{name}");
    }
}

#[test]
fn the_plane_through_the_eye_has_no_hole() {
    let Some(path) = original("the_plane_through_the_eye_has_no_hole", "eye_split.mscene") else { return };
    let Rendering { image, counts, .. } = rendered(&path, Profile::Conservative);
    assert!(counts.processed < 150_000, "{}", counts.processed);
    let seen = |column: u32, row: u32| image.rgb[((row * image.width + column) * 3) as usize] > 0;
    let horizon = (0..720).find(|&row| seen(640, row)).expect("a plane");
    for (column, row) in (horizon + 2..720).flat_map(|row| (0..1280).map(move |column| (column, row))) {
        assert!(seen(column, row), "a hole at ({column}, {row}); the horizon is at row {horizon}");
    }
}

/// Points and unit normals along the border of a patch.
struct Border {
    points: Vec<[f32; 3]>,
    normals: Vec<[f64; 3]>,
}

const PLACES: u32 = 8;

fn borders(scene: &DeviceScene) -> Vec<Border> {
    let gregory = scene.patches.iter().filter(|patch| patch.faces > 0);
    let mut borders = Vec::new();
    for patch in gregory {
        let object = &scene.objects[patch.object as usize];
        let net = Net::in_eye_space(patch, object);
        let faces = Faces::in_eye_space(&scene.patches[patch.faces as usize], object);
        for side in 0..4 {
            let (mut points, mut normals) = (Vec::new(), Vec::new());
            for k in 0..=PLACES {
                let t = k * (PARAM_ONE / PLACES);
                let (u, v) = [(t, 0), (t, PARAM_ONE), (0, t), (PARAM_ONE, t)][side];
                let vertex = evaluate_gregory(&net, &faces, &scene.frame, u, v);
                points.push(vertex.point);
                normals.push(unit_cross(vertex.du, vertex.dv));
            }
            borders.push(Border { points, normals });
        }
    }
    borders
}

fn unit_cross(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    let cross = glam::Vec3::from(a).as_dvec3().cross(glam::Vec3::from(b).as_dvec3());
    cross.normalize_or_zero().to_array()
}

/// Angles in degrees between the normals of two patches along borders that they share, but for the ends.
fn jumps(scene: &DeviceScene) -> Vec<f64> {
    let mut known: std::collections::HashMap<Vec<[u32; 3]>, Border> = std::collections::HashMap::new();
    let mut jumps = Vec::new();
    for mut border in borders(scene) {
        // Whichever way it runs it is the same; points are bit-equal.
        let key =
            |points: &[[f32; 3]]| points.iter().map(|p| p.map(|c| (c + 0.0).to_bits())).collect::<Vec<_>>();
        let backwards: Vec<_> = border.points.iter().rev().copied().collect();
        if key(&backwards) < key(&border.points) {
            border.points = backwards;
            border.normals.reverse();
        }
        if let Some(other) = known.remove(&key(&border.points)) {
            for k in 1..PLACES as usize {
                let (a, b) = (glam::DVec3::from(border.normals[k]), glam::DVec3::from(other.normals[k]));
                jumps.push(a.cross(b).length().atan2(a.dot(b).abs()).to_degrees());
            }
        } else {
            known.insert(key(&border.points), border);
        }
    }
    jumps
}

#[test]
fn normals_do_not_jump_across_the_edges_of_gregory_patches() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gregory.toml");
    let columns = original("normals_do_not_jump_across_the_edges_of_gregory_patches", "columns.mscene");
    // The smallest patches of the columns are some ten thousand roundings of their coordinates wide.
    for (path, most, mean) in [(Some(own), 0.001, 0.0001), (columns, 0.2, 0.002)] {
        let Some(path) = path else { continue };
        let scene = Scene::load(&path).expect("a scene");
        let with = |profile| {
            let options = FrameOptions { profile, ..FrameOptions::default() };
            jumps(&scene.for_device(&options).expect("a drawable scene"))
        };
        let (ours, his) = (with(Profile::Conservative), with(Profile::Weber2014));
        assert!(ours.len() >= 12 * 7, "{}", ours.len());
        let largest = |jumps: &[f64]| jumps.iter().copied().fold(0.0, f64::max);
        let average = ours.iter().sum::<f64>() / ours.len() as f64;
        assert!(largest(&ours) < most && average < mean, "{}: {} degrees", path.display(), largest(&ours));
        assert!(largest(&his) > 8.0, "{}: {} degrees", path.display(), largest(&his));
    }
}
