//! A device against a reference: every stage alone, then whole images and counts.

use std::collections::BTreeMap;

use micropoly_core::abi::Pixel;
use micropoly_core::backend::Device;
use micropoly_core::memory::DEFAULT_BATCH;
use micropoly_core::stage::Stage;
use serde::Serialize;

use crate::corpus;
use crate::outcome::{Case, Found, Outcome, Schedule, render, run, run_scheduled};
use crate::stages::{Difference, first_difference, run_stage};

/// How one stage fared.
#[derive(Clone, Debug, Serialize)]
pub struct StageReport {
    /// Name of the stage.
    pub stage: &'static str,
    /// Inputs that were run.
    pub inputs: u64,
    /// The first difference, if there is any.
    pub difference: Option<Difference>,
    /// What the device said when it failed.
    pub error: Option<String>,
}

/// How one case fared with one schedule.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// Name of the case.
    pub case: String,
    /// Scheduler, batch and stack.
    pub schedule: String,
    /// What the reference made of it.
    pub expected: Outcome,
    /// What the device made of it; `None` if it failed.
    pub found: Option<Outcome>,
    /// What the device said when it failed.
    pub error: Option<String>,
}

/// How one picture fared.
#[derive(Clone, Debug, Serialize)]
pub struct PictureReport {
    /// Name of the scene.
    pub scene: String,
    /// How it was rendered.
    pub look: String,
    /// Hash of the reference's pixels.
    pub expected: String,
    /// Hash of the device's; `None` if it failed.
    pub found: Option<String>,
    /// What the device said when it failed.
    pub error: Option<String>,
}

impl PictureReport {
    /// Did the device give the reference's bits?
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.found.as_ref() == Some(&self.expected)
    }
}

/// How one device fared.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceReport {
    /// Name of the backend.
    pub backend: String,
    /// Name of the device.
    pub device: String,
    /// Driver and limits, by name.
    pub details: BTreeMap<&'static str, String>,
    /// Each stage alone.
    pub stages: Vec<StageReport>,
    /// Whole images and counts.
    pub cases: Vec<CaseReport>,
    /// Pictures in all looks.
    pub pictures: Vec<PictureReport>,
}

impl StageReport {
    /// Did the device give the reference's bits?
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.difference.is_none() && self.error.is_none()
    }
}

impl CaseReport {
    /// Did the device give the reference's bits?
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.found.as_ref() == Some(&self.expected)
    }
}

impl DeviceReport {
    /// Did the device give the reference's bits everywhere?
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.stages.iter().all(StageReport::agrees)
            && self.cases.iter().all(CaseReport::agrees)
            && self.pictures.iter().all(PictureReport::agrees)
    }
}

/// Runs a stage on both devices with `inputs` inputs of the corpus, up to the first difference.
pub fn check_stage<R: Device, D: Device>(
    reference: &mut R,
    device: &mut D,
    stage: Stage,
    inputs: u64,
) -> StageReport {
    let mut report = StageReport { stage: stage.name(), inputs, difference: None, error: None };
    for round in 0..inputs {
        let input = corpus::input(stage, round);
        let expected = match run_stage(reference, &input) {
            Ok(outputs) => outputs,
            Err(error) => return StageReport { error: Some(format!("reference: {error}")), ..report },
        };
        match run_stage(device, &input) {
            Ok(found) => report.difference = first_difference(stage, &expected, &found),
            Err(error) => report.error = Some(error.to_string()),
        }
        if !report.agrees() {
            report.inputs = round + 1;
            break;
        }
    }
    report
}

/// Renders a case on both devices, on the reference with the default schedule.
///
/// # Errors
/// What the reference reports; what the device reports is in the report.
pub fn check_case<R: Device, D: Device>(
    reference: &mut R,
    device: &mut D,
    case: &Case,
    schedule: Schedule,
) -> Result<CaseReport, R::Error> {
    let expected = run(reference, case, DEFAULT_BATCH)?;
    let (found, error) = match run_scheduled(device, case, schedule) {
        Ok(outcome) => (Some(outcome), None),
        Err(error) => (None, Some(error.to_string())),
    };
    Ok(CaseReport { case: case.name.clone(), schedule: schedule.to_string(), expected, found, error })
}

/// All pixels of a case, row after row: for pictures of what differs.
///
/// # Errors
/// What the plan or the device reports.
pub fn pixels<D: Device>(device: &mut D, case: &Case, schedule: Schedule) -> Result<Vec<Pixel>, D::Error> {
    let Found { plan, buffers, .. } = render(device, case, schedule)?;
    let mut pixels = vec![Pixel::default(); plan.sizes().area.pixels as usize];
    device.read(&buffers.pixels, 0, &mut pixels)?;
    Ok(pixels)
}
