//! A file as a scene.

use super::lower;
use crate::error::Result;
use crate::rib::RibScene;
use crate::scene::{Scene, SceneObject};

/// The scene that a file describes; its name is for messages. Cages are refined so often around what is not regular.
///
/// # Errors
/// As [`lower`].
pub fn scene(name: String, file: &RibScene, levels: u32) -> Result<Scene> {
    let made = lower(file, levels)?;
    let looks = made.shapes.into_iter().zip(made.materials);
    let objects = file.objects.iter().zip(looks).map(|(object, (shape, material))| SceneObject {
        to_world: object.to_world,
        ..SceneObject::new(shape, material)
    });
    Ok(Scene {
        name,
        camera: made.camera,
        path: None,
        blur: made.blur,
        background: made.background,
        ambient: made.ambient,
        lights: made.lights,
        objects: objects.collect(),
        notes: file.warnings.clone(),
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::rib::load;

    #[test]
    fn the_sample_has_all_kinds_of_geometry_and_nothing_to_warn_about() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shapes.rib");
        let file = load(&path).expect("readable");
        assert_eq!(file.warnings, [""; 0]);
        let scene = scene("shapes".to_owned(), &file, 3).expect("a scene");
        assert_eq!((scene.objects.len(), scene.lights.len()), (file.objects.len(), 2));
        let kinds = |count: &dyn Fn(&crate::Shape) -> usize| {
            scene.objects.iter().any(|object| count(&object.shape) > 0)
        };
        assert!(kinds(&|shape| shape.bezier.len()) && kinds(&|shape| shape.rational.len()));
        assert!(kinds(&|shape| shape.gregory.len()));
        assert!(scene.for_device(&crate::FrameOptions::default()).is_ok());
    }
}
