//! micropoly's stages on OpenCL devices: kernels that mirror `micropoly-core` function by function.
//!
//! `src/kernel` has a file for each of core's, and some for the kernels into which the fused stage is cut.
//! Nothing in them rounds but the functions of `num.cl`, without fusing ([`OpenOptions::barrier`] enforces that
//! whatever the compiler is told), so the bits are core's.
//! The OpenCL library is loaded at run time: without one everything ends in [`OclError::NoDriver`].

mod buffer;
mod chunk;
mod device;
mod error;
mod list;
mod program;

pub use buffer::OclBuffer;
pub use device::{Edit, OclDevice, OpenOptions};
pub use error::OclError;
pub use list::{DeviceInfo, devices};
pub use program::{ACCEL_FILES, Argument, FILES, Kind, Part, TESS_FILES, Which};
