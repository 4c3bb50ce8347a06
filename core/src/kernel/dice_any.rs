//! Dicing of any surface: which way its patch and its object need.

use crate::abi::{Draw, Frame, Object, Patch};
use crate::kernel::dice::{Grid, dice};
use crate::kernel::dice_gregory::dice_gregory;
use crate::kernel::displace::dice_displaced;
use crate::patch::{Faces, Net};

/// Dices a surface of any patch, seen as `object` is placed.
#[inline(always)]
pub fn dice_any(frame: &Frame, patches: &[Patch], object: &Object, draw: Draw, grid: &mut Grid) {
    if object.reach > 0.0 {
        return dice_displaced(frame, patches, object, draw, grid);
    }
    let patch = &patches[draw.patch_id as usize];
    let net = Net::in_eye_space(patch, object);
    match patch.faces {
        0 => dice(&net, frame, draw, grid),
        record => {
            let faces = Faces::in_eye_space(&patches[record as usize], object);
            dice_gregory(&net, &faces, frame, draw, grid);
        }
    }
}
