//! What the tests of cages share: cages, how they are read, and the limit surface found the slow way.

#![allow(dead_code)] // each test uses its part of it

pub(crate) mod list;
pub(crate) mod oracle;

use std::path::{Path, PathBuf};

use glam::DVec3;
use micropoly::cage::{Boundary, Cage, Crease, Evaluator, Patches};

/// A file of the shared data; where it is missing a test says that it is skipped, and passes.
pub(crate) fn shared(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped {test}: no {}", path.display());
    None
}

/// Reads vertices, faces and tags of an OBJ file, without any check.
pub(crate) fn read_obj(path: &Path) -> Cage {
    obj(&std::fs::read_to_string(path).expect("a text"))
}

/// The same, from a text.
pub(crate) fn obj(text: &str) -> Cage {
    let mut cage = Cage::default();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |k: usize| words[k].parse::<f64>().expect("a number");
        match words.first() {
            Some(&"v") => cage.positions.push([1, 2, 3].map(number)),
            Some(&"f") => {
                cage.face_sizes.push(words.len() as u32 - 1);
                let first = |word: &&str| word.split('/').next().and_then(|n| n.parse::<u32>().ok());
                cage.corners.extend(words[1..].iter().map(|word| first(word).expect("an index") - 1));
            }
            Some(&"t") if words[1] == "crease" => {
                let vertices = [number(3) as u32, number(4) as u32];
                cage.creases.push(Crease { vertices, sharpness: number(5) as f32 });
            }
            Some(&"t") if words[1] == "corner" => {
                cage.sharp_vertices.push((number(3) as u32, number(4) as f32));
            }
            _ => {}
        }
    }
    cage
}

/// A cage of these vertices and faces.
pub(crate) fn cage_of(positions: Vec<[f64; 3]>, faces: &[&[u32]]) -> Cage {
    let face_sizes = faces.iter().map(|face| face.len() as u32).collect();
    Cage { positions, face_sizes, corners: faces.concat(), ..Cage::default() }
}

/// Rows of quads with heights that are not smooth at all.
pub(crate) fn bumpy_grid(columns: u32, rows: u32) -> Cage {
    let mut random = fastrand::Rng::with_seed(7);
    let place = |k: u32| [f64::from(k % (columns + 1)), f64::from(k / (columns + 1))];
    let positions =
        (0..(columns + 1) * (rows + 1)).map(|k| [place(k)[0], place(k)[1], random.f64()]).collect();
    let mut faces = Vec::new();
    for face in 0..columns * rows {
        let a = face / columns * (columns + 1) + face % columns;
        faces.push([a, a + 1, a + columns + 2, a + columns + 1]);
    }
    cage_of(positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>())
}

pub(crate) fn crease(a: u32, b: u32, sharpness: f32) -> Crease {
    Crease { vertices: [a, b], sharpness }
}

pub(crate) fn cube() -> Cage {
    let positions = (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(2 * (k >> axis & 1) - 1))).collect();
    cage_of(
        positions,
        &[&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]],
    )
}

pub(crate) fn tetrahedron() -> Cage {
    let positions = vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    cage_of(positions, &[&[0, 1, 2], &[0, 3, 1], &[0, 2, 3], &[1, 3, 2]])
}

/// Two poles with this many triangles each, and a belt of quads between.
pub(crate) fn drum(count: u32) -> Cage {
    let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(count);
    let ring = |z: f64| (0..count).map(move |k| [libm::cos(angle(k)), libm::sin(angle(k)), z]);
    let mut positions: Vec<[f64; 3]> = ring(-0.5).chain(ring(0.5)).collect();
    positions.extend([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]);
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for k in 0..count {
        let next = (k + 1) % count;
        faces.push(vec![k, next, count + next, count + k]);
        faces.push(vec![next, k, 2 * count]);
        faces.push(vec![count + k, count + next, 2 * count + 1]);
    }
    cage_of(positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>())
}

/// A disc of this many quads around a vertex, bent, as a part of nothing: its boundary is that of the surface.
pub(crate) fn star(count: u32) -> Cage {
    let angle = |k: u32| std::f64::consts::PI * f64::from(k) / f64::from(count);
    let at = |k: u32, r: f64| {
        [r * libm::cos(angle(k)), r * libm::sin(angle(k)), 0.3 * r * libm::cos(3.0 * angle(k))]
    };
    let mut positions = vec![[0.0, 0.0, 0.4]];
    positions.extend((0..2 * count).map(|k| at(k, if k % 2 == 0 { 1.0 } else { 1.5 })));
    let faces: Vec<[u32; 4]> =
        (0..count).map(|k| [0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % (2 * count)]).collect();
    cage_of(positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>())
}

/// The diagonal of the box around a cage.
pub(crate) fn bbox_diagonal(cage: &Cage) -> f64 {
    let points = || cage.positions.iter().map(|&point| DVec3::from(point));
    let low = points().fold(DVec3::INFINITY, DVec3::min);
    points().fold(DVec3::NEG_INFINITY, DVec3::max).distance(low)
}

/// How far a surface is from where it should be, at some places.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Errors {
    /// Along the normal, over the diagonal of the cage's box.
    pub(crate) offset: f64,
    /// Where it is not smooth: at the same parameter, over the diagonal.
    pub(crate) distance: f64,
    /// Between normals, degrees.
    pub(crate) angle: f64,
    /// Along the normal, in Bézier patches alone.
    pub(crate) regular: f64,
    pub(crate) places: usize,
}

/// A place, and what is there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) face: u32,
    pub(crate) sub: i32,
    pub(crate) place: [f64; 2],
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) is_smooth: bool,
}

pub(crate) fn compare(patches: &Patches, samples: &[Sample], diagonal: f64) -> Errors {
    let evaluator = Evaluator::new(patches);
    let bezier_only = Patches { gregory: vec![], gregory_origins: vec![], ..patches.clone() };
    let bezier_only = Evaluator::new(&bezier_only);
    let mut errors = Errors { places: samples.len(), ..Errors::default() };
    for sample in samples {
        let [u, v] = sample.place;
        let Some(found) = evaluator.at(sample.face, sample.sub, u, v) else {
            panic!("nothing at {sample:?}");
        };
        let off = (found.position - sample.position) / diagonal;
        let offset =
            if sample.is_smooth || sample.normal != DVec3::ZERO { off.dot(sample.normal).abs() } else { 0.0 };
        errors.offset = errors.offset.max(offset);
        if bezier_only.at(sample.face, sample.sub, u, v).is_some() {
            errors.regular = errors.regular.max(if sample.is_smooth { offset } else { off.length() });
        }
        if sample.is_smooth {
            let (a, b) = (found.normal, sample.normal);
            errors.angle = errors.angle.max(a.cross(b).length().atan2(a.dot(b)).to_degrees());
        } else {
            errors.distance = errors.distance.max(off.length());
        }
    }
    errors
}

pub(crate) fn boundary(name: &str) -> Boundary {
    match name {
        "none" => Boundary::None,
        "edge_only" => Boundary::EdgeOnly,
        _ => Boundary::EdgeAndCorner,
    }
}
