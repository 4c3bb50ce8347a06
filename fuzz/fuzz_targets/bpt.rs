//! Any bytes as a patch file: they are read, or refused with an error; every point that is read is finite.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(patches) = micropoly::bpt::parse_bytes(Path::new("fuzz.bpt"), bytes.to_vec()) {
        assert!(!patches.is_empty());
        assert!(patches.iter().flat_map(|patch| patch.points).flatten().all(f32::is_finite));
    }
});
