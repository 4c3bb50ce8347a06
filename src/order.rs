//! Transparency in order: all triangles of a scene, sorted for the eye (Imre 2016), instead of a list a sample.

use std::time::Instant;

use glam::Vec3;
use micropoly_backend_cpu::{BspGrid, BspOptions, BspShot, BspSight, CpuDevice};
use micropoly_core::abi::{Colour, Frame, Object, Sample};
use micropoly_core::accel::bsp::show::{Eye, Face, Half};
use micropoly_core::camera::Camera;

use crate::bsp::{Triangle, too_far, unfit};
use crate::error::{Error, Result};
use crate::render::Ordering;
use crate::scene::{Scene, SceneObject};
use crate::shape::BezierPatch;

/// The triangles of a scene, as they are at a moment.
pub(crate) struct Ordered {
    device: CpuDevice,
    ordering: Ordering,
    time: f64,
    grid: BspGrid,
    faces: Vec<Face>,
    /// What was seen last.
    seen: Option<BspSight>,
    /// Time that all of it took.
    seconds: f64,
}

impl Ordered {
    /// Cuts the triangles of a scene at a moment, in frames.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is anything but polygons, or they cut each other into too many pieces.
    pub(crate) fn new(scene: &Scene, time: f64, ordering: Ordering, threads: usize) -> Result<Self> {
        let start = Instant::now();
        let device = CpuDevice::new(threads).map_err(|error| Error::on_device(&error))?;
        let (grid, faces) = cut(&device, scene, time, ordering)?;
        let seconds = start.elapsed().as_secs_f64();
        Ok(Self { device, ordering, time, grid, faces, seen: None, seconds })
    }

    /// Cuts the triangles as they are at another moment, if they move.
    ///
    /// # Errors
    /// As [`Ordered::new`].
    pub(crate) fn move_to(&mut self, scene: &Scene, time: f64) -> Result<()> {
        if self.time != time && scene.objects_move() {
            (self.grid, self.faces) = cut(&self.device, scene, time, self.ordering)?;
            (self.time, self.seen) = (time, None);
        }
        Ok(())
    }

    /// Time that all of it took so far.
    pub(crate) const fn seconds(&self) -> f64 {
        self.seconds
    }

    /// What a user may want to know of it.
    pub(crate) fn note(&self) -> String {
        let Self { grid, faces, .. } = self;
        let [x, y, z] = grid.slabs.each_ref().map(Vec::len);
        let (triangles, pieces) = (faces.len(), grid.pieces.len());
        format!("transparency in order: {triangles} triangles in {pieces} pieces, a grid of {x}x{y}x{z}")
    }

    /// Blends all samples of a frame.
    ///
    /// # Errors
    /// [`Error::Scene`] if the camera is too far away.
    pub(crate) fn draw(
        &mut self,
        camera: &Camera,
        frame: &Frame,
        objects: &[Object],
        (front, layers): (&mut [Sample], &mut [Colour]),
    ) -> Result<()> {
        let start = Instant::now();
        let eye = Eye::new(&self.grid.lattice, &camera.view, frame).ok_or_else(too_far)?;
        let seen = self.seen.take().filter(|seen| seen.eye == eye);
        let sight = seen.unwrap_or_else(|| self.device.see_bsp(&self.grid, eye, f64::from(frame.near)));
        let shot = BspShot { grid: &self.grid, faces: &self.faces, sight: &sight, frame, objects };
        self.device.draw_bsp(&shot, front, layers);
        self.seen = Some(sight);
        self.seconds += start.elapsed().as_secs_f64();
        Ok(())
    }
}

/// Pieces of a scene's triangles at a moment, and what each triangle is seen as.
fn cut(device: &CpuDevice, scene: &Scene, time: f64, ordering: Ordering) -> Result<(BspGrid, Vec<Face>)> {
    let (mut triangles, mut faces, mut first) = (Vec::new(), Vec::new(), 0);
    for (number, object) in (0..).zip(&scene.objects) {
        check(number, object)?;
        add(object, time, |half, patch, triangle| {
            faces.push(Face { object: number, patch_id: first + patch, half });
            triangles.push(triangle);
        });
        first += object.patch_count() as u32;
    }
    let options = BspOptions { grid: ordering.grid, tolerance: ordering.tolerance, ..BspOptions::default() };
    Ok((device.build_bsp(&triangles, &options).map_err(unfit)?, faces))
}

fn check(number: u32, object: &SceneObject) -> Result<()> {
    let remedy =
        "draw .obj files with --polygons (in scene files: polygons = true), or use --transparency layers";
    if !object.shape.is_polygons {
        let problem =
            format!("object {number} (counted from 0) has curved patches, and only polygons can be sorted");
        return Err(Error::scene(problem, remedy));
    }
    if object.displacement.is_some() {
        let problem =
            format!("object {number} (counted from 0) is displaced, and only flat polygons can be sorted");
        return Err(Error::scene(problem, "remove its displacement, or use --transparency layers"));
    }
    Ok(())
}

/// Tells the triangles of an object: half, number of the patch, corners.
fn add(object: &SceneObject, time: f64, mut tell: impl FnMut(Half, u32, Triangle)) {
    let to_world = object.motion.at(object.to_world, time);
    let world = |p: [f32; 3]| to_world.transform_point3(Vec3::from(p).as_dvec3()).as_vec3().to_array();
    for (number, BezierPatch { points }) in (0..).zip(&object.shape.bezier) {
        let [a, b, c, d] = [points[0], points[12], points[15], points[3]].map(world);
        if points[15] == points[3] {
            tell(Half::Whole, number, [a, b, c]);
        } else {
            tell(Half::First, number, [a, b, c]);
            tell(Half::Second, number, [a, c, d]);
        }
    }
}
