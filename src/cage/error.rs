//! What can be wrong with a cage, and what to do about it.

use std::path::Path;

use super::Cage;
use crate::error::Error;

/// Why a cage has no surface. Faces, vertices and the like are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CageError {
    /// The sizes of the faces do not add up.
    #[error("the faces have {needed} corners, but {corners} are listed")]
    Sizes {
        /// Corners that are listed.
        corners: usize,
        /// Sum of the faces' sizes.
        needed: u64,
    },
    /// A face has too few corners.
    #[error("a face has {corners} corners; 3 or more make a face")]
    FewCorners {
        /// The face.
        face: u32,
        /// Its corners.
        corners: u32,
    },
    /// A face names a vertex that is not there.
    #[error("a face names vertex {vertex} (counted from 0), but there are {vertices}")]
    NoVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A face has a vertex twice.
    #[error("a face has vertex {vertex} (counted from 0) more than once")]
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// A position cannot be drawn.
    #[error("a coordinate of vertex {vertex} (counted from 0) is not finite, or too large")]
    Position {
        /// A face with that vertex.
        face: Option<u32>,
        /// The vertex.
        vertex: u32,
    },
    /// More than two faces meet in an edge.
    #[error("3 or more faces share the edge between vertices {} and {} (counted from 0)", vertices[0], vertices[1])]
    CrowdedEdge {
        /// One of the faces.
        face: u32,
        /// The ends of the edge.
        vertices: [u32; 2],
    },
    /// Two neighbours are not wound the same way.
    #[error(
        "two faces run the same way along the edge from vertex {} to {} (counted from 0), so one shows its back",
        vertices[0], vertices[1]
    )]
    Winding {
        /// One of the faces.
        face: u32,
        /// From where to where both run.
        vertices: [u32; 2],
    },
    /// A crease is not on an edge.
    #[error("a crease names vertices {} and {} (counted from 0), which no edge joins", vertices[0], vertices[1])]
    NoEdge {
        /// The vertices.
        vertices: [u32; 2],
    },
    /// A sharp vertex is not there.
    #[error("vertex {vertex} (counted from 0) is to be sharp, but there are {vertices}")]
    NoSharpVertex {
        /// The vertex.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A sharpness is not a number.
    #[error("the sharpness at vertex {vertex} (counted from 0) is not a number")]
    Sharpness {
        /// The vertex, or one of the crease's two.
        vertex: u32,
    },
    /// A hole is not there.
    #[error("face {hole} (counted from 0) is to be a hole, but there are {faces}")]
    NoHole {
        /// The face.
        hole: u32,
        /// How many there are.
        faces: usize,
    },
    /// More levels than can be numbered.
    #[error("{levels} levels of refinement are asked for; {most} is the most")]
    Levels {
        /// Levels that are asked for.
        levels: u32,
        /// The most that can be.
        most: u32,
    },
    /// There would be more faces than can be held.
    #[error("refining {level} times would give {faces} faces; {most} is the most")]
    TooLarge {
        /// The level.
        level: u32,
        /// Faces there.
        faces: u64,
        /// The most that can be.
        most: u64,
    },
    /// A side of a patch has no counterpart of half its size.
    #[error("a patch has no neighbours of half its size where a face was refined: this is a bug")]
    Unbalanced {
        /// The face.
        face: u32,
    },
}

impl CageError {
    /// What is wrong.
    #[must_use]
    pub fn problem(&self) -> String {
        self.to_string()
    }

    /// The face that is to blame, if it is one: callers know its line.
    #[must_use]
    pub const fn face(&self) -> Option<u32> {
        match *self {
            Self::FewCorners { face, .. }
            | Self::NoVertex { face, .. }
            | Self::RepeatedVertex { face, .. }
            | Self::CrowdedEdge { face, .. }
            | Self::Winding { face, .. }
            | Self::Unbalanced { face } => Some(face),
            Self::Position { face, .. } => face,
            _ => None,
        }
    }

    /// The same, of a cage from a file: with the line, if it is known.
    #[must_use]
    pub fn in_file(&self, path: &Path, cage: &Cage) -> Error {
        let line = self.face().and_then(|face| cage.face_lines.get(face as usize));
        match line {
            Some(&line) => Error::format(path, line as usize, self.problem(), self.remedy()),
            None => Error::content(path, self.problem(), self.remedy()),
        }
    }

    /// What to do about it.
    #[must_use]
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::Sizes { .. } => "list as many corners as the faces have",
            Self::FewCorners { .. } => "remove the face, or give it three different vertices at least",
            Self::NoVertex { .. } => "correct the face's vertices, or add those that are missing",
            Self::RepeatedVertex { .. } => "give each corner of the face a vertex of its own",
            Self::Position { .. } => "replace NaN, infinities and numbers beyond 1e30",
            Self::CrowdedEdge { .. } => "split the mesh there: let no more than two faces share an edge",
            Self::Winding { .. } => "turn one of the two faces round (list its vertices in reverse)",
            Self::NoEdge { .. } => "name the two ends of one edge of a face",
            Self::NoSharpVertex { .. } => "name a vertex that is there",
            Self::Sharpness { .. } => "give a number from 0; 10 or more is sharp for ever",
            Self::NoHole { .. } => "name a face that is there",
            Self::Levels { .. } => "ask for fewer levels",
            Self::TooLarge { .. } => {
                "ask for fewer levels, make creases less sharp (or sharp for ever), or split the mesh"
            }
            Self::Unbalanced { .. } => "please report it with the mesh",
        }
    }
}
