//! From what a file says to what a scene is made of: shapes, looks, lights and a camera.

mod looks;
mod scene;
mod shapes;

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use micropoly_core::camera::{Camera, Light, Material};

pub use self::looks::{lights_of, material_of};
pub use self::scene::scene;
pub use self::shapes::shape_of;
use super::model::{RibGeometry, RibObject, RibScene};
use crate::error::{Error, Result};
use crate::shape::Shape;
use crate::shot::Blur;

/// Most patches of all shapes together; objects that have the same shape count once.
const MAX_PATCHES: usize = 10_000_000;

/// What a scene is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Lowered {
    /// The shape of each object of the file; instances have the same one.
    pub shapes: Vec<Arc<Shape>>,
    /// The looks of each object.
    pub materials: Vec<Material>,
    /// The file's camera, or one that shows all of it.
    pub camera: Camera,
    /// Its lens.
    pub blur: Blur,
    /// Colour where nothing is, linear RGB.
    pub background: Vec3,
    /// Light from everywhere, linear RGB.
    pub ambient: Vec3,
    /// The lights.
    pub lights: Vec<Light>,
}

/// Makes shapes of all geometry. Cages are refined so often around what is not regular.
///
/// # Errors
/// [`Error::Format`] that names the request, or [`Error::Scene`] if a camera that shows all of it cannot be found.
pub fn lower(scene: &RibScene, levels: u32) -> Result<Lowered> {
    let mut shapes = Shapes::new(scene, levels);
    // Curves face the eye, which may depend on where everything else is.
    let is_curves = |object: &RibObject| matches!(*object.geometry, RibGeometry::Curves(_));
    for (index, object) in scene.objects.iter().enumerate().filter(|(_, object)| !is_curves(object)) {
        shapes.add(index, object, DVec3::ZERO)?;
    }
    let (middle, radius) = shapes.bounds();
    let camera = match &scene.camera {
        Some(camera) => camera.camera(),
        None => around(middle, radius)?,
    };
    let eye = camera.view.inverse().translation;
    for (index, object) in scene.objects.iter().enumerate().filter(|(_, object)| is_curves(object)) {
        shapes.add(index, object, eye)?;
    }
    let (ambient, lights) = lights_of(&scene.lights, middle, eye)?;
    Ok(Lowered {
        shapes: shapes.list,
        materials: scene.objects.iter().map(material_of).collect(),
        camera,
        blur: scene.camera.as_ref().map_or_else(Blur::default, super::RibCamera::blur),
        background: background(scene),
        ambient,
        lights,
    })
}

/// Black unless the file says otherwise; grey where it does not say how it is seen at all.
fn background(scene: &RibScene) -> Vec3 {
    let otherwise = if scene.camera.is_none() { [0.8; 3] } else { [0.0; 3] };
    DVec3::from(scene.background.unwrap_or(otherwise)).as_vec3()
}

/// A camera that sees everything within this distance from a point: from the front, the right and above; z is up.
fn around(middle: DVec3, radius: f64) -> Result<Camera> {
    let eye = middle + DVec3::new(0.5, -0.75, 0.45).normalize() * radius * 3.0;
    Camera::look_at(eye, middle, DVec3::Z, 40.0, radius * 0.01)
        .ok_or_else(|| Error::scene("the geometry lies too far out", "scale it down"))
}

/// The shapes made so far.
struct Shapes<'a> {
    scene: &'a RibScene,
    levels: u32,
    list: Vec<Arc<Shape>>,
    /// By the geometry they come from, and whether they are reversed.
    known: HashMap<(*const RibGeometry, bool), Arc<Shape>>,
    patches: usize,
}

impl<'a> Shapes<'a> {
    fn new(scene: &'a RibScene, levels: u32) -> Self {
        let list = vec![Arc::default(); scene.objects.len()];
        Self { scene, levels, list, known: HashMap::new(), patches: 0 }
    }

    fn add(&mut self, index: usize, object: &RibObject, eye: DVec3) -> Result<()> {
        let key = (Arc::as_ptr(&object.geometry), shapes::is_reversed(object));
        let is_shared = !matches!(*object.geometry, RibGeometry::Curves(_));
        if let Some(shape) = self.known.get(&key).filter(|_| is_shared) {
            self.list[index] = Arc::clone(shape);
            return Ok(());
        }
        let shape = Arc::new(shape_of(object, eye, self.levels)?);
        self.patches += shape.patch_count();
        if self.patches > MAX_PATCHES {
            let problem = format!("with this the scene has more than {MAX_PATCHES} patches");
            return Err(object.place.wrong(problem, "split the scene, or use fewer curves in objects"));
        }
        self.known.insert(key, Arc::clone(&shape));
        self.list[index] = shape;
        Ok(())
    }

    /// The middle of the box around everything, and how far its corners are from there.
    fn bounds(&self) -> (DVec3, f64) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (object, shape) in self.scene.objects.iter().zip(&self.list) {
            shapes::for_each_point(object, shape, |point| {
                let point = object.to_world.transform_point3(point);
                (low, high) = (low.min(point), high.max(point));
            });
        }
        if !(low.is_finite() && high.is_finite()) {
            return (DVec3::ZERO, 1.0);
        }
        let radius = (high - low).length() * 0.5;
        ((low + high) * 0.5, if radius > 0.0 { radius } else { 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::read;

    fn lowered(text: &str) -> Lowered {
        lower(&read(text), 3).unwrap_or_else(|error| panic!("{text}\n{error}"))
    }

    #[test]
    fn instances_have_the_same_shape_unless_one_is_turned_inside_out() {
        let made = lowered(
            "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd ObjectInstance 1 Translate 3 0 0 ObjectInstance 1\n\
             Scale -1 1 1 ObjectInstance 1 ReverseOrientation ObjectInstance 1",
        );
        let [first, second, mirrored, back] = &made.shapes[..] else { panic!("four") };
        assert!(Arc::ptr_eq(first, second) && Arc::ptr_eq(first, back));
        assert!(!Arc::ptr_eq(first, mirrored));
    }

    #[test]
    fn without_a_camera_all_is_seen() {
        let made = lowered("Translate 5 0 0 Sphere 1 -1 1 360");
        let seen = made.camera.view.transform_point3(DVec3::new(5.0, 0.0, 0.0));
        assert!(seen.x.abs() < 1e-6 && seen.y.abs() < 1e-6 && seen.z < -2.0, "{seen}");
        assert_eq!(made.lights.len(), 1);
    }

    /// Where on the screen a point of an object is: to the right and upwards, as slopes.
    fn on_screen(made: &Lowered, scene: &RibScene, index: usize) -> (f64, f64) {
        let point = Vec3::from(made.shapes[index].bezier[0].points[0]).as_dvec3();
        let seen = made.camera.view.transform_point3(scene.objects[index].to_world.transform_point3(point));
        assert!(seen.z < 0.0, "it lies behind the eye");
        (seen.x / -seen.z, seen.y / -seen.z)
    }

    #[test]
    fn what_is_at_the_right_in_the_file_is_at_the_right_in_the_image() {
        let quad = |x: f64, y: f64| {
            let corners = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]];
            let points = corners.map(|[a, b]| format!("{} {} 0", x + a, y + b)).join(" ");
            format!("Polygon \"P\" [{points}]")
        };
        let text = format!(
            "Projection \"perspective\" \"fov\" 90 Translate 0 0 4 WorldBegin {} {} WorldEnd",
            quad(1.0, 0.0),
            quad(0.0, 2.0)
        );
        let scene = read(&text);
        let made = lower(&scene, 3).expect("lowered");
        let (x, y) = on_screen(&made, &scene, 0);
        assert!((x - 0.25).abs() < 1e-6 && y.abs() < 1e-6, "at {x}, {y}");
        let (x, y) = on_screen(&made, &scene, 1);
        assert!(x.abs() < 1e-6 && (y - 0.5).abs() < 1e-6, "at {x}, {y}");
    }
}
