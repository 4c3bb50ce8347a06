//! `micropoly conform`: every device against the CPU with one thread.

use std::path::Path;

use micropoly::core::backend::Device;
use micropoly::core::stage::Stage;
use micropoly::devices::{DeviceEntry, Job, with_device};
use micropoly::looks::Look;
use micropoly::{
    Backend, Blur, Error, FrameOptions, Image, Lens, Result, Scene, Scheduler, Shape, bpt, scene_file,
};
use micropoly_conformance::report::{
    CaseReport, DeviceReport, PictureReport, check_case, check_stage, pixels,
};
use micropoly_conformance::{Case, Outcome, Schedule, corpus};
use serde_json::Value;

use super::args::ConformArguments;
use super::devices::compared;
use super::render::write_json;

/// Image sizes of every scene.
const SIZES: [(u32, u32); 3] = [(160, 90), (640, 360), (1280, 720)];
/// Image size of pictures in all looks.
const LOOK_SIZE: (u32, u32) = (96, 54);
/// Surfaces a batch.
const BATCHES: [u32; 3] = [300, 4096, 50_000];
/// Fewer patches than this make a small scene.
const FEW: usize = 5000;

pub(crate) fn run(arguments: &ConformArguments) -> Result<()> {
    let entries = compared(arguments.backend)?;
    let scenes = scenes(&arguments.scenes)?;
    let (cases, looked_at) = (cases(&scenes)?, [scenes, blurred_scenes()?].concat());
    let mut reports = Vec::new();
    for entry in &entries {
        say!("\n{} {}  {}", entry.backend.name(), entry.index, entry.name);
        let job = Conform { entry, cases: &cases, scenes: &looked_at, pictures: &arguments.pictures };
        reports.push(with_device(entry, 3, job)??);
    }
    if let Some(path) = &arguments.json {
        write_json(path, &reports)?;
    }
    let wrong = reports.iter().filter(|report| !report.agrees()).count();
    say!("\n{} of {} devices agree with the CPU", reports.len() - wrong, reports.len());
    if wrong > 0 {
        let problem = format!("{wrong} of {} devices give other bits than the CPU", reports.len());
        return Err(Error::scene(problem, "see the first difference of each above"));
    }
    Ok(())
}

fn built_in(name: &str, text: &str) -> Result<Scene> {
    scene_file::parse_bytes(name.as_ref(), text.as_bytes().to_vec())
}

pub(super) fn teapot(name: &str) -> Result<Scene> {
    let teapot = include_bytes!("../../scenes/teapot.bpt").to_vec();
    Scene::around(name.to_owned(), Shape::of_bezier(bpt::parse_bytes("teapot.bpt".as_ref(), teapot)?))
}

/// A teapot with balls in it that can be seen through, and one that spins out of focus.
fn blurred_scenes() -> Result<Vec<Scene>> {
    let (mut glass, mut spinning) = (teapot("glass")?, teapot("spinning")?);
    let mut balls = built_in("spheres", include_str!("../../scenes/spheres.toml"))?.objects.remove(0);
    balls.material.opacity = 0.6;
    glass.objects[0].material.opacity = 0.3;
    glass.objects.push(balls);
    spinning.objects[0].motion.rotate.z = 40.0;
    spinning.blur = Blur { shutter: 0.5, lens: Some(Lens { fstop: 2.8, focus: 9.0 }), sensor: 0.5 };
    Ok(vec![glass, spinning])
}

/// The built-in scenes and those that the user names.
fn scenes(files: &[std::path::PathBuf]) -> Result<Vec<Scene>> {
    let mut scenes = vec![
        teapot("teapot")?,
        built_in("eyesplit", include_str!("../../scenes/eyesplit.toml"))?,
        built_in("spheres", include_str!("../../scenes/spheres.toml"))?,
        built_in("gregory", include_str!("../../scenes/gregory.toml"))?,
        built_in("displaced", include_str!("../../scenes/displaced.toml"))?,
    ];
    for file in files {
        scenes.push(Scene::load(file)?);
    }
    Ok(scenes)
}

/// All scenes at every size.
fn cases(scenes: &[Scene]) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for (scene, (width, height)) in scenes.iter().flat_map(|scene| SIZES.map(|size| (scene, size))) {
        let options = FrameOptions { width, height, ..FrameOptions::default() };
        let device = scene.for_device(&options)?;
        cases.push(Case {
            name: format!("{} {width}x{height}", scene.name),
            frame: device.frame,
            objects: device.objects,
            patches: device.patches,
            patch_count: device.patch_count,
        });
    }
    Ok(cases)
}

/// Batches of all sizes; of small images also all schedulers, but one surface at a time only in small scenes.
fn schedules(case: &Case) -> Vec<Schedule> {
    let mut all = BATCHES.map(Schedule::of_batch).to_vec();
    if case.frame.width == SIZES[0].0 {
        let affordable = |how: &Schedule| how.scheduler != Scheduler::Stack || case.patch_count < FEW;
        all.extend(Schedule::all(case).into_iter().filter(affordable));
    }
    all
}

/// Comparing one device with the CPU.
struct Conform<'a> {
    entry: &'a DeviceEntry,
    cases: &'a [Case],
    scenes: &'a [Scene],
    pictures: &'a Path,
}

impl Job for Conform<'_> {
    type Output = Result<DeviceReport>;

    fn run<D: Device>(self, device: D, name: String) -> Result<DeviceReport> {
        let (reference, _) = Backend::Cpu.candidates(None)?;
        with_device(&reference[0], 1, AgainstReference { conform: self, device, name })?
    }
}

/// The same, with the reference open.
struct AgainstReference<'a, D> {
    conform: Conform<'a>,
    device: D,
    name: String,
}

impl<D: Device> Job for AgainstReference<'_, D> {
    type Output = Result<DeviceReport>;

    fn run<R: Device>(mut self, mut reference: R, _: String) -> Result<DeviceReport> {
        let mut report = DeviceReport {
            backend: self.conform.entry.backend.name().to_owned(),
            device: self.name.clone(),
            details: self.conform.entry.details.iter().cloned().collect(),
            stages: Vec::new(),
            cases: Vec::new(),
            pictures: Vec::new(),
        };
        for stage in Stage::ALL {
            let checked = check_stage(&mut reference, &mut self.device, stage, corpus::ROUNDS);
            print_row(stage.name(), &format!("{} inputs", checked.inputs), checked.agrees());
            if let Some(difference) = &checked.difference {
                say!("      {difference}");
            }
            print_error(checked.error.as_deref());
            report.stages.push(checked);
        }
        for case in self.conform.cases {
            for schedule in schedules(case) {
                let checked = check_case(&mut reference, &mut self.device, case, schedule)
                    .map_err(|error| Error::Device(error.to_string()))?;
                print_case(&checked);
                if !checked.agrees() {
                    self.picture(&mut reference, case, schedule)?;
                }
                report.cases.push(checked);
            }
        }
        for scene in self.conform.scenes {
            report.pictures.extend(self.looks(&mut reference, scene)?);
        }
        Ok(report)
    }
}

impl<D: Device> AgainstReference<'_, D> {
    /// Compares pictures of a scene in all looks.
    fn looks<R: Device>(&mut self, reference: &mut R, scene: &Scene) -> Result<Vec<PictureReport>> {
        let (name, mut reports) = (scene.name.clone(), Vec::new());
        for look in Look::all() {
            let expected = look.usual().hash_on(reference, scene, LOOK_SIZE)?;
            let (found, error) = match look.hash_on(&mut self.device, scene, LOOK_SIZE) {
                Ok(hash) => (Some(hash), None),
                Err(error) => (None, Some(error.to_string())),
            };
            let (scene, look) = (name.clone(), look.to_string());
            let report = PictureReport { scene, look, expected, found, error };
            print_row(&report.scene, &report.look, report.agrees());
            print_error(report.error.as_deref());
            reports.push(report);
        }
        Ok(reports)
    }

    /// Writes expected, actual and difference of a case side by side.
    fn picture<R: Device>(&mut self, reference: &mut R, case: &Case, schedule: Schedule) -> Result<()> {
        let (width, height) = (case.frame.width, case.frame.height);
        let (Ok(expected), Ok(actual)) =
            (pixels(reference, case, schedule), pixels(&mut self.device, case, schedule))
        else {
            return Ok(());
        };
        let images = [expected, actual].map(|all| Image::from_pixels(width, height, &all));
        let path = self.conform.pictures.join(format!("{}.png", case.name.replace([' ', '/'], "-")));
        side_by_side(&images[0], &images[1]).save_png(&path)?;
        say!("      expected | actual | difference: {}", path.display());
        Ok(())
    }
}

/// Both images and, white, the pixels in which they differ.
fn side_by_side(expected: &Image, actual: &Image) -> Image {
    let stride = expected.width as usize * 3;
    let rows = expected.rgb.chunks_exact(stride).zip(actual.rgb.chunks_exact(stride));
    let rgb = rows
        .flat_map(|(expected, actual)| {
            let pixels = expected.chunks_exact(3).zip(actual.chunks_exact(3));
            let difference = pixels.flat_map(|(a, b)| [if a == b { 0 } else { 255 }; 3]);
            expected.iter().chain(actual).copied().chain(difference).collect::<Vec<u8>>()
        })
        .collect();
    Image { width: expected.width * 3, height: expected.height, rgb }
}

fn print_case(report: &CaseReport) {
    let what = format!("{}: {} surfaces", report.schedule, report.expected.processed);
    print_row(&report.case, &what, report.agrees());
    for (field, expected, found) in differences(report) {
        say!("      {field} is {found}, should be {expected}");
    }
    print_error(report.error.as_deref());
}

/// The fields in which a device's outcome differs: name, expected value, found value.
fn differences(report: &CaseReport) -> Vec<(String, Value, Value)> {
    let fields = |outcome: &Outcome| serde_json::to_value(outcome).unwrap_or_default();
    let Some(found) = report.found.as_ref().map(fields) else { return Vec::new() };
    let Value::Object(expected) = fields(&report.expected) else { return Vec::new() };
    let pairs = expected.into_iter().map(|(name, value)| (found[&name].clone(), name, value));
    pairs
        .filter(|(found, _, value)| found != value)
        .map(|(found, name, value)| (name, value, found))
        .collect()
}

fn print_row(name: &str, what: &str, agrees: bool) {
    say!("  {name:<24} {what:<46} {}", if agrees { "same bits" } else { "DIFFERS" });
}

fn print_error(error: Option<&str>) {
    if let Some(error) = error {
        say!("      {error}");
    }
}
