//! Scenes as meshes of triangles, as fine as the camera needs them: watertight where the patches are.
//!
//! Which vertices there are is what the renderer would draw, decided by the same functions; the mesh itself is
//! evaluated in the space of each object and then moved to the world, so it does not shake with the camera.

mod glb;
pub mod lengths;
mod obj;
mod ply;
mod weld;

use std::path::Path;

use glam::{DAffine3, DMat3, Vec3};
use micropoly_core::abi::{CULL, DRAW, DRAW_LIMITED, Draw, Frame, Object, PARAM_STEP, Surface};
use micropoly_core::camera::FrameOptions;
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::dice::{Grid, dice};
use micropoly_core::kernel::dice_gregory::dice_gregory;
use micropoly_core::patch::gregory::patch_count;
use micropoly_core::patch::{Faces, Net};
use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::scene::{DeviceScene, Scene};

/// Triangles of a scene, in world space. Of each patch a vertex is there once; vertices on the common edge of two
/// patches have the same position, bit for bit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one a position: outwards is where u runs to the right and v upwards.
    pub normals: Vec<[f32; 3]>,
    /// u and v of each within its patch, from 0 to 1.
    pub uvs: Vec<[f32; 2]>,
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
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "glb" => Some(Self::Glb),
            _ => None,
        }
    }
}

impl Mesh {
    /// All of a scene, or with [`FrameOptions::whole`] unset what its camera can see.
    ///
    /// # Errors
    /// As [`Scene::for_device`]; [`Error::Scene`] if there are more vertices than an index can tell apart.
    pub fn of(scene: &Scene, options: &FrameOptions) -> Result<Self> {
        let seen = scene.for_device(options)?;
        let patches = 0..patch_count(&seen.patches) as u32;
        let parts: Vec<Part> = patches
            .into_par_iter()
            .map_init(|| Box::new(Grid::default()), |grid, patch| Part::of(&seen, scene, patch, grid))
            .collect();
        let mut mesh = Self::default();
        for (patch, part) in (0..).zip(parts) {
            mesh.append(patch, part)?;
        }
        Ok(mesh)
    }

    fn append(&mut self, patch: u32, part: Part) -> Result<()> {
        let first = self.positions.len();
        if first + part.positions.len() > u32::MAX as usize {
            return Err(Error::scene(
                "the mesh has more than 2³² vertices",
                "choose a larger --micropolygon-size",
            ));
        }
        let first = first as u32;
        self.patches.extend(part.positions.iter().map(|_| patch));
        self.positions.extend(part.positions);
        self.normals.extend(part.normals);
        self.uvs.extend(part.uvs);
        self.triangles.extend(part.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        self.limited += part.limited;
        Ok(())
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

/// The mesh of one patch.
#[derive(Default)]
struct Part {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<[u32; 3]>,
    limited: u64,
}

impl Part {
    fn of(seen: &DeviceScene, scene: &Scene, patch: u32, grid: &mut Grid) -> Self {
        let own = &seen.patches[patch as usize];
        let place = Placed::new(scene.objects[own.object as usize].to_world);
        let (mut part, mut known) = (Self::default(), weld::Numbers::default());
        for_each_draw(seen, patch, |draw, is_limited| {
            part.limited += u64::from(is_limited);
            dice_any(seen, &AS_IT_IS, draw, grid);
            part.add(draw, grid, &place, &mut known);
        });
        part
    }

    fn add(&mut self, draw: Draw, grid: &Grid, place: &Placed, known: &mut weld::Numbers<[u32; 2]>) {
        let mut numbers = vec![0; grid.stride * grid.rows];
        for (at, number) in numbers.iter_mut().enumerate() {
            let uv = draw.vertex((at / grid.stride) as u32, (at % grid.stride) as u32);
            let (found, is_new) = known.number(uv);
            *number = found;
            if is_new {
                self.positions.push(place.point(grid.point(at)));
                self.normals.push(place.normal(grid.unit_normal(at)));
                self.uvs.push(uv.map(|t| t as f32 * PARAM_STEP));
            }
        }
        for (row, column) in (0..grid.rows - 1).flat_map(|row| (0..grid.stride - 1).map(move |c| (row, c))) {
            let a = row * grid.stride + column;
            let [a, b, c, d] = [a, a + 1, a + grid.stride + 1, a + grid.stride].map(|at| numbers[at]);
            let place = |corner: u32| self.positions[corner as usize];
            let has_area = |[a, b, c]: &[u32; 3]| {
                place(*a) != place(*b) && place(*b) != place(*c) && place(*c) != place(*a)
            };
            self.triangles.extend([[a, b, c], [a, c, d]].into_iter().filter(has_area));
        }
    }
}

/// From the space of an object to the world.
struct Placed {
    to_world: DAffine3,
    normals: DMat3,
}

impl Placed {
    fn new(to_world: DAffine3) -> Self {
        // The cofactors turn normals rightly even where the matrix cannot be inverted; a mirror keeps outside outside.
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

/// An object that leaves its points where they are.
const AS_IT_IS: Object = Object {
    to_eye: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    colour: [0.0; 3],
    specular: 0.0,
    gloss: 0,
};

/// Everything that is drawn of a patch, in the order of depth first, and whether it should have been split deeper.
fn for_each_draw(seen: &DeviceScene, patch: u32, mut each: impl FnMut(Draw, bool)) {
    let mut stack = vec![Surface::root(patch)];
    while let Some(surface) = stack.pop() {
        let verdict = bound_any(&seen.frame, &seen.objects, &seen.patches, surface);
        match verdict.code {
            CULL => {}
            DRAW | DRAW_LIMITED => each(Draw::new(surface, verdict), verdict.code == DRAW_LIMITED),
            _ => stack.extend(surface.halves(verdict)),
        }
    }
}

/// Dices a surface of any patch, seen as `object` is placed.
fn dice_any(seen: &DeviceScene, object: &Object, draw: Draw, grid: &mut Grid) {
    let patch = &seen.patches[draw.patch_id as usize];
    let frame: &Frame = &seen.frame;
    let net = Net::in_eye_space(patch, object);
    match patch.faces {
        0 => dice(&net, frame, draw, grid),
        record => {
            let faces = Faces::in_eye_space(&seen.patches[record as usize], object);
            dice_gregory(&net, &faces, frame, draw, grid);
        }
    }
}
