//! micropoly: a Reyes micropolygon renderer that gives the same bits on every device.
//!
//! ```no_run
//! use micropoly::{RenderOptions, Scene};
//!
//! # fn main() -> micropoly::Result<()> {
//! let scene = Scene::load("scenes/teapot.toml")?;
//! let rendering = micropoly::render(&scene, &RenderOptions::default(), |_| {})?;
//! rendering.image.save_png("teapot.png".as_ref())?;
//! println!("{} surfaces drawn", rendering.counts.drawn);
//! # Ok(())
//! # }
//! ```
//!
//! This crate holds what a host needs around the kernels: scenes and their files, images, statistics and
//! the choice of a device. The kernels and the plans that run them are in [`core`].

#[cfg(feature = "cpu")]
pub mod accel;
mod backend;
pub mod bench;
pub mod bpt;
#[cfg(feature = "cpu")]
pub mod bsp;
pub mod cage;
pub mod cage_bench;
mod canvas;
pub mod cull;
pub mod culling;
pub mod curve;
pub mod devices;
pub mod dicing;
pub mod diff;
pub mod error;
mod film;
pub mod generate;
mod geometry;
mod gregory;
mod image;
pub mod looks;
pub mod mesh;
pub mod mscene;
pub mod nurbs;
pub mod obj;
#[cfg_attr(not(feature = "cpu"), path = "order_without.rs")]
mod order;
mod passes;
mod path;
mod picture;
pub mod polygon;
pub mod quadric;
pub mod rasterising;
mod records;
mod render;
pub mod rib;
mod scene;
pub mod scene_file;
mod shape;
mod shot;
pub mod stats;
pub mod tess;
mod timed;

#[cfg(feature = "wgpu")]
pub use micropoly_backend_wgpu as backend_wgpu;
pub use micropoly_core as core;

pub use crate::backend::{Backend, render, render_frames};
pub use crate::core::camera::{
    Borders, Camera, FrameOptions, Light, Material, Oracle, Profile, Rasteriser, Shading,
};
pub use crate::core::pattern::{Samples, Window};
pub use crate::core::reconstruction::{Filter, Kernel};
pub use crate::core::render::Counts;
pub use crate::core::schedule::Scheduler;
pub use crate::error::{Error, Result};
pub use crate::film::{Film, Precision};
pub use crate::geometry::{ReadProgress, Reading};
pub use crate::gregory::GregoryPatch;
pub use crate::image::Image;
pub use crate::path::{CameraKey, CameraPath};
pub use crate::picture::{Picture, extension};
pub use crate::render::{
    Batch, Ordering, Progress, RenderOptions, Rendering, Transparency, render_on, sizes_for,
};
pub use crate::scene::{DeviceScene, Motion, Scene, SceneObject};
pub use crate::shape::{BezierPatch, HalfSide, RationalPatch, Shape};
pub use crate::shot::{Blur, Lens, Shot};
pub use crate::timed::Seconds;
