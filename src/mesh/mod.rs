//! Scenes as meshes of triangles, as fine as the camera needs them: watertight where the patches are.
//!
//! A device makes them in its own memory ([`micropoly_core::tessellate`]); here they are fetched, moved from the space
//! of each object to the world, and put in an order that depends on nothing but the scene and its options.

mod glb;
pub mod lengths;
mod obj;
mod ply;
pub(crate) mod weld;

use std::path::Path;

use glam::{DAffine3, DMat3, Vec3};
use micropoly_core::abi::MeshVertex;
use micropoly_core::backend::Device;
use micropoly_core::patch::instance::{Instance, instance};
use micropoly_core::render::FramePlan;
use micropoly_core::tessellate::MeshBuffers;
use rayon::prelude::*;

use crate::backend::on_first_device;
use crate::devices::{Job, with_device};
use crate::error::{Error, Result};
use crate::picture::extension;
use crate::render::{RenderOptions, plan_on, read_all};
use crate::scene::{DeviceScene, Scene};

/// Triangles of a scene, in world space. Of each patch a vertex is there once; vertices on the common edge of two
/// patches have the same position, bit for bit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one a position: outwards is where u runs to the right and v upwards.
    pub normals: Vec<[f32; 3]>,
    /// u and v of each within its patch, from 0 to 1; or, if it is textured, those of its mesh.
    pub uvs: Vec<[f32; 2]>,
    /// Are these for a picture, whose v runs upwards?
    pub is_textured: bool,
    /// The patch of each.
    pub patches: Vec<u32>,
    /// Corners of each triangle, as indices into the lists above. None has two corners in the same place.
    pub triangles: Vec<[u32; 3]>,
    /// Surfaces that should have been split deeper than the options allow: beside them the mesh may be open.
    pub limited: u64,
}

/// Kinds of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: positions are shared across patches.
    Obj,
    /// Binary PLY: positions are shared across patches, normals are their mean.
    Ply,
    /// Binary glTF 2.0.
    Glb,
}

impl Format {
    /// By the end of a file's name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "glb" => Some(Self::Glb),
            _ => None,
        }
    }
}

impl Mesh {
    /// All of a scene, or without [`micropoly_core::camera::FrameOptions::whole`] what its camera can see; and what a
    /// user should be told about the choice of the device. The mesh does not depend on it, nor on batch and scheduler.
    ///
    /// # Errors
    /// As [`crate::render()`]; [`Error::Plan`] if the mesh is larger than the device's largest buffer, or breadth-first.
    pub fn of(scene: &Scene, options: &RenderOptions) -> Result<(Self, Vec<String>)> {
        let (mesh, mut notes) = on_first_device(options, |entry| {
            with_device(entry, options.threads, Tessellate { scene, options })
        })?;
        let (mesh, own) = mesh?;
        notes.extend(own);
        Ok((mesh, notes))
    }

    /// From vertices and indices of a device.
    fn new(scene: &Scene, seen: &DeviceScene, vertices: &[MeshVertex], indices: &[u32]) -> Self {
        let triangles = indices.as_chunks::<3>().0;
        let mut order: Vec<[&MeshVertex; 3]> = triangles
            .par_iter()
            .filter(|[a, b, _]| a != b)
            .map(|corners| corners.map(|corner| &vertices[corner as usize]))
            .collect();
        order.par_sort_unstable_by_key(|corners| (corners[0].patch_id, corners.map(key)));
        let places: Vec<Placed> = scene.objects.iter().map(|object| Placed::new(object.to_world)).collect();
        let (mut mesh, mut known) = (Self::default(), weld::Numbers::default());
        for corners in order {
            let triangle = corners.map(|corner| {
                let (number, is_new) = known.number((corner.patch_id, key(corner)));
                if is_new {
                    let Instance { object, .. } =
                        instance(&seen.frame, &seen.objects, &seen.patches, corner.patch_id);
                    mesh.put(corner, &places[object as usize]);
                }
                number
            });
            mesh.triangles.push(triangle);
        }
        mesh
    }

    fn put(&mut self, vertex: &MeshVertex, place: &Placed) {
        self.positions.push(place.point(vertex.position));
        self.normals.push(place.normal(vertex.normal));
        self.uvs.push(vertex.uv);
        self.patches.push(vertex.patch_id);
    }

    /// Edges that are not shared by two triangles in opposite directions; 0 for a closed surface.
    #[must_use]
    pub fn open_edges(&self) -> usize {
        weld::open_edges(self)
    }

    /// Writes the mesh to a file.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save(&self, path: &Path, format: Format) -> Result<()> {
        let failed = |error: std::io::Error| Error::Write { path: path.to_owned(), why: error.to_string() };
        let mut file = std::io::BufWriter::new(std::fs::File::create(path).map_err(failed)?);
        match format {
            Format::Obj => obj::write(self, &mut file),
            Format::Ply => ply::write(self, &mut file),
            Format::Glb => glb::write(self, &mut file),
        }
        .and_then(|()| std::io::Write::flush(&mut file))
        .map_err(failed)
    }
}

/// u and v, which order as they are: neither is negative.
fn key(vertex: &MeshVertex) -> [u32; 2] {
    vertex.uv.map(f32::to_bits)
}

/// Tessellating a scene, as a job for any device.
struct Tessellate<'a> {
    scene: &'a Scene,
    options: &'a RenderOptions,
}

impl Job for Tessellate<'_> {
    type Output = Result<(Mesh, Vec<String>)>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let Self { scene, options } = self;
        let seen = scene.for_device(&options.frame)?;
        let (plan, notes) = plan_on(&device, scene, options, seen.frame)?;
        plan.can_tessellate().map_err(Error::Plan)?;
        let mesh = fetch(&mut device, &plan, scene, &seen).map_err(|error| Error::on_device(&error))?;
        Ok((mesh, notes))
    }
}

fn fetch<D: Device>(
    device: &mut D,
    plan: &FramePlan,
    scene: &Scene,
    seen: &DeviceScene,
) -> std::result::Result<Mesh, D::Error> {
    let mut buffers = plan.prepare(device, &seen.objects, &seen.patches)?;
    let MeshBuffers { vertices, indices, totals, counts } = plan.tessellate(device, &mut buffers)?;
    let vertices: Vec<MeshVertex> = read_all(device, &vertices, totals.vertices as usize)?;
    let indices: Vec<u32> = read_all(device, &indices, 3 * totals.triangles as usize)?;
    let mesh = Mesh::new(scene, seen, &vertices, &indices);
    Ok(Mesh { limited: counts.depth_limited, ..mesh })
}

/// From the space of an object to the world.
struct Placed {
    to_world: DAffine3,
    normals: DMat3,
}

impl Placed {
    fn new(to_world: DAffine3) -> Self {
        // Cofactors turn normals as triangles turn, in a mirror too, and where the matrix cannot be inverted.
        let [x, y, z] = [to_world.matrix3.x_axis, to_world.matrix3.y_axis, to_world.matrix3.z_axis];
        Self { to_world, normals: DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) }
    }

    fn point(&self, point: [f32; 3]) -> [f32; 3] {
        let moved = self.to_world.transform_point3(Vec3::from(point).as_dvec3());
        (moved.as_vec3() + Vec3::ZERO).to_array() // -0 is 0
    }

    fn normal(&self, normal: [f32; 3]) -> [f32; 3] {
        (self.normals * Vec3::from(normal).as_dvec3()).normalize_or_zero().as_vec3().to_array()
    }
}
