//! The first level: the cage as it is given, checked.

use glam::DVec3;
use rayon::prelude::*;

use super::error::CageError;
use super::level::{Level, NONE};
use super::origin::Origin;
use super::topology::connect;
use super::{Boundary, Cage, INFINITELY_SHARP};

/// Larger coordinates are refused, so that whatever is computed of them stays finite in single precision.
const LARGEST: f64 = 1e30;

/// The cage as level 0.
pub(super) fn level_of(cage: &Cage) -> Result<Level, CageError> {
    let mut level = faces(cage)?;
    check_positions(cage, &level)?;
    level.points = cage.positions.par_iter().map(|&point| DVec3::from(point)).collect();
    level.limits = vec![[f32::NAN; 3]; level.points.len()];
    connect(&mut level)?;
    sharpen_edges(&mut level, cage)?;
    sharpen_vertices(&mut level, cage)?;
    level.origins = origins(&level);
    leave_out_holes(&mut level, cage)?;
    Ok(level)
}

/// Corners of faces, and where each face's begin.
fn faces(cage: &Cage) -> Result<Level, CageError> {
    let needed = cage.face_sizes.iter().map(|&size| u64::from(size)).sum();
    let corners = cage.corners.len();
    if needed != corners as u64 {
        return Err(CageError::Sizes { corners, needed });
    }
    let most = u64::from(NONE);
    if needed >= most || cage.positions.len() as u64 >= most {
        return Err(CageError::TooLarge { level: 0, faces: needed, most });
    }
    let mut level = Level { corners: cage.corners.clone(), ..Level::default() };
    if cage.face_sizes.iter().any(|&size| size != 4) {
        count_corners(&mut level, cage);
    }
    (0..level.face_count())
        .into_par_iter()
        .filter_map(|face| check_face(&level, cage, face).err().map(|error| (face, error)))
        .min_by_key(|(face, _)| *face)
        .map_or(Ok(level), |(_, error)| Err(error))
}

fn count_corners(level: &mut Level, cage: &Cage) {
    level.starts = Vec::with_capacity(cage.face_sizes.len() + 1);
    level.starts.push(0);
    level.faces = Vec::with_capacity(cage.corners.len());
    for (face, &size) in cage.face_sizes.iter().enumerate() {
        level.faces.resize(level.faces.len() + size as usize, face as u32);
        level.starts.push(level.faces.len() as u32);
    }
}

fn check_face(level: &Level, cage: &Cage, face: usize) -> Result<(), CageError> {
    let corners = &level.corners[level.corners_of(face)];
    let (face, vertices) = (face as u32, cage.positions.len());
    if corners.len() < 3 {
        return Err(CageError::FewCorners { face, corners: corners.len() as u32 });
    }
    if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
        return Err(CageError::NoVertex { face, vertex, vertices });
    }
    match repeated(corners) {
        Some(vertex) => Err(CageError::RepeatedVertex { face, vertex }),
        None => Ok(()),
    }
}

/// A number that occurs twice.
fn repeated(numbers: &[u32]) -> Option<u32> {
    if let &[a, b, c, d] = numbers {
        let is_twice = a == b || a == c || a == d || b == c || b == d || c == d;
        if !is_twice {
            return None;
        }
    }
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

fn check_positions(cage: &Cage, level: &Level) -> Result<(), CageError> {
    let wrong = cage.positions.iter().position(|point| !point.iter().all(|x| x.abs() <= LARGEST));
    let Some(vertex) = wrong else { return Ok(()) };
    let corner = level.corners.iter().position(|&other| other as usize == vertex);
    let face = corner.map(|corner| level.face_of(corner) as u32);
    Err(CageError::Position { face, vertex: vertex as u32 })
}

/// Gives half-edges the sharpness of their creases.
fn sharpen_edges(level: &mut Level, cage: &Cage) -> Result<(), CageError> {
    if cage.creases.is_empty() {
        return Ok(());
    }
    let mut sharp = vec![0.0; level.corners.len()];
    for crease in &cage.creases {
        let [a, b] = crease.vertices;
        if crease.sharpness.is_nan() {
            return Err(CageError::Sharpness { vertex: a });
        }
        let half_edge = between(level, a, b).or_else(|| between(level, b, a));
        let half_edge = half_edge.ok_or(CageError::NoEdge { vertices: [a, b] })?;
        sharp[half_edge] = crease.sharpness.max(0.0);
        if let Some(twin) = level.twin(half_edge) {
            sharp[twin] = sharp[half_edge];
        }
    }
    level.sharp_edges = sharp;
    Ok(())
}

/// The half-edge from one vertex to another, looked for where fewer faces meet.
fn between(level: &Level, from: u32, to: u32) -> Option<usize> {
    let known = level.points.len() as u32;
    if from >= known || to >= known {
        return None;
    }
    let (leaving, arriving) = (level.fan(from as usize), level.fan(to as usize));
    if leaving.len() <= arriving.len() {
        leaving.iter().map(|&h| h as usize).find(|&h| level.end(h) == to as usize)
    } else {
        arriving.iter().map(|&h| level.previous(h as usize)).find(|&h| level.vertex(h) == from as usize)
    }
}

/// Gives vertices their sharpness: their own, and that of vertices where surfaces only touch, or end in one face.
fn sharpen_vertices(level: &mut Level, cage: &Cage) -> Result<(), CageError> {
    let pointed = cage.boundary == Boundary::EdgeAndCorner;
    let found: &Level = level;
    let always: Vec<usize> = (0..found.points.len())
        .into_par_iter()
        .filter(|&vertex| pointed && found.fan(vertex).len() == 1 || !is_one_fan(found, vertex))
        .collect();
    let vertices = cage.positions.len();
    if always.is_empty() && cage.sharp_vertices.is_empty() {
        return Ok(());
    }
    let mut sharp = vec![0.0; vertices];
    for &(vertex, sharpness) in &cage.sharp_vertices {
        if sharpness.is_nan() {
            return Err(CageError::Sharpness { vertex });
        }
        let place = sharp.get_mut(vertex as usize).ok_or(CageError::NoSharpVertex { vertex, vertices })?;
        *place = sharpness.max(0.0);
    }
    for vertex in always {
        sharp[vertex] = INFINITELY_SHARP;
    }
    level.sharp_vertices = sharp;
    Ok(())
}

/// Can one walk through all faces at a vertex across their edges there?
fn is_one_fan(level: &Level, vertex: usize) -> bool {
    let fan = level.fan(vertex);
    let Some(&first) = fan.first() else { return true };
    let first = first as usize;
    let around = walk(first, |corner| level.counter_clockwise(corner));
    if around.1 {
        return around.0 == fan.len();
    }
    around.0 + walk(first, |corner| level.clockwise(corner)).0 - 1 == fan.len()
}

/// Corners that are met from one of them on, itself included, and if the walk ended where it began.
fn walk(first: usize, step: impl Fn(usize) -> Option<usize>) -> (usize, bool) {
    let (mut count, mut corner) = (1, first);
    while let Some(next) = step(corner) {
        if next == first {
            return (count, true);
        }
        (count, corner) = (count + 1, next);
    }
    (count, false)
}

/// All faces; those that are not quads are told apart once they are divided.
fn origins(level: &Level) -> Vec<Option<Origin>> {
    (0..level.face_count() as u32).into_par_iter().map(|face| Some(Origin::whole(face, -1))).collect()
}

fn leave_out_holes(level: &mut Level, cage: &Cage) -> Result<(), CageError> {
    let faces = level.face_count();
    for &hole in &cage.holes {
        let origin = level.origins.get_mut(hole as usize).ok_or(CageError::NoHole { hole, faces })?;
        *origin = None;
    }
    if cage.boundary == Boundary::None {
        for half_edge in (0..level.corners.len()).filter(|&h| level.twins[h] == NONE) {
            for vertex in [level.vertex(half_edge), level.end(half_edge)] {
                let fan = level.fan_starts[vertex] as usize..level.fan_starts[vertex + 1] as usize;
                for place in fan {
                    let face = level.face_of(level.fans[place] as usize);
                    level.origins[face] = None;
                }
            }
        }
    }
    Ok(())
}
