//! Any bytes as a scene file: they are read and made ready for a device, with finite numbers only, or
//! refused with an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::{Corpus, fuzz_target};
use micropoly::DeviceScene;

/// Beside it there are no patch files.
const PLACE: &str = "no such folder/fuzz.toml";
/// Longest `count` that is tried, in characters: generators may fill gigabytes, which finds nothing.
const COUNT_LENGTH: usize = 3;

fuzz_target!(|bytes: &[u8]| -> Corpus {
    if generates_much(bytes) {
        return Corpus::Reject;
    }
    if let Ok(scene) = micropoly::scene_file::parse_bytes(Path::new(PLACE), bytes.to_vec()) {
        assert!(scene.background.is_finite());
        if let Ok(device) = scene.for_device(&Default::default()) {
            assert_eq!(device.patches.len(), scene.patch_count());
            assert!(is_finite(&device));
        }
        for frame in scene.path.iter().flat_map(|path| path.evenly(5)) {
            if let Ok(camera) = scene.camera_at(frame) {
                assert!(camera.view.is_finite() && camera.fov.is_finite());
            }
        }
    }
    Corpus::Keep
});

/// Does a number of more than [`COUNT_LENGTH`] characters follow some `count =`?
fn generates_much(bytes: &[u8]) -> bool {
    let key = b"count";
    (0..bytes.len()).filter(|&at| bytes[at..].starts_with(key)).any(|at| {
        let tail = bytes[at + key.len()..].iter();
        let value = tail.skip_while(|byte| b"\"' \t=+".contains(byte));
        value.take_while(|&&byte| byte.is_ascii_alphanumeric() || byte == b'_').count() > COUNT_LENGTH
    })
}

/// Are all numbers finite that kernels work with?
fn is_finite(scene: &DeviceScene) -> bool {
    let DeviceScene { frame, objects, patches } = scene;
    let camera = [frame.focal, frame.near];
    let lights = frame.light_vector.iter().flatten().chain(frame.light_colour.iter().flatten());
    let objects = objects.iter().flat_map(|object| object.to_eye.iter().chain(&object.colour));
    let points = patches.iter().flat_map(|patch| patch.x.iter().chain(&patch.y).chain(&patch.z));
    camera.iter().chain(&frame.ambient).chain(lights).chain(objects).chain(points).all(|x| x.is_finite())
}
