//! The same tree, and the same answers, on any device: bits are compared with the CPU's, and times are taken.

use std::time::Instant;

use micropoly_backend_cpu::Lbvh;
use micropoly_core::abi::{Finding, Frustum, Node, Probe, Triangle};
use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::morton::Precision;
use micropoly_core::accel::nearest::Around;
use micropoly_core::accel::plan::{DeviceTree, upload};
use micropoly_core::accel::query::{Plane, in_frustum};
use micropoly_core::accel::ray::{Ray, Shot};
use micropoly_core::accel::walk::find;
use micropoly_core::backend::Device;
use serde::Serialize;

use super::elapsed;
use crate::devices::{DeviceEntry, Job, with_device};
use crate::error::{Error, Result};

/// What a tree is asked.
#[derive(Clone, Debug, Default)]
pub struct Questions {
    /// Planes of frusta, six at most each.
    pub frusta: Vec<Vec<Plane>>,
    /// Rays.
    pub rays: Vec<Probe>,
    /// Points.
    pub points: Vec<Probe>,
}

/// Milliseconds on a device, the shortest of all runs, with what goes to the device and comes back.
#[derive(Clone, Debug, Serialize)]
pub struct Times {
    /// Name of the device.
    pub device: String,
    /// To build the tree.
    pub build: f64,
    /// To fit it to primitives that have moved.
    pub refit: f64,
    /// What all frusta see.
    pub frusta: f64,
    /// What all rays hit first.
    pub rays: f64,
    /// What is nearest to all points.
    pub nearest: f64,
}

/// Builds the tree over triangles on a device, fits it to them and asks it, `repeat` times; and compares all of it with a tree of
/// the CPU's.
///
/// # Errors
/// What the device reports; [`Error::Device`] if a bit differs.
pub fn on_device(
    entry: &DeviceEntry,
    (triangles, tree): (&[Triangle], &Lbvh),
    precision: Precision,
    questions: &Questions,
    repeat: u32,
) -> Result<Times> {
    with_device(entry, 0, Measure { triangles, tree, precision, questions, repeat })?
}

struct Measure<'a> {
    triangles: &'a [Triangle],
    tree: &'a Lbvh,
    precision: Precision,
    questions: &'a Questions,
    repeat: u32,
}

impl Job for Measure<'_> {
    type Output = Result<Times>;

    fn run<D: Device>(self, mut device: D, name: String) -> Self::Output {
        let (build, refit) = (f64::INFINITY, f64::INFINITY);
        let mut times = Times { device: name, build, refit, frusta: refit, rays: refit, nearest: refit };
        for _ in 0..self.repeat.max(1) {
            let answers = self.once(&mut device, &mut times).map_err(|error| Error::on_device(&error))?;
            self.compare(&answers, &times.device)?;
        }
        Ok(times)
    }
}

/// All that a device says.
struct Answers {
    built: Lbvh,
    refitted: Vec<Node>,
    seen: Vec<u32>,
    starts: Vec<u32>,
    hits: Vec<Finding>,
    nearest: Vec<Finding>,
}

impl Measure<'_> {
    fn once<D: Device>(&self, device: &mut D, times: &mut Times) -> std::result::Result<Answers, D::Error> {
        let boxes: Vec<Bounds> =
            self.triangles.iter().map(|triangle| Bounds::of(&triangle.points())).collect();
        let tree = DeviceTree::new(device, boxes.len() as u64, self.precision)?;
        let start = Instant::now();
        tree.build(device, &boxes)?;
        let mut built = Lbvh {
            nodes: vec![Node::default(); self.tree.nodes.len()],
            parents: vec![0; self.tree.parents.len()],
        };
        wait(device, &tree.parents)?;
        times.build = elapsed(start).min(times.build);
        device.read(&tree.nodes, 0, &mut built.nodes)?;
        device.read(&tree.parents, 0, &mut built.parents)?;
        // Somewhere else, and back again.
        tree.refit(device, &vec![Bounds::default(); boxes.len()])?;
        wait(device, &tree.parents)?;
        let start = Instant::now();
        tree.refit(device, &boxes)?;
        wait(device, &tree.parents)?;
        times.refit = elapsed(start).min(times.refit);
        let mut refitted = vec![Node::default(); built.nodes.len()];
        device.read(&tree.nodes, 0, &mut refitted)?;
        let Questions { frusta, rays, points } = self.questions;
        let frusta: Vec<Frustum> = frusta.iter().map(|planes| Frustum::new(planes)).collect();
        let mut starts = vec![0; frusta.len() + 1];
        let start = Instant::now();
        let buffer = tree.see(device, &frusta, &mut starts)?;
        let mut seen = vec![0; starts[frusta.len()] as usize];
        device.read(&buffer, 0, &mut seen)?;
        times.frusta = elapsed(start).min(times.frusta);
        let triangles = upload(device, self.triangles)?;
        let mut hits = vec![Finding::NONE; rays.len()];
        let start = Instant::now();
        tree.rays(device, &triangles, rays, &mut hits)?;
        times.rays = elapsed(start).min(times.rays);
        let mut nearest = vec![Finding::NONE; points.len()];
        let start = Instant::now();
        tree.nearest(device, &triangles, points, &mut nearest)?;
        times.nearest = elapsed(start).min(times.nearest);
        Ok(Answers { built, refitted, seen, starts, hits, nearest })
    }

    fn compare(&self, answers: &Answers, device: &str) -> Result<()> {
        let nodes = &self.tree.nodes;
        let mut seen = Vec::new();
        let mut starts = vec![0];
        for planes in &self.questions.frusta {
            in_frustum(nodes, planes, |primitive| seen.push(primitive));
            starts.push(seen.len() as u32);
        }
        let triangles = self.triangles;
        let hit = |probe: &Probe| find(&Shot { ray: Ray::new(probe), triangles }, nodes);
        let near = |probe: &Probe| find(&Around { probe: *probe, triangles }, nodes);
        let hits: Vec<Finding> = self.questions.rays.iter().map(hit).collect();
        let nearest: Vec<Finding> = self.questions.points.iter().map(near).collect();
        for (what, is_same) in [
            ("tree", bits(&answers.built.nodes) == bits(nodes) && answers.built.parents == self.tree.parents),
            ("fitted tree", bits(&answers.refitted) == bits(nodes)),
            ("answer to frusta", answers.seen == seen && answers.starts == starts),
            ("answer to rays", bits(&answers.hits) == bits(&hits)),
            ("nearest triangle", bits(&answers.nearest) == bits(&nearest)),
        ] {
            if !is_same {
                return Err(Error::Device(format!("the {what} of {device} is not the CPU's")));
            }
        }
        Ok(())
    }
}

fn bits<T: bytemuck::NoUninit>(all: &[T]) -> &[u8] {
    bytemuck::cast_slice(all)
}

/// Waits until all that was dispatched is done.
fn wait<D: Device>(device: &mut D, any: &D::Buffer) -> std::result::Result<(), D::Error> {
    device.read(any, 0, &mut [0_u32])
}
