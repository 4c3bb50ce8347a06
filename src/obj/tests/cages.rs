//! The cages that come with the repository.

use std::collections::HashSet;
use std::path::Path;

use super::super::load;
use crate::cage::{Boundary, Cage};

fn cage(name: &str) -> Cage {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cages").join(name);
    let obj = load(&path).expect("readable");
    assert!(obj.warnings.is_empty() && obj.surfaces.is_empty(), "{:?}", obj.warnings);
    obj.cage.expect("faces")
}

fn faces(cage: &Cage) -> impl Iterator<Item = &[u32]> {
    let mut rest = cage.corners.as_slice();
    cage.face_sizes
        .iter()
        .map(move |&size| rest.split_off(..size as usize).expect("as many corners as they say"))
}

/// Edges that no face runs along in the other direction.
fn open_edges(cage: &Cage) -> usize {
    let mut runs = HashSet::new();
    for face in faces(cage) {
        for (at, &from) in face.iter().enumerate() {
            let to = face[(at + 1) % face.len()];
            assert!(runs.insert((from, to)), "two faces run from {from} to {to}");
        }
    }
    runs.iter().filter(|&&(from, to)| !runs.contains(&(to, from))).count()
}

/// Six times the volume within (Gauss): above 0 where faces run counter-clockwise, seen from outside.
fn volume(cage: &Cage) -> f64 {
    let at = |vertex: u32| glam::DVec3::from(cage.positions[vertex as usize]);
    let fan = |face: &[u32]| -> f64 {
        face[1..].windows(2).map(|pair| at(face[0]).dot(at(pair[0]).cross(at(pair[1])))).sum()
    };
    faces(cage).map(fan).sum()
}

#[test]
fn solids_are_closed_and_face_outwards() {
    for (name, sizes, least) in [
        ("cube.obj", vec![4; 6], 47.9),
        ("creased_cube.obj", vec![4; 6], 47.9),
        ("tetrahedra.obj", vec![3; 12], 1.0),
        ("solids.obj", [vec![5; 12], vec![6; 2], vec![4; 6]].concat(), 40.0),
    ] {
        let cage = cage(name);
        assert_eq!(cage.face_sizes, sizes, "{name}");
        assert_eq!(open_edges(&cage), 0, "{name}");
        assert!(volume(&cage) > least, "{name}: {}", volume(&cage));
    }
}

#[test]
fn the_creased_cube_has_a_sharp_ring_and_a_rounded_one() {
    let sharpness: Vec<f32> =
        cage("creased_cube.obj").creases.iter().map(|crease| crease.sharpness).collect();
    assert_eq!(sharpness, [10.0, 10.0, 10.0, 10.0, 2.5, 2.5, 2.5, 2.5]);
}

#[test]
fn the_open_grid_has_one_border() {
    let grid = cage("open_grid.obj");
    assert_eq!((grid.positions.len(), open_edges(&grid)), (25, 16));
    assert_eq!(grid.boundary, Boundary::EdgeAndCorner);
}
