//! The verdict on a surface as Weber's program reaches it (2014, sec. 4.2), to compare with his figures.
//!
//! Nine points of the surface stand for all of it, and the deepest level is culled: what is drawn can have
//! holes. His rules are kept to the letter, where they are odd too.

use crate::abi::{
    CULL, DRAW, Frame, LENGTH_TINY, SPLIT_U, SPLIT_V, Surface, WEBER_FAR, WEBER_FAR_OFF, WEBER_MARGIN,
    WEBER_SPLITS, WEBER_TINY,
};
use crate::kernel::dice::position_at;
use crate::num::{abs, add, clamp, max, min, mul, neg, recip, sqrt, sub};
use crate::patch::bezier::param;
use crate::patch::gregory::weber_blends;
use crate::patch::{Faces, Net};

/// Points at the ends and middles of the ranges of u and v: first along v, then along u.
type Points = [[f32; 3]; 9];

/// The verdict's code; `net` and `faces` are in eye space.
#[must_use]
pub fn code(frame: &Frame, net: &Net, faces: Option<&Faces>, surface: Surface) -> u32 {
    if surface.level() + 1 >= frame.levels {
        return CULL;
    }
    let points = points(net, faces, surface);
    let (low, high) = box_around(&points);
    if is_outside(frame, low, high) {
        return CULL;
    }
    if low[2] < mul(0.1, frame.near) && high[2] > frame.near {
        return split(surface, surface.u_size() < surface.v_size());
    }
    let (along_u, along_v) = lengths(frame, &points);
    if max(along_u, along_v) <= frame.bound {
        return if is_divisible(surface) { DRAW } else { CULL };
    }
    split(surface, along_u > along_v)
}

/// Can each range be diced at any rate? One that cannot is taken for one of the deepest level.
const fn is_divisible(surface: Surface) -> bool {
    surface.u_level() <= crate::abi::MAX_SPLITS && surface.v_level() <= crate::abi::MAX_SPLITS
}

/// Splits unless the middle of a half would be no parameter.
const fn split(surface: Surface, along_u: bool) -> u32 {
    if along_u {
        if surface.u_level() < WEBER_SPLITS { SPLIT_U } else { CULL }
    } else if surface.v_level() < WEBER_SPLITS {
        SPLIT_V
    } else {
        CULL
    }
}

fn points(net: &Net, faces: Option<&Faces>, surface: Surface) -> Points {
    let (half_u, half_v) = (surface.u_size() / 2, surface.v_size() / 2);
    let mut points = [[0.0; 3]; 9];
    for (k, point) in points.iter_mut().enumerate() {
        let (u, v) = (surface.u + k as u32 / 3 * half_u, surface.v + k as u32 % 3 * half_v);
        *point = match faces {
            None => position_at(net, u, v),
            Some(faces) => position_at(&faces.net_at(net, weber_blends(param(u), param(v))), u, v),
        };
    }
    points
}

fn box_around(points: &Points) -> ([f32; 3], [f32; 3]) {
    let (mut low, mut high) = (points[0], points[0]);
    for point in points {
        for k in 0..3 {
            low[k] = min(low[k], point[k]);
            high[k] = max(high[k], point[k]);
        }
    }
    (low, high)
}

/// Is the box before the near plane, too far away, or beside the view?
fn is_outside(frame: &Frame, low: [f32; 3], high: [f32; 3]) -> bool {
    let (nearest, farthest) = (neg(high[2]), neg(low[2]));
    if farthest < frame.near || nearest > WEBER_FAR {
        return true;
    }
    let (near, far) = (recip(max(frame.near, nearest)), recip(farthest));
    is_beside((low[0], high[0]), (near, far), frame.focal, frame.centre_x)
        || is_beside((low[1], high[1]), (near, far), frame.focal, frame.centre_y)
}

/// Is a range of one coordinate more than the margin outside of the image, `half` pixels to either side? The
/// ends are seen at the box's near side where they point outwards, and at its far side otherwise.
fn is_beside((low, high): (f32, f32), (near, far): (f32, f32), focal: f32, half: f32) -> bool {
    let low = mul(mul(low, if low < 0.0 { near } else { far }), focal);
    let high = mul(mul(high, if high > 0.0 { near } else { far }), focal);
    let last = sub(add(half, half), 1.0);
    add(low, half) > add(last, WEBER_MARGIN) || add(high, half) < neg(WEBER_MARGIN)
}

/// Lengths of the longest polylines along u and along v, pixels.
fn lengths(frame: &Frame, points: &Points) -> (f32, f32) {
    let mut seen = [[0.0; 2]; 9];
    for (seen, point) in seen.iter_mut().zip(points) {
        *seen = on_screen(frame, *point);
    }
    let (mut along_u, mut along_v) = (0.0, 0.0);
    for k in 0..3 {
        along_u = max(along_u, polyline(seen[k], seen[3 + k], seen[6 + k]));
        along_v = max(along_v, polyline(seen[3 * k], seen[3 * k + 1], seen[3 * k + 2]));
    }
    (along_u, along_v)
}

/// Pixel offsets from the optical axis; of points behind the eye too, which are mirrored.
fn on_screen(frame: &Frame, [x, y, z]: [f32; 3]) -> [f32; 2] {
    let size = recip(max(abs(z), WEBER_TINY));
    let scale = mul(frame.focal, if z > 0.0 { neg(size) } else { size });
    let limited = |offset: f32| clamp(offset, neg(WEBER_FAR_OFF), WEBER_FAR_OFF);
    [limited(mul(x, scale)), limited(mul(y, scale))]
}

fn polyline(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> f32 {
    add(segment(a, b), segment(b, c))
}

fn segment(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (sub(b[0], a[0]), sub(b[1], a[1]));
    sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY))
}
