//! Half sides: where a cage was refined on one side of an edge only, two small patches lie beside a large one (Nießner et
//! al. 2012, "Feature-adaptive GPU rendering of Catmull-Clark subdivision surfaces", have patterns of triangles there).
//!
//! The large patch is halved in any case, so that its side has a vertex where the small ones meet; and all that the small
//! ones have on the side, vertices and lengths, is found on the large one's curve. So both have the same bits.

use crate::abi::{KIND_HALF_SHIFT, OWNER_SHIFT, Object, PARAM_ONE, Patch, Surface};
use crate::border::SIDES;
use crate::kernel::dice::position_at;
use crate::patch::Net;
use crate::patch::bezier::{blend4, blossom};
use crate::patch::owner::{Owner, place_on};

/// Control points of the sides, along u or v; numbered as in [`crate::border`].
pub const SIDE_POINTS: [[usize; 4]; 4] = [[0, 4, 8, 12], [3, 7, 11, 15], [0, 1, 2, 3], [12, 13, 14, 15]];

/// Control points of a piece of a line, in eye space.
pub type Line = [[f32; 3]; 4];

impl Patch {
    /// Is this side one half of another patch's?
    #[inline(always)]
    #[must_use]
    pub const fn is_half(&self, side: usize) -> bool {
        self.kind >> KIND_HALF_SHIFT >> side & 1 != 0
    }

    /// Where a vertex is evaluated that lies on a side that is half of another's.
    #[inline(always)]
    #[must_use]
    pub const fn joined(&self, u: u32, v: u32) -> Option<Owner> {
        let mut side = 0;
        while side < 4 {
            if self.is_half(side) && lies_on(side, u, v) {
                let [u, v] = place_on(self.owners[side], if side < 2 { u } else { v });
                return Some(Owner { patch_id: (self.owners[side] >> OWNER_SHIFT) - 1, u, v });
            }
            side += 1;
        }
        None
    }
}

/// Does a parameter lie on a side of its patch?
#[inline(always)]
const fn lies_on(side: usize, u: u32, v: u32) -> bool {
    [v == 0, v == PARAM_ONE, u == 0, u == PARAM_ONE][side]
}

/// Does a side of a surface lie on the same side of its patch?
#[inline(always)]
#[must_use]
pub const fn is_outer(surface: Surface, side: usize) -> bool {
    lies_on(
        side,
        if side == 3 { surface.u + surface.u_size() } else { surface.u },
        if side == 1 { surface.v + surface.v_size() } else { surface.v },
    )
}

/// Eye-space position of a vertex of a Bézier patch, given its net in eye space.
#[inline(always)]
#[must_use]
pub fn joined_position(
    patches: &[Patch],
    object: &Object,
    patch: &Patch,
    net: &Net,
    u: u32,
    v: u32,
) -> [f32; 3] {
    match patch.joined(u, v) {
        None => position_at(net, u, v),
        Some(Owner { patch_id, u, v }) => {
            position_at(&Net::in_eye_space(&patches[patch_id as usize], object), u, v)
        }
    }
}

/// Pieces of larger patches' sides that the sides of a surface are, where they are halves of them.
#[inline(always)]
#[must_use]
pub fn half_lines(patches: &[Patch], object: &Object, patch: &Patch, surface: Surface) -> [Option<Line>; 4] {
    let mut out = [None; 4];
    for side in SIDES {
        if patch.is_half(side) && is_outer(surface, side) {
            let (start, bits) = surface.extent_of(side);
            out[side] = Some(half_line(patches, object, patch.owners[side], start, start + (1 << bits)));
        }
    }
    out
}

/// The piece from `low` to `high` along a side that is half of another's, given the side's word.
#[inline(always)]
fn half_line(patches: &[Patch], object: &Object, word: u32, low: u32, high: u32) -> Line {
    let coarse = &patches[(word >> OWNER_SHIFT) as usize - 1];
    let side = (word >> 1 & 3) as usize;
    let along = |[u, v]: [u32; 2]| if side < 2 { u } else { v };
    let (a, b) = (along(place_on(word, low)), along(place_on(word, high)));
    let weights = blossom(a.min(b), a.max(b));
    let points = SIDE_POINTS[side].map(|l| object.point_to_eye([coarse.x[l], coarse.y[l], coarse.z[l]]));
    let coordinate = |k: usize| [points[0][k], points[1][k], points[2][k], points[3][k]];
    weights.map(|w| [blend4(w, coordinate(0)), blend4(w, coordinate(1)), blend4(w, coordinate(2))])
}
