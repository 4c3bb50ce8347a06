//! Any bytes as a scene file: they are read and made ready for a device, or refused with an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;

/// Beside it there are no patch files.
const PLACE: &str = "no such folder/fuzz.toml";

fuzz_target!(|bytes: &[u8]| {
    if let Ok(scene) = micropoly::scene_file::parse_bytes(Path::new(PLACE), bytes.to_vec())
        && let Ok(device) = scene.for_device(&Default::default())
    {
        assert_eq!(device.patches.len(), scene.patch_count());
    }
});
