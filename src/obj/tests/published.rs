//! Files of others, which are not part of the repository; where they are missing these tests say so and pass.

use std::path::{Path, PathBuf};

use super::super::load;
use crate::cage::Cage;

fn original(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped {test}: no {}", path.display());
    None
}

fn cage(test: &str, name: &str) -> Option<Cage> {
    original(test, name).map(|path| load(&path).expect("readable").cage.expect("faces"))
}

#[test]
fn spot_has_triangles_quads_and_pentagons() {
    let Some(spot) = cage("spot_has_triangles_quads_and_pentagons", "models/spot_control_mesh.obj") else {
        return;
    };
    assert_eq!((spot.positions.len(), spot.face_sizes.len()), (188, 180));
    assert!([3, 4, 5].iter().all(|size| spot.face_sizes.contains(size)));
    assert_eq!(spot.texture_corners.len(), spot.corners.len());
}

#[test]
fn the_bunny_is_all_triangles() {
    let Some(bunny) = cage("the_bunny_is_all_triangles", "models/stanford-bunny.obj") else { return };
    assert_eq!((bunny.positions.len(), bunny.face_sizes.len()), (35_947, 69_451));
    assert!(bunny.face_sizes.iter().all(|&size| size == 3));
}

#[test]
fn the_creased_cube_keeps_its_tags() {
    let Some(cube) = cage("the_creased_cube_keeps_its_tags", "catmull-clark/cube_crease_semi.obj") else {
        return;
    };
    assert_eq!((cube.creases.len(), cube.sharp_vertices), (5, vec![(0, 3.0)]));
    assert_eq!(cube.creases[4].vertices, [0, 4]);
}
