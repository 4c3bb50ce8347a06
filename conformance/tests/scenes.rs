//! Every scene of the repository at three sizes with three batch sizes on every device of every backend built
//! in: the same bits as the snapshot, of which there is one for all.
//!
//! `INSTA_UPDATE=always cargo test -p micropoly-conformance` accepts new snapshots after a change that is
//! meant to change images or counts.

mod common;

use common::{devices, report};
use micropoly::devices::{Job, with_device};
use micropoly::looks::Look;
use micropoly::{Backend, FrameOptions, Oracle, Scene};
use micropoly_conformance::{Case, Outcome, Schedule, run, run_scheduled};
use micropoly_core::backend::Device;
use micropoly_core::known::{Mismatch, check};

const SCENES: [&str; 9] = [
    "teapot.toml",
    "eyesplit.toml",
    "spheres.toml",
    "still-life.toml",
    "gregory.toml",
    "displaced.toml",
    "copies.toml",
    "shapes.rib",
    FLAT,
];
/// The shapes again, split until they are flat.
const FLAT: &str = "shapes.rib, flat";
/// Scenes that are also rendered as pictures are: with several samples a pixel, by both rasterisers, in parts, with all that
/// blurs them and can be seen through in them.
const PICTURES: [&str; 9] = [
    "teapot.toml",
    "eyesplit.toml",
    "spheres.toml",
    "still-life.toml",
    "gregory.toml",
    "displaced.toml",
    "glass.toml",
    "spinning.toml",
    "focus.toml",
];
const SIZES: [(u32, u32); 3] = [(160, 90), (320, 180), (640, 360)];
/// One more, where it is not a matter of minutes: not on devices that only pretend to be a GPU.
const LARGE: (u32, u32) = (1280, 720);
const BATCHES: [u32; 3] = [500, 4096, 100_000];

fn load(file: &str) -> Scene {
    Scene::load(format!("{}/../scenes/{file}", env!("CARGO_MANIFEST_DIR"))).expect("a scene")
}

fn case(scene: &str, width: u32, height: u32) -> Case {
    let scene_file = load(scene.trim_end_matches(", flat"));
    let oracle = if scene == FLAT { Oracle::Flatness } else { Oracle::Size };
    let options = FrameOptions { width, height, oracle, ..FrameOptions::default() };
    let device = scene_file.for_device(&options).expect("a drawable scene");
    Case {
        name: format!("{}_{width}x{height}", scene.trim_end_matches(".toml")),
        frame: device.frame,
        objects: device.objects,
        patches: device.patches,
        patch_count: device.patch_count,
    }
}

/// Renders all cases on one device.
struct RunAll<'a>(&'a [&'a Case]);

impl Job for RunAll<'_> {
    type Output = Vec<(String, u32, Outcome)>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let all = self.0.iter().flat_map(|&case| BATCHES.map(|batch| (case, batch)));
        all.map(|(case, batch)| {
            let outcome = run(&mut device, case, batch).expect("renders");
            (case.name.clone(), batch, outcome)
        })
        .collect()
    }
}

#[test]
fn all_backends_give_the_bits_of_the_snapshot() {
    let cases: Vec<Case> = SCENES
        .into_iter()
        .flat_map(|scene| {
            [SIZES[0], SIZES[1], SIZES[2], LARGE].map(|(width, height)| case(scene, width, height))
        })
        .collect();
    let mut devices = devices();
    // The CPU a second time, with other threads.
    devices.push((devices[0].0.clone(), 3));
    for (entry, threads) in &devices {
        let fast = entry.is_gpu || entry.backend == Backend::Cpu;
        let chosen: Vec<&Case> = cases.iter().filter(|case| fast || case.frame.width < LARGE.0).collect();
        for (case, _, outcome) in with_device(entry, *threads, RunAll(&chosen)).expect("opens") {
            insta::allow_duplicates! { insta::assert_json_snapshot!(case, outcome) };
        }
        let sizes = chosen.len() / SCENES.len();
        let runs = format!("{} scenes at {sizes} sizes in {} batch sizes", SCENES.len(), BATCHES.len());
        report(entry, &runs, "as the snapshots");
    }
}

/// Renders all cases with all schedulers on one device.
struct ScheduleAll<'a>(&'a [Case]);

impl Job for ScheduleAll<'_> {
    type Output = Vec<(String, Outcome)>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let all = self.0.iter().flat_map(|case| Schedule::all(case).into_iter().map(move |how| (case, how)));
        all.map(|(case, schedule)| {
            let outcome = run_scheduled(&mut device, case, schedule).expect("renders");
            (case.name.clone(), outcome)
        })
        .collect()
    }
}

#[test]
fn all_schedulers_give_the_bits_of_the_snapshot() {
    let (width, height) = SIZES[0];
    let cases: Vec<Case> = SCENES.into_iter().map(|scene| case(scene, width, height)).collect();
    for (entry, threads) in devices() {
        for (case, outcome) in with_device(&entry, threads, ScheduleAll(&cases)).expect("opens") {
            insta::allow_duplicates! { insta::assert_json_snapshot!(case, outcome) };
        }
        let runs = format!("{} scenes with {} schedules", SCENES.len(), Schedule::all(&cases[0]).len());
        report(&entry, &runs, "as the snapshots");
    }
}

/// Renders a scene in all looks on one device.
struct LookAtAll<'a>(&'a Scene);

impl Job for LookAtAll<'_> {
    type Output = Vec<(Look, String)>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let mut hash = |look: Look| look.hash_on(&mut device, self.0, (72, 40)).expect("renders");
        Look::all().into_iter().map(|look| (look, hash(look))).collect()
    }
}

#[test]
fn both_rasterisers_give_the_same_pictures_on_every_device() {
    for name in PICTURES {
        let scene = load(name);
        let mut expected: Vec<(Look, String)> = Vec::new(); // by the usual rasteriser of the first device, the CPU
        for (entry, _) in devices() {
            for (look, hash) in with_device(&entry, 2, LookAtAll(&scene)).expect("opens") {
                match expected.iter().find(|(known, _)| *known == look.usual()) {
                    Some((_, wanted)) => assert_eq!(&hash, wanted, "{}: {name}: {look}", entry.name),
                    None => expected.push((look.usual(), hash)),
                }
            }
            report(&entry, &format!("{name}: 2 rasterisers, 1, 4 and 16 samples"), "same pictures");
        }
        assert_eq!(expected.len(), 3, "{name}");
    }
}

struct AskAll;

impl Job for AskAll {
    type Output = Option<Mismatch>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        check(&mut device).expect("runs")
    }
}

#[test]
fn every_device_gives_the_known_answers() {
    for (entry, threads) in devices() {
        assert_eq!(with_device(&entry, threads, AskAll).expect("opens"), None, "{}", entry.name);
        report(&entry, "known answers", "right");
    }
}
