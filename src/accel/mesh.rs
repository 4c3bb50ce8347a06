//! The triangles of a mesh file, for trees over them: all of them, however large, small or thin.

use std::path::Path;

use glam::DVec3;

use crate::Camera;
use crate::cage::Cage;
use crate::error::{Error, Result};
use crate::obj;
use crate::picture::extension;
use crate::polygon::{self, PolygonError};
use crate::scene::camera_around;

/// Triangles as a file has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Corners of each. Faces of more corners are divided, holes are left out.
    pub triangles: Vec<[[f32; 3]; 3]>,
    /// What of the file is left out, to be told to the user.
    pub notes: Vec<String>,
}

impl TriangleMesh {
    /// Reads an OBJ file.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Format`] with file and line, or [`Error::Content`] if there is no mesh in it.
    pub fn load(path: &Path) -> Result<Self> {
        let wrong = |what: &str| {
            let problem = format!("trees are built over triangles, and {what}");
            Err(Error::content(path, problem, "give an .obj file of polygons, or tessellate this one first"))
        };
        match extension(path).as_str() {
            "obj" => {}
            "bpt" => return wrong("these are Bézier patches"),
            _ => return wrong("this is no .obj file"),
        }
        let file = obj::load(path)?;
        if file.cage.is_none() && !file.surfaces.is_empty() {
            return wrong("this file has surfaces (`surf`) only");
        }
        let notes = file.notes_as_mesh(path);
        let mesh = file.cage.unwrap_or_default();
        let own = Self::of_mesh(&mesh).map_err(|error| error.in_file(path, &mesh))?;
        Ok(Self { notes, ..own })
    }

    /// Those of a mesh.
    ///
    /// # Errors
    /// [`PolygonError`] if the mesh contradicts itself.
    pub fn of_mesh(mesh: &Cage) -> std::result::Result<Self, PolygonError> {
        let place = |corner: u32| {
            let position = mesh.positions[mesh.corners[corner as usize] as usize];
            position.map(|coordinate| coordinate as f32 + 0.0) // no zero is negative
        };
        let triangles = polygon::triangles(mesh)?.iter().map(|corners| corners.map(place)).collect();
        Ok(Self { triangles, notes: Vec::new() })
    }

    /// The camera that renders the mesh if nobody says otherwise.
    ///
    /// # Errors
    /// [`Error::Scene`] if the triangles lie too far out to be seen.
    pub fn camera(&self) -> Result<Camera> {
        let points = self.triangles.as_flattened().iter().map(|p| DVec3::from(p.map(f64::from)));
        let box_of = points.map(|point| (point, point)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = box_of.unwrap_or_default();
        camera_around(low, high, DVec3::Y)
    }
}
