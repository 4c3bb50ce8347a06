//! What the tessellator makes of levels, as text: one JSON object a line in, one out.
//!
//! It is the form in which what fixed-function tessellators generate can be captured, so that they can be compared.

use std::collections::HashMap;
use std::path::Path;

use micropoly_core::abi::{
    TESS_COORDINATES, TESS_EQUAL, TESS_EVEN, TESS_GIVEN, TESS_ISOLINES, TESS_ODD, TESS_QUADS,
    TESS_STADLBAUER, TESS_TRIANGLES, TESS_UNIT, TessFrame, TessLevels, TessPatch, TessVertex,
};
use micropoly_core::backend::Device;
use micropoly_core::tess::level::level_counts;
use micropoly_core::tess::stream::TessInput;
use serde::{Deserialize, Serialize};

use super::chunk::each_chunk;
use crate::backend::{Backend, on_first_device};
use crate::devices::{Job, with_device};
use crate::error::{Error, Result};
use crate::render::RenderOptions;

/// Memory for what is made of a batch of questions.
const MEMORY: u64 = 64 << 20;

/// A kind of patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// Triangles.
    Triangles,
    /// Quadrilaterals.
    Quads,
    /// Rows of lines.
    Isolines,
}

/// How segments are spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// All are equally long.
    Equal,
    /// Even in number.
    FractionalEven,
    /// Odd in number.
    FractionalOdd,
}

/// How points are placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Profile {
    /// As Direct3D 11 does it, bit by bit.
    #[default]
    D3d11,
    /// As Stadlbauer 2019 does it.
    Stadlbauer,
}

impl Domain {
    /// Its number in a frame.
    #[must_use]
    pub const fn code(self) -> u32 {
        match self {
            Self::Triangles => TESS_TRIANGLES,
            Self::Quads => TESS_QUADS,
            Self::Isolines => TESS_ISOLINES,
        }
    }
}

impl Spacing {
    /// Its number in a frame.
    #[must_use]
    pub const fn code(self) -> u32 {
        match self {
            Self::Equal => TESS_EQUAL,
            Self::FractionalEven => TESS_EVEN,
            Self::FractionalOdd => TESS_ODD,
        }
    }
}

impl Profile {
    /// Its bit in a frame.
    #[must_use]
    pub const fn flag(self) -> u32 {
        if matches!(self, Self::Stadlbauer) { TESS_STADLBAUER } else { 0 }
    }
}

/// A level: a number, or one that JSON has no word for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum Level {
    Number(f64),
    Word(String),
}

impl Level {
    fn value(&self) -> Option<f32> {
        match self {
            Self::Number(value) => Some(*value as f32),
            Self::Word(word) => match word.to_lowercase().as_str() {
                "nan" => Some(f32::NAN),
                "inf" | "+inf" => Some(f32::INFINITY),
                "-inf" => Some(f32::NEG_INFINITY),
                _ => None,
            },
        }
    }
}

/// A patch that is asked about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Question {
    domain: Domain,
    spacing: Spacing,
    #[serde(default)]
    inner: Vec<Level>,
    outer: Vec<Level>,
}

/// What becomes of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    #[serde(flatten)]
    question: Question,
    /// Distinct coordinates in units of 2⁻¹⁶.
    pub verts: Vec<Vec<u32>>,
    /// Their indices, three a triangle and two a line.
    pub prims: Vec<u32>,
    /// In point mode: so many, each once; or which.
    pub points: Points,
}

/// What point mode emits.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Points {
    /// All distinct coordinates in their order.
    All(u32),
    /// These.
    Listed(Vec<u32>),
}

/// Reads a question a line; empty lines are none.
///
/// # Errors
/// [`Error::Format`] with the line that is wrong; `name` stands for the file.
pub fn questions(text: &str, name: &Path) -> Result<Vec<Question>> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(at, line)| question(line).map_err(|why| wrong(name, at + 1, &why))).collect()
}

fn wrong(name: &Path, line: usize, why: &str) -> Error {
    let remedy = "each line is like {\"domain\":\"quads\",\"spacing\":\"fractional_odd\",\"inner\":[3,4.5],\"outer\":[1,2,3,4]}; \
                  a level is a number, \"nan\" or \"inf\"; triangles have 3 outer levels and 1 inner, quads 4 and 2, isolines 2 and none; \
                  spacings are equal, fractional_even and fractional_odd";
    Error::format(name, line, why, remedy)
}

fn question(line: &str) -> std::result::Result<Question, String> {
    let question: Question = serde_json::from_str(line).map_err(|error| error.to_string())?;
    let counts = [question.outer.len() as u32, question.inner.len() as u32];
    let wanted = level_counts(question.domain.code());
    if counts != wanted {
        return Err(format!(
            "{} outer and {} inner levels where there must be {} and {}",
            counts[0], counts[1], wanted[0], wanted[1]
        ));
    }
    match question.outer.iter().chain(&question.inner).find(|level| level.value().is_none()) {
        Some(Level::Word(word)) => Err(format!("`{word}` is no level")),
        _ => Ok(question),
    }
}

impl Question {
    fn levels(&self) -> TessLevels {
        let mut levels = TessLevels::default();
        for (to, from) in levels.outer.iter_mut().zip(&self.outer) {
            *to = from.value().unwrap_or(f32::NAN);
        }
        for (to, from) in levels.inner.iter_mut().zip(&self.inner) {
            *to = from.value().unwrap_or(f32::NAN);
        }
        levels
    }
}

/// Questions that are answered together.
const BATCH: usize = 256;

/// Answers all questions on a device of a backend, in their order; `each` is given some at a time. Gives what a user should be
/// told about the choice of the device.
///
/// # Errors
/// [`Error::Backend`], [`Error::Refused`], [`Error::Device`], and what `each` reports.
pub fn ask(
    backend: Backend,
    device: Option<&str>,
    questions: &[Question],
    profile: Profile,
    mut each: impl FnMut(&[Answer]) -> Result<()>,
) -> Result<Vec<String>> {
    let options = RenderOptions { backend, device: device.map(str::to_owned), ..RenderOptions::default() };
    let (done, notes) = on_first_device(&options, |entry| {
        with_device(entry, 0, Ask { questions, profile, each: &mut each })
    })?;
    done.map(|()| notes)
}

/// Asking, as a job for any device.
struct Ask<'a, F> {
    questions: &'a [Question],
    profile: Profile,
    each: F,
}

impl<F: FnMut(&[Answer]) -> Result<()>> Job for Ask<'_, F> {
    type Output = Result<()>;

    fn run<D: Device>(mut self, mut device: D, _: String) -> Result<()> {
        for some in self.questions.chunks(BATCH) {
            (self.each)(&answers(&mut device, some, self.profile)?)?;
        }
        Ok(())
    }
}

/// What a device makes of all questions, in their order.
///
/// # Errors
/// What the device reports.
pub fn answers<D: Device>(device: &mut D, questions: &[Question], profile: Profile) -> Result<Vec<Answer>> {
    let mut found: Vec<Option<Answer>> = vec![None; questions.len()];
    let mut kinds: HashMap<(Domain, Spacing), Vec<usize>> = HashMap::new();
    for (at, question) in questions.iter().enumerate() {
        kinds.entry((question.domain, question.spacing)).or_default().push(at);
    }
    for (kind, own) in kinds {
        let levels: Vec<TessLevels> = own.iter().map(|&at| questions[at].levels()).collect();
        answer_kind(device, kind, profile, &levels, |patch, mesh| {
            let at = own[patch];
            found[at] = Some(answer(&questions[at], mesh));
        })?;
    }
    Ok(found.into_iter().flatten().collect())
}

/// Coordinates of a patch's vertices, and its primitives.
type Pattern<'a> = (&'a [[u32; 3]], &'a [u32]);

/// In the form in which tessellators are captured: vertices at the same coordinates are the same one.
fn answer(question: &Question, (vertices, prims): Pattern<'_>) -> Answer {
    let kept = if question.domain == Domain::Triangles { 3 } else { 2 };
    let (mut verts, mut places) = (Vec::new(), HashMap::new());
    let distinct: Vec<u32> = vertices
        .iter()
        .map(|vertex| {
            *places.entry(vertex).or_insert_with(|| {
                verts.push(vertex[..kept].to_vec());
                verts.len() as u32 - 1
            })
        })
        .collect();
    let prims = prims.iter().map(|&index| distinct[index as usize]).collect();
    let points = if verts.len() == vertices.len() {
        Points::All(verts.len() as u32)
    } else {
        Points::Listed(distinct)
    };
    Answer { question: question.clone(), verts, prims, points }
}

/// Tessellates patches of one kind; `each` is given every patch by its number.
fn answer_kind<D: Device>(
    device: &mut D,
    (domain, spacing): (Domain, Spacing),
    profile: Profile,
    levels: &[TessLevels],
    mut each: impl FnMut(usize, Pattern<'_>),
) -> Result<()> {
    let frame = TessFrame {
        domain: domain.code(),
        spacing: spacing.code(),
        flags: profile.flag(),
        control: TESS_GIVEN,
        evaluation: TESS_COORDINATES,
        ..TessFrame::default()
    };
    let patches = vec![TessPatch::default(); levels.len()];
    let input = TessInput { frame, patches: &patches, levels, heights: &[] };
    let mut dropped = vec![true; levels.len()];
    each_chunk(device, &input, MEMORY, |chunk| {
        for (patch, record) in (chunk.first..).zip(&chunk.records) {
            let vertices = &chunk.vertices[record.first_vertex as usize..][..record.vertices as usize];
            let coordinates: Vec<_> = vertices.iter().map(coordinates).collect();
            let own = chunk.corners * record.first_primitive as usize;
            let indices = &chunk.indices[own..][..chunk.corners * record.primitives as usize];
            let prims: Vec<_> = indices.iter().map(|index| index - record.first_vertex).collect();
            each(patch, (&coordinates, &prims));
            dropped[patch] = false;
        }
        Ok(())
    })?;
    (0..levels.len()).filter(|&patch| dropped[patch]).for_each(|patch| each(patch, (&[], &[])));
    Ok(())
}

/// Coordinates in units of 2⁻¹⁶, which a float holds exactly.
fn coordinates(vertex: &TessVertex) -> [u32; 3] {
    vertex.position.map(|coordinate| (coordinate * TESS_UNIT as f32) as u32)
}
