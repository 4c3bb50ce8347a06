//! Kinds of patches: evaluation, restriction to a sub-range, eye-space control nets.

pub mod bezier;
pub(crate) mod net;

pub use net::Net;
