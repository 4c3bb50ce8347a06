//! Vertices that are the same, and edges that meet.

use std::collections::HashMap;
use std::hash::Hash;

use super::Mesh;

/// Numbers from 0 for things as they turn up.
#[derive(Debug)]
pub(super) struct Numbers<K>(HashMap<K, u32>);

impl<K> Default for Numbers<K> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Eq + Hash> Numbers<K> {
    /// The number of something, and whether it is new.
    pub(super) fn number(&mut self, key: K) -> (u32, bool) {
        let next = self.0.len() as u32;
        let number = *self.0.entry(key).or_insert(next);
        (number, number == next)
    }
}

/// Where vertices are, each place once, and the place of each vertex.
pub(crate) fn places(positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, Vec<u32>) {
    let (mut places, mut known) = (Vec::new(), Numbers::default());
    let of_vertices = positions.iter().map(|position| {
        let (number, is_new) = known.number(position.map(f32::to_bits));
        if is_new {
            places.push(*position);
        }
        number
    });
    let of_vertices = of_vertices.collect();
    (places, of_vertices)
}

/// Edges, between places, that are not run through as often one way as the other.
pub(super) fn open_edges(mesh: &Mesh) -> usize {
    let (_, places) = places(&mesh.positions);
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| places[corner as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (edge, way) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            *edges.entry(edge).or_default() += way;
        }
    }
    edges.values().filter(|balance| **balance != 0).count()
}
