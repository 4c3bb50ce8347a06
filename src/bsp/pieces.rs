//! Pieces in an order, as a mesh: for programs that draw them one after the other.

use glam::DVec3;
use micropoly_backend_cpu::BspGrid;

use crate::mesh::Mesh;

/// Makes triangles of pieces, in their order. Their corners are rounded to single precision. The patch of a vertex is the number
/// of the triangle that it is a part of; u and v are the weights of that triangle's second and third corner there, so whatever the
/// corners have can be had for it; its normal is the triangle's.
#[must_use]
pub fn mesh(grid: &BspGrid, order: &[u32]) -> Mesh {
    let (mut mesh, mut corners) = (Mesh::default(), Vec::new());
    for &piece in order {
        grid.corners_of(piece, &mut corners);
        let first = mesh.positions.len() as u32;
        let triangle = grid.pieces[piece as usize].triangle;
        let whole = Whole::new(grid, triangle as usize);
        for corner in &corners {
            mesh.positions.push(grid.lattice.place(corner.at).map(|coordinate| coordinate as f32 + 0.0));
            mesh.normals.push(whole.normal);
            mesh.uvs.push(whole.weights(corner.at.into()));
            mesh.patches.push(triangle);
        }
        for k in 2..corners.len() as u32 {
            let fan = [first, first + k - 1, first + k];
            let [a, b, c] = fan.map(|corner| mesh.positions[corner as usize]);
            if a != b && b != c && c != a {
                mesh.triangles.push(fan);
            }
        }
    }
    mesh
}

/// A triangle that was cut, in units of the lattice.
struct Whole {
    corners: [DVec3; 3],
    normal: [f32; 3],
    /// Twice its area along its normal.
    across: DVec3,
}

impl Whole {
    fn new(grid: &BspGrid, triangle: usize) -> Self {
        let corners = grid.triangles[triangle].map(|corner| DVec3::from(corner.map(f64::from)));
        let across = DVec3::from(grid.planes[triangle].normal.map(|c| c as f64));
        let normal = (across.normalize_or_zero().as_vec3() + glam::Vec3::ZERO).to_array(); // -0 is 0
        Self { corners, normal, across }
    }

    /// Weights of the second and third corner at a place.
    fn weights(&self, at: DVec3) -> [f32; 2] {
        let [a, b, c] = self.corners;
        let share = |twice: DVec3| (twice.dot(self.across) / self.across.length_squared()) as f32;
        [share((c - at).cross(a - at)), share((a - at).cross(b - at))].map(|weight| weight.clamp(0.0, 1.0))
    }
}
