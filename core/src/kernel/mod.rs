//! One pure function a stage, one stage a file; device kernels mirror them by name.
#![deny(clippy::float_arithmetic)]

pub mod balance;
pub mod blend;
pub mod bound;
pub mod bound_lanes;
pub mod clip;
pub mod deal;
pub mod dense;
pub mod dice;
pub mod dice_any;
pub mod dice_gregory;
pub mod dice_rational;
pub mod displace;
pub mod filter;
pub mod flat;
pub mod known_answers;
pub mod local;
pub mod mesh;
pub mod project;
pub mod quads;
pub mod sample;
pub mod scan;
pub mod shade;
pub mod sides;
pub mod sort_last;
pub mod split;
pub mod take;
pub mod tess_control;
pub mod tess_evaluate;
pub mod tess_places;
pub mod triangle;
pub mod weber;
