//! Schedulers as state machines: which stage runs next. They know counts, never surfaces.

pub mod adaptive;
mod bounded;

pub use bounded::{Bounded, Step};
