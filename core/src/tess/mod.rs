//! The tessellation stage of OpenGL, Vulkan and Direct3D 11, which WebGPU has not got: levels in, vertices and triangles out.
//!
//! | step | file |
//! |---|---|
//! | levels as asked for become levels as used | `level.rs` |
//! | a level divides a line | `division.rs` |
//! | which vertices and triangles there are, and what each is | `topology.rs`, `strip.rs` |
//! | control: which levels a patch has | `control.rs`, `corner.rs` |
//! | evaluation: where its points are | `evaluate.rs`, `surface.rs` |
//! | all patches, chunk by chunk | `stream.rs` |

pub mod control;
pub mod corner;
pub mod division;
pub mod evaluate;
pub mod level;
pub mod stream;
pub mod strip;
pub mod surface;
pub mod topology;
