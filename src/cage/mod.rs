//! Cages: polygon meshes whose Catmull-Clark limit surfaces are drawn.

mod accuracy;
mod convert;
mod dart;
mod eigen;
mod error;
mod eval;
mod fan;
pub mod generate;
mod gregory;
mod level;
mod limit;
mod masks;
mod net;
mod origin;
mod refine;
mod regular;
mod sector;
mod start;
mod tags;
mod tangents;
mod texture;
mod topology;

pub use convert::{MOST_LEVELS, Options, Patches, convert};
pub use error::CageError;
pub use eval::{Evaluation, Evaluator};
pub use origin::Origin;
pub use texture::TextureMap;

/// How the surface ends where the cage has a boundary; OpenSubdiv's names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// Faces with a vertex on the boundary are not drawn: they only shape the others.
    None,
    /// The surface ends in a smooth curve along the boundary.
    EdgeOnly,
    /// As `EdgeOnly`, and it reaches vertices that have one face only.
    #[default]
    EdgeAndCorner,
}

/// An edge that is sharp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crease {
    /// Its two vertices.
    pub vertices: [u32; 2],
    /// How many levels of refinement it stays sharp; [`INFINITELY_SHARP`] or more = for ever.
    pub sharpness: f32,
}

/// Sharpness that never decays; OpenSubdiv's.
pub const INFINITELY_SHARP: f32 = 10.0;

/// A polygon mesh, and how sharp it is where.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cage {
    /// Positions of the vertices.
    pub positions: Vec<[f64; 3]>,
    /// Number of corners of each face, 3 or more.
    pub face_sizes: Vec<u32>,
    /// The vertex at each corner, face after face.
    pub corners: Vec<u32>,
    /// Texture coordinates; may be empty.
    pub texture: Vec<[f32; 2]>,
    /// Which of them each corner has; empty, or as long as `corners`.
    pub texture_corners: Vec<u32>,
    /// Sharp edges.
    pub creases: Vec<Crease>,
    /// Sharp vertices, and how sharp they are.
    pub sharp_vertices: Vec<(u32, f32)>,
    /// Faces that are not drawn, but shape the others.
    pub holes: Vec<u32>,
    /// How the surface ends.
    pub boundary: Boundary,
    /// The line of the file on which each face is; may be empty. For messages only.
    pub face_lines: Vec<u32>,
}
