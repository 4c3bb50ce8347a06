//! mesh: drawn surfaces become vertices and triangles, in the space of their objects.
//!
//! A grid's vertices lie in the mesh row after row; a micropolygon is two triangles, a b c and a c d, as for `sample`.
//! A triangle two of whose corners are in the same place has collapsed: all its indices are that of its first corner,
//! so that it can be told, and no rasteriser looks at it twice.

use crate::abi::{Control, Draw, Frame, MeshPlace, MeshTotals, MeshVertex, Object, Patch};
use crate::kernel::dice::Grid;
use crate::kernel::dice_any::dice_any;
use crate::patch::bezier::param;
use crate::patch::instance::{Instance, instance};

/// Indices of a micropolygon.
pub const QUAD_INDICES: usize = 6;

/// The transforms of points and of normals that leave them where they are.
const AS_IT_IS: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const NORMALS_AS_THEY_ARE: [f32; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

impl Draw {
    /// Vertices of its grid.
    #[inline(always)]
    #[must_use]
    pub const fn vertices(self) -> u32 {
        (self.rate_u() + 1) * (self.rate_v() + 1)
    }

    /// Triangles of its grid.
    #[inline(always)]
    #[must_use]
    pub const fn triangles(self) -> u32 {
        2 * self.rate_u() * self.rate_v()
    }
}

/// Places for the meshes of all draws in the draw buffer, behind what there is, and the totals after it. Totals that
/// exceed 32 bits wrap around; the plan notices.
#[must_use]
pub fn places(control: &Control, draws: &[Draw], places: &mut [MeshPlace], totals: MeshTotals) -> MeshTotals {
    let mut totals = totals;
    let count = (control.waiting + control.fresh) as usize;
    for (draw, place) in draws[..count].iter().zip(places) {
        *place = MeshPlace { vertex: totals.vertices, triangle: totals.triangles };
        totals.vertices = totals.vertices.wrapping_add(draw.vertices());
        totals.triangles = totals.triangles.wrapping_add(draw.triangles());
    }
    totals
}

/// Dices a draw for a mesh: in the space of its object.
#[inline(always)]
pub fn dice_in_place(frame: &Frame, objects: &[Object], patches: &[Patch], draw: Draw, grid: &mut Grid) {
    let Instance { record, object } = instance(frame, objects, patches, draw.patch_id);
    let object = &objects[object as usize];
    let stays = Object { to_eye: AS_IT_IS, normal_to_eye: NORMALS_AS_THEY_ARE, ..*object };
    dice_any(frame, patches, record, &stays, draw, grid);
}

/// The mesh of a draw that is diced: `vertices` has room for [`Draw::vertices`], `indices` for three times
/// [`Draw::triangles`].
#[inline(always)]
pub fn mesh(draw: Draw, place: MeshPlace, grid: &Grid, vertices: &mut [MeshVertex], indices: &mut [u32]) {
    for (at, vertex) in vertices.iter_mut().enumerate() {
        *vertex = vertex_at(draw, grid, at);
    }
    for (quad, indices) in indices.chunks_exact_mut(QUAD_INDICES).enumerate() {
        let (row, column) = (quad / draw.rate_u() as usize, quad % draw.rate_u() as usize);
        let a = row * grid.stride + column;
        let [a, b, c, d] = [a, a + 1, a + grid.stride + 1, a + grid.stride];
        indices[..3].copy_from_slice(&triangle(grid, place, [a, b, c]));
        indices[3..].copy_from_slice(&triangle(grid, place, [a, c, d]));
    }
}

#[inline(always)]
fn vertex_at(draw: Draw, grid: &Grid, at: usize) -> MeshVertex {
    let [u, v] = draw.vertex((at / grid.stride) as u32, (at % grid.stride) as u32);
    MeshVertex {
        position: grid.point(at),
        normal: grid.unit_normal(at),
        uv: [param(u), param(v)],
        patch_id: draw.patch_id,
    }
}

/// Indices of a triangle of the grid, or thrice the same one.
#[inline(always)]
fn triangle(grid: &Grid, place: MeshPlace, corners: [usize; 3]) -> [u32; 3] {
    let [a, b, c] = corners.map(|corner| grid.point(corner));
    let [first, second, third] = corners.map(|corner| place.vertex.wrapping_add(corner as u32));
    if a == b || b == c || c == a { [first; 3] } else { [first, second, third] }
}
