//! The tessellation stage for meshes: levels or a level of detail in, triangles out, as many as there are.

mod bench;
pub mod chunk;
mod height;
mod outcome;
pub mod pattern;
mod source;

use std::cell::RefCell;
use std::time::Instant;

use glam::DVec3;
use micropoly_core::abi::{
    TESS_CONSTANT, TESS_DISTANCE, TESS_LENGTH, TESS_LINEAR, TESS_PHONG, TESS_PN, TessFrame,
};
use micropoly_core::backend::Device;
use micropoly_core::tess::stream::{TessCounts, TessInput};

use crate::backend::{Backend, on_first_device};
use crate::devices::{Job, with_device};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::render::RenderOptions;

pub use bench::{LEVELS, Row, measure};
pub use height::HeightMap;
pub use pattern::{Profile, Spacing};
pub use source::TessSource;

use chunk::{count, each_chunk_of};
use outcome::Outcome;

/// Which levels patches get.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// All the same one.
    Level(f32),
    /// Edges become segments about so many pixels long, seen from the eye, but no more than 64.
    Pixels {
        /// Length of a segment.
        pixels: f32,
        /// Focal length of the camera, in pixels.
        focal: f64,
    },
    /// So much, divided by the distance of the edge from the eye.
    Distance(f32),
}

/// Where the points of triangles are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Evaluation {
    /// On the triangle.
    #[default]
    Linear,
    /// On its PN triangle (Vlachos et al. 2001).
    Pn,
    /// By Phong tessellation (Boubekeur and Alexa 2008).
    Phong,
}

/// How to tessellate.
#[derive(Clone, Debug, PartialEq)]
pub struct TessOptions {
    /// Which levels patches get.
    pub control: Control,
    /// Where the eye is; none = where the camera stands from which the mesh would be rendered.
    pub eye: Option<DVec3>,
    /// How segments are spaced.
    pub spacing: Spacing,
    /// How points are placed.
    pub profile: Profile,
    /// Where the points of triangles are.
    pub evaluation: Evaluation,
    /// Heights, and how long the height 1 is.
    pub heights: Option<(HeightMap, f32)>,
    /// Bytes of the device's memory; the mesh comes in as many chunks as it takes.
    pub memory: u64,
    /// What tessellates. The mesh does not depend on it.
    pub backend: Backend,
    /// Number or part of the name of a device of the backend.
    pub device: Option<String>,
    /// Threads of the CPU backend; 0 = one a core.
    pub threads: usize,
}

impl Default for TessOptions {
    fn default() -> Self {
        Self {
            control: Control::Level(8.0),
            eye: None,
            spacing: Spacing::Equal,
            profile: Profile::default(),
            evaluation: Evaluation::default(),
            heights: None,
            memory: 256 << 20,
            backend: Backend::default(),
            device: None,
            threads: 0,
        }
    }
}

/// What became of a tessellation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellated {
    /// The mesh, if it was asked for.
    pub mesh: Option<Mesh>,
    /// What it comes to.
    pub counts: TessCounts,
    /// Seconds from the first buffer to the end of the last chunk: compiling what the device needs, and reading, included.
    pub seconds: f64,
    /// What a user should be told.
    pub notes: Vec<String>,
}

/// Tessellates; without `wants_mesh` the mesh stays on the device, chunk after chunk, and is only counted.
///
/// # Errors
/// [`Error::Scene`] if the source has not got what the options ask for, or every patch is dropped; [`Error::Plan`],
/// [`Error::Backend`], [`Error::Refused`], [`Error::Device`].
pub fn tessellate(source: &TessSource, options: &TessOptions, wants_mesh: bool) -> Result<Tessellated> {
    let frame = frame(source, options)?;
    let heights = options.heights.as_ref().map_or(&[][..], |(map, _)| &map.heights);
    let input = TessInput { frame, patches: &source.patches, levels: &[], heights };
    let devices = RenderOptions {
        backend: options.backend,
        device: options.device.clone(),
        ..RenderOptions::default()
    };
    let (done, notes) = on_first_device(&devices, |entry| {
        with_device(
            entry,
            options.threads,
            Tessellate { input: &input, memory: options.memory, wants_mesh, is_textured: source.has_texture },
        )
    })?;
    let done = done?;
    if done.counts.vertices == 0 && !source.patches.is_empty() {
        return Err(Error::scene(
            "every patch is dropped, as its levels are not above 0",
            "choose levels from 1 to 64",
        ));
    }
    Ok(Tessellated { notes, ..done })
}

/// What all patches have in common.
fn frame(source: &TessSource, options: &TessOptions) -> Result<TessFrame> {
    let mut frame = TessFrame {
        domain: source.domain().code(),
        spacing: options.spacing.code(),
        flags: options.profile.flag(),
        evaluation: source.evaluation(match options.evaluation {
            Evaluation::Linear => TESS_LINEAR,
            Evaluation::Pn => TESS_PN,
            Evaluation::Phong => TESS_PHONG,
        }),
        phong: PHONG,
        ..TessFrame::default()
    };
    if let Some((map, scale)) = &options.heights {
        check_heights(source, *scale)?;
        (frame.columns, frame.rows, frame.scale) = (map.columns, map.rows, *scale);
    }
    (frame.control, frame.factor) = match options.control {
        Control::Level(level) => {
            (frame.outer, frame.inner) = ([level; 4], [level; 2]);
            (TESS_CONSTANT, 0.0)
        }
        Control::Pixels { pixels, focal } => (TESS_LENGTH, (focal / f64::from(pixels)) as f32),
        Control::Distance(factor) => (TESS_DISTANCE, factor),
    };
    if frame.control != TESS_CONSTANT && !(1.0e-6..=1.0e9).contains(&frame.factor) {
        return Err(Error::scene("levels of detail are out of range", "choose a number nearer to 1"));
    }
    if frame.control != TESS_CONSTANT {
        frame.eye = eye(source, options)?.as_vec3().to_array();
    }
    Ok(frame)
}

/// What Boubekeur and Alexa 2008 recommend.
const PHONG: f32 = 0.75;

fn eye(source: &TessSource, options: &TessOptions) -> Result<DVec3> {
    match options.eye {
        Some(eye) => Ok(eye),
        None => Ok(source.camera()?.view.inverse().translation),
    }
}

fn check_heights(source: &TessSource, scale: f32) -> Result<()> {
    if source.is_bezier {
        let problem = "a height map needs normals that patches share, which Bézier patches have not";
        return Err(Error::scene(problem, "tessellate them to a mesh first, or leave the height map out"));
    }
    if !source.has_texture {
        let problem =
            "a height map needs texture coordinates (`vt`), which the mesh has not, or not at all corners";
        return Err(Error::scene(problem, "add them to the mesh, or leave the height map out"));
    }
    let is_possible = scale.abs() <= 1.0e6;
    if !is_possible {
        return Err(Error::scene(
            "heights are scaled by too much",
            "choose a scale from -1000000 to 1000000",
        ));
    }
    Ok(())
}

/// Tessellating, as a job for any device.
struct Tessellate<'a> {
    input: &'a TessInput<'a>,
    memory: u64,
    wants_mesh: bool,
    is_textured: bool,
}

impl Job for Tessellate<'_> {
    type Output = Result<Tessellated>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        let Self { input, memory, wants_mesh, is_textured } = self;
        let start = Instant::now();
        if !wants_mesh {
            let counts = count(&mut device, input, memory)?;
            return Ok(Tessellated {
                counts,
                seconds: start.elapsed().as_secs_f64(),
                ..Tessellated::default()
            });
        }
        let outcome = RefCell::new(Outcome::default());
        let counts = each_chunk_of(
            &mut device,
            input,
            memory,
            |counts| outcome.borrow_mut().reserve(counts),
            |chunk| {
                outcome.borrow_mut().add(&chunk);
                Ok(())
            },
        )?;
        let seconds = start.elapsed().as_secs_f64();
        let mesh = Some(outcome.into_inner().finish(input.frame.columns > 0, is_textured));
        Ok(Tessellated { mesh, counts, seconds, notes: Vec::new() })
    }
}
