//! Refinement: the quads of the next level, of those faces that need it and whatever touches them.

use glam::DVec3;
use rayon::prelude::*;

use super::error::CageError;
use super::level::{Level, NONE, decayed};
use super::masks::{edge_point, face_point, vertex_point};
use super::origin::Origin;
use super::tags::Fate;
use super::topology::connect;

/// The most faces a level may have: their corners are counted in 32 bits, and they should fit into memory.
const MOST_FACES: u64 = 1 << 27;

/// Numbers of the vertices that faces, edges and vertices give rise to.
struct Children {
    /// Faces, in order.
    faces: Vec<u32>,
    /// Half-edges that stand for edges, in order.
    edges: Vec<u32>,
    /// Vertices, in order.
    vertices: Vec<u32>,
    /// Number of the vertex of each face.
    of_face: Vec<u32>,
    /// Number of the vertex of each edge, by the half-edge that stands for it.
    of_edge: Vec<u32>,
    /// Number of the vertex of each vertex.
    of_vertex: Vec<u32>,
}

/// The next level. Of each refined face there are all quads, in order and before any others; then, of others, those
/// that touch one.
pub(super) fn refine(level: &Level, fates: &[Fate], depth: u32) -> Result<Level, CageError> {
    let touched = touched(level, fates);
    let quads = quads(level, fates, &touched, depth)?;
    let children = Children::number(level, &touched);
    let mut next = Level { points: children.points(level), ..Level::default() };
    next.corners = quads.par_iter().flat_map_iter(|&corner| children.quad(level, corner as usize)).collect();
    next.origins = quads.par_iter().map(|&corner| origin(level, fates, corner as usize)).collect();
    next.limits = children.limits(level);
    children.sharpen(level, &quads, &mut next);
    connect(&mut next)?;
    Ok(next)
}

/// Is a vertex at a refined face?
fn touched(level: &Level, fates: &[Fate]) -> Vec<bool> {
    let mut touched = vec![false; level.points.len()];
    for face in refined(fates) {
        for &vertex in &level.corners[level.corners_of(face)] {
            touched[vertex as usize] = true;
        }
    }
    touched
}

fn refined(fates: &[Fate]) -> impl Iterator<Item = usize> {
    (0..fates.len()).filter(|&face| fates[face] == Fate::Refined)
}

/// The corners at which there are quads.
fn quads(level: &Level, fates: &[Fate], touched: &[bool], depth: u32) -> Result<Vec<u32>, CageError> {
    let beside = |corner: &u32| {
        touched[level.vertex(*corner as usize)] && fates[level.face_of(*corner as usize)] != Fate::Refined
    };
    let own = refined(fates).flat_map(|face| level.corners_of(face)).map(|corner| corner as u32);
    let quads: Vec<u32> = own.chain((0..level.corners.len() as u32).filter(beside)).collect();
    let faces = quads.len() as u64;
    if faces > MOST_FACES {
        return Err(CageError::TooLarge { level: depth + 1, faces, most: MOST_FACES });
    }
    Ok(quads)
}

/// Where a quad lies, if it is drawn.
fn origin(level: &Level, fates: &[Fate], corner: usize) -> Option<Origin> {
    let face = level.face_of(corner);
    if fates[face] != Fate::Refined {
        return None;
    }
    let at = corner - level.corners_of(face).start;
    level.origins[face].map(|origin| {
        if level.is_quad(face) { origin.quarter(at) } else { Origin::whole(origin.face, at as i32) }
    })
}

impl Children {
    /// Numbers them: those of faces first, then those of edges, then those of vertices.
    fn number(level: &Level, touched: &[bool]) -> Self {
        let is_touched = |corner: usize| touched[level.vertex(corner)];
        let with = |face: &u32| level.corners_of(*face as usize).any(is_touched);
        let along = |h: &u32| {
            let half_edge = *h as usize;
            level.edge(half_edge) == half_edge && (is_touched(half_edge) || touched[level.end(half_edge)])
        };
        let faces: Vec<u32> = (0..level.face_count() as u32).into_par_iter().filter(with).collect();
        let edges: Vec<u32> = (0..level.corners.len() as u32).into_par_iter().filter(along).collect();
        let vertices: Vec<u32> =
            (0..touched.len() as u32).into_par_iter().filter(|&v| touched[v as usize]).collect();
        let (first_edge, first_vertex) = (faces.len(), faces.len() + edges.len());
        Self {
            of_face: numbered(&faces, 0, level.face_count()),
            of_edge: numbered(&edges, first_edge, level.corners.len()),
            of_vertex: numbered(&vertices, first_vertex, touched.len()),
            faces,
            edges,
            vertices,
        }
    }

    /// Positions.
    fn points(&self, level: &Level) -> Vec<DVec3> {
        let mut points: Vec<DVec3> =
            self.faces.par_iter().map(|&face| face_point(level, face as usize)).collect();
        let middle = |face: usize| points[self.of_face[face] as usize];
        let edges: Vec<DVec3> =
            self.edges.par_iter().map(|&half_edge| edge_point(level, half_edge as usize, middle)).collect();
        let vertices: Vec<DVec3> =
            self.vertices.par_iter().map(|&vertex| vertex_point(level, vertex as usize, middle)).collect();
        points.extend(edges);
        points.extend(vertices);
        points
    }

    /// Limit positions, of which a vertex keeps those it has.
    fn limits(&self, level: &Level) -> Vec<[f32; 3]> {
        let mut limits = vec![[f32::NAN; 3]; self.faces.len() + self.edges.len()];
        limits.extend(self.vertices.iter().map(|&vertex| level.limits[vertex as usize]));
        limits
    }

    /// The quad at a corner. It begins where its face does, so that parameters run the same way.
    fn quad(&self, level: &Level, corner: usize) -> [u32; 4] {
        let quad = [
            self.of_vertex[level.vertex(corner)],
            self.of_edge[level.edge(corner)],
            self.of_face[level.face_of(corner)],
            self.of_edge[level.edge(level.previous(corner))],
        ];
        let turns = turns(level, corner);
        std::array::from_fn(|place| quad[(place + turns) & 3])
    }

    /// What is left of the sharpness of edges and vertices.
    fn sharpen(&self, level: &Level, quads: &[u32], next: &mut Level) {
        if level.sharp_edges.iter().any(|&sharpness| decayed(sharpness) > 0.0) {
            let left = |corner: usize| {
                let left = |half_edge: usize| decayed(level.sharp_edges[half_edge]);
                let quad = [left(corner), 0.0, 0.0, left(level.previous(corner))];
                let turns = turns(level, corner);
                std::array::from_fn::<_, 4, _>(|place| quad[(place + turns) & 3])
            };
            next.sharp_edges = quads.par_iter().flat_map_iter(|&corner| left(corner as usize)).collect();
        }
        if level.sharp_vertices.iter().any(|&sharpness| decayed(sharpness) > 0.0) {
            next.sharp_vertices = vec![0.0; self.faces.len() + self.edges.len()];
            let left = |&vertex: &u32| decayed(level.sharp_vertices[vertex as usize]);
            next.sharp_vertices.extend(self.vertices.iter().map(left));
        }
    }
}

/// How many places the vertex of a corner is after the first one of the corner's quad, the other way round.
fn turns(level: &Level, corner: usize) -> usize {
    let face = level.face_of(corner);
    if level.is_quad(face) { (4 - (corner - level.corners_of(face).start)) & 3 } else { 0 }
}

/// Where in a list each number stands, plus `first`.
fn numbered(list: &[u32], first: usize, size: usize) -> Vec<u32> {
    let mut places = vec![NONE; size];
    for (place, &number) in list.iter().enumerate() {
        places[number as usize] = (first + place) as u32;
    }
    places
}
