//! What subdivision costs: scheduler × batch × scene × device, as in Weber 2014, Table 7.2.
//!
//! Nothing is diced or sampled here, so that schedulers are compared and nothing else.

use std::time::Instant;

use micropoly_core::backend::Device;
use micropoly_core::camera::Camera;
use micropoly_core::memory::Sizes;
use micropoly_core::render::FramePlan;
use micropoly_core::schedule::Scheduler;
use serde::Serialize;

use crate::devices::{DeviceEntry, Job, with_device};
use crate::error::{Error, Result};
use crate::render::{Batch, RenderOptions, sizes_for};
use crate::scene::{DeviceScene, Scene};

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Name of the backend.
    pub backend: &'static str,
    /// Name of the device.
    pub device: String,
    /// Frame of the camera's path; none for the scene's own camera.
    pub frame: Option<f64>,
    /// Name of the scheduler.
    pub scheduler: &'static str,
    /// Surfaces a batch; 0 where the scheduler takes what there is.
    pub batch: u32,
    /// Wall time in seconds: the shortest of all runs.
    pub seconds: f64,
    /// Bytes of all that subdivision needs: stack, batch and draw buffer, but neither scene nor image. For
    /// BREADTH what this very view made of them.
    pub memory: u64,
    /// Largest number of surfaces on the stack.
    pub max: u64,
    /// Surfaces that were bounded.
    pub processed: u64,
    /// Surfaces that would be drawn.
    pub drawn: u64,
    /// Batches that were taken.
    pub batches: u64,
    /// Million surfaces bounded a second.
    pub rate: f64,
    /// Number of LOCAL's groups.
    pub groups: Option<u32>,
    /// How far the load of any of them is from the mean at most, as a share of it.
    pub imbalance: Option<f64>,
}

/// From where a scene is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Views {
    /// With its own camera.
    Camera,
    /// At one frame of its camera's path.
    Frame(f64),
    /// At so many frames of it, evenly spaced from its first to its last.
    Path(u32),
}

impl Views {
    /// Frames, with the camera at each.
    fn of(self, scene: &Scene) -> Result<Vec<(Option<f64>, Camera)>> {
        let at = |frame: f64| Ok((Some(frame), scene.camera_at(frame)?));
        match self {
            Self::Camera => Ok(vec![(None, scene.camera)]),
            Self::Frame(frame) => Ok(vec![at(frame)?]),
            Self::Path(count) => scene.path()?.evenly(count).map(at).collect(),
        }
    }
}

/// What is to be measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The devices.
    pub devices: Vec<DeviceEntry>,
    /// The schedulers.
    pub schedulers: Vec<Scheduler>,
    /// Batch sizes, for the schedulers that have one.
    pub batches: Vec<u32>,
    /// From where.
    pub views: Views,
    /// Runs of each; the shortest counts.
    pub repeat: u32,
    /// Everything else.
    pub options: RenderOptions,
}

impl Plan {
    /// Measures one scene; `progress` is given each row as it is done.
    ///
    /// # Errors
    /// [`Error::Scene`] if the views need a path and there is none; [`Error::Refused`], [`Error::Plan`] or
    /// [`Error::Device`].
    pub fn run(&self, scene: &Scene, mut progress: impl FnMut(&Row)) -> Result<Vec<Row>> {
        let (views, mut rows) = (self.views.of(scene)?, Vec::new());
        for entry in &self.devices {
            let job = OnDevice { plan: self, scene, views: &views, entry, progress: &mut progress };
            rows.extend(with_device(entry, self.options.threads, job)??);
        }
        Ok(rows)
    }

    /// Schedulers with the batches that make sense for them.
    fn cases(&self) -> impl Iterator<Item = (Scheduler, u32)> {
        self.schedulers.iter().flat_map(|&scheduler| {
            let batches: &[u32] = match scheduler {
                Scheduler::Stack | Scheduler::Breadth => &[1],
                Scheduler::Bounded | Scheduler::Local | Scheduler::Adaptive => &self.batches,
            };
            batches.iter().map(move |&batch| (scheduler, batch))
        })
    }
}

/// The part of the table for one device.
struct OnDevice<'a, F> {
    plan: &'a Plan,
    scene: &'a Scene,
    views: &'a [(Option<f64>, Camera)],
    entry: &'a DeviceEntry,
    progress: &'a mut F,
}

impl<F: FnMut(&Row)> Job for OnDevice<'_, F> {
    type Output = Result<Vec<Row>>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let mut rows = Vec::new();
        for (frame, camera) in self.views {
            let seen = self.scene.seen_from(camera, &self.plan.options.frame)?;
            let view = View { scene: self.scene, entry: self.entry, frame: *frame, seen };
            for (scheduler, batch) in self.plan.cases() {
                let batch = Batch::Surfaces(batch);
                let capacity = if scheduler.has_capacity() { self.plan.options.capacity } else { 0 };
                let options = RenderOptions { scheduler, batch, capacity, ..self.plan.options.clone() };
                let row = measure(&mut device, &view, &options, self.plan.repeat)?;
                (self.progress)(&row);
                rows.push(row);
            }
        }
        Ok(rows)
    }
}

/// A scene seen from one place, to be measured on one device.
struct View<'a> {
    scene: &'a Scene,
    entry: &'a DeviceEntry,
    frame: Option<f64>,
    seen: DeviceScene,
}

fn measure<D: Device>(device: &mut D, view: &View<'_>, options: &RenderOptions, repeat: u32) -> Result<Row> {
    let View { scene, entry, frame, ref seen } = *view;
    let failed = |error: D::Error| Error::on_device(&error);
    let sizes: Sizes = sizes_for(scene, options)?;
    let plan = FramePlan::with_sizes(seen.frame, sizes).map_err(Error::Plan)?.without_drawing();
    let before = device.bytes_allocated();
    let (mut seconds, mut counts, mut memory) = (f64::INFINITY, None, 0);
    for _ in 0..repeat.max(1) {
        let mut buffers = plan.prepare(device, &seen.objects, &seen.patches).map_err(failed)?;
        let start = Instant::now();
        counts = Some(plan.run(device, &mut buffers, |_| {}).map_err(failed)?);
        seconds = seconds.min(start.elapsed().as_secs_f64());
        memory = device.bytes_allocated() - before - plan.sizes().fixed_bytes();
    }
    let counts = counts.unwrap_or_default();
    let has_batch = !matches!(options.scheduler, Scheduler::Stack | Scheduler::Breadth);
    Ok(Row {
        scene: scene.name.clone(),
        backend: entry.backend.name(),
        device: entry.name.clone(),
        frame,
        scheduler: options.scheduler.name(),
        batch: if has_batch { plan.sizes().batch } else { 0 },
        seconds,
        memory,
        max: counts.max_stack,
        processed: counts.processed,
        drawn: counts.drawn,
        batches: counts.batches,
        rate: counts.processed as f64 / seconds * 1e-6,
        groups: counts.load.map(|load| load.groups),
        imbalance: counts.load.map(|load| load.imbalance()),
    })
}

/// The spike view: the row of the frame at which BREADTH needs most memory, and most work among equals.
#[must_use]
pub fn spike(rows: &[Row]) -> Option<&Row> {
    let of_frames =
        rows.iter().filter(|row| row.frame.is_some() && row.scheduler == Scheduler::Breadth.name());
    of_frames.max_by_key(|row| (row.memory, row.max, row.processed))
}
