//! `micropoly tessellate --levels`: a mesh by levels or levels of detail, not as finely as a camera needs it.

use std::path::PathBuf;
use std::time::Instant;

use bytesize::ByteSize;
use clap::{ArgGroup, Args, ValueEnum};
use glam::DVec3;
use micropoly::tess::{
    Control, Evaluation, HeightMap, Profile, Spacing, TessOptions, TessSource, tessellate,
};
use micropoly::{Error, Result};

use super::args::{TessellateArguments, bytes};
use super::render::check_folder;

#[derive(Debug, Args)]
#[command(next_help_heading = "Meshes by levels")]
#[command(group = ArgGroup::new("by_levels").args(["levels", "lod", "distance"]))]
#[command(group = ArgGroup::new("by_eye").args(["lod", "distance"]))]
pub(crate) struct LevelArguments {
    /// Divide all edges of the mesh into so many segments (a level: 1 to 64, clamped and rounded as OpenGL does), instead of
    /// as finely as a camera needs it.
    #[arg(long, value_name = "LEVEL", allow_negative_numbers = true, conflicts_with = "by_scene")]
    levels: Option<f32>,
    /// Divide each edge of the mesh into segments about so many pixels long, in the image of --res, but into no more than 64.
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = above_zero, conflicts_with = "by_scene")]
    lod: Option<f32>,
    /// Divide each edge of the mesh into so many segments at distance 1 from the eye, half as many at distance 2, and so on, but
    /// into no more than 64.
    #[arg(long, value_name = "LEVEL", allow_negative_numbers = true, value_parser = above_zero, conflicts_with = "by_scene")]
    distance: Option<f32>,
    /// Where the eye is, for --lod and --distance. [default: where the camera stands that renders the mesh]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point, requires = "by_eye")]
    eye: Option<DVec3>,
    /// How segments are spaced.
    #[arg(long, value_enum, default_value_t = SpacingChoice::Equal, requires = "by_levels")]
    spacing: SpacingChoice,
    /// Whose rule places points: that of Direct3D 11, bit by bit, or Stadlbauer's.
    #[arg(long, value_enum, default_value_t = ProfileChoice::D3d11, requires = "by_levels")]
    tess_profile: ProfileChoice,
    /// Where points of triangles are; Bézier patches (.bpt) are what they are.
    #[arg(long, value_enum, default_value_t = EvaluationChoice::Linear, requires = "by_levels")]
    evaluation: EvaluationChoice,
    /// Move points along their normals by this picture (.png, .exr), which is looked up by the mesh's texture coordinates.
    #[arg(long, value_name = "FILE", requires = "by_levels")]
    heightmap: Option<PathBuf>,
    /// How far a white pixel, or the height 1, moves them.
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "1",
        allow_negative_numbers = true,
        requires = "heightmap"
    )]
    scale: f32,
    /// Memory of the device, patches included; the mesh comes in as many chunks as it takes.
    #[arg(long, value_name = "BYTES", default_value = "256MiB", value_parser = bytes, requires = "by_levels")]
    memory: u64,
}

impl LevelArguments {
    /// Are levels asked for?
    pub(crate) const fn are_given(&self) -> bool {
        self.levels.is_some() || self.lod.is_some() || self.distance.is_some()
    }

    fn control(&self, source: &TessSource, height: u32) -> Result<Control> {
        Ok(match (self.levels, self.lod, self.distance) {
            (Some(level), ..) => Control::Level(level),
            (_, Some(pixels), _) => Control::Pixels { pixels, focal: source.camera()?.focal(height) },
            (.., distance) => Control::Distance(distance.unwrap_or(1.0)),
        })
    }

    fn heights(&self) -> Result<Option<(HeightMap, f32)>> {
        let Some(path) = &self.heightmap else { return Ok(None) };
        Ok(Some((HeightMap::load(path)?, self.scale)))
    }
}

pub(crate) fn run(arguments: &TessellateArguments) -> Result<()> {
    let start = Instant::now();
    let (path, format) = &arguments.output;
    if format.is_some() {
        check_folder(path)?;
    }
    let levels = &arguments.levels;
    let source = TessSource::load(&arguments.scene.scene)?;
    let options = TessOptions {
        control: levels.control(&source, arguments.res.1)?,
        eye: levels.eye,
        spacing: levels.spacing.into(),
        profile: levels.tess_profile.into(),
        evaluation: levels.evaluation.into(),
        heights: levels.heights()?,
        memory: levels.memory,
        backend: arguments.backend.into(),
        device: arguments.device.clone(),
        threads: 0,
    };
    let done = tessellate(&source, &options, format.is_some() || arguments.check)?;
    for note in source.notes.iter().chain(&done.notes) {
        eprintln!("note: {note}");
    }
    if source.is_bezier && levels.evaluation != EvaluationChoice::Linear {
        eprintln!("note: --evaluation is for triangles, and these are Bézier patches");
    }
    if let (Some(mesh), Some(format)) = (&done.mesh, format) {
        mesh.save(path, *format)?;
        eprintln!("mesh          {}", path.display());
    }
    eprintln!("patches       {}", source.patches.len());
    eprintln!("vertices      {}", done.counts.vertices);
    // Those of no area are not in a file.
    let kept = done.mesh.as_ref().map_or(done.counts.primitives, |mesh| mesh.triangles.len() as u64);
    eprintln!("triangles     {kept}");
    eprintln!("chunks        {} of at most {}", done.counts.chunks, ByteSize(levels.memory).display().iec());
    if let (true, Some(mesh)) = (arguments.check, &done.mesh) {
        eprintln!("open edges    {}", mesh.open_edges());
    }
    eprintln!("device        {:.3} s", done.seconds);
    eprintln!("seconds       {:.3}", start.elapsed().as_secs_f64());
    Ok(())
}

/// What `tessellate` must not be asked for without levels.
pub(crate) fn needs_levels(mesh: &str) -> Error {
    Error::scene(
        format!("`-o {mesh}` writes no mesh, and only --levels, --lod and --distance go without one"),
        "choose a name that ends in .obj, .ply or .glb",
    )
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SpacingChoice {
    /// Levels are rounded up; all segments of an edge are equally long.
    Equal,
    /// An even number of segments; two of them grow with the level.
    FractionalEven,
    /// An odd number of segments; two of them grow with the level.
    FractionalOdd,
}

impl From<SpacingChoice> for Spacing {
    fn from(choice: SpacingChoice) -> Self {
        match choice {
            SpacingChoice::Equal => Self::Equal,
            SpacingChoice::FractionalEven => Self::FractionalEven,
            SpacingChoice::FractionalOdd => Self::FractionalOdd,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProfileChoice {
    /// Direct3D 11's reference tessellator, bit by bit.
    D3d11,
    /// Stadlbauer 2019.
    Stadlbauer,
}

impl From<ProfileChoice> for Profile {
    fn from(choice: ProfileChoice) -> Self {
        match choice {
            ProfileChoice::D3d11 => Self::D3d11,
            ProfileChoice::Stadlbauer => Self::Stadlbauer,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EvaluationChoice {
    /// On the flat triangle.
    Linear,
    /// On its PN triangle: round where normals differ.
    Pn,
    /// By Phong tessellation: the same more cheaply.
    Phong,
}

impl From<EvaluationChoice> for Evaluation {
    fn from(choice: EvaluationChoice) -> Self {
        match choice {
            EvaluationChoice::Linear => Self::Linear,
            EvaluationChoice::Pn => Self::Pn,
            EvaluationChoice::Phong => Self::Phong,
        }
    }
}

fn above_zero(text: &str) -> std::result::Result<f32, String> {
    let number = text.parse().ok().filter(|x: &f32| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| "give a number above 0".to_owned())
}

fn point(text: &str) -> std::result::Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|x| x.trim().parse().ok()).collect();
    match (numbers.as_slice(), text.split(',').count()) {
        (&[x, y, z], 3) if numbers.iter().all(|x| x.abs() <= 1.0e9) => Ok(DVec3::new(x, y, z)),
        _ => Err("write three numbers, for example 0,1.5,4".into()),
    }
}
