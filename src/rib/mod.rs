//! Scenes in RenderMan's Interface Bytestream (`.rib`), ASCII: what of it can be drawn here (RenderMan Interface 3.2).
//!
//! What cannot is left out with a warning, once for each kind of it; what would give another picture than is meant, and
//! cannot be told apart from it, is an error.

mod archive;
mod blocks;
mod camera;
mod curves;
mod geometry;
mod lexer;
pub mod lower;
mod model;
mod parameters;
mod patches;
mod place;
mod polygons;
mod quadrics;
mod reader;
mod request;
mod shading;
mod state;
mod strings;
mod subdivision;
#[cfg(test)]
mod tests;
mod transforms;
mod view;
mod warnings;

use std::path::Path;

pub use camera::{RibCamera, RibLens};
pub use model::{
    RibBasis, RibCurve, RibCurves, RibGeometry, RibLight, RibLightKind, RibNuPatch, RibObject, RibPatches,
    RibQuadric, RibScene, RibSurface,
};
pub use place::Place;

use crate::error::{Result, read_bytes};
use crate::scene::Scene;

/// Reads a file and the archives it names.
///
/// # Errors
/// [`Error::Read`](crate::Error::Read), or [`Error::Format`](crate::Error::Format) with file and line.
pub fn load(path: &Path) -> Result<RibScene> {
    parse_bytes(path, &read_bytes(path)?)
}

/// Reads a file as a scene. Cages are refined so often around what is not regular.
///
/// # Errors
/// As [`load`], and [`Error::Format`](crate::Error::Format) for geometry that cannot be drawn.
pub fn load_scene(path: &Path, levels: u32) -> Result<Scene> {
    lower::scene(path.display().to_string(), &load(path)?, levels)
}

/// Reads a scene from bytes; archives that it names are looked for beside `path`.
///
/// # Errors
/// [`Error::Read`](crate::Error::Read), or [`Error::Format`](crate::Error::Format) with file and line.
pub fn parse_bytes(path: &Path, bytes: &[u8]) -> Result<RibScene> {
    let lexer = lexer::Lexer::new(path.into(), bytes)?;
    let mut reader = reader::Reader::new(path);
    reader.run(lexer.clone())?;
    reader.finish(&lexer)
}
