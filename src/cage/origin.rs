//! Where patches lie on their cage.

/// The square of a face, or of one of its sub-faces, that a patch covers.
///
/// The first vertex of a quad is at (0, 0), u runs to its second, v to its fourth. A face with another number of
/// corners has a sub-face at each: (0, 0) is that corner, u runs to the middle of the edge to the next one, v to the
/// middle of the edge to the one before, and (1, 1) is the middle of the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Origin {
    /// The face.
    pub face: u32,
    /// The sub-face; -1 in a quad.
    pub sub: i32,
    /// How often the square was halved.
    pub level: u8,
    /// Which of the 2^`level` columns of squares this one is in, along u.
    pub x: u16,
    /// Which of the rows, along v.
    pub y: u16,
    /// Where the surface is not smooth: bit 0 to 3 for the sides, 4 to 7 for the corners, both numbered as in
    /// [`micropoly_core::border`].
    pub sharp: u8,
}

/// Columns and rows of the quarters at the four corners of a square, counter-clockwise.
const QUARTERS: [[u16; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

impl Origin {
    /// A whole quad, or the whole sub-face of another face.
    pub(super) const fn whole(face: u32, sub: i32) -> Self {
        Self { face, sub, level: 0, x: 0, y: 0, sharp: 0 }
    }

    /// The quarter at one of the four corners, counter-clockwise from (0, 0).
    pub(super) const fn quarter(self, corner: usize) -> Self {
        let [x, y] = QUARTERS[corner];
        Self { level: self.level + 1, x: 2 * self.x + x, y: 2 * self.y + y, ..self }
    }
}
