//! From [`Mscene`] to [`Scene`].

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use micropoly_core::abi::{MAX_LIGHTS, MIN_NEAR};
use micropoly_core::camera::{Camera, Light, Material};

use super::model::{CameraEntry, LightEntry, LightType, Mesh, MeshPatches, Mscene, ObjectEntry};
use super::place::{Place, quoted};
use crate::error::{Error, Result};
use crate::scene::{Scene, SceneObject};
use crate::shape::Shape;
use crate::shot::Blur;

/// Most patches of all objects together: a small file can use one mesh many times.
const MAX_PATCHES: usize = 10_000_000;

/// Light from everywhere, which the format does not know: as in scene files.
const AMBIENT: f32 = 0.1;

type Meshes<'a> = HashMap<&'a str, Arc<Shape>>;

pub(super) fn scene(path: &Path, file: &Mscene) -> Result<Scene> {
    let camera = camera(path, file)?;
    let (ambient, lights) = lights(path, &file.lights)?;
    Ok(Scene {
        name: path.display().to_string(),
        camera,
        path: None,
        blur: Blur::default(),
        background: Vec3::ZERO,
        ambient,
        lights,
        objects: objects(path, file)?,
        notes: Vec::new(),
    })
}

fn camera(path: &Path, file: &Mscene) -> Result<Camera> {
    let Some(CameraEntry { name, placement, near, fovy }) = file.cameras.first() else {
        return Err(Error::content(path, "the scene has no camera", "export it with one"));
    };
    let place = Place { path, kind: "camera", index: 0, count: file.cameras.len(), name };
    let number = |what: &str, number: f64, least: f64, most: f64| {
        if number >= least && number <= most {
            return Ok(number);
        }
        Err(place
            .wrong(format!("its {what} is {number}"), format!("choose a {what} from {least:?} to {most:?}")))
    };
    let fov = number("fovy", *fovy, 0.001, 179.0)?;
    let near = number("near", *near, f64::from(MIN_NEAR), 1.0e12)?;
    Ok(Camera { view: placement.from_world(), fov, near })
}

/// The light from everywhere, and the others.
fn lights(path: &Path, entries: &[LightEntry]) -> Result<(Vec3, Vec<Light>)> {
    if entries.len() > MAX_LIGHTS {
        let problem = format!("the scene has {} lights", entries.len());
        return Err(Error::content(path, problem, format!("keep {MAX_LIGHTS} or fewer")));
    }
    let hemi = entries.iter().filter(|light| light.kind == LightType::Hemi);
    let ambient = hemi.fold(Vec3::splat(AMBIENT), |sum, light| sum + light.colour * 0.5);
    Ok((ambient, entries.iter().map(light).collect()))
}

/// A sky lights what faces it fully and what is turned away not at all, (1 + cosine) / 2: one half comes from
/// everywhere, the other along its axis. This is exact on the side that faces it; the other gets the first half.
fn light(entry: &LightEntry) -> Light {
    let LightEntry { placement, colour, kind, .. } = entry;
    let to_light: DVec3 = -placement.forward();
    match kind {
        LightType::Point => Light::Point { position: placement.translation, colour: *colour },
        LightType::Directional => Light::Directional { to_light, colour: *colour },
        LightType::Hemi => Light::Directional { to_light, colour: *colour * 0.5 },
    }
}

fn objects(path: &Path, file: &Mscene) -> Result<Vec<SceneObject>> {
    if file.objects.is_empty() {
        return Err(Error::content(
            path,
            "the scene has no objects",
            "export it with an object for each mesh",
        ));
    }
    let meshes = meshes(path, &file.meshes)?;
    let count = file.objects.len();
    let mut objects = Vec::new();
    let mut total = 0;
    for (index, entry) in file.objects.iter().enumerate() {
        let place = Place { path, kind: "object", index, count, name: &entry.name };
        let shape = shape_of(&place, &meshes, entry)?;
        total += shape.patch_count();
        if total > MAX_PATCHES {
            let problem = format!("with it the scene has more than {MAX_PATCHES} patches");
            return Err(place.wrong(problem, "split the scene"));
        }
        let material = Material { colour: entry.colour, specular: 0.0, gloss: 0, opacity: 1.0 };
        let to_world = entry.placement.to_world();
        objects.push(SceneObject { to_world, ..SceneObject::new(shape, material) });
    }
    Ok(objects)
}

/// Shapes by name: objects may have the same one.
fn meshes<'a>(path: &'a Path, list: &'a [Mesh]) -> Result<Meshes<'a>> {
    let mut meshes = Meshes::new();
    for (index, mesh) in list.iter().enumerate() {
        let place = Place { path, kind: "mesh", index, count: list.len(), name: &mesh.name };
        if mesh.name.is_empty() {
            return Err(place.wrong("it has no name", "give each mesh a name, by which objects find it"));
        }
        let shape = match &mesh.patches {
            MeshPatches::Bezier(patches) => Shape::of_bezier(patches.clone()),
            MeshPatches::Gregory(patches) => Shape::of_gregory(patches.clone()),
        };
        if meshes.insert(&mesh.name, Arc::new(shape)).is_some() {
            return Err(place.wrong("an earlier mesh has the same name", "give each mesh a name of its own"));
        }
    }
    Ok(meshes)
}

fn shape_of(place: &Place<'_>, meshes: &Meshes<'_>, object: &ObjectEntry) -> Result<Arc<Shape>> {
    meshes.get(object.mesh.as_str()).cloned().ok_or_else(|| {
        let problem = format!("there is no mesh {}", quoted(&object.mesh));
        place.wrong(problem, "name a mesh of the same file")
    })
}
