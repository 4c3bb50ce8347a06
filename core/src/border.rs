//! Borders: which vertices lie on the four sides of a surface, so that whoever shares a side has the same ones.
//!
//! A side belongs to a line of the patch: one of its edges, or a line that some split made. The vertices on it are
//! decided by the line alone: a piece of it is halved until it is short enough on screen, and then gets as many
//! steps as it is micropolygons long. Until then the side is *live*. Surfaces on either side of the line see the
//! same pieces, so they agree (the idea is DiagSplit's, Fisher et al. 2009; here every rate is an integer, and
//! grids stay regular inside).
//!
//! A surface that is split where its side has steps already may get a corner that is no vertex of the side. Such a
//! corner has *strayed*: it is drawn at the last vertex before it. All of this is integers: sides and corners are
//! packed into four words, and a corner is the surface's own with low bits of `u` and `v` cleared, and perhaps
//! some steps added along one of them.

use crate::abi::{
    CORNER_SHIFT, Draw, FIVE_BITS, PARAM_BITS, PLACE_BITS, RATE_U_SHIFT, RATE_V_SHIFT, SIDE_MASK, SPLIT_U,
    Surface, Verdict,
};

/// The sides, by number: `v` = low, `v` = high, `u` = low, `u` = high. The first two run along `u`.
pub const SIDES: [usize; 4] = [0, 1, 2, 3];

/// The corners at which a side starts and ends; corner 2·j + i is at the low (0) or high (1) end i of `u` and j of
/// `v`.
#[inline(always)]
#[must_use]
pub const fn corners_of(side: usize) -> [usize; 2] {
    [[0, 1], [2, 3], [0, 2], [1, 3]][side]
}

/// How a side is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Side {
    /// Steps of the whole piece of the line that the side lies in; 0 = the side is live.
    pub steps: u32,
    /// The piece is 2^`bits` units long, and starts at a multiple of its length.
    pub bits: u32,
}

impl Side {
    /// Not decided yet.
    pub const LIVE: Self = Self { steps: 0, bits: 0 };

    /// Steps that a grid needs along a part of the piece, 2^`own_bits` units long, to have all vertices there.
    #[inline(always)]
    #[must_use]
    pub const fn steps_needed(self, own_bits: u32) -> u32 {
        let halved = self.bits.saturating_sub(own_bits); // a live side needs none
        (self.steps + (1 << halved) - 1) >> halved
    }

    #[inline(always)]
    const fn packed(self) -> u32 {
        self.steps | self.bits << 5
    }

    #[inline(always)]
    const fn unpacked(word: u32) -> Self {
        Self { steps: word & FIVE_BITS, bits: (word >> 5) & FIVE_BITS }
    }
}

/// Where step `index` of `steps` ends in a piece 2^`bits` long: rounded so that counting from the other end gives
/// the same places.
#[inline(always)]
#[must_use]
pub const fn place(index: u32, steps: u32, bits: u32) -> u32 {
    let fine = if bits < PLACE_BITS { bits } else { PLACE_BITS };
    let rest = bits - fine;
    if 2 * index <= steps {
        ((index << fine) / steps) << rest
    } else {
        (1 << bits) - ((((steps - index) << fine) / steps) << rest)
    }
}

/// A corner that has strayed, packed: low bits of `u` and of `v` that are cleared, along which of them steps are
/// added, and which step of how many (of a piece as long as the bits cleared). 0 = the corner is where it seems.
#[inline(always)]
const fn stray(clear: [u32; 2], along: u32, step: u32, steps: u32) -> u32 {
    clear[0] | clear[1] << 5 | along << 10 | step << 11 | steps << 16
}

/// Where a strayed corner is that seems to be at `seems`.
#[inline(always)]
const fn astray(word: u32, seems: [u32; 2]) -> [u32; 2] {
    let bits = [word & FIVE_BITS, (word >> 5) & FIVE_BITS];
    let mut at = [seems[0] >> bits[0] << bits[0], seems[1] >> bits[1] << bits[1]];
    let (along, step, steps) = ((word >> 10) & 1, (word >> 11) & FIVE_BITS, word >> 16);
    if steps > 0 {
        at[along as usize] += place(step, steps, bits[along as usize]);
    }
    at
}

impl Surface {
    /// How a side is divided.
    #[inline(always)]
    #[must_use]
    pub const fn side(self, side: usize) -> Side {
        Side::unpacked(self.borders[side])
    }

    /// Are all corners where they seem to be?
    #[inline(always)]
    #[must_use]
    pub const fn keeps_its_corners(self) -> bool {
        let [a, b, c, d] = self.borders;
        (a | b | c | d) >> CORNER_SHIFT == 0
    }

    /// Has this corner strayed?
    #[inline(always)]
    #[must_use]
    pub const fn has_strayed(self, corner: usize) -> bool {
        self.borders[corner] >> CORNER_SHIFT != 0
    }

    /// `u` and `v` of the vertex at a corner.
    #[inline(always)]
    #[must_use]
    pub const fn corner(self, corner: usize) -> [u32; 2] {
        astray(self.borders[corner] >> CORNER_SHIFT, self.seeming_corner(corner))
    }

    /// `u` and `v` of a corner, if it has not strayed.
    #[inline(always)]
    #[must_use]
    pub const fn seeming_corner(self, corner: usize) -> [u32; 2] {
        let u = if corner.is_multiple_of(2) { self.u } else { self.u + self.u_size() };
        let v = if corner < 2 { self.v } else { self.v + self.v_size() };
        [u, v]
    }

    /// Where a side begins along its line, and the log2 of its length.
    #[inline(always)]
    pub(crate) const fn extent_of(self, side: usize) -> (u32, u32) {
        if side < 2 { (self.u, PARAM_BITS - self.u_level()) } else { (self.v, PARAM_BITS - self.v_level()) }
    }

    /// Steps that a grid needs along a side, so that it can have all of the side's vertices.
    #[inline(always)]
    #[must_use]
    pub const fn steps_needed(self, side: usize) -> u32 {
        self.side(side).steps_needed(self.extent_of(side).1)
    }

    /// Are the side's own vertices those of a regular grid with so many steps along it?
    #[inline(always)]
    #[must_use]
    pub const fn is_regular(self, side: usize, rate: u32) -> bool {
        let Side { steps, bits } = self.side(side);
        steps == 0 || (steps == rate && bits == self.extent_of(side).1)
    }

    /// `u` and `v` of the vertex with which step `index` of `rate` along a side ends: one of the side's own.
    #[inline(always)]
    #[must_use]
    pub const fn border_vertex(self, side: usize, index: u32, rate: u32) -> [u32; 2] {
        let [first, last] = corners_of(side);
        if index == 0 {
            return self.corner(first);
        }
        if index == rate {
            return self.corner(last);
        }
        let (start, own_bits) = self.extent_of(side);
        let Side { steps, bits } = self.side(side);
        if steps == 0 {
            return self.on_side(side, start + place(index, rate, own_bits));
        }
        // The piece's vertices at or before both ends, and one between them: the grid has no fewer steps, so each
        // of them is chosen.
        let halved = bits - own_bits;
        let before = (start & ((1 << bits) - 1)) >> own_bits;
        let (low, high) = ((before * steps) >> halved, ((before + 1) * steps) >> halved);
        let step = low + (2 * index * (high - low) + rate) / (2 * rate);
        if step <= low {
            self.corner(first)
        } else if step >= high {
            self.corner(last)
        } else {
            self.on_side(side, (start >> bits << bits) + place(step, steps, bits))
        }
    }

    #[inline(always)]
    const fn on_side(self, side: usize, along: u32) -> [u32; 2] {
        match side {
            0 => [along, self.v],
            1 => [along, self.v + self.v_size()],
            2 => [self.u, along],
            _ => [self.u + self.u_size(), along],
        }
    }

    /// The word of the corner that a split makes in the middle of a side.
    #[inline(always)]
    const fn middle_corner(self, side: usize) -> u32 {
        let Side { steps, bits } = self.side(side);
        if steps == 0 {
            return 0; // the middle of a live side is a vertex
        }
        let (start, own_bits) = self.extent_of(side);
        let along = side as u32 / 2;
        // Of the piece: where the side begins, and where its middle is.
        let from = start & ((1 << bits) - 1);
        let middle = from + (1 << own_bits) / 2;
        let step = (middle * steps) >> bits;
        if step << bits > from * steps {
            if place(step, steps, bits) == middle {
                return 0;
            }
            let mut clear = [0; 2];
            clear[along as usize] = bits;
            return stray(clear, along, step, steps);
        }
        // No vertex since the side's start, so that is where it is: back to it, and wherever that has strayed.
        let word = self.borders[corners_of(side)[0]] >> CORNER_SHIFT;
        let cleared = (word >> (5 * along)) & FIVE_BITS;
        let more = own_bits.saturating_sub(cleared);
        word + (more << (5 * along))
    }

    /// The surface with its sides as `bound` found them to be divided.
    #[inline(always)]
    #[must_use]
    pub const fn divided(self, verdict: Verdict) -> Self {
        let mut borders = self.borders;
        let mut side = 0;
        while side < 4 {
            borders[side] = (borders[side] & !SIDE_MASK) | verdict.side(side);
            side += 1;
        }
        Self { borders, ..self }
    }

    /// The two halves of the range of `u` or of `v`, lower first, of a surface that is [`Surface::divided`]. The line
    /// between them is new, and live.
    #[inline(always)]
    #[must_use]
    pub const fn halves(self, verdict: Verdict) -> [Self; 2] {
        let whole = self.divided(verdict);
        let is_u = verdict.code == SPLIT_U;
        let [low, high] = if is_u { whole.halves_u() } else { whole.halves_v() };
        // The sides that are halved, and those that the halves have for themselves.
        let (halved, own) = if is_u { ([0, 1], [2, 3]) } else { ([2, 3], [0, 1]) };
        let (mut low_words, mut high_words) = (whole.borders, whole.borders);
        low_words[own[1]] &= !SIDE_MASK;
        high_words[own[0]] &= !SIDE_MASK;
        let mut end = 0;
        while end < 2 {
            let middle = whole.middle_corner(halved[end]) << CORNER_SHIFT;
            let [first, last] = corners_of(halved[end]);
            low_words[last] = (low_words[last] & SIDE_MASK) | middle;
            high_words[first] = (high_words[first] & SIDE_MASK) | middle;
            end += 1;
        }
        [Self { borders: low_words, ..low }, Self { borders: high_words, ..high }]
    }
}

impl Verdict {
    /// Packed sides and rates.
    #[inline(always)]
    #[must_use]
    pub const fn with_sides(self, sides: [Side; 4], rates: [u32; 2]) -> Self {
        Self {
            along_u: sides[0].packed() | sides[1].packed() << CORNER_SHIFT | rates[0] << (2 * CORNER_SHIFT),
            along_v: sides[2].packed() | sides[3].packed() << CORNER_SHIFT | rates[1] << (2 * CORNER_SHIFT),
            ..self
        }
    }

    #[inline(always)]
    const fn side(self, side: usize) -> u32 {
        let word = if side < 2 { self.along_u } else { self.along_v };
        if side.is_multiple_of(2) { word & SIDE_MASK } else { (word >> CORNER_SHIFT) & SIDE_MASK }
    }

    /// Micropolygons along `u` and along `v`; of drawn surfaces only.
    #[inline(always)]
    #[must_use]
    pub const fn rates(self) -> [u32; 2] {
        [self.along_u >> (2 * CORNER_SHIFT), self.along_v >> (2 * CORNER_SHIFT)]
    }
}

impl Draw {
    /// Micropolygons along `u`.
    #[inline(always)]
    #[must_use]
    pub const fn rate_u(self) -> u32 {
        (self.shape >> RATE_U_SHIFT) & FIVE_BITS
    }

    /// Micropolygons along `v`.
    #[inline(always)]
    #[must_use]
    pub const fn rate_v(self) -> u32 {
        (self.shape >> RATE_V_SHIFT) & FIVE_BITS
    }

    /// `u` of a column of vertices inside the grid, where it is regular.
    #[inline(always)]
    #[must_use]
    pub const fn column(self, column: u32) -> u32 {
        let surface = self.surface();
        surface.u + place(column, self.rate_u(), PARAM_BITS - surface.u_level())
    }

    /// `v` of a row of vertices inside the grid.
    #[inline(always)]
    #[must_use]
    pub const fn row(self, row: u32) -> u32 {
        let surface = self.surface();
        surface.v + place(row, self.rate_v(), PARAM_BITS - surface.v_level())
    }

    /// `u` and `v` of a vertex of the grid: on a border, one of the border's own.
    #[inline(always)]
    #[must_use]
    pub const fn vertex(self, row: u32, column: u32) -> [u32; 2] {
        let surface = self.surface();
        if row == 0 {
            surface.border_vertex(0, column, self.rate_u())
        } else if row == self.rate_v() {
            surface.border_vertex(1, column, self.rate_u())
        } else if column == 0 {
            surface.border_vertex(2, row, self.rate_v())
        } else if column == self.rate_u() {
            surface.border_vertex(3, row, self.rate_v())
        } else {
            [self.column(column), self.row(row)]
        }
    }
}
