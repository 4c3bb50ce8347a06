//! Faces: polygons of any number of corners.

use super::notes::Notes;
use super::vertices::{Corner, Vertices};
use super::words::Words;
use crate::cage::Cage;
use crate::error::Result;

/// Up to so many corners it is quicker to compare each with each than to sort them.
const FEW: usize = 8;

/// The faces that have been read.
#[derive(Default)]
pub(super) struct Faces {
    sizes: Vec<u32>,
    corners: Vec<u32>,
    texture_corners: Vec<u32>,
    lines: Vec<u32>,
    /// Line of the first face without texture coordinates.
    bare: Option<usize>,
    /// Corners of the face that is being read.
    face: Vec<Corner>,
    /// Room to sort them.
    sorted: Vec<u32>,
}

impl Faces {
    pub(super) fn len(&self) -> usize {
        self.sizes.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.sizes.is_empty()
    }

    /// Reads `f v v v ...`, each `v` in one of the four ways of writing a corner.
    pub(super) fn read(&mut self, words: &mut Words<'_>, vertices: &Vertices) -> Result<()> {
        vertices.read_corners(words, &mut self.face)?;
        self.check(words)?;
        self.sizes.push(self.face.len() as u32);
        self.lines.push(u32::try_from(words.start()).unwrap_or(u32::MAX));
        self.corners.extend(self.face.iter().map(|corner| corner.vertex));
        self.texture_corners.extend(self.face.iter().filter_map(|corner| corner.texture));
        if self.face.iter().any(|corner| corner.texture.is_none()) {
            self.bare.get_or_insert(words.start());
        }
        Ok(())
    }

    fn check(&mut self, words: &Words<'_>) -> Result<()> {
        let count = self.face.len();
        if count < 3 {
            let problem = format!("a face with {count} of 3 or more corners");
            return Err(
                words.wrong_statement(problem, "remove the face, or write all its corners on one line")
            );
        }
        match self.repeated() {
            None => Ok(()),
            Some(vertex) => {
                let problem = format!("the face has vertex {} more than once", vertex + 1);
                Err(words.wrong_statement(problem, "remove the corner that is repeated, or the face"))
            }
        }
    }

    /// A vertex at which the face has two corners.
    fn repeated(&mut self) -> Option<u32> {
        let face = &self.face;
        if face.len() <= FEW {
            let is_before = |at: usize| face[..at].iter().any(|before| before.vertex == face[at].vertex);
            return (1..face.len()).find(|&at| is_before(at)).map(|at| face[at].vertex);
        }
        self.sorted.clear();
        self.sorted.extend(face.iter().map(|corner| corner.vertex));
        self.sorted.sort_unstable();
        self.sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
    }

    /// All faces as a cage without tags. Texture coordinates are all or nothing.
    pub(super) fn into_cage(self, vertices: Vertices, notes: &mut Notes) -> Cage {
        let mut cage = Cage {
            positions: vertices.positions,
            face_sizes: self.sizes,
            corners: self.corners,
            face_lines: self.lines,
            ..Cage::default()
        };
        match self.bare {
            None => (cage.texture, cage.texture_corners) = (vertices.texture, self.texture_corners),
            Some(line) if !self.texture_corners.is_empty() => {
                notes.add(
                    "vt",
                    "other faces have texture coordinates, this one has not: they are not used",
                    line,
                );
            }
            Some(_) => {}
        }
        cage
    }
}
