//! Kinds of patches: evaluation, restriction to a sub-range, eye-space control nets.

pub mod bezier;
pub mod gregory;
pub(crate) mod net;
pub mod owner;

pub use gregory::Faces;
pub use net::Net;
