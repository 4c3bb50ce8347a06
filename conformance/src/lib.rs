//! Do all devices give the same bits?
//!
//! A [`Case`] is a scene as devices read it. [`run`] renders it on any device and gives an [`Outcome`]: a
//! hash of every sample and colour, bit by bit, and all counts. Outcomes of two devices, batches or thread
//! counts must be equal; snapshots of them are kept with the tests, one for all backends.

pub mod corpus;
pub mod headers;
pub mod mirrors;
pub mod mutation;
mod outcome;
pub mod report;
pub mod stages;
pub mod trial;
mod witness;

pub use outcome::{Case, Outcome, Schedule, run, run_scheduled};
