//! Any bytes as a RenderMan file: they are read and made ready for a device, with finite
//! numbers only, or refused with an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use micropoly::rib::{RibGeometry, parse_bytes};

/// Beside it there are no archives.
const PLACE: &str = "no such folder/fuzz.rib";

fuzz_target!(|bytes: &[u8]| {
    if let Ok(scene) = parse_bytes(Path::new(PLACE), bytes) {
        assert!(!scene.objects.is_empty());
        for object in &scene.objects {
            assert!(object.to_world.is_finite());
            assert!(object.opacity > 0.0 && object.opacity <= 1.0);
            assert!(is_finite(&object.geometry));
        }
        if let Ok(scene) = micropoly::rib::lower::scene(PLACE.to_owned(), &scene, 1)
            && let Ok(device) = scene.for_device(&Default::default())
        {
            assert!(device.objects.iter().flat_map(|object| object.to_eye).all(f32::is_finite));
        }
        if let Some(camera) = scene.camera.map(|camera| camera.camera()) {
            assert!(camera.view.is_finite() && camera.fov.is_finite());
        }
    }
});

/// Are all points finite, and is there one at least?
fn is_finite(geometry: &RibGeometry) -> bool {
    let sound = |point: &[f64]| point.iter().all(|number| number.is_finite());
    match geometry {
        RibGeometry::Patches(patches) => patches.points.iter().all(|point| sound(point)),
        RibGeometry::NuPatch(patch) => patch.points.iter().all(|point| sound(point)),
        RibGeometry::Subdivision(cage) | RibGeometry::Polygons(cage) => {
            cage.positions.iter().all(|point| sound(point))
                && cage.corners.iter().all(|&corner| (corner as usize) < cage.positions.len())
        }
        RibGeometry::Quadric(_) => true,
        RibGeometry::Curves(curves) => curves
            .curves
            .iter()
            .all(|curve| curve.points.iter().all(|point| sound(point)) && sound(&curve.widths)),
    }
}
