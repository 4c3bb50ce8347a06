//! Any bytes as an OBJ file: they are read, or refused with an error; what is read is whole, and its numbers are
//! finite.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use micropoly::cage::Cage;
use micropoly::obj::{FreeForm, parse_bytes};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(obj) = parse_bytes(Path::new("fuzz.obj"), bytes) {
        assert!(obj.cage.is_some() || !obj.surfaces.is_empty());
        assert!(obj.cage.iter().all(is_whole));
        assert!(obj.surfaces.iter().all(is_surface));
    }
});

/// Do all indices name something, and are all numbers finite?
fn is_whole(cage: &Cage) -> bool {
    let corners: u64 = cage.face_sizes.iter().map(|&size| u64::from(size)).sum();
    let names = |indices: &[u32], count: usize| indices.iter().all(|&index| (index as usize) < count);
    let creased = cage.creases.iter().flat_map(|crease| crease.vertices).collect::<Vec<_>>();
    cage.face_sizes.iter().all(|&size| size >= 3)
        && corners == cage.corners.len() as u64
        && cage.face_lines.len() == cage.face_sizes.len()
        && names(&cage.corners, cage.positions.len())
        && names(&creased, cage.positions.len())
        && names(&cage.holes, cage.face_sizes.len())
        && names(&cage.texture_corners, cage.texture.len())
        && (cage.texture_corners.is_empty() || cage.texture_corners.len() == cage.corners.len())
        && cage.positions.iter().flatten().all(|value| value.is_finite())
}

/// Has it as many points as it says, all finite and with weights above 0?
fn is_surface(surface: &FreeForm) -> bool {
    let [u, v] = surface.counts();
    u * v == surface.points.len()
        && surface.points.iter().all(|point| point.iter().all(|value| value.is_finite()) && point[3] > 0.0)
        && surface.knots.iter().flatten().all(|value| value.is_finite())
}
