//! Wavefront OBJ files (`.obj`): polygon cages with the tags of OpenSubdiv's shapes, and free-form surfaces.
//!
//! What is not drawn (curves, trims, lines, points) is named in a warning; what cannot be understood is an error.

mod faces;
mod freeform;
mod notes;
mod parameters;
mod tags;
mod vertices;
mod words;

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::cage::Cage;
use crate::error::{Result, read_bytes};
use faces::Faces;
use freeform::Elements;
use notes::Notes;
use tags::Tags;
use vertices::Vertices;
use words::Words;

pub use freeform::FreeForm;

/// What an OBJ file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Obj {
    /// All its polygons, whatever their groups: faces of two groups may share an edge. `None` if there are none.
    pub cage: Option<Cage>,
    /// Its free-form surfaces.
    pub surfaces: Vec<FreeForm>,
    /// What is not drawn, or not used, of what it says; each kind once, with file and line.
    pub warnings: Vec<String>,
}

impl Obj {
    /// What is not used of it where only its polygons are.
    pub(crate) fn notes_as_mesh(&self, path: &Path) -> Vec<String> {
        let left_out = || format!("{}: its free-form surfaces are no mesh and are left out", path.display());
        let surfaces = (!self.surfaces.is_empty()).then(left_out);
        self.warnings.iter().cloned().chain(surfaces).collect()
    }
}

/// Reads an OBJ file.
///
/// # Errors
/// [`Error::Read`](crate::Error::Read), or [`Error::Format`](crate::Error::Format) with the line.
pub fn load(path: &Path) -> Result<Obj> {
    parse_bytes(path, &read_bytes(path)?)
}

/// Reads what an OBJ file holds from bytes; `path` is for messages only.
///
/// # Errors
/// [`Error::Format`](crate::Error::Format) with the line.
pub fn parse_bytes(path: &Path, bytes: &[u8]) -> Result<Obj> {
    let mut reader = Reader::new(Words::new(path, bytes));
    while let Some(keyword) = reader.words.statement() {
        reader.read(keyword)?;
    }
    reader.finish()
}

/// What has been read so far.
struct Reader<'a> {
    words: Words<'a>,
    vertices: Vertices,
    faces: Faces,
    tags: Tags,
    elements: Elements,
    notes: Notes,
}

impl<'a> Reader<'a> {
    fn new(words: Words<'a>) -> Self {
        let (vertices, faces, tags) = Default::default();
        Self { words, vertices, faces, tags, elements: Elements::default(), notes: Notes::default() }
    }

    /// Reads the statement that starts with this word.
    fn read(&mut self, keyword: &[u8]) -> Result<()> {
        let words = &mut self.words;
        match keyword {
            b"v" => self.vertices.read_position(words),
            b"vt" => self.vertices.read_texture(words),
            b"vn" => self.vertices.read_normal(words),
            b"f" | b"fo" => self.faces.read(words, &self.vertices),
            b"t" => self.tags.read(words, &mut self.notes),
            b"cstype" => self.elements.read_type(words),
            b"deg" => self.elements.read_degree(words),
            b"surf" => self.elements.begin_surface(words, &self.vertices),
            b"curv" | b"curv2" => {
                self.elements.begin_curve(words)?;
                self.notes.pass_over(keyword, words)
            }
            b"parm" => self.elements.read_parameters(words),
            b"end" => self.elements.end(words, &self.vertices),
            _ => self.notes.pass_over(keyword, words),
        }
    }

    fn finish(mut self) -> Result<Obj> {
        let surfaces = self.elements.finish(&self.words)?;
        if self.faces.is_empty() && surfaces.is_empty() {
            let remedy = "is this the right file? Lines, points and curves alone are not drawn";
            return Err(self.words.wrong("the file has neither faces (`f`) nor surfaces (`surf`)", remedy));
        }
        self.tags.check(&self.words, self.vertices.len(), self.faces.len())?;
        let has_faces = !self.faces.is_empty();
        let cage = self.faces.into_cage(self.vertices, &mut self.notes);
        let cage = has_faces.then(|| self.tags.put_into(cage));
        Ok(Obj { cage, surfaces, warnings: self.notes.warnings(self.words.path()) })
    }
}
