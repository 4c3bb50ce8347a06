//! Any bytes as a packed scene: they are read and made ready for a device, with finite numbers only, or refused
//! with an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use micropoly::mscene::{MeshPatches, Mscene, parse_bytes, read_contents};

fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz.mscene");
    if let Ok(contents) = read_contents(path, bytes) {
        assert!(is_finite(&contents));
    }
    if let Ok(scene) = parse_bytes(path, bytes)
        && let Ok(device) = scene.for_device(&Default::default())
    {
        assert_eq!(device.patches.len(), scene.patch_count());
        assert!(device.objects.iter().flat_map(|object| object.to_eye).all(f32::is_finite));
    }
});

/// Are all numbers finite, and has each mesh a patch?
fn is_finite(contents: &Mscene) -> bool {
    let Mscene { meshes, lights, objects, cameras } = contents;
    let points = |patches: &MeshPatches| match patches {
        MeshPatches::Bezier(patches) => patches.iter().flat_map(|patch| patch.points).collect::<Vec<_>>(),
        MeshPatches::Gregory(patches) => patches.iter().flat_map(|patch| patch.points).collect(),
    };
    let mut meshes = meshes.iter().map(|mesh| points(&mesh.patches));
    let mut placements = (lights.iter().map(|light| light.placement))
        .chain(objects.iter().map(|object| object.placement))
        .chain(cameras.iter().map(|camera| camera.placement));
    let mut colours = lights.iter().map(|light| light.colour).chain(objects.iter().map(|object| object.colour));
    meshes.all(|points| !points.is_empty() && points.iter().flatten().all(|value| value.is_finite()))
        && placements.all(|placement| placement.to_world().is_finite() && placement.from_world().is_finite())
        && colours.all(|colour| colour.is_finite())
}
