//! Trees over the triangles of a mesh, how good they are, and what they find: the linear hierarchy of
//! [`micropoly_core::accel`], on the CPU and on any other device.

pub mod bench;
pub mod mesh;
pub mod on_device;

use std::time::Instant;

use glam::{DVec3, Vec3};
use micropoly_core::abi::Probe;
use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::morton::Precision;
use micropoly_core::accel::query::{Plane, in_frustum, is_visible};
use micropoly_core::accel::tree::{Node, validate};
use serde::Serialize;

use crate::Camera;
use crate::error::{Error, Result};

/// A tree as it was built.
#[derive(Clone, Debug, Serialize)]
pub struct Built {
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Nodes of the tree.
    pub nodes: usize,
    /// Bytes of nodes and parents.
    pub bytes: usize,
    /// Milliseconds, the shortest of all runs.
    pub milliseconds: f64,
    /// What a ray costs by the surface area heuristic (MacDonald & Booth 1990): boxes and triangles that it meets.
    pub sah: f64,
    /// Inner nodes on the longest way to a leaf.
    pub depth: usize,
}

/// What a frustum sees.
#[derive(Clone, Debug, Serialize)]
pub struct Seen {
    /// Triangles whose boxes may be in it.
    pub visible: usize,
    /// Milliseconds with the tree, the shortest of all runs.
    pub milliseconds: f64,
    /// Milliseconds box by box.
    pub milliseconds_box_by_box: f64,
}

/// Boxes of triangles.
#[must_use]
pub fn boxes(triangles: &[[[f32; 3]; 3]]) -> Vec<Bounds> {
    triangles.iter().map(|triangle| Bounds::of(triangle)).collect()
}

/// Rays from a camera's eye through an image of so many columns and rows; and a point on each, half as far away as the origin.
#[must_use]
pub fn rays(camera: &Camera, [columns, rows]: [u32; 2]) -> [Vec<Probe>; 2] {
    let eye = camera.view.inverse().transform_point3(DVec3::ZERO);
    let high = 1.0 / camera.focal(1);
    let ray = |place: u32| {
        let [x, y] = [place % columns, place / columns].map(|k| f64::from(k) + 0.5);
        let across = (x - 0.5 * f64::from(columns)) / f64::from(rows);
        let up = 0.5 - y / f64::from(rows);
        let to = DVec3::new(across * high, up * high, -1.0).normalize();
        let direction = camera.view.matrix3.transpose() * to;
        Probe { origin: eye.as_vec3().into(), direction: direction.as_vec3().into(), far: FAR }
    };
    let rays: Vec<Probe> = (0..columns * rows).map(ray).collect();
    let distance = 0.5 * eye.length();
    let points = rays.iter().map(|ray| {
        let at = eye + distance * Vec3::from(ray.direction).as_dvec3();
        Probe { origin: at.as_vec3().into(), ..*ray }
    });
    let points = points.collect();
    [rays, points]
}

/// As far as anything is looked for.
const FAR: f32 = 1.0e30;

/// What a camera sees in an image of this width, in heights: left, right, bottom, top, and before the near plane.
#[must_use]
pub fn frustum(camera: &Camera, width: f64) -> [Plane; 5] {
    let high = 1.0 / (2.0 * camera.focal(1));
    // In the space of the eye, which looks along -z.
    let inwards = [
        DVec3::new(1.0, 0.0, -width * high),
        DVec3::new(-1.0, 0.0, -width * high),
        DVec3::new(0.0, 1.0, -high),
        DVec3::new(0.0, -1.0, -high),
        DVec3::new(0.0, 0.0, -1.0),
    ];
    let mut planes = inwards.map(|normal| {
        let turned = camera.view.matrix3.transpose() * normal;
        let offset = normal.dot(camera.view.translation);
        [turned.x as f32, turned.y as f32, turned.z as f32, offset as f32]
    });
    planes[4][3] -= camera.near as f32;
    planes
}

/// Builds the tree `repeat` times on all cores; and checks it.
///
/// # Errors
/// [`Error::Device`] if the threads cannot be started.
pub fn build(
    boxes: &[Bounds],
    precision: Precision,
    repeat: u32,
) -> Result<(micropoly_backend_cpu::Lbvh, Built)> {
    let device = cpu()?;
    let (mut tree, mut milliseconds) = (micropoly_backend_cpu::Lbvh::default(), f64::INFINITY);
    for _ in 0..repeat.max(1) {
        let start = Instant::now();
        tree = device.build_lbvh(boxes, precision);
        milliseconds = elapsed(start).min(milliseconds);
    }
    validate(&tree.nodes, &tree.parents, boxes, &mut vec![false; boxes.len()])
        .map_err(|fault| Error::Device(format!("the tree is wrong: {fault:?}")))?;
    let built = Built {
        triangles: boxes.len(),
        nodes: tree.nodes.len(),
        bytes: tree.nodes.len() * (size_of::<Node>() + size_of::<u32>()),
        milliseconds,
        sah: sah(&tree.nodes),
        depth: depth(&tree.nodes),
    };
    Ok((tree, built))
}

/// What of the tree is within all planes, which is compared with looking at every box.
///
/// # Errors
/// [`Error::Device`] if that is not the same.
pub fn query(nodes: &[Node], boxes: &[Bounds], planes: &[Plane], repeat: u32) -> Result<Seen> {
    let (mut found, mut milliseconds, mut box_by_box) = (Vec::new(), f64::INFINITY, f64::INFINITY);
    let mut wanted = Vec::new();
    for _ in 0..repeat.max(1) {
        found.clear();
        let start = Instant::now();
        in_frustum(nodes, planes, |primitive| found.push(primitive));
        milliseconds = elapsed(start).min(milliseconds);
        let start = Instant::now();
        wanted = (0..).zip(boxes).filter(|(_, bounds)| is_visible(planes, bounds)).map(|(k, _)| k).collect();
        box_by_box = elapsed(start).min(box_by_box);
    }
    found.sort_unstable();
    if found != wanted {
        return Err(Error::Device("the tree finds other triangles than there are".to_owned()));
    }
    Ok(Seen { visible: found.len(), milliseconds, milliseconds_box_by_box: box_by_box })
}

/// All cores.
fn cpu() -> Result<micropoly_backend_cpu::CpuDevice> {
    micropoly_backend_cpu::CpuDevice::new(0).map_err(|error| Error::on_device(&error))
}

fn elapsed(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// Areas of all boxes, in shares of the root's.
#[must_use]
pub fn sah(nodes: &[Node]) -> f64 {
    areas(nodes.iter().map(|node| node.bounds()))
}

/// Areas of all boxes, in shares of the first's.
fn areas(mut boxes: impl Iterator<Item = Bounds>) -> f64 {
    let Some(root) = boxes.next() else { return 0.0 };
    let below: f64 = boxes.map(|bounds| bounds.half_area()).sum();
    let root = root.half_area();
    if root > 0.0 { 1.0 + below / root } else { 0.0 }
}

fn depth(nodes: &[Node]) -> usize {
    let (mut deepest, mut stack) = (0, vec![(0, 0)]);
    while let Some((index, depth)) = stack.pop() {
        let Some(node) = nodes.get(index as usize) else { break };
        deepest = deepest.max(depth);
        if !node.is_leaf() {
            stack.extend([(node.first, depth + 1), (node.second, depth + 1)]);
        }
    }
    deepest
}
