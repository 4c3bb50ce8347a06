//! micropoly's stages on the CPU: loops over the functions of `micropoly-core`, spread over threads by
//! rayon. There is no arithmetic here, so the bits are core's, whatever the number of threads.

mod accel;
mod bsp;
mod buffer;
mod device;
mod draw;
mod local;
mod pixels;
mod radix;
mod sort_last;
mod stages;
mod tessellate;
mod trees;

pub use accel::Lbvh;
pub use bsp::{BspError, BspGrid, BspOptions, BspOrder, BspShot, BspSight, Piece};
pub use buffer::CpuBuffer;
pub use device::{CpuDevice, CpuError};
pub use tessellate::{Evaluate, Levels};
