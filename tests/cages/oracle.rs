//! The limit surface found the slow way: the whole cage is refined, level after level, and limit masks are applied to the
//! last. It shares nothing with what it is to check but the definition of the surface (Catmull & Clark 1978; DeRose, Kass &
//! Truong 1998; limits after Halstead, Kass & DeRose 1993).

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use micropoly::cage::{Boundary, Cage};

use super::Sample;

const INFINITE: f32 = 10.0;

#[derive(Clone)]
struct Face {
    corners: Vec<usize>,
    origin: Origin,
}

#[derive(Clone, Copy)]
struct Origin {
    face: u32,
    sub: i32,
    /// Position and size of the square.
    low: [f64; 2],
    size: f64,
    is_drawn: bool,
}

struct Mesh {
    points: Vec<DVec3>,
    faces: Vec<Face>,
    sharp_edges: BTreeMap<[usize; 2], f32>,
    sharp_vertices: BTreeMap<usize, f32>,
}

/// Faces and edges around, found anew for each level.
struct Around {
    /// Faces at each edge.
    edges: BTreeMap<[usize; 2], Vec<usize>>,
    /// Faces at each vertex.
    faces: Vec<Vec<usize>>,
    /// The other ends of the edges at each vertex.
    ends: Vec<BTreeSet<usize>>,
}

fn key(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

fn less(sharpness: f32) -> f32 {
    if sharpness >= INFINITE { sharpness } else { (sharpness - 1.0).max(0.0) }
}

/// Limit positions and normals at all vertices that refining so often gives.
pub(crate) fn samples(cage: &Cage, levels: u32) -> Vec<Sample> {
    let mut mesh = Mesh::of(cage);
    for _ in 0..levels {
        mesh = mesh.refined();
    }
    mesh.limits()
}

impl Around {
    fn of(mesh: &Mesh) -> Self {
        let count = mesh.points.len();
        let mut around =
            Self { edges: BTreeMap::new(), faces: vec![vec![]; count], ends: vec![BTreeSet::new(); count] };
        for (number, face) in mesh.faces.iter().enumerate() {
            for (k, &a) in face.corners.iter().enumerate() {
                let b = face.corners[(k + 1) % face.corners.len()];
                around.edges.entry(key(a, b)).or_default().push(number);
                around.faces[a].push(number);
                around.ends[a].insert(b);
                around.ends[b].insert(a);
            }
        }
        around
    }
}

impl Mesh {
    fn of(cage: &Cage) -> Self {
        let mut corners = cage.corners.iter().map(|&vertex| vertex as usize);
        let origin =
            |face| Origin { face, sub: -1, low: [0.0; 2], size: 1.0, is_drawn: !cage.holes.contains(&face) };
        let faces = cage.face_sizes.iter().zip(0..);
        let faces = faces.map(|(&size, face)| Face {
            corners: corners.by_ref().take(size as usize).collect(),
            origin: origin(face),
        });
        let mut mesh = Self {
            faces: faces.collect(),
            points: cage.positions.iter().map(|&point| DVec3::from(point)).collect(),
            sharp_edges: BTreeMap::new(),
            sharp_vertices: cage.sharp_vertices.iter().map(|&(vertex, s)| (vertex as usize, s)).collect(),
        };
        for crease in &cage.creases {
            let [a, b] = crease.vertices;
            mesh.sharp_edges.insert(key(a as usize, b as usize), crease.sharpness);
        }
        mesh.bound(cage.boundary);
        mesh
    }

    fn bound(&mut self, rule: Boundary) {
        let around = Around::of(self);
        for (&[a, b], _) in around.edges.iter().filter(|(_, faces)| faces.len() == 1) {
            self.sharp_edges.insert([a, b], INFINITE);
            if rule == Boundary::None {
                for &face in around.faces[a].iter().chain(&around.faces[b]) {
                    self.faces[face].origin.is_drawn = false;
                }
            }
        }
        for vertex in 0..self.points.len() {
            let faces = &around.faces[vertex];
            let boundaries =
                around.ends[vertex].iter().filter(|&&end| around.edges[&key(vertex, end)].len() == 1).count();
            let is_lone = rule == Boundary::EdgeAndCorner && faces.len() == 1;
            let is_touched = boundaries > 2 || faces.len() > self.reached(&around, vertex);
            if is_lone || is_touched {
                self.sharp_vertices.insert(vertex, INFINITE);
            }
        }
    }

    /// How many faces at a vertex can be reached from the first across edges there.
    fn reached(&self, around: &Around, vertex: usize) -> usize {
        let mut seen: BTreeSet<usize> = around.faces[vertex].first().copied().into_iter().collect();
        let mut waiting: Vec<usize> = seen.iter().copied().collect();
        while let Some(face) = waiting.pop() {
            for end in
                around.ends[vertex].iter().filter(|&&end| around.edges[&key(vertex, end)].contains(&face))
            {
                for &other in &around.edges[&key(vertex, *end)] {
                    if seen.insert(other) {
                        waiting.push(other);
                    }
                }
            }
        }
        seen.len()
    }

    fn edge_sharpness(&self, a: usize, b: usize) -> f32 {
        self.sharp_edges.get(&key(a, b)).copied().unwrap_or(0.0)
    }

    fn sharp_ends(&self, around: &Around, vertex: usize, left: fn(f32) -> f32) -> Vec<usize> {
        let sharp = |end: &&usize| left(self.edge_sharpness(vertex, **end)) > 0.0;
        around.ends[vertex].iter().filter(sharp).copied().collect()
    }

    fn middle(&self, face: usize) -> DVec3 {
        let corners = &self.faces[face].corners;
        corners.iter().map(|&vertex| self.points[vertex]).sum::<DVec3>() / corners.len() as f64
    }

    fn edge_point(&self, [a, b]: [usize; 2], faces: &[usize]) -> DVec3 {
        let sharp = (self.points[a] + self.points[b]) / 2.0;
        let sharpness = f64::from(self.edge_sharpness(a, b).min(1.0));
        if sharpness >= 1.0 {
            return sharp;
        }
        let smooth = sharp / 2.0 + (self.middle(faces[0]) + self.middle(faces[1])) / 4.0;
        sharp * sharpness + smooth * (1.0 - sharpness)
    }

    /// By the rule that holds with this much of all sharpness left.
    fn ruled(&self, around: &Around, vertex: usize, left: fn(f32) -> f32) -> DVec3 {
        let here = self.points[vertex];
        let ends = self.sharp_ends(around, vertex, left);
        let own = left(self.sharp_vertices.get(&vertex).copied().unwrap_or(0.0));
        if own > 0.0 || ends.len() > 2 {
            here
        } else if let [a, b] = ends[..] {
            (here * 6.0 + self.points[a] + self.points[b]) / 8.0
        } else {
            let n = around.faces[vertex].len() as f64;
            let edges: DVec3 = around.ends[vertex].iter().map(|&end| (here + self.points[end]) / 2.0).sum();
            let faces: DVec3 = around.faces[vertex].iter().map(|&face| self.middle(face)).sum();
            (faces / n + edges * 2.0 / n + here * (n - 3.0)) / n
        }
    }

    fn vertex_point(&self, around: &Around, vertex: usize) -> DVec3 {
        let own = self.sharp_vertices.get(&vertex).copied();
        let all = around.ends[vertex].iter().map(|&end| self.edge_sharpness(vertex, end)).chain(own);
        let ceasing: Vec<f64> = all.filter(|&s| s > 0.0 && less(s) == 0.0).map(f64::from).collect();
        let now = self.ruled(around, vertex, |s| s);
        if ceasing.is_empty() {
            return now;
        }
        // A dart, or a crease without a partner, has the smooth rule already.
        let weight = ceasing.iter().sum::<f64>() / ceasing.len() as f64;
        now * weight + self.ruled(around, vertex, less) * (1.0 - weight)
    }

    fn refined(&self) -> Self {
        let around = Around::of(self);
        let mut points: Vec<DVec3> = (0..self.points.len())
            .map(|v| if around.faces[v].is_empty() { self.points[v] } else { self.vertex_point(&around, v) })
            .collect();
        let first_face = points.len();
        points.extend((0..self.faces.len()).map(|face| self.middle(face)));
        let mut sharp_edges = BTreeMap::new();
        let mut edges = BTreeMap::new();
        for (&edge, faces) in &around.edges {
            let number = points.len();
            edges.insert(edge, number);
            points.push(self.edge_point(edge, faces));
            let sharpness = less(self.edge_sharpness(edge[0], edge[1]));
            if sharpness > 0.0 {
                sharp_edges.insert(key(edge[0], number), sharpness);
                sharp_edges.insert(key(edge[1], number), sharpness);
            }
        }
        let mut faces = Vec::new();
        for (number, face) in self.faces.iter().enumerate() {
            let count = face.corners.len();
            for k in 0..count {
                let [before, here, after] = [count - 1, 0, 1].map(|step| face.corners[(k + step) % count]);
                let mut corners =
                    vec![here, edges[&key(here, after)], first_face + number, edges[&key(before, here)]];
                let mut origin = face.origin;
                if count == 4 {
                    corners.rotate_right(k);
                    origin.size /= 2.0;
                    let [x, y] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k];
                    origin.low = [origin.low[0] + x * origin.size, origin.low[1] + y * origin.size];
                } else {
                    origin.sub = k as i32;
                }
                faces.push(Face { corners, origin });
            }
        }
        let sharp_vertices =
            self.sharp_vertices.iter().map(|(&v, &s)| (v, less(s))).filter(|&(_, s)| s > 0.0).collect();
        Self { points, faces, sharp_edges, sharp_vertices }
    }

    fn limits(&self) -> Vec<Sample> {
        let around = Around::of(self);
        let limits: Vec<(DVec3, DVec3, bool)> =
            (0..self.points.len()).map(|v| self.limit(&around, v)).collect();
        let mut samples = Vec::new();
        for face in self.faces.iter().filter(|face| face.origin.is_drawn) {
            let Origin { face: number, sub, low, size, .. } = face.origin;
            for (k, &vertex) in face.corners.iter().enumerate() {
                let [x, y] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k];
                let (position, normal, is_smooth) = limits[vertex];
                let place = [low[0] + x * size, low[1] + y * size];
                samples.push(Sample { face: number, sub, place, position, normal, is_smooth });
            }
        }
        samples
    }

    /// Limit position, normal, and if there is one.
    fn limit(&self, around: &Around, vertex: usize) -> (DVec3, DVec3, bool) {
        let here = self.points[vertex];
        let ends = self.sharp_ends(around, vertex, |s| s);
        if self.sharp_vertices.contains_key(&vertex) || ends.len() > 2 || around.faces[vertex].is_empty() {
            return (here, DVec3::ZERO, false);
        }
        if let [a, b] = ends[..] {
            return ((here * 4.0 + self.points[a] + self.points[b]) / 6.0, DVec3::ZERO, false);
        }
        let (edges, faces) = self.ring(around, vertex);
        let n = edges.len() as f64;
        let sum: DVec3 = edges.iter().map(|&e| e * 4.0).chain(faces.iter().copied()).sum();
        let position = (here * n * n + sum) / (n * (n + 5.0));
        let angle = std::f64::consts::TAU / n;
        let c = libm::cos(angle);
        let ratio = 1.0 + c + libm::cos(angle / 2.0) * (2.0 * (9.0 + c)).sqrt();
        let tangent = |shift: f64| -> DVec3 {
            let wave = |k: f64| libm::cos(k * angle + shift);
            (0..edges.len())
                .map(|k| {
                    let k0 = k as f64;
                    edges[k] * (ratio * wave(k0)) + faces[k] * (wave(k0) + wave(k0 + 1.0))
                })
                .sum()
        };
        let quarter = std::f64::consts::FRAC_PI_2;
        // The mask of a smooth vertex is only nearly that of a vertex where a crease ends.
        if !ends.is_empty() {
            return (position, DVec3::ZERO, false);
        }
        (position, tangent(0.0).cross(tangent(-quarter)).normalize_or_zero(), true)
    }

    /// Ends of the edges of a smooth vertex in order, and the vertices opposite between them.
    fn ring(&self, around: &Around, vertex: usize) -> (Vec<DVec3>, Vec<DVec3>) {
        let (mut edges, mut opposite) = (vec![], vec![]);
        let first = around.faces[vertex][0];
        let mut number = first;
        for _ in 0..around.faces[vertex].len() {
            let corners = &self.faces[number].corners;
            let k = corners.iter().position(|&corner| corner == vertex).expect("a corner there");
            let [after, far, before] = [1, 2, 3].map(|step| corners[(k + step) % 4]);
            edges.push(self.points[after]);
            opposite.push(self.points[far]);
            let faces = &around.edges[&key(vertex, before)];
            number = if faces[0] == number { faces[1] } else { faces[0] };
        }
        (edges, opposite)
    }
}
