//! Kinds of patches: evaluation, restriction to a sub-range, eye-space control nets.

pub mod bezier;
pub mod gregory;
pub mod half;
pub mod instance;
pub(crate) mod net;
pub mod owner;
pub mod rational;

pub use gregory::Faces;
pub use net::{Net, Range, range_of};
pub use rational::Weights;
