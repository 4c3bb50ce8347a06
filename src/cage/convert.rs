//! From cages to patches (Nießner, Loop, Meyer & DeRose 2012): regular faces become Bézier patches at once, others are
//! refined, and what is irregular still becomes Gregory patches.

use rayon::prelude::*;

use super::accuracy::{Tolerance, Tolerances};
use super::error::CageError;
use super::level::{Level, NONE};
use super::net::{BORDER_CORNER, SIDE, runs_along};
use super::origin::Origin;
use super::refine::refine;
use super::start::level_of;
use super::tags::{Fate, Kind, Rule, fates, kinds, spread};
use super::tangents::Tangents;
use super::{Cage, gregory, limit, regular};
use crate::gregory::GregoryPatch;
use crate::shape::{BezierPatch, HalfSide};

/// The most levels that can be asked for; creases that decay add up to 10.
pub const MOST_LEVELS: u32 = 10;

/// How cages become patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Levels of refinement around what is not regular, up to [`MOST_LEVELS`]. There are fewer where a cage is so fine that
    /// these are not needed, and more, up to 5, where they leave the surface farther off than they do around a corner of a
    /// cube.
    pub levels: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { levels: 3 }
    }
}

/// The patches of a cage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// Bézier patches.
    pub bezier: Vec<BezierPatch>,
    /// Gregory patches.
    pub gregory: Vec<GregoryPatch>,
    /// Which sides of Bézier patches are halves of others.
    pub halves: Vec<HalfSide>,
    /// Where each Bézier patch lies.
    pub bezier_origins: Vec<Origin>,
    /// Where each Gregory patch lies.
    pub gregory_origins: Vec<Origin>,
}

/// The patches of the limit surface of a cage; `progress` is told from time to time which share of them is done.
///
/// A patch's front (`∂u × ∂v`) is the side from which its face runs counter-clockwise.
///
/// # Errors
/// If the cage is not one: see [`CageError`].
pub fn convert(
    cage: &Cage,
    options: &Options,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<Patches, CageError> {
    let levels = options.levels;
    if levels > MOST_LEVELS {
        return Err(CageError::Levels { levels, most: MOST_LEVELS });
    }
    let mut patches = Patches::default();
    let mut level = level_of(cage)?;
    let tolerances = Tolerances::new(&level.points, levels);
    let mut open = Vec::new();
    for depth in 0.. {
        let kinds = kinds(&level);
        let mut fates = fates(&level, &kinds);
        limit::settle(&mut level, &kinds, &fates);
        emit_gregory(&level, &kinds, &mut fates, tolerances.at(depth), &mut patches);
        let numbers = emit_bezier(&level, &kinds, &fates, &mut patches);
        close(&level, &open, &numbers, &mut patches)?;
        open = open_sides(&level, &fates, &numbers);
        progress((depth + 1) as f32 / (levels.max(depth) + 1) as f32);
        if !fates.contains(&Fate::Refined) {
            break;
        }
        level = refine(&level, &fates, depth)?;
    }
    Ok(patches)
}

/// Faces with one fate, in order.
fn faces_with(fates: &[Fate], fate: Fate) -> Vec<u32> {
    (0..fates.len() as u32).into_par_iter().filter(|&face| fates[face as usize] == fate).collect()
}

/// Adds the Gregory patches of a level, except for those that are too far off: their faces are refined.
fn emit_gregory(
    level: &Level,
    kinds: &[Kind],
    fates: &mut [Fate],
    tolerance: Option<Tolerance>,
    patches: &mut Patches,
) {
    let (faces, first) = (faces_with(fates, Fate::Irregular), patches.gregory.len());
    let tangents = Tangents::of(level, kinds, fates);
    let patch = |&face: &u32| gregory::patch(level, kinds, &tangents, face as usize);
    patches.gregory.par_extend(faces.par_iter().map(patch));
    if let Some(tolerance) = tolerance {
        tolerance.apply(level, kinds, (&faces, &patches.gregory[first..]), fates);
        spread(level, fates);
        let is_kept = |face: &u32| fates[*face as usize] == Fate::Irregular;
        let mut kept = std::iter::repeat_n(true, first).chain(faces.iter().map(is_kept));
        patches.gregory.retain(|_| kept.next().unwrap_or(true));
    }
    let place = |&face: &u32| place(level, kinds, face as usize);
    patches.gregory_origins.par_extend(faces_with(fates, Fate::Irregular).par_iter().filter_map(place));
}

/// Adds the Bézier patches of a level, and gives the number of each face's patch.
fn emit_bezier(level: &Level, kinds: &[Kind], fates: &[Fate], patches: &mut Patches) -> Vec<u32> {
    let (faces, mut numbers) = (faces_with(fates, Fate::Regular), vec![NONE; fates.len()]);
    for (&face, number) in faces.iter().zip(patches.bezier.len()..) {
        numbers[face as usize] = number as u32;
    }
    patches.bezier.par_extend(faces.par_iter().map(|&face| regular::patch(level, face as usize)));
    let place = |&face: &u32| place(level, kinds, face as usize);
    patches.bezier_origins.par_extend(faces.par_iter().filter_map(place));
    numbers
}

/// Where a face lies, and where it is not smooth.
fn place(level: &Level, kinds: &[Kind], face: usize) -> Option<Origin> {
    let mut sharp = 0;
    for (at, corner) in level.corners_of(face).enumerate() {
        sharp |= u8::from(level.is_crease(corner)) << SIDE[at & 3];
        let is_sharp = matches!(kinds[level.vertex(corner)].rule, Rule::Crease | Rule::Corner);
        sharp |= u8::from(is_sharp) << (4 + BORDER_CORNER[at & 3]);
    }
    level.origins[face].map(|origin| Origin { sharp, ..origin })
}

/// A side of a patch beside a face that was refined.
struct OpenSide {
    coarse: u32,
    /// The corner of its face at which the side begins.
    coarse_corner: usize,
    /// The half-edge of the other face.
    fine: u32,
    /// The corner at which it begins.
    fine_corner: usize,
    /// How many refined faces come before the other one.
    refined_before: u32,
}

fn open_sides(level: &Level, fates: &[Fate], numbers: &[u32]) -> Vec<OpenSide> {
    let mut before = Vec::with_capacity(fates.len());
    let mut corners_before = 0;
    for (face, &fate) in fates.iter().enumerate() {
        before.push(corners_before);
        if fate == Fate::Refined {
            corners_before += level.corners_of(face).len() as u32;
        }
    }
    let side = |half_edge: usize| {
        let face = level.face_of(half_edge);
        let twin = level.twin(half_edge).filter(|_| fates[face] == Fate::Regular)?;
        let beside = level.face_of(twin);
        (fates[beside] == Fate::Refined).then(|| OpenSide {
            coarse: numbers[face],
            coarse_corner: half_edge - level.corners_of(face).start,
            fine: beside as u32,
            fine_corner: twin - level.corners_of(beside).start,
            refined_before: before[beside],
        })
    };
    (0..level.corners.len()).into_par_iter().filter_map(side).collect()
}

/// Finds the two patches at each of these sides, now that there are any.
fn close(level: &Level, open: &[OpenSide], numbers: &[u32], patches: &mut Patches) -> Result<(), CageError> {
    for side in open {
        let quads = (level.corners_of(0).len() == 4).then_some(side.refined_before as usize);
        let quads = quads.ok_or(CageError::Unbalanced { face: side.fine })?;
        let is_along = runs_along(side.coarse_corner);
        for place in 0..2 {
            // The quad where the half-edge begins comes first; the large patch's own half-edge ends there.
            let fine = numbers[quads + ((side.fine_corner + place) & 3)];
            if fine == NONE {
                return Err(CageError::Unbalanced { face: side.fine });
            }
            patches.halves.push(HalfSide {
                fine,
                fine_side: SIDE[side.fine_corner],
                coarse: side.coarse,
                coarse_side: SIDE[side.coarse_corner],
                is_reversed: is_along == runs_along(side.fine_corner),
                is_second: is_along == (place == 0),
            });
        }
    }
    Ok(())
}
