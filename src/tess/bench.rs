//! What tessellating costs: level × mesh × device (Stadlbauer 2019, ch. 6).

use std::time::Instant;

use micropoly_core::abi::{TESS_CONSTANT, TessFrame};
use micropoly_core::backend::Device;
use micropoly_core::tess::stream::{TessCounts, TessInput, TessPlan};
use serde::Serialize;

use super::chunk::wait;
use super::source::TessSource;
use crate::cage::generate::{Layout, torus_cage};
use crate::devices::{DeviceEntry, Job, with_device};
use crate::error::{Error, Result};

/// Levels that are measured.
pub const LEVELS: [u32; 5] = [4, 8, 16, 32, 64];
/// Triangles of meshes as large as those that are measured elsewhere: a monkey's head, a rabbit.
const TRIANGLES: [(&str, u32); 2] = [("small torus", 968), ("large torus", 69_564)];

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The mesh.
    pub mesh: String,
    /// Name of the device.
    pub device: String,
    /// Level of all edges.
    pub level: u32,
    /// Patches of the mesh.
    pub patches: usize,
    /// Triangles that they become.
    pub triangles: u64,
    /// Chunks that they come in.
    pub chunks: u64,
    /// Milliseconds of control, with patches to the device, and in the first run of what has to be compiled; the shortest of
    /// all runs.
    pub control: f64,
    /// Milliseconds of evaluation, with places; the shortest of all runs.
    pub evaluation: f64,
    /// Million triangles a second, both steps together.
    pub rate: f64,
}

/// Measures all meshes at all levels on a device, the CPU with so many threads (0 = one a core), within so many bytes of its
/// memory; `progress` is given each row.
///
/// # Errors
/// What the device reports.
pub fn measure(
    entry: &DeviceEntry,
    threads: usize,
    memory: u64,
    repeat: u32,
    mut progress: impl FnMut(&Row),
) -> Result<Vec<Row>> {
    let meshes = meshes()?;
    let mut rows = Vec::new();
    for (name, source) in &meshes {
        for level in LEVELS {
            let row = with_device(entry, threads, Measure { name, source, level, memory, repeat })??;
            progress(&row);
            rows.push(row);
        }
    }
    Ok(rows)
}

fn meshes() -> Result<Vec<(String, TessSource)>> {
    let mut meshes = Vec::new();
    for (name, triangles) in TRIANGLES {
        let cage = torus_cage(triangles, Layout::Triangles);
        let source =
            TessSource::of_mesh(&cage).map_err(|error| Error::scene(error.to_string(), "report it"))?;
        meshes.push((name.to_owned(), source));
    }
    let teapot = crate::bpt::parse_bytes("teapot.bpt".as_ref(), TEAPOT.to_vec())?;
    meshes.insert(1, ("teapot".to_owned(), TessSource::of_bezier(&teapot)));
    Ok(meshes)
}

/// Measuring, as a job for any device.
struct Measure<'a> {
    name: &'a str,
    source: &'a TessSource,
    level: u32,
    memory: u64,
    repeat: u32,
}

impl Job for Measure<'_> {
    type Output = Result<Row>;

    fn run<D: Device>(self, mut device: D, name: String) -> Self::Output {
        let Self { source, level, memory, repeat, .. } = self;
        let levels = level as f32;
        let frame = TessFrame {
            domain: source.domain().code(),
            control: TESS_CONSTANT,
            evaluation: source.evaluation(0),
            outer: [levels; 4],
            inner: [levels; 2],
            ..TessFrame::default()
        };
        let input = TessInput { frame, patches: &source.patches, levels: &[], heights: &[] };
        let plan = TessPlan::new(&input, memory).map_err(Error::Plan)?;
        let (mut control, mut evaluation, mut counts) = (f64::INFINITY, f64::INFINITY, TessCounts::default());
        for _ in 0..repeat {
            let mut run = || {
                let start = Instant::now();
                let buffers = plan.prepare(&mut device)?;
                control = milliseconds(start).min(control);
                // The first time, the system has to find the memory.
                for _ in 0..2 {
                    let start = Instant::now();
                    counts = plan.run(&mut device, &buffers, wait)?;
                    evaluation = milliseconds(start).min(evaluation);
                }
                Ok(())
            };
            run().map_err(|error: D::Error| Error::on_device(&error))?;
        }
        Ok(Row {
            mesh: self.name.to_owned(),
            device: name,
            level,
            patches: source.patches.len(),
            triangles: counts.primitives,
            chunks: counts.chunks,
            control,
            evaluation,
            rate: counts.primitives as f64 / 1e3 / (control + evaluation),
        })
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// The built-in teapot's 32 patches.
const TEAPOT: &[u8] = include_bytes!("../../scenes/teapot.bpt");
