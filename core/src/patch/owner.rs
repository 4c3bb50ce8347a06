//! Owners: which patch evaluates a vertex that several patches have.
//!
//! Positions on a common edge are the same bits whichever patch they come from, normals are not. Where normals move
//! vertices, a vertex on an edge is therefore evaluated on the edge's owner, the lowest patch that has it, and one at a
//! corner on the lowest patch that has the corner. [`crate::adjacency`] finds them.
//!
//! A side may also be one half of the side of a patch that is twice as large, where a cage was refined on one side of an
//! edge only. What lies on it is always evaluated on the large patch, displaced or not ([`crate::patch::half`]).

use crate::abi::{
    OWNER_IS_CORNER, OWNER_IS_HALF, OWNER_IS_REVERSED, OWNER_IS_SECOND, OWNER_SHIFT, PARAM_ONE, Patch,
};

/// Where a vertex is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Owner {
    /// Index of the patch.
    pub patch_id: u32,
    /// `u` there, in units of 2⁻²⁴.
    pub u: u32,
    /// `v` there.
    pub v: u32,
}

/// The word for a side of a patch that owns a side, which runs the same way or not.
#[must_use]
pub const fn owned_by_side(patch_id: u32, side: u32, is_reversed: bool) -> u32 {
    (patch_id + 1) << OWNER_SHIFT | side << 1 | if is_reversed { OWNER_IS_REVERSED } else { 0 }
}

/// The word for a side of a patch that owns a side, both of which run back over their own points from the middle on.
#[must_use]
pub const fn owned_by_fold(patch_id: u32, side: u32) -> u32 {
    (patch_id + 1) << OWNER_SHIFT | OWNER_IS_CORNER | side << 1 | OWNER_IS_REVERSED
}

/// The word for a corner of a patch that owns a corner, or a side that is one point.
#[must_use]
pub const fn owned_by_corner(patch_id: u32, corner: u32) -> u32 {
    (patch_id + 1) << OWNER_SHIFT | OWNER_IS_CORNER | corner << 1
}

/// The word for a side of a patch that is the first or second half of a side of a larger one, which runs the same way or
/// not.
#[must_use]
pub const fn owned_by_half(patch_id: u32, side: u32, is_reversed: bool, is_second: bool) -> u32 {
    owned_by_side(patch_id, side, is_reversed) | OWNER_IS_HALF | if is_second { OWNER_IS_SECOND } else { 0 }
}

/// The word for a corner of a patch that lies in the middle of a side of a larger one.
#[must_use]
pub const fn owned_by_middle(patch_id: u32, side: u32) -> u32 {
    (patch_id + 1) << OWNER_SHIFT | OWNER_IS_CORNER | OWNER_IS_HALF | side << 1
}

/// Which word of [`Patch::owners`] tells about a vertex; `None` inside a patch.
#[inline(always)]
#[must_use]
pub const fn word_for(u: u32, v: u32) -> Option<usize> {
    let (high_u, high_v) = (u == PARAM_ONE, v == PARAM_ONE);
    match (u == 0 || high_u, v == 0 || high_v) {
        (true, true) => Some(4 + high_u as usize + 2 * high_v as usize),
        (false, true) => Some(high_v as usize),
        (true, false) => Some(2 + high_u as usize),
        (false, false) => None,
    }
}

/// Where the owner that a word names has the vertex that lies at `along` on a side.
#[inline(always)]
#[must_use]
pub const fn place_on(word: u32, along: u32) -> [u32; 2] {
    let number = (word >> 1) & 3;
    let (first, second) = ((number & 1) * PARAM_ONE, (number >> 1) * PARAM_ONE);
    let (is_corner, is_reversed) = (word & OWNER_IS_CORNER != 0, word & OWNER_IS_REVERSED != 0);
    let is_half = word & OWNER_IS_HALF != 0;
    if is_corner && !is_reversed {
        return if is_half { on_side(number, PARAM_ONE / 2) } else { [first, second] };
    }
    let turns = is_reversed && (!is_corner || along > PARAM_ONE / 2);
    let along = if turns { PARAM_ONE - along } else { along };
    let start = if word & OWNER_IS_SECOND != 0 { PARAM_ONE / 2 } else { 0 };
    on_side(number, if is_half { start + along / 2 } else { along })
}

/// `u` and `v` of what lies at `along` on a side.
#[inline(always)]
const fn on_side(side: u32, along: u32) -> [u32; 2] {
    let across = (side & 1) * PARAM_ONE;
    if side < 2 { [along, across] } else { [across, along] }
}

impl Patch {
    /// Where a vertex of this patch, which is number `patch_id`, is evaluated.
    #[inline(always)]
    #[must_use]
    pub const fn owner(&self, patch_id: u32, u: u32, v: u32) -> Owner {
        let own = Owner { patch_id, u, v };
        let Some(at) = word_for(u, v) else { return own };
        let word = self.owners[at];
        if word == 0 {
            return own;
        }
        let [u, v] = place_on(word, if at < 2 { u } else { v });
        Owner { patch_id: (word >> OWNER_SHIFT) - 1, u, v }
    }
}
