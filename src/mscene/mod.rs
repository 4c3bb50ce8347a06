//! Scenes as Weber's Micropolis (2014) keeps them (`.mscene`): one packed Cap'n Proto message, whose schema is
//! `mscene.capnp`.
//!
//! What such a file does not say is as in a scene file that leaves it out: a black background, a little ambient
//! light, no highlights. Names are for messages only, but for those of meshes, by which objects find theirs.

mod lower;
mod model;
// Generated; `mscene.capnp` says how.
#[rustfmt::skip]
#[allow(clippy::all, clippy::disallowed_methods, clippy::unwrap_used)]
#[allow(missing_docs, unreachable_pub, unsafe_code, dead_code)]
mod mscene_capnp;
mod packing;
mod place;
mod read;

use std::path::Path;

pub use model::{CameraEntry, LightEntry, LightType, Mesh, MeshPatches, Mscene, ObjectEntry, Placement};

use crate::error::{Result, read_bytes};
use crate::scene::Scene;

/// Reads a scene.
///
/// # Errors
/// [`Error::Read`](crate::Error::Read), or [`Error::Content`](crate::Error::Content) that names the mesh, object,
/// light or camera.
pub fn load(path: &Path) -> Result<Scene> {
    parse_bytes(path, &read_bytes(path)?)
}

/// Reads a scene from bytes; `path` is for messages and the scene's name only.
///
/// # Errors
/// [`Error::Content`](crate::Error::Content) that names the mesh, object, light or camera.
pub fn parse_bytes(path: &Path, bytes: &[u8]) -> Result<Scene> {
    lower::scene(path, &read_contents(path, bytes)?)
}

/// Reads what the file says, with meshes of every type, whether or not they can be drawn.
///
/// # Errors
/// [`Error::Content`](crate::Error::Content) that names the mesh, object, light or camera.
pub fn read_contents(path: &Path, bytes: &[u8]) -> Result<Mscene> {
    read::contents(path, &packing::unpacked(path, bytes)?)
}
