//! Adjacency: which patches share edges and corners, found once on the host from the bits of their control points.
//!
//! Edges are the same if their four control points are, from either end; corners if they are in the same place. Patches
//! of different objects never meet. A side may be one point, or run back over its own points. Nothing is allocated: numbers are sorted in room that the caller gives.

use crate::abi::{OWNER_IS_REVERSED, OWNER_IS_SECOND, OWNER_SHIFT, Patch};
use crate::border::corners_of;
use crate::patch::gregory::patch_count;
use crate::patch::half::SIDE_POINTS;
use crate::patch::owner::{owned_by_corner, owned_by_fold, owned_by_middle, owned_by_side};

/// A control point as bits, in which -0 is 0.
type Bits = [u32; 3];

/// Control points of the corners; numbered as in [`crate::border`].
const CORNER_POINTS: [usize; 4] = [0, 12, 3, 15];

/// Most patches that can have owners.
pub const MAX_PATCHES: usize = (1 << (32 - OWNER_SHIFT)) - 1;

/// Numbers that [`find_owners`] needs room for.
#[must_use]
pub fn room_needed(patches: &[Patch]) -> usize {
    4 * patch_count(patches)
}

/// Fills in [`Patch::owners`] of all patches; records of face points may follow them. Sides that are halves of others must
/// have their words already.
///
/// # Panics
/// If `room` is shorter than [`room_needed`], or there are more than [`MAX_PATCHES`].
pub fn find_owners(patches: &mut [Patch], room: &mut [u32]) {
    let count = patch_count(patches);
    assert!(count <= MAX_PATCHES, "too many patches");
    let room = &mut room[..4 * count];
    // Corners first: a side that is one point belongs to the owner of its corner.
    number(room);
    room.sort_unstable_by(|&a, &b| corner_of(patches, a).cmp(&corner_of(patches, b)).then(a.cmp(&b)));
    own_groups(patches, room, corner_of, |patches, owner, at| {
        patches[(at / 4) as usize].owners[4 + (at % 4) as usize] =
            if owner == at { 0 } else { owned_by_corner(owner / 4, owner % 4) };
    });
    number(room);
    room.sort_unstable_by(|&a, &b| side_of(patches, a).cmp(&side_of(patches, b)).then(a.cmp(&b)));
    own_groups(patches, room, side_of, own_side);
}

/// 4 · patch + side or corner.
fn number(room: &mut [u32]) {
    for (number, entry) in (0..).zip(room) {
        *entry = number;
    }
}

/// Calls `own` with the first entry of each group of equal keys, and every entry of it.
fn own_groups<K: Ord>(
    patches: &mut [Patch],
    sorted: &[u32],
    key: impl Fn(&[Patch], u32) -> K,
    own: impl Fn(&mut [Patch], u32, u32),
) {
    let mut rest = sorted;
    while let Some(&first) = rest.first() {
        let wanted = key(patches, first);
        let end = rest.iter().position(|&entry| key(patches, entry) != wanted).unwrap_or(rest.len());
        for &entry in &rest[..end] {
            own(patches, first, entry);
        }
        rest = &rest[end..];
    }
}

fn own_side(patches: &mut [Patch], owner: u32, at: u32) {
    let (patch, side) = ((at / 4) as usize, (at % 4) as usize);
    let (_, curve) = side_of(patches, at);
    let corner = corners_of(side)[0];
    if patches[patch].is_half(side) {
        return own_middle(&mut patches[patch], side);
    }
    patches[patch].owners[side] = if curve.iter().all(|point| *point == curve[0]) {
        match patches[patch].owners[4 + corner] {
            0 => owned_by_corner(patch as u32, corner as u32),
            word => word,
        }
    } else if curve == mirrored(curve) {
        owned_by_fold(owner / 4, owner % 4)
    } else if owner == at {
        0
    } else {
        owned_by_side(owner / 4, owner % 4, runs_backwards(patches, at) != runs_backwards(patches, owner))
    };
}

/// The corner at which a half of a side begins or ends in its middle belongs to the large patch, as the side does.
fn own_middle(patch: &mut Patch, side: usize) {
    let word = patch.owners[side];
    let is_last = (word & OWNER_IS_SECOND != 0) == (word & OWNER_IS_REVERSED != 0);
    let corner = corners_of(side)[usize::from(is_last)];
    patch.owners[4 + corner] = owned_by_middle((word >> OWNER_SHIFT) - 1, (word >> 1) & 3);
}

/// Control points of a side from the end that is lower, after its object.
fn side_of(patches: &[Patch], at: u32) -> (u32, [Bits; 4]) {
    let patch = &patches[(at / 4) as usize];
    let curve = SIDE_POINTS[(at % 4) as usize].map(|l| bits(patch, l));
    (patch.object, curve.min(mirrored(curve)))
}

const fn mirrored([a, b, c, d]: [Bits; 4]) -> [Bits; 4] {
    [d, c, b, a]
}

/// Is it the other end of a side that is lower?
fn runs_backwards(patches: &[Patch], at: u32) -> bool {
    let curve = SIDE_POINTS[(at % 4) as usize].map(|l| bits(&patches[(at / 4) as usize], l));
    curve > mirrored(curve)
}

fn corner_of(patches: &[Patch], at: u32) -> (u32, Bits) {
    let patch = &patches[(at / 4) as usize];
    (patch.object, bits(patch, CORNER_POINTS[(at % 4) as usize]))
}

fn bits(patch: &Patch, l: usize) -> Bits {
    [patch.x[l], patch.y[l], patch.z[l]].map(|c| if c == 0.0 { 0 } else { c.to_bits() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::abi::{KIND_HALF_SHIFT, PARAM_ONE};
    use crate::kernel::dice::position_at;
    use crate::patch::Net;
    use crate::patch::owner::{Owner, owned_by_half};

    /// Two patches beside each other on a grid of points; `turn` numbers the points of the second one anew.
    fn pair(turn: impl Fn(usize, usize) -> (usize, usize)) -> [Patch; 2] {
        let mut patches = [Patch::default(); 2];
        for (p, patch) in patches.iter_mut().enumerate() {
            for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
                let (a, b) = if p == 0 { (i, j) } else { turn(i, j) };
                let (x, y) = ((a + 3 * p) as f32, b as f32);
                let at = 4 * i + j;
                (patch.x[at], patch.y[at], patch.z[at]) = (x, y + 0.1 * x, x * y * 0.25);
            }
        }
        patches
    }

    fn found(mut patches: [Patch; 2]) -> [Patch; 2] {
        let mut room = [0; 8];
        find_owners(&mut patches, &mut room);
        patches
    }

    #[test]
    fn a_neighbour_however_turned_has_the_owners_vertices() {
        type Turn = fn(usize, usize) -> (usize, usize);
        let turns: [Turn; 4] = [|i, j| (i, j), |i, j| (j, 3 - i), |i, j| (3 - i, 3 - j), |i, j| (3 - j, i)];
        for turn in turns {
            let patches = found(pair(turn));
            assert_eq!(patches[0].owners, [0; 8], "the first patch owns its own");
            let mut shared = 0;
            for (u, v) in [0, 1 << 20, PARAM_ONE / 2, PARAM_ONE]
                .into_iter()
                .flat_map(|a| [0, 1 << 20, PARAM_ONE / 2, PARAM_ONE].map(|b| (a, b)))
            {
                let owner = patches[1].owner(1, u, v);
                shared += u32::from(owner.patch_id == 0);
                let at = |patch: &Patch, u, v| position_at(&Net::in_object_space(patch), u, v);
                let own = at(&patches[1], u, v);
                assert_eq!(own, at(&patches[owner.patch_id as usize], owner.u, owner.v), "at {u}, {v}");
            }
            assert_eq!(shared, 4, "all vertices of one side");
        }
    }

    /// A large patch, and two that lie beside the half of it with u = 1; `turn` says whether theirs runs the other way.
    fn beside(turn: bool) -> [Patch; 3] {
        let large = pair(|i, j| (i, j))[0];
        let halves = [[0, PARAM_ONE / 2], [PARAM_ONE / 2, PARAM_ONE]].map(|range| {
            let net = Net::in_object_space(&large).between([[0, PARAM_ONE], range]);
            let mut small = Patch { x: net.x, y: net.y, z: net.z, ..large };
            for l in 0..16 {
                let from = if turn { 4 * (3 - l / 4) + 3 - l % 4 } else { l };
                (small.x[l], small.y[l], small.z[l]) = (net.x[from] + 3.0, net.y[from] + 0.3, net.z[from]);
            }
            small
        });
        let [mut first, mut second] = halves;
        let side = if turn { 3 } else { 2 };
        for (patch, is_second) in [(&mut first, false), (&mut second, true)] {
            patch.kind = 1 << side << KIND_HALF_SHIFT;
            patch.owners[side] = owned_by_half(0, 3, turn, is_second);
        }
        [Patch { kind: 1 << 3, ..large }, first, second]
    }

    #[test]
    fn halves_of_a_side_have_the_large_patchs_vertices() {
        for turn in [false, true] {
            let mut patches = beside(turn);
            find_owners(&mut patches, &mut [0; 12]);
            for along in [0, 2, 1 << 20, PARAM_ONE / 2, PARAM_ONE] {
                for (index, start) in [(1, 0), (2, PARAM_ONE / 2)] {
                    let (u, v) = if turn { (PARAM_ONE, PARAM_ONE - along) } else { (0, along) };
                    let there = Owner { patch_id: 0, u: PARAM_ONE, v: start + along / 2 };
                    assert_eq!(patches[index].joined(u, v), Some(there), "{index} at {along}");
                    if (along == 0) == (index == 1) && along % PARAM_ONE == 0 {
                        continue; // the corner that is the large patch's too: found by its place
                    }
                    assert_eq!(patches[index].owner(index as u32, u, v), there, "{index} at {along}");
                }
            }
        }
    }

    #[test]
    fn a_side_that_is_a_point_belongs_to_a_corner() {
        let mut patches = pair(|i, j| (i, j));
        for l in 0..4 {
            (patches[1].x[l], patches[1].y[l], patches[1].z[l]) =
                (patches[0].x[15], patches[0].y[15], patches[0].z[15]);
        }
        let patches = found(patches);
        let tip = Owner { patch_id: 0, u: PARAM_ONE, v: PARAM_ONE };
        for v in [0, 5, PARAM_ONE / 2, PARAM_ONE] {
            assert_eq!(patches[1].owner(1, 0, v), tip, "at {v}");
        }
        assert_eq!(patches[1].owner(1, 7, 9), Owner { patch_id: 1, u: 7, v: 9 });
    }

    #[test]
    fn a_side_that_is_folded_has_each_vertex_twice() {
        let mut patches = pair(|i, j| (j, 3 - i));
        for patch in &mut patches {
            for (from, to) in [(0, 3), (1, 2)] {
                (patch.x[to], patch.y[to], patch.z[to]) = (patch.x[from], patch.y[from], patch.z[from]);
            }
        }
        for l in 0..4 {
            let k = 4 * l; // side 0 of the second patch is side 2 of the first
            (patches[1].x[k], patches[1].y[k], patches[1].z[k]) =
                (patches[0].x[l], patches[0].y[l], patches[0].z[l]);
        }
        let patches = found(patches);
        let owner = |v| Owner { patch_id: 0, u: 0, v };
        for v in [1, 1 << 20, PARAM_ONE / 2] {
            assert_eq!(patches[0].owner(0, 0, v), owner(v));
            assert_eq!(patches[0].owner(0, 0, PARAM_ONE - v), owner(v));
            assert_eq!(patches[1].owner(1, v, 0), owner(v));
            assert_eq!(patches[1].owner(1, PARAM_ONE - v, 0), owner(v));
        }
        assert_eq!(patches[1].owner(1, PARAM_ONE, 0), patches[0].owner(0, 0, 0));
    }

    #[test]
    fn objects_never_meet() {
        let mut patches = pair(|i, j| (i, j));
        patches[1].object = 1;
        assert_eq!(found(patches).map(|patch| patch.owners), [[0; 8]; 2]);
    }

    #[test]
    fn a_patch_that_meets_itself_owns_the_lower_side() {
        let mut patch = pair(|i, j| (i, j))[0];
        for l in 0..4 {
            (patch.x[12 + l], patch.y[12 + l], patch.z[12 + l]) = (patch.x[l], patch.y[l], patch.z[l]);
        }
        let mut patches = [patch];
        find_owners(&mut patches, &mut [0; 4]);
        assert_eq!(patches[0].owner(0, PARAM_ONE, 99), Owner { patch_id: 0, u: 0, v: 99 });
        assert_eq!(patches[0].owner(0, PARAM_ONE, PARAM_ONE), Owner { patch_id: 0, u: 0, v: PARAM_ONE });
    }
}
