//! Dicing of any surface: which way its patch and its object need.

use crate::abi::{Draw, Frame, KIND_RATIONAL, Object, Patch};
use crate::kernel::dice::{Grid, dice, dice_net, finish_grid};
use crate::kernel::dice_gregory::dice_gregory;
use crate::kernel::dice_rational::dice_rational;
use crate::kernel::displace::dice_displaced;
use crate::patch::half::joined_position;
use crate::patch::{Faces, Net, Weights};

/// Dices a surface of a patch, seen as `object` is placed. `record` is the patch's.
#[inline(always)]
pub fn dice_any(frame: &Frame, patches: &[Patch], record: u32, object: &Object, draw: Draw, grid: &mut Grid) {
    if object.reach > 0.0 {
        return dice_displaced(frame, patches, record, object, draw, grid);
    }
    let patch = &patches[record as usize];
    let net = Net::in_eye_space(patch, object);
    if patch.kind & KIND_RATIONAL != 0 {
        let weights = Weights::of(&patches[patch.faces as usize]);
        dice_rational(&net, &weights, frame, draw, grid);
    } else if patch.faces > 0 {
        let faces = Faces::in_eye_space(&patches[patch.faces as usize], object);
        dice_gregory(&net, &faces, frame, draw, grid);
    } else if patch.kind > 0 {
        dice_net(&net, draw, grid);
        join(patches, object, patch, &net, draw, grid);
        finish_grid(&net, frame, draw, grid);
    } else {
        dice(&net, frame, draw, grid);
    }
}

/// Puts the vertices that lie on halves of other patches' sides where those patches have them.
#[inline(never)]
fn join(patches: &[Patch], object: &Object, patch: &Patch, net: &Net, draw: Draw, grid: &mut Grid) {
    let (rows, columns) = (draw.rate_v(), draw.rate_u());
    for row in 0..=rows {
        let step = if row == 0 || row == rows { 1 } else { columns };
        for column in (0..=columns).step_by(step as usize) {
            let [u, v] = draw.vertex(row, column);
            if patch.joined(u, v).is_some() {
                let at = (row * (columns + 1) + column) as usize;
                let point = joined_position(patches, object, patch, net, u, v);
                for k in 0..3 {
                    grid.position[k][at] = point[k];
                }
            }
        }
    }
}
