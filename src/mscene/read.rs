//! From the message to [`Mscene`]. Every pointer is followed once, so that a message whose pointers meet in one
//! big list runs into the limit on what may be read.

use std::path::Path;

use capnp::message::ReaderOptions;
use capnp::{serialize, struct_list, text};
use glam::{DQuat, Vec3};

use super::model::{CameraEntry, LightEntry, LightType, Mesh, MeshPatches, Mscene, ObjectEntry, Placement};
use super::mscene_capnp::{camera, light_source, mesh, object, quaternion, scene, transform, vec3};
use super::place::Place;
use crate::error::{Error, Result};
use crate::gregory::GregoryPatch;
use crate::shape::BezierPatch;

const DAMAGED: &str = "copy or export the file again: it is damaged or cut short, or not a .mscene file";

/// Largest coordinate of a place, as in scene files.
const MAX_TRANSLATION: f64 = 1.0e12;

/// Brightest colour and intensity, as in scene files.
const MAX_COLOUR: f32 = 1.0e6;

/// Rotations shorter than this have no direction.
const MIN_ROTATION: f64 = 1.0e-6;

pub(super) fn contents(path: &Path, words: &[u64]) -> Result<Mscene> {
    let damaged =
        |error: capnp::Error| Error::content(path, format!("the message is damaged: {error}"), DAMAGED);
    let mut bytes: &[u8] = bytemuck::cast_slice(words);
    if bytes.is_empty() {
        return Err(Error::content(path, "the file is empty", DAMAGED));
    }
    let message = serialize::read_message_from_flat_slice(&mut bytes, limits(words)).map_err(damaged)?;
    if !bytes.is_empty() {
        let problem = format!("{} bytes follow the message, unpacked", bytes.len());
        return Err(Error::content(path, problem, "a .mscene file is a single message"));
    }
    let scene: scene::Reader<'_> = message.get_root().map_err(damaged)?;
    Ok(Mscene {
        meshes: each(path, "mesh", scene.get_meshes(), read_mesh)?,
        lights: each(path, "light", scene.get_lights(), read_light)?,
        objects: each(path, "object", scene.get_objects(), read_object)?,
        cameras: each(path, "camera", scene.get_cameras(), read_camera)?,
    })
}

/// Enough to read each word twice: more is only needed where pointers share what they point to.
fn limits(words: &[u64]) -> ReaderOptions {
    let mut options = ReaderOptions::new();
    options.traversal_limit_in_words(Some(2 * words.len() + 64)).nesting_limit(8);
    options
}

type List<'a, T> = capnp::Result<struct_list::Reader<'a, T>>;

/// Reads the elements of a list.
fn each<'a, T, R>(
    path: &Path,
    kind: &'static str,
    list: List<'a, T>,
    read: impl Fn(&Place<'_>, T::Reader<'a>) -> Result<R>,
) -> Result<Vec<R>>
where
    T: capnp::traits::OwnedStruct,
{
    let list = list.map_err(|error| {
        let problem = format!("the list of {} is damaged: {error}", plural(kind));
        Error::content(path, problem, DAMAGED)
    })?;
    let count = list.len() as usize;
    let place = |index| Place { path, kind, index, count, name: "" };
    list.iter().enumerate().map(|(index, element)| read(&place(index), element)).collect()
}

fn plural(kind: &str) -> String {
    if kind == "mesh" { "meshes".to_owned() } else { format!("{kind}s") }
}

impl Place<'_> {
    fn damaged(&self, what: &str, error: impl std::fmt::Display) -> Error {
        self.wrong(format_args!("its {what} is damaged: {error}"), DAMAGED)
    }

    fn text(&self, what: &str, text: capnp::Result<text::Reader<'_>>) -> Result<String> {
        let text = text.map_err(|error| self.damaged(what, error))?;
        text.to_string().map_err(|error| self.damaged(what, error))
    }

    fn vector(&self, what: &str, vector: capnp::Result<vec3::Reader<'_>>) -> Result<Vec3> {
        let vector = vector.map_err(|error| self.damaged(what, error))?;
        Ok(Vec3::new(vector.get_x(), vector.get_y(), vector.get_z()))
    }

    fn placement(&self, transform: capnp::Result<transform::Reader<'_>>) -> Result<Placement> {
        let transform = transform.map_err(|error| self.damaged("transform", error))?;
        let translation = self.vector("translation", transform.get_translation())?.as_dvec3();
        if !(translation.is_finite() && translation.abs().max_element() <= MAX_TRANSLATION) {
            return Err(self.wrong("its translation is not finite or beyond 1e12", "use smaller numbers"));
        }
        Ok(Placement { translation, rotation: self.rotation(transform.get_rotation())? })
    }

    /// Exporters round, so that lengths are not quite 1; any that has a direction is taken as if it were.
    fn rotation(&self, rotation: capnp::Result<quaternion::Reader<'_>>) -> Result<DQuat> {
        let q = rotation.map_err(|error| self.damaged("rotation", error))?;
        let [i, j, k, r] = [q.get_i(), q.get_j(), q.get_k(), q.get_r()].map(f64::from);
        let rotation = DQuat::from_xyzw(i, j, k, r);
        let length = rotation.length();
        if length.is_finite() && length >= MIN_ROTATION {
            return Ok(rotation * (1.0 / length));
        }
        let problem = format!("its rotation is r = {r}, i = {i}, j = {j}, k = {k}, which is none");
        Err(self.wrong(problem, "use a quaternion of length 1; r = 1, i = j = k = 0 does not turn"))
    }

    fn colour(&self, colour: capnp::Result<vec3::Reader<'_>>) -> Result<Vec3> {
        let colour = self.vector("colour", colour)?;
        if colour.is_finite() && colour.min_element() >= 0.0 && colour.max_element() <= MAX_COLOUR {
            return Ok(colour);
        }
        let problem = format!("its colour is {} {} {}", colour.x, colour.y, colour.z);
        Err(self.wrong(problem, "use linear values from 0 to 1e6"))
    }
}

fn read_mesh(place: &Place<'_>, mesh: mesh::Reader<'_>) -> Result<Mesh> {
    let name = place.text("name", mesh.get_name())?;
    let place = place.named(&name);
    let positions = mesh.get_positions().map_err(|error| place.damaged("list of positions", error))?;
    let kind = mesh.get_type().map_err(|_| {
        place.wrong("its type is neither bezier (0) nor gregory (1)", "export it as Bézier patches")
    })?;
    let positions: Vec<f32> = positions.iter().collect();
    let patches = match kind {
        mesh::Type::Bezier => {
            MeshPatches::Bezier(patches(&place, &positions, |points| BezierPatch { points })?)
        }
        mesh::Type::Gregory => {
            MeshPatches::Gregory(patches(&place, &positions, |points| GregoryPatch { points })?)
        }
    };
    Ok(Mesh { name, patches })
}

/// Cuts positions into patches of `POINTS` points.
fn patches<const POINTS: usize, P>(
    place: &Place<'_>,
    positions: &[f32],
    patch: impl Fn([[f32; 3]; POINTS]) -> P,
) -> Result<Vec<P>> {
    let (patches, rest) = positions.as_chunks::<3>().0.as_chunks::<POINTS>();
    if patches.is_empty() || !rest.is_empty() || !positions.len().is_multiple_of(3) {
        let floats = 3 * POINTS;
        let problem = format!("its list of positions has {} numbers", positions.len());
        return Err(
            place.wrong(problem, format!("a patch is {floats} numbers, and a mesh one patch or more"))
        );
    }
    if let Some(at) = positions.iter().position(|value| !value.is_finite()) {
        let (index, count) = (at / (3 * POINTS) + 1, patches.len());
        let problem = format!("a coordinate of patch {index} of {count} is not finite");
        return Err(place.wrong(problem, "replace NaN and infinities"));
    }
    Ok(patches.iter().map(|&points| patch(points)).collect())
}

fn read_light(place: &Place<'_>, light: light_source::Reader<'_>) -> Result<LightEntry> {
    let name = place.text("name", light.get_name())?;
    let place = place.named(&name);
    let kind = match light.get_type() {
        Ok(light_source::Type::Point) => LightType::Point,
        Ok(light_source::Type::Directional) => LightType::Directional,
        Ok(light_source::Type::Hemi) => LightType::Hemi,
        Err(_) => {
            let problem = "its type is neither point (0) nor directional (1) nor hemi (2)";
            return Err(place.wrong(problem, "use one of these types"));
        }
    };
    let intensity = light.get_intensity();
    if !(0.0..=MAX_COLOUR).contains(&intensity) {
        return Err(place.wrong(format!("its intensity is {intensity}"), "choose one from 0 to 1e6"));
    }
    let colour = place.colour(light.get_color())? * intensity;
    let placement = place.placement(light.get_transform())?;
    Ok(LightEntry { placement, colour, kind, name })
}

fn read_object(place: &Place<'_>, object: object::Reader<'_>) -> Result<ObjectEntry> {
    let name = place.text("name", object.get_name())?;
    let place = place.named(&name);
    let mesh = place.text("mesh's name", object.get_meshname())?;
    let placement = place.placement(object.get_transform())?;
    let colour = place.colour(object.get_color())?;
    Ok(ObjectEntry { placement, mesh, colour, name })
}

fn read_camera(place: &Place<'_>, camera: camera::Reader<'_>) -> Result<CameraEntry> {
    let name = place.text("name", camera.get_name())?;
    let place = place.named(&name);
    let placement = place.placement(camera.get_transform())?;
    let (near, fovy) = (f64::from(camera.get_near()), f64::from(camera.get_fovy()));
    Ok(CameraEntry { placement, near, fovy, name })
}
