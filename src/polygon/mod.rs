//! Polygons as patches: the faces of a mesh as they are, not as the cage of a smooth surface.
//!
//! All edges are straight cubics whose control points depend on their two ends alone, the same bits from either end, and
//! no edge is divided: so faces that share an edge have the same one.

mod ears;
#[cfg(test)]
mod tests;

use std::path::Path;

use rayon::prelude::*;

use self::ears::{Flat, is_convex, sees_all, triangulated};
use crate::cage::Cage;
use crate::error::Error;
use crate::shape::BezierPatch;

/// Why a mesh cannot be drawn as polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolygonError {
    /// Sizes of faces do not add up to the number of corners.
    #[error("the faces have {claimed} corners together, but there are {corners}")]
    Corners {
        /// What the faces' sizes add up to.
        claimed: u64,
        /// How many there are.
        corners: usize,
    },
    /// A face of fewer than 3 corners.
    #[error("face {face} (counted from 0) has {size} corners; it needs 3 or more")]
    Size {
        /// Which face.
        face: usize,
        /// Its corners.
        size: u32,
    },
    /// A corner at a vertex that is not there.
    #[error(
        "face {face} (counted from 0) has a corner at vertex {vertex}, but there are {vertices} vertices"
    )]
    Vertex {
        /// Which face.
        face: usize,
        /// The vertex.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A vertex that is not finite, or too far away.
    #[error("vertex {vertex} (counted from 0) is not at finite coordinates that single precision has")]
    Position {
        /// Which vertex.
        vertex: usize,
    },
    /// A vertex that is too far away to be tessellated.
    #[error("vertex {vertex} (counted from 0) has a coordinate beyond 1e12")]
    Far {
        /// Which vertex.
        vertex: usize,
    },
    /// A face is said to be a hole that is not there.
    #[error("face {face} is to be a hole, but there are {faces} faces")]
    Hole {
        /// Which face.
        face: u32,
        /// How many there are.
        faces: usize,
    },
    /// A face that takes too long to divide into triangles.
    #[error(
        "face {face} (counted from 0) is concave and has {size} corners; at most {MOST_CORNERS} can be drawn"
    )]
    Concave {
        /// Which face.
        face: usize,
        /// Its corners.
        size: usize,
    },
    /// A face of too many corners to be divided into triangles.
    #[error("face {face} (counted from 0) has {size} corners; at most {MOST_CORNERS} can become triangles")]
    Large {
        /// Which face.
        face: usize,
        /// Its corners.
        size: usize,
    },
}

impl PolygonError {
    /// The face that is wrong.
    #[must_use]
    pub const fn face(&self) -> Option<usize> {
        match self {
            Self::Size { face, .. }
            | Self::Vertex { face, .. }
            | Self::Concave { face, .. }
            | Self::Large { face, .. } => Some(*face),
            Self::Corners { .. } | Self::Position { .. } | Self::Far { .. } | Self::Hole { .. } => None,
        }
    }

    /// The same, of a mesh from a file: with the line, if it is known.
    #[must_use]
    pub fn in_file(&self, path: &Path, mesh: &Cage) -> Error {
        let line = self.face().and_then(|face| mesh.face_lines.get(face)).map_or(1, |line| *line as usize);
        let remedy = match self {
            Self::Far { .. } => "scale the mesh down, or mend the vertex",
            _ => "triangulate the face, or repair the mesh",
        };
        Error::format(path, line, self.to_string(), remedy)
    }
}

/// Most corners of a face that is divided by cutting off ears, which takes as long as the square of their number.
pub const MOST_CORNERS: usize = 10_000;

/// A flat or twisted patch with straight edges: its corners are at (u, v) = (0, 0), (1, 0), (1, 1) and (0, 1). Seen from
/// the front they are counter-clockwise.
#[must_use]
pub fn bilinear(corners: [[f64; 3]; 4]) -> BezierPatch {
    let [low, high] = [straight(corners[0], corners[1]), straight(corners[3], corners[2])];
    let mut patch = BezierPatch { points: [[0.0; 3]; 16] };
    for (i, points) in patch.points.chunks_exact_mut(4).enumerate() {
        for (point, place) in points.iter_mut().zip(straight(low[i], high[i])) {
            // No zero is negative.
            *point = place.map(|coordinate| coordinate as f32 + 0.0);
        }
    }
    patch
}

/// Control points of a line; the other way round it gives the same bits.
fn straight(a: [f64; 3], b: [f64; 3]) -> [[f64; 3]; 4] {
    let third = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) / 3.0);
    [a, third(a, b), third(b, a), b]
}

/// A triangle: v = 1 is its last corner.
fn triangle([a, b, c]: [[f64; 3]; 3]) -> BezierPatch {
    bilinear([a, b, c, c])
}

/// All faces of a mesh that are no holes, as flat patches, face by face. Creases and boundaries mean nothing here.
///
/// A triangle is a patch with one side that is a point, and a convex quadrilateral is one patch. Faces of more corners
/// become triangles: about their centre where all of their edges can be seen from there, and otherwise by cutting off
/// ears. Faces need not be planar.
///
/// # Errors
/// [`PolygonError`], if the mesh contradicts itself, or a face cannot be drawn.
pub fn polygons(cage: &Cage) -> Result<Vec<BezierPatch>, PolygonError> {
    check(cage)?;
    let is_hole = holes(cage)?;
    let ends = cage.face_sizes.iter().scan(0, |end, &size| {
        *end += size as usize;
        Some(*end)
    });
    let faces: Vec<_> = ends.zip(&cage.face_sizes).map(|(end, &size)| end - size as usize..end).collect();
    let drawn: Vec<_> = faces.into_iter().enumerate().filter(|&(face, _)| !is_hole[face]).collect();
    let parts: Vec<_> = drawn.par_chunks(FACES_AT_ONCE).map(|faces| patches_of(cage, faces)).collect();
    // Of several errors the first, whichever was found first.
    Ok(parts.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
}

/// The triangles of all faces that are no holes, face by face, as numbers of corners of the mesh; no edge is divided.
///
/// # Errors
/// As [`polygons`], and [`PolygonError::Large`].
pub fn triangles(mesh: &Cage) -> Result<Vec<[u32; 3]>, PolygonError> {
    check(mesh)?;
    let is_hole = holes(mesh)?;
    let (mut triangles, mut start) = (Vec::new(), 0);
    for (face, &size) in mesh.face_sizes.iter().enumerate() {
        let range = start as usize..(start + size) as usize;
        let corners = face_corners(mesh, &(face, range))?;
        if !is_hole[face] {
            let own = triangles_of(face, &corners)?;
            triangles.extend(own.into_iter().map(|triangle| triangle.map(|corner| start + corner as u32)));
        }
        start += size;
    }
    Ok(triangles)
}

fn triangles_of(face: usize, corners: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, PolygonError> {
    match corners.len() {
        3 => Ok(vec![[0, 1, 2]]),
        size if size > MOST_CORNERS => Err(PolygonError::Large { face, size }),
        _ => Ok(triangulated(&Flat::new(corners).of(corners))),
    }
}

/// Faces that one thread works off in a row.
const FACES_AT_ONCE: usize = 1024;

/// A face's number, and which corners are its own.
type Face = (usize, std::ops::Range<usize>);

fn patches_of(cage: &Cage, faces: &[Face]) -> Result<Vec<BezierPatch>, PolygonError> {
    let mut patches = Vec::with_capacity(faces.len());
    for face in faces {
        add_polygon(face.0, &face_corners(cage, face)?, &mut patches)?;
    }
    Ok(patches)
}

/// Where the corners of a face are.
fn face_corners(cage: &Cage, (face, range): &Face) -> Result<Vec<[f64; 3]>, PolygonError> {
    let vertices = cage.positions.len();
    let position = |&vertex: &u32| {
        let wrong = PolygonError::Vertex { face: *face, vertex, vertices };
        cage.positions.get(vertex as usize).copied().ok_or(wrong)
    };
    cage.corners[range.clone()].iter().map(position).collect()
}

fn check(cage: &Cage) -> Result<(), PolygonError> {
    let claimed = cage.face_sizes.iter().map(|&size| u64::from(size)).sum();
    if claimed != cage.corners.len() as u64 {
        return Err(PolygonError::Corners { claimed, corners: cage.corners.len() });
    }
    if let Some(face) = cage.face_sizes.iter().position(|&size| size < 3) {
        return Err(PolygonError::Size { face, size: cage.face_sizes[face] });
    }
    let is_wild = |c: &f64| !(*c as f32).is_finite();
    match cage.positions.iter().position(|position| position.iter().any(is_wild)) {
        Some(vertex) => Err(PolygonError::Position { vertex }),
        None => Ok(()),
    }
}

fn holes(cage: &Cage) -> Result<Vec<bool>, PolygonError> {
    let faces = cage.face_sizes.len();
    let mut is_hole = vec![false; faces];
    for &face in &cage.holes {
        *is_hole.get_mut(face as usize).ok_or(PolygonError::Hole { face, faces })? = true;
    }
    Ok(is_hole)
}

fn add_polygon(
    face: usize,
    corners: &[[f64; 3]],
    patches: &mut Vec<BezierPatch>,
) -> Result<(), PolygonError> {
    let flat = Flat::new(corners);
    match *corners {
        [a, b, c] => patches.push(triangle([a, b, c])),
        [a, b, c, d] if is_convex([a, b, c, d].map(|corner| flat.point(corner))) => {
            patches.push(bilinear([a, b, c, d]));
        }
        _ => patches.extend(divided(face, corners, &flat)?),
    }
    Ok(())
}

/// The triangles of a face that is no single patch.
fn divided(face: usize, corners: &[[f64; 3]], flat: &Flat) -> Result<Vec<BezierPatch>, PolygonError> {
    let (size, centre, seen) = (corners.len(), mean(corners), flat.of(corners));
    if size > 4 && sees_all(flat.point(centre), &seen) {
        return Ok(around(centre, corners));
    }
    if size > MOST_CORNERS {
        return Err(PolygonError::Concave { face, size });
    }
    Ok(triangulated(&seen).into_iter().map(|triple| triangle(triple.map(|k| corners[k]))).collect())
}

fn mean(corners: &[[f64; 3]]) -> [f64; 3] {
    let sum = corners.iter().fold([0.0; 3], |sum, corner| [0, 1, 2].map(|k| sum[k] + corner[k]));
    sum.map(|coordinate: f64| coordinate / corners.len() as f64)
}

fn around(centre: [f64; 3], corners: &[[f64; 3]]) -> Vec<BezierPatch> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&a, &b)| triangle([a, b, centre])).collect()
}
