//! What rasterising costs, step by step: tile sizes × bound × samples, as in Eisenacher & Loop 2010, Table 1.

use std::time::Instant;

use micropoly_core::backend::Device;
use micropoly_core::camera::{FrameOptions, Rasteriser};
use micropoly_core::pattern::Samples;
use serde::Serialize;

use crate::backend::Backend;
use crate::devices::{DeviceEntry, Job, with_device};
use crate::error::Result;
use crate::render::{RenderOptions, render_on};
use crate::scene::Scene;

/// One line of the table. Times are milliseconds.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Name of the backend.
    pub backend: &'static str,
    /// Name of the device.
    pub device: String,
    /// Name of the rasteriser.
    pub rasteriser: &'static str,
    /// Pixels a side of a tile; 0 = as the device likes it.
    pub tile: u32,
    /// Largest extent of a drawn surface on screen, pixels.
    pub bound: f32,
    /// Samples of a pixel.
    pub samples: u32,
    /// Bounding and splitting.
    pub subdivide: f64,
    /// Steps of drawing, by name; only of devices that can tell them apart.
    pub steps: Vec<(&'static str, f64)>,
    /// All of drawing, if stages are waited for one by one.
    pub draw: f64,
    /// From samples to pixels.
    pub filter: f64,
    /// From the uploaded scene to the pixels on the host: wall time.
    pub total: f64,
    /// Total over that of one sample a pixel, all else being equal.
    pub of_one_sample: f64,
}

impl Row {
    /// A step of drawing by its name.
    #[must_use]
    pub fn step(&self, name: &str) -> Option<f64> {
        self.steps.iter().find(|(step, _)| *step == name).map(|(_, milliseconds)| *milliseconds)
    }
}

/// Tiles that are measured: those that can be chosen, and as the device likes them.
const TILES: [u32; 5] = [0, 4, 8, 16, 32];
/// Bounds that are measured: theirs, and our own.
const BOUNDS: [u32; 3] = [4, 8, 16];
/// Numbers of samples that are measured.
const SAMPLES: [Samples; 3] = [Samples::One, Samples::Four, Samples::Sixteen];

/// Measures a scene on some devices, the shortest of `repeat` runs each; `progress` is given each row as it is done.
///
/// # Errors
/// As [`crate::render()`].
pub fn measure(
    entries: &[DeviceEntry],
    scene: &Scene,
    options: &RenderOptions,
    repeat: u32,
    mut progress: impl FnMut(&Row),
) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for entry in entries {
        // On one thread the steps add up, unless another number was asked for.
        let threads = options.threads.max(1);
        let job = OnDevice { entry, scene, options, repeat, progress: &mut progress };
        rows.extend(with_device(entry, threads, job)??);
    }
    Ok(rows)
}

struct OnDevice<'a, F> {
    entry: &'a DeviceEntry,
    scene: &'a Scene,
    options: &'a RenderOptions,
    repeat: u32,
    progress: &'a mut F,
}

impl<F: FnMut(&Row)> Job for OnDevice<'_, F> {
    type Output = Result<Vec<Row>>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let middle =
            BOUNDS.into_iter().flat_map(|bound| TILES.map(|tile| (Rasteriser::SortMiddle, bound, tile)));
        let last = BOUNDS.into_iter().map(|bound| (Rasteriser::SortLast, bound, 0));
        device.time_steps();
        let mut rows: Vec<Row> = Vec::new();
        for (rasteriser, bound, tile) in middle.chain(last) {
            let mut of_one = 0.0;
            for samples in SAMPLES {
                let bound = bound as f32 * self.options.frame.size;
                let rate = (bound / self.options.frame.size) as u32;
                let frame = FrameOptions { rasteriser, tile, bound, rate, samples, ..self.options.frame };
                let mut row = self.measure(&mut device, frame)?;
                of_one = if samples == Samples::One { row.total } else { of_one };
                row.of_one_sample = row.total / of_one;
                (self.progress)(&row);
                rows.push(row);
            }
        }
        Ok(rows)
    }
}

impl<F> OnDevice<'_, F> {
    /// The shortest run.
    fn measure<D: Device>(&self, device: &mut D, frame: FrameOptions) -> Result<Row> {
        let options = RenderOptions { frame, ..self.options.clone() };
        let mut best = Row { total: f64::INFINITY, ..Row::default() };
        for _ in 0..self.repeat.max(1) {
            device.tell_steps(&mut |_, _| {}); // those of the run before
            let start = Instant::now();
            let rendering = render_on(device, String::new(), self.scene, &options, |_| {})?;
            let seconds = rendering.seconds;
            let total = (start.elapsed().as_secs_f64() - seconds.setup) * 1e3;
            if total < best.total {
                let mut steps = Vec::new();
                device.tell_steps(&mut |name, milliseconds| steps.push((name, milliseconds)));
                let subdivide = (seconds.bound + seconds.split) * 1e3;
                let (draw, filter) = (seconds.draw * 1e3, seconds.resolve * 1e3);
                best = Row { subdivide, steps, draw, filter, total, ..best };
            }
        }
        // Elsewhere stages are only recorded when they are dispatched.
        let waits = self.entry.backend == Backend::Cpu;
        let known = |milliseconds: f64| if waits { milliseconds } else { 0.0 };
        Ok(Row {
            scene: self.scene.name.clone(),
            backend: self.entry.backend.name(),
            device: self.entry.name.clone(),
            rasteriser: frame.rasteriser.name(),
            tile: frame.tile,
            bound: frame.bound,
            samples: frame.samples.count(),
            subdivide: known(best.subdivide),
            draw: known(best.draw),
            filter: known(best.filter),
            ..best
        })
    }
}
