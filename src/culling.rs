//! What culling of whole patches saves: each way to cull on the same scene, device and run.

use std::time::Instant;

use micropoly_core::backend::Device;
use serde::Serialize;

use crate::cull::Cull;
use crate::devices::{DeviceEntry, Job, with_device};
use crate::error::{Error, Result};
use crate::render::{RenderOptions, Rendering, render_on};
use crate::scene::Scene;

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Name of the backend.
    pub backend: &'static str,
    /// Name of the device.
    pub device: String,
    /// Which patches were left out.
    pub cull: &'static str,
    /// Patches that were bounded.
    pub taken: u64,
    /// Patches that can touch no sample.
    pub outside: u64,
    /// Patches behind what was drawn before.
    pub hidden: u64,
    /// Surfaces that were diced.
    pub drawn: u64,
    /// From the uploaded scene to the pixels on the host: wall time in milliseconds, the shortest of all runs.
    pub milliseconds: f64,
    /// Surfaces diced without culling over those with it.
    pub fewer: f64,
    /// Time without culling over that with it.
    pub faster: f64,
}

/// Measures a scene on some devices, the shortest of `repeat` runs each; `progress` is given each row as it is done.
///
/// # Errors
/// As [`crate::render()`]; [`Error::Device`] if culling changed the image.
pub fn measure(
    entries: &[DeviceEntry],
    scene: &Scene,
    options: &RenderOptions,
    repeat: u32,
    mut progress: impl FnMut(&Row),
) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for entry in entries {
        let job = OnDevice { entry, scene, options, repeat, progress: &mut progress };
        rows.extend(with_device(entry, options.threads, job)??);
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
        let mut rows: Vec<Row> = Vec::new();
        let mut without = None;
        for cull in Cull::ALL {
            let options = RenderOptions { cull, ..self.options.clone() };
            let (rendering, milliseconds) = self.shortest(&mut device, &options)?;
            let row = self.row(cull, &rendering, milliseconds, rows.first());
            if *without.get_or_insert_with(|| rendering.image.hash()) != rendering.image.hash() {
                return Err(Error::Device(format!("culling ({}) changed the image", cull.name())));
            }
            (self.progress)(&row);
            rows.push(row);
        }
        Ok(rows)
    }
}

impl<F> OnDevice<'_, F> {
    /// The last rendering, and the shortest time of all.
    fn shortest<D: Device>(&self, device: &mut D, options: &RenderOptions) -> Result<(Rendering, f64)> {
        let mut least = f64::INFINITY;
        loop_of(self.repeat, || {
            let start = Instant::now();
            let rendering = render_on(device, String::new(), self.scene, options, |_| {})?;
            least = least.min((start.elapsed().as_secs_f64() - rendering.seconds.setup) * 1e3);
            Ok(rendering)
        })
        .map(|rendering| (rendering, least))
    }

    fn row(&self, cull: Cull, rendering: &Rendering, milliseconds: f64, without: Option<&Row>) -> Row {
        let (roots, drawn) = (rendering.roots, rendering.counts.drawn);
        let (drawn_without, time_without) =
            without.map_or((drawn, milliseconds), |row| (row.drawn, row.milliseconds));
        Row {
            scene: self.scene.name.clone(),
            backend: self.entry.backend.name(),
            device: self.entry.name.clone(),
            cull: cull.name(),
            taken: roots.taken,
            outside: roots.outside,
            hidden: roots.hidden,
            drawn,
            milliseconds,
            fewer: drawn_without as f64 / drawn.max(1) as f64,
            faster: time_without / milliseconds,
        }
    }
}

/// What the last of so many runs comes to; there is one.
fn loop_of<T>(repeat: u32, mut run: impl FnMut() -> Result<T>) -> Result<T> {
    for _ in 1..repeat {
        run()?;
    }
    run()
}
