//! Materials and lights as ours can be.

use glam::{DVec3, Vec3};
use micropoly_core::abi::MAX_LIGHTS;
use micropoly_core::camera::{Light, Material};

use crate::error::Result;
use crate::rib::model::{RibLight, RibLightKind, RibObject};

/// Widest and narrowest highlight: exponents 1 and 1024, as in scene files.
const MAX_GLOSS: f64 = 10.0;

/// The looks of an object. RenderMan's highlight is a cosine to the power of 1 / roughness; ours to the nearest power of
/// two.
#[must_use]
pub fn material_of(object: &RibObject) -> Material {
    let surface = &object.surface;
    let colour = (DVec3::from(object.colour) * surface.diffuse).as_vec3();
    let gloss = libm::round(-libm::log2(surface.roughness.max(1.0e-6))).clamp(0.0, MAX_GLOSS) as u32;
    Material { colour, specular: surface.specular as f32, gloss, opacity: object.opacity as f32 }
}

/// The light from everywhere, and the others. A point light is everywhere as bright as it is in the middle of the scene.
/// A file without any lights gets one at the eye, as RenderMan's default surface does.
///
/// # Errors
/// [`Error::Format`](crate::Error::Format) if there are too many.
pub fn lights_of(lights: &[RibLight], middle: DVec3, eye: DVec3) -> Result<(Vec3, Vec<Light>)> {
    if lights.is_empty() {
        let to_light = (eye - middle).try_normalize().unwrap_or(DVec3::Z);
        return Ok((Vec3::splat(0.15), vec![Light::Directional { to_light, colour: Vec3::splat(0.9) }]));
    }
    let mut ambient = DVec3::ZERO;
    let mut list = Vec::new();
    for light in lights {
        let colour = DVec3::from(light.colour);
        match light.kind {
            RibLightKind::Ambient => ambient += colour,
            RibLightKind::Distant { to_light } => {
                list.push(Light::Directional { to_light: to_light.into(), colour: colour.as_vec3() });
            }
            RibLightKind::Point { position } => list.push(point(position.into(), colour, middle)),
        }
        if list.len() > MAX_LIGHTS {
            let problem = format!("with this there are more than {MAX_LIGHTS} lights besides ambient ones");
            return Err(light.place.wrong(problem, "remove some"));
        }
    }
    Ok((ambient.as_vec3(), list))
}

fn point(position: DVec3, colour: DVec3, middle: DVec3) -> Light {
    let distance = (position - middle).length().max(1.0e-3);
    let colour = (colour / (distance * distance)).min(DVec3::splat(1.0e6)).as_vec3();
    Light::Point { position, colour }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::read;

    #[test]
    fn roughness_becomes_the_nearest_gloss() {
        let material =
            |requests: &str| material_of(&read(&format!("{requests} Sphere 1 -1 1 360")).objects[0]);
        let gloss =
            |roughness: &str| material(&format!("Surface \"plastic\" \"roughness\" {roughness}")).gloss;
        assert_eq!([gloss("0.1"), gloss("0.02"), gloss("1"), gloss("0"), gloss("5")], [3, 6, 0, 10, 0]);
        let plastic = material("Color 1 0.5 0 Opacity 0.5 0.5 0.5 Surface \"plastic\"");
        let expected = Material { colour: Vec3::new(0.5, 0.25, 0.0), specular: 0.5, gloss: 3, opacity: 0.5 };
        assert_eq!(plastic, expected);
    }

    #[test]
    fn point_lights_are_as_bright_as_in_the_middle_of_the_scene() {
        let scene = read(
            "LightSource \"ambientlight\" 1 \"intensity\" 0.25 LightSource \"ambientlight\" 2 \"intensity\" 0.5\n\
             LightSource \"pointlight\" 3 \"from\" [0 4 0] \"intensity\" 8 Sphere 1 -1 1 360",
        );
        let (ambient, lights) =
            lights_of(&scene.lights, DVec3::new(0.0, 2.0, 0.0), DVec3::Z).expect("few lights");
        assert_eq!(ambient, Vec3::splat(0.75));
        let position = DVec3::new(0.0, 4.0, 0.0);
        assert_eq!(lights, [Light::Point { position, colour: Vec3::splat(2.0) }]);
    }

    #[test]
    fn too_many_lights_are_refused() {
        let lights: String = (0..9).map(|_| "\nLightSource \"distantlight\" 1").collect();
        let scene = read(&format!("{lights} Sphere 1 -1 1 360"));
        let error = lights_of(&scene.lights, DVec3::ZERO, DVec3::Z).expect_err("refused").to_string();
        assert!(error.starts_with("x.rib:10: with this there are more than 8"), "{error}");
    }
}
