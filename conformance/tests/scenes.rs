//! Every scene of the repository on every backend present: the same bits as the snapshot.
//!
//! `INSTA_UPDATE=always cargo test -p micropoly-conformance` accepts new snapshots after a change that is
//! meant to change images or counts.

use micropoly::{FrameOptions, Scene};
use micropoly_backend_cpu::CpuDevice;
use micropoly_conformance::{Case, Outcome, run};

/// Scene and resolution of every case.
const SCENES: [(&str, u32, u32); 8] = [
    ("teapot", 320, 180),
    ("teapot", 1280, 720),
    ("eyesplit", 320, 180),
    ("eyesplit", 1280, 720),
    ("spheres", 320, 180),
    ("spheres", 1280, 720),
    ("still-life", 320, 180),
    ("still-life", 1280, 720),
];

fn case(scene: &str, width: u32, height: u32) -> Case {
    let path = format!("{}/../scenes/{scene}.toml", env!("CARGO_MANIFEST_DIR"));
    let scene_file = Scene::load(path).expect("a scene");
    let options = FrameOptions { width, height, ..FrameOptions::default() };
    let device = scene_file.for_device(&options).expect("a drawable scene");
    Case {
        name: format!("{scene} {width}x{height}"),
        frame: device.frame,
        objects: device.objects,
        patches: device.patches,
    }
}

/// What every backend that is present makes of a case, in several configurations.
fn outcomes(case: &Case) -> Vec<(String, Outcome)> {
    let mut all = Vec::new();
    for (threads, batch) in [(1, 4096), (2, 4096), (2, 500), (3, 100_000)] {
        let mut device = CpuDevice::new(threads).expect("threads");
        let outcome = run(&mut device, case, batch).expect("renders");
        all.push((format!("cpu, {threads} threads, batch {batch}"), outcome));
    }
    all
}

#[test]
fn all_backends_give_the_bits_of_the_snapshot() {
    for (scene, width, height) in SCENES {
        let case = case(scene, width, height);
        let all = outcomes(&case);
        let (first, expected) = &all[0];
        for (name, outcome) in &all {
            assert_eq!(outcome, expected, "{}: {name} differs from {first}", case.name);
        }
        insta::assert_json_snapshot!(case.name.replace(' ', "_"), expected);
    }
}

#[test]
fn the_cpu_gives_the_known_answers() {
    let mut device = CpuDevice::new(1).expect("threads");
    assert_eq!(micropoly_core::known::check(&mut device).expect("runs"), None);
}
