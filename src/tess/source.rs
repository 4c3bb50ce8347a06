//! Patches to tessellate, from meshes and Bézier patches.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;
use micropoly_core::abi::{TESS_BEZIER, TessFrame, TessPatch};
use micropoly_core::tess::corner::ends;

use super::pattern::Domain;
use crate::cage::Cage;
use crate::error::{Error, Result};
use crate::mesh::weld;
use crate::obj;
use crate::picture::extension;
use crate::polygon::{self, PolygonError};
use crate::scene::camera_around;
use crate::shape::BezierPatch;
use crate::{Camera, bpt};

/// No coordinate is larger, so that all arithmetic of the tessellator stays in range.
const FARTHEST: f64 = (1_u64 << 40) as f64;
/// No texture coordinate is.
const TEXTURE_END: f32 = (1 << 20) as f32;

/// Patches of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TessSource {
    /// The patches.
    pub patches: Vec<TessPatch>,
    /// Are they bicubic, not triangles?
    pub is_bezier: bool,
    /// Do they have texture coordinates, along which heights can be looked up?
    pub has_texture: bool,
    /// What of the file is not used.
    pub notes: Vec<String>,
}

impl TessSource {
    /// Reads a mesh (`.obj`) as triangles, or Bézier patches (`.bpt`).
    ///
    /// # Errors
    /// [`Error::Read`]; [`Error::Format`] with the line; [`Error::Content`] if the file is of another kind.
    pub fn load(path: &Path) -> Result<Self> {
        match extension(path).as_str() {
            "bpt" => of_bpt(path),
            "obj" => of_obj(path),
            _ => {
                let remedy = "choose an .obj or .bpt file, or leave out --levels, --lod and --distance: then scenes are \
                              tessellated as finely as their camera needs";
                Err(Error::content(path, "levels are for meshes and Bézier patches, not for scenes", remedy))
            }
        }
    }

    /// Bicubic patches.
    #[must_use]
    pub fn of_bezier(patches: &[BezierPatch]) -> Self {
        let patch = |patch: &BezierPatch| TessPatch {
            points: bytemuck::cast(patch.points),
            uv: [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0],
            ..TessPatch::default()
        };
        let patches = patches.iter().map(patch).collect();
        Self { patches, is_bezier: true, ..Self::default() }
    }

    /// The triangles of a mesh, faces of more corners divided; holes are left out, and triangles two of whose corners are in the
    /// same place. Normals are means of the triangles at
    /// each place, so that they are the same for all of them.
    ///
    /// # Errors
    /// [`PolygonError`] if the mesh contradicts itself.
    pub fn of_mesh(mesh: &Cage) -> std::result::Result<Self, PolygonError> {
        let mut triangles = polygon::triangles(mesh)?;
        if let Some(vertex) = mesh.positions.iter().position(|p| p.iter().any(|x| x.abs() > FARTHEST)) {
            return Err(PolygonError::Far { vertex });
        }
        let vertices: Vec<[f32; 3]> = mesh.positions.iter().map(|vertex| vertex.map(single)).collect();
        let (places, place_of) = weld::places(&vertices);
        let at = |corner: u32| place_of[mesh.corners[corner as usize] as usize];
        // What has collapsed to a line lets its neighbours meet each other.
        triangles.retain(|triangle| {
            let [a, b, c] = triangle.map(at);
            a != b && b != c && c != a
        });
        let normals = normals(&places, triangles.iter().map(|triangle| triangle.map(at)));
        let uv = |corner: u32| texture(mesh, corner);
        let owners = Owners::of(&triangles, at);
        let patches = triangles
            .iter()
            .map(|triangle| {
                let mut patch = TessPatch::default();
                for (k, &corner) in triangle.iter().enumerate() {
                    let place = at(corner) as usize;
                    patch.points[3 * k..][..3].copy_from_slice(&places[place]);
                    patch.points[12 + 3 * k..][..3].copy_from_slice(&normals[place]);
                    patch.uv[2 * k..][..2].copy_from_slice(&uv(corner));
                    patch.corners[2 * k..][..2].copy_from_slice(&uv(owners.corners[&at(corner)]));
                }
                for edge in 0..3 {
                    let [a, b] = ends(&TessFrame::default(), edge).map(|k| triangle[k as usize]);
                    for (k, corner) in owners.edge(at(a), at(b)).into_iter().enumerate() {
                        patch.edges[4 * edge as usize + 2 * k..][..2].copy_from_slice(&uv(corner));
                    }
                }
                patch
            })
            .collect();
        let has_texture = !mesh.texture.is_empty() && !mesh.texture_corners.is_empty();
        Ok(Self { patches, has_texture, ..Self::default() })
    }

    /// What kind of patches they are.
    #[must_use]
    pub const fn domain(&self) -> Domain {
        if self.is_bezier { Domain::Quads } else { Domain::Triangles }
    }

    /// Must they be evaluated in a certain way?
    pub(crate) const fn evaluation(&self, chosen: u32) -> u32 {
        if self.is_bezier { TESS_BEZIER } else { chosen }
    }

    /// The camera that renders the mesh if nobody says otherwise.
    ///
    /// # Errors
    /// [`Error::Scene`] if the patches lie too far out to be seen.
    pub fn camera(&self) -> Result<Camera> {
        let up = if self.is_bezier { DVec3::Z } else { DVec3::Y };
        let (low, high) = if self.patches.is_empty() { Default::default() } else { self.bounds() };
        camera_around(low, high, up)
    }

    /// The smallest box that has all points; without patches its low end is at infinity, and above its high end.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let count = if self.is_bezier { 48 } else { 9 };
        let points = self.patches.iter().flat_map(|patch| patch.points[..count].chunks_exact(3));
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        points.fold(nothing, |(low, high), p| {
            let point = DVec3::new(p[0].into(), p[1].into(), p[2].into());
            (low.min(point), high.max(point))
        })
    }
}

fn of_bpt(path: &Path) -> Result<TessSource> {
    let patches = bpt::load(path)?;
    let is_far = |patch: &BezierPatch| patch.points.iter().flatten().any(|x| f64::from(x.abs()) > FARTHEST);
    if let Some(patch) = patches.iter().position(is_far) {
        let problem = format!("patch {patch} (counted from 0) has a coordinate beyond {FARTHEST:e}");
        return Err(Error::content(path, problem, "scale the patches down, or mend the file"));
    }
    Ok(TessSource::of_bezier(&patches))
}

fn of_obj(path: &Path) -> Result<TessSource> {
    let file = obj::load(path)?;
    let Some(mesh) = &file.cage else {
        let remedy = "leave out --levels, --lod and --distance: then surfaces are tessellated as finely as the camera needs";
        return Err(Error::content(
            path,
            "levels are for meshes, and this file has surfaces (`surf`) only",
            remedy,
        ));
    };
    let mut source = TessSource::of_mesh(mesh).map_err(|error| error.in_file(path, mesh))?;
    source.notes = file.notes_as_mesh(path);
    Ok(source)
}

/// In single precision; no zero is negative.
fn single(coordinate: f64) -> f32 {
    coordinate as f32 + 0.0
}

/// At each place the mean normal of the triangles there, larger ones counting more; zero where they have none.
pub(super) fn normals(positions: &[[f32; 3]], triangles: impl Iterator<Item = [u32; 3]>) -> Vec<[f32; 3]> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|place| DVec3::from(positions[place as usize].map(f64::from)));
        let twice = (b - a).cross(c - a);
        triangle.into_iter().for_each(|place| sums[place as usize] += twice);
    }
    sums.into_iter().map(|sum| (sum.normalize_or_zero().as_vec3() + glam::Vec3::ZERO).to_array()).collect()
}

/// Texture coordinates of a corner; zero where there are none.
fn texture(mesh: &Cage, corner: u32) -> [f32; 2] {
    let index = mesh.texture_corners.get(corner as usize).copied().unwrap_or(u32::MAX);
    let uv = mesh.texture.get(index as usize).copied().unwrap_or_default();
    uv.map(|t| if t.is_finite() { t.clamp(-TEXTURE_END, TEXTURE_END) } else { 0.0 })
}

/// Which triangle says where heights are looked up on an edge or at a corner: the first that has it. Texture coordinates
/// may be torn there, and heights must not be.
struct Owners {
    /// Corners at which the owner has the ends of an edge, which is named by its places, the smaller one first.
    edges: HashMap<[u32; 2], [u32; 2]>,
    corners: HashMap<u32, u32>,
}

impl Owners {
    fn of(triangles: &[[u32; 3]], at: impl Fn(u32) -> u32) -> Self {
        let mut owners = Self { edges: HashMap::new(), corners: HashMap::new() };
        for &[a, b, c] in triangles {
            for corner in [a, b, c] {
                owners.corners.entry(at(corner)).or_insert(corner);
            }
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let ends = if at(from) < at(to) { [from, to] } else { [to, from] };
                owners.edges.entry(ends.map(&at)).or_insert(ends);
            }
        }
        owners
    }

    /// Corners at which the owner of an edge has its ends.
    fn edge(&self, from: u32, to: u32) -> [u32; 2] {
        if from < to {
            self.edges[&[from, to]]
        } else {
            let [a, b] = self.edges[&[to, from]];
            [b, a]
        }
    }
}
