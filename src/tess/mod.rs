//! The tessellation stage for meshes: levels or a level of detail in, triangles out, as many as there are.

pub mod chunk;
pub mod pattern;
