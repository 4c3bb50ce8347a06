//! The stages on an OpenCL device. Not built yet: [`AVAILABLE`] says so, and the program says it too.

/// Whether this backend can render.
pub const AVAILABLE: bool = false;
