//! A tessellation as a mesh in main memory, for files.

use micropoly_core::abi::TessVertex;
use micropoly_core::tess::stream::TessCounts;

use super::chunk::HostChunk;
use super::source::normals;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, weld};

/// What has been tessellated so far.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    mesh: Mesh,
}

impl Outcome {
    /// Makes room for a mesh, so that there is an error before anything is made if there is none.
    pub(super) fn reserve(&mut self, counts: TessCounts) -> Result<()> {
        let remedy = "choose smaller levels, or -o none without --check, which keeps no mesh";
        let too_large = |problem: &str| Error::scene(problem, remedy);
        let vertices = u32::try_from(counts.vertices)
            .map_err(|_| too_large("the mesh has more vertices than 32 bits can number"))?
            as usize;
        let Mesh { positions, normals, uvs, patches, triangles, .. } = &mut self.mesh;
        let room = positions.try_reserve_exact(vertices).and(normals.try_reserve_exact(vertices));
        let room = room.and(uvs.try_reserve_exact(vertices)).and(patches.try_reserve_exact(vertices));
        room.and(triangles.try_reserve_exact(counts.primitives as usize))
            .map_err(|_| too_large("there is no memory for so large a mesh"))
    }

    /// Adds a chunk of triangles. A triangle two of whose corners are in the same place has collapsed and is left out.
    pub(super) fn add(&mut self, chunk: &HostChunk) {
        let base = self.mesh.positions.len();
        for (patch, record) in (chunk.first..).zip(&chunk.records) {
            self.mesh.patches.extend((0..record.vertices).map(|_| patch as u32));
        }
        self.mesh.positions.extend(chunk.vertices.iter().map(|vertex| vertex.position));
        self.mesh.normals.extend(chunk.vertices.iter().map(|vertex| vertex.normal));
        self.mesh.uvs.extend(chunk.vertices.iter().map(|vertex| vertex.uv));
        let whole = |[a, b, c]: &&[u32; 3]| {
            let [a, b, c] = [*a, *b, *c].map(|index| place(&chunk.vertices[index as usize]));
            a != b && b != c && c != a
        };
        let triangles = chunk.indices.as_chunks::<3>().0.iter().filter(whole);
        self.mesh.triangles.extend(triangles.map(|triangle| triangle.map(|index| base as u32 + index)));
    }

    /// The mesh. Heights have turned its normals, and where Bézier patches collapse they have none: there they are the
    /// means of the triangles at each place.
    pub(super) fn finish(mut self, is_displaced: bool, is_textured: bool) -> Mesh {
        self.mesh.is_textured = is_textured;
        let lacks = |normal: &[f32; 3]| is_displaced || *normal == [0.0; 3];
        if !self.mesh.normals.iter().any(lacks) {
            return self.mesh;
        }
        let (positions, places) = weld::places(&self.mesh.positions);
        let triangles =
            self.mesh.triangles.iter().map(|triangle| triangle.map(|index| places[index as usize]));
        let means = normals(&positions, triangles);
        for (normal, place) in self.mesh.normals.iter_mut().zip(&places) {
            if lacks(normal) {
                *normal = means[*place as usize];
            }
        }
        self.mesh
    }
}

fn place(vertex: &TessVertex) -> [u32; 3] {
    vertex.position.map(f32::to_bits)
}
