//! Seams of Gregory patches: as `seam.rs` does it, but the curves inside such a patch are not those of one net.
//!
//! `bound` takes the lengths of a surface from a net whose inner points follow the blends from corner to corner
//! ([`Faces::follow`]). The row of control points of that net along a border depends on the border alone: the
//! blends at its two ends, and nothing across it. So what `bound` found for a neighbour can be found from here,
//! whichever side it is on. Borders of the whole patch stay those of the net, which another patch may share.

use crate::abi::{Frame, PARAM_ONE, SEAM_ALLOWANCE, Surface, THIRD};
use crate::kernel::dice_gregory::{blends_at, evaluate_gregory};
use crate::kernel::project::perspective;
use crate::kernel::seam::{Border, Curve, Seam, is_short, seam};
use crate::num::{abs, max, mul, sub};
use crate::patch::gregory::mix;
use crate::patch::{Faces, Net};

/// The seams along the borders v = low, v = high, u = low and u = high of a surface of a Gregory patch.
#[must_use]
pub fn seams_gregory(net: &Net, faces: &Faces, frame: &Frame, surface: Surface) -> [Seam; 4] {
    Border::all(surface).map(|border| {
        if border.is_outer() { seam(net, frame, border) } else { seam_inside(net, faces, frame, border) }
    })
}

fn seam_inside(net: &Net, faces: &Faces, frame: &Frame, border: Border) -> Seam {
    let longest = longest_inside(net, faces, frame, border);
    let chord = border.chord_beyond(frame, longest).and_then(|[low, high]| {
        let [low, middle, high] = [low, border.end(), high].map(|t| {
            let (u, v) = border.at(t);
            evaluate_gregory(net, faces, frame, u, v).point
        });
        let in_reach = is_in_reach(frame, middle, low) && is_in_reach(frame, middle, high);
        in_reach.then_some([low, high])
    });
    Seam { longest, chord }
}

/// The longest chord in steps of the border: that of the largest ancestor that may be drawn. Blends differ from
/// one ancestor to the next, so a larger one may be drawn though a smaller one may not.
fn longest_inside(net: &Net, faces: &Faces, frame: &Frame, border: Border) -> u32 {
    let (mut longest, mut size) = (1, 2 * border.size);
    while size <= PARAM_ONE {
        if is_short(frame, &followed(net, faces, frame, border.ancestor(size))) {
            longest = size / border.size;
        }
        size *= 2;
    }
    longest
}

/// Control points along a border of the net that follows the blends.
fn followed(net: &Net, faces: &Faces, frame: &Frame, border: Border) -> Curve {
    let [low, high] = [border.start, border.end()].map(|t| {
        let (u, v) = border.at(t);
        border.part(&border.curve(&faces.net_at(net, blends_at(frame, u, v))))
    });
    [follow_row(low[0], high[0]), follow_row(low[1], high[1]), follow_row(low[2], high[2])]
}

/// From the row that the blends at the low end give to that of the high end, one coordinate.
fn follow_row(low: [f32; 4], high: [f32; 4]) -> [f32; 4] {
    [low[0], mix(low[1], high[1], THIRD), mix(low[2], high[2], mul(2.0, THIRD)), high[3]]
}

/// Is this end of a chord no farther from its middle, along columns and rows, than the longest border that is
/// drawn? Boxes of pixels have room for no more; the real curve may leave the one that was measured.
fn is_in_reach(frame: &Frame, middle: [f32; 3], end: [f32; 3]) -> bool {
    let (x, y, _) = perspective(frame, middle);
    let (end_x, end_y, _) = perspective(frame, end);
    max(abs(sub(end_x, x)), abs(sub(end_y, y))) <= mul(frame.bound, SEAM_ALLOWANCE)
}
