//! Where refined vertices are: Catmull & Clark 1978 with the sharp edges of DeRose, Kass & Truong 1998, as OpenSubdiv
//! combines them (uniform creasing).

use glam::DVec3;

use super::level::{Level, decayed};

/// The middle of a face.
pub(super) fn face_point(level: &Level, face: usize) -> DVec3 {
    let corners = level.corners_of(face);
    let count = corners.len() as f64;
    corners.map(|corner| level.point(corner)).sum::<DVec3>() / count
}

/// The vertex on an edge; `middle` gives the middles of faces.
pub(super) fn edge_point(level: &Level, half_edge: usize, middle: impl Fn(usize) -> DVec3) -> DVec3 {
    let ends = level.point(half_edge) + level.points[level.end(half_edge)];
    let sharpness = f64::from(level.edge_sharpness(half_edge));
    let sharp = ends * 0.5;
    match level.twin(half_edge) {
        Some(twin) if sharpness < 1.0 => {
            let faces = middle(level.face_of(half_edge)) + middle(level.face_of(twin));
            sharp * sharpness + (ends + faces) * 0.25 * (1.0 - sharpness)
        }
        _ => sharp,
    }
}

/// Sharp edges at a vertex, and what of them is left one level later.
#[derive(Default)]
struct Sharpness {
    /// How many are sharp: now, and then.
    count: [u32; 2],
    /// The sum of the ends of those.
    ends: [DVec3; 2],
    /// How many cease to be sharp, the vertex itself among them.
    ceasing: u32,
    /// The sum of their sharpness.
    sum: f32,
}

impl Sharpness {
    fn at(level: &Level, vertex: usize) -> Self {
        let mut all = Self::default();
        all.cease(level.vertex_sharpness(vertex));
        for (half_edge, starts_here) in level.edges_at(vertex) {
            let sharpness = level.edge_sharpness(half_edge);
            let end = if starts_here { level.end(half_edge) } else { level.vertex(half_edge) };
            for (when, sharpness) in [sharpness, decayed(sharpness)].into_iter().enumerate() {
                if sharpness > 0.0 {
                    all.count[when] += 1;
                    all.ends[when] += level.points[end];
                }
            }
            all.cease(sharpness);
        }
        all
    }

    fn cease(&mut self, sharpness: f32) {
        if sharpness > 0.0 && decayed(sharpness) == 0.0 {
            self.ceasing += 1;
            self.sum += sharpness;
        }
    }

    /// How much of the sharper rule is left.
    fn weight(&self) -> f64 {
        if self.ceasing == 0 { 0.0 } else { f64::from((self.sum / self.ceasing as f32).min(1.0)) }
    }
}

/// Where a vertex moves; `middle` gives the middles of faces.
pub(super) fn vertex_point(level: &Level, vertex: usize, middle: impl Fn(usize) -> DVec3) -> DVec3 {
    if level.is_plain(vertex) {
        return smooth_point(level, vertex, middle);
    }
    let here = level.points[vertex];
    let sharpness = Sharpness::at(level, vertex);
    let own = level.vertex_sharpness(vertex);
    let rules = [(own, 0), (decayed(own), 1)].map(|(own, when)| match sharpness.count[when] {
        0 | 1 if own == 0.0 => None,
        2 if own == 0.0 => Some(here * 0.75 + sharpness.ends[when] * 0.125),
        _ => Some(here),
    });
    let smooth = || smooth_point(level, vertex, &middle);
    let Some(now) = rules[0] else { return smooth() };
    let weight = sharpness.weight();
    if weight == 0.0 {
        return now;
    }
    now * weight + rules[1].unwrap_or_else(smooth) * (1.0 - weight)
}

fn smooth_point(level: &Level, vertex: usize, middle: impl Fn(usize) -> DVec3) -> DVec3 {
    let fan = level.fan(vertex);
    let count = fan.len() as f64;
    let around: DVec3 = fan
        .iter()
        .map(|&corner| level.points[level.end(corner as usize)] + middle(level.face_of(corner as usize)))
        .sum();
    (level.points[vertex] * (count - 2.0) + around / count) / count
}
