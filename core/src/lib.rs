//! The heart of micropoly: a Reyes pipeline as pure functions over plain structs.
//!
//! No `std`, no allocator, no threads, no I/O: callers bring the memory, backends bring the loops.
//! The way one frame takes, and where each step lives:
//!
//! | step | function | file |
//! |---|---|---|
//! | camera and scene become plain structs | [`camera::Camera::frame`] | `camera.rs`, [`abi`] |
//! | the next batch: the top of the stack, and roots, one a patch | [`kernel::take::take`] | `kernel/take.rs` |
//! | cull, draw or split, decided conservatively | [`kernel::bound::bound`] | `kernel/bound.rs` |
//! | the same by the rules of Weber's program | [`kernel::weber::code`] | `kernel/weber.rs` |
//! | where each child and each drawn surface goes | [`kernel::scan::scan`] | `kernel/scan.rs` |
//! | children back to the stack, the rest to be drawn | [`kernel::split::split`] | `kernel/split.rs` |
//! | a drawn surface becomes a grid of vertices | [`kernel::dice::dice`] | `kernel/dice.rs` |
//! | the same for a Gregory patch | [`kernel::dice_gregory::dice_gregory`] | `kernel/dice_gregory.rs`, `patch/gregory.rs` |
//! | the same where vertices are displaced | [`kernel::displace::dice_displaced`] | `kernel/displace.rs`, `patch/owner.rs` |
//! | a colour a vertex | [`kernel::shade::shade`] | `kernel/shade.rs` |
//! | where samples lie, in space, in time and on the lens | [`abi::Frame::with_region`] | `pattern.rs` |
//! | micropolygons become samples | [`kernel::sample::sample`] | `kernel/sample.rs`, `kernel/dense.rs` |
//! | layers that can be seen through are put together | [`kernel::blend::blend`] | `kernel/blend.rs` |
//! | samples become pixels | [`kernel::filter::filter`] | `kernel/filter.rs`, `reconstruction.rs` |
//! | who calls what, in which order | [`schedule::Bounded`], [`render::FramePlan`] | `schedule/`, `render.rs` |
//! | which samples a whole patch can touch, and how near it is | [`cull::Sight::of_patch`] | `cull.rs` |
//! | how much memory that can ever need | [`memory`] | `memory.rs` |
//! | the tessellation stage that WebGPU has not got | [`tess`], [`kernel::tess_evaluate`] | `tess/`, `kernel/tess_*.rs` |
//! | does a device compute as it must | [`known::check`] | `known.rs`, `kernel/known_answers.rs` |
//! | what a backend must bring | [`backend::Device`] | `backend.rs` |
//!
//! All kernel arithmetic goes through [`num`], so that every device computes the same bits.
#![no_std]

pub mod abi;
pub mod accel;
pub mod adjacency;
pub mod backend;
pub mod border;
pub mod camera;
pub mod cull;
pub mod displacement;
pub mod error;
pub mod kernel;
pub mod known;
pub mod memory;
pub mod num;
pub mod patch;
pub mod pattern;
pub mod reconstruction;
pub mod render;
pub mod schedule;
pub mod stage;
pub mod surface;
pub mod tess;
pub mod tessellate;
