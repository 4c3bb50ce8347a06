//! Schedulers as state machines: which stage runs next. They know counts, never surfaces.

mod bounded;

pub use bounded::{Bounded, Step};
