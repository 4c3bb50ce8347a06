//! micropoly's stages on a GPU through wgpu: WGSL mirrors of the functions of `micropoly-core`, bit for bit.
//!
//! Each kernel file in `src/kernel` mirrors the file of the same name in core. A device that rounds, fuses or
//! flushes otherwise than core does is refused when it is opened.

mod buffer;
mod chunk;
mod device;
mod error;
mod info;
mod kernels;

pub use buffer::WgpuBuffer;
pub use device::WgpuDevice;
pub use error::WgpuError;
pub use info::{DeviceInfo, devices};
pub use kernels::{Edit, File, Kind, Which};
pub use wgpu;
