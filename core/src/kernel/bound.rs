//! bound: cull, draw or split a surface, by the control hull of its parameter range.
//!
//! Unlike the 3×3 point samples of Weber 2014 (sec. 4.2) the hull contains the surface, so nothing visible
//! is ever culled, and the control polygons are at least as long as the curves they control.

use crate::abi::{
    CULL, DRAW, DRAW_LIMITED, FAR_OFF, FLAG_WEBER, Frame, LENGTH_TINY, MAX_SPLITS, Object, Patch, ROUNDING,
    SEAM_ALLOWANCE, SPLIT_U, SPLIT_V, Surface, Verdict,
};
use crate::kernel::project::perspective;
use crate::kernel::weber;
use crate::num::{add, clamp, float, floor, max, min, mul, neg, recip, sqrt, sub};
use crate::patch::net::fold;
use crate::patch::{Faces, Net};

/// The verdict on one surface of any patch, by the rules of the frame's profile.
#[inline(always)]
#[must_use]
pub fn bound_any(frame: &Frame, objects: &[Object], patches: &[Patch], surface: Surface) -> Verdict {
    let patch = &patches[surface.patch_id as usize];
    let object = &objects[patch.object as usize];
    let record = if patch.faces > 0 { Some(&patches[patch.faces as usize]) } else { None };
    match record {
        _ if frame.flags & FLAG_WEBER != 0 => bound_weber(frame, patch, record, object, surface),
        Some(record) => bound_gregory(frame, patch, record, object, surface),
        None => bound(frame, patch, object, surface),
    }
}

/// The verdict on one surface of a Bézier patch.
#[inline(always)]
#[must_use]
pub fn bound(frame: &Frame, patch: &Patch, object: &Object, surface: Surface) -> Verdict {
    judge(frame, surface, &Hull::of_bezier(patch, object, surface))
}

/// The verdict on one surface of a Gregory patch: the hull of a Bézier patch that is near it everywhere.
#[must_use]
pub fn bound_gregory(
    frame: &Frame,
    patch: &Patch,
    record: &Patch,
    object: &Object,
    surface: Surface,
) -> Verdict {
    judge(frame, surface, &Hull::of_gregory(frame, patch, record, object, surface))
}

/// Control hull of a surface, and how far outside of it the surface can be.
struct Hull {
    part: Net,
    /// What rounding can do, in eye space.
    slack: f32,
    /// Only for a Gregory patch.
    apart: Option<Apart>,
}

/// How a surface of a Gregory patch differs from the one whose hull is known.
struct Apart {
    /// Largest distance between the two along any axis.
    spread: f32,
    /// Control points of one that is even nearer: its lengths are the surface's, but it bounds nothing.
    follower: Net,
}

impl Hull {
    #[inline(always)]
    fn of_bezier(patch: &Patch, object: &Object, surface: Surface) -> Self {
        let whole = Net::in_eye_space(patch, object);
        let slack = mul(whole.extent(), ROUNDING);
        Self { part: whole.restricted(surface), slack, apart: None }
    }

    #[inline(always)]
    fn of_gregory(frame: &Frame, patch: &Patch, record: &Patch, object: &Object, surface: Surface) -> Self {
        let mut whole = Net::in_eye_space(patch, object);
        let faces = Faces::in_eye_space(record, object);
        let slack = mul(max(whole.extent(), faces.extent()), ROUNDING);
        let exchanged = frame.flags & FLAG_WEBER != 0;
        let spread = faces.centre_inner(&mut whole, surface, exchanged);
        let part = whole.restricted(surface);
        let mut follower = part;
        faces.follow(&mut follower, surface, exchanged);
        Self { part, slack, apart: Some(Apart { spread, follower }) }
    }

    #[inline(always)]
    fn spread(&self) -> f32 {
        match &self.apart {
            Some(apart) => apart.spread,
            None => 0.0,
        }
    }

    /// Smallest distance of the surface from the eye plane.
    #[inline(always)]
    fn nearest(&self) -> f32 {
        sub(neg(fold(&self.part.z, max)), self.spread())
    }

    /// What the image shows of a hull that lies beyond the near plane, `nearest` away.
    #[inline(always)]
    fn seen(&self, frame: &Frame, nearest: f32, x: &[f32; 16], y: &[f32; 16]) -> Seen {
        let wobble = match &self.apart {
            None => 0.0,
            Some(apart) => {
                let off_axis = max(largest(x), largest(y));
                mul(mul(add(frame.focal, off_axis), apart.spread), recip(nearest))
            }
        };
        let margin = add(margin(frame, self.slack, nearest), wobble);
        Seen { x: Reach::of(x), y: Reach::of(y), margin }
    }

    /// Lengths along u and along v on screen, where the hull is seen at `x` and `y`.
    #[inline(always)]
    fn extents(&self, frame: &Frame, x: &[f32; 16], y: &[f32; 16]) -> (f32, f32) {
        match &self.apart {
            None => (length_u(x, y), length_v(x, y)),
            Some(apart) => {
                let (x, y) = on_screen(frame, &apart.follower);
                (length_u(&x, &y), length_v(&x, &y))
            }
        }
    }
}

/// How far, in pixels, rounding and the snap can move what is drawn of a surface that is `nearest` away.
#[inline(always)]
pub(super) fn margin(frame: &Frame, slack: f32, nearest: f32) -> f32 {
    add(1.0, mul(mul(frame.focal, slack), recip(nearest)))
}

/// Least and largest of one coordinate on screen, in pixels from the optical axis.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    pub(super) low: f32,
    pub(super) high: f32,
}

impl Reach {
    #[inline(always)]
    pub(super) fn of(offsets: &[f32; 16]) -> Self {
        Self { low: fold(offsets, min), high: fold(offsets, max) }
    }

    /// First pixel that it, widened by `margin`, can touch, and one past the last; within the image.
    #[inline(always)]
    fn pixels(self, centre: f32, size: u32, margin: f32) -> (i32, i32) {
        let size = float(size as i32);
        let low = sub(add(self.low, centre), margin);
        let high = add(add(self.high, centre), add(margin, 1.0));
        (floor(clamp(low, 0.0, size)), floor(clamp(high, 0.0, size)))
    }
}

/// Where on screen the control points of a surface lie.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) x: Reach,
    pub(super) y: Reach,
    /// How far the surface can be outside of their hull, pixels.
    pub(super) margin: f32,
}

impl Seen {
    /// Can any pixel's sample lie on the surface?
    #[inline(always)]
    pub(super) fn is_in_view(&self, frame: &Frame) -> bool {
        !PixelBox::around(frame, self, self.margin).is_empty()
    }

    /// The pixels that drawing it can touch: a seam may reach beyond the surface, by no more than the longest
    /// border that can be drawn.
    #[inline(always)]
    fn pixels(&self, frame: &Frame) -> PixelBox {
        PixelBox::around(frame, self, add(self.margin, mul(frame.bound, SEAM_ALLOWANCE)))
    }

    /// The verdict on a surface in view that is so long along u and along v.
    #[inline(always)]
    pub(super) fn verdict(&self, frame: &Frame, surface: Surface, extents: (f32, f32)) -> Verdict {
        if max(extents.0, extents.1) <= frame.bound {
            return verdict(DRAW, self.pixels(frame));
        }
        verdict(refine(frame, surface, extents, Some(frame.bound)), self.pixels(frame))
    }
}

/// The verdict on the surface inside a hull.
#[inline(always)]
fn judge(frame: &Frame, surface: Surface, hull: &Hull) -> Verdict {
    let nearest = hull.nearest();
    let farthest = add(neg(fold(&hull.part.z, min)), hull.spread());
    if add(farthest, hull.slack) < frame.near {
        return Verdict::CULLED;
    }
    if nearest < frame.near {
        if beside_the_view(frame, &hull.part, add(hull.slack, hull.spread())) {
            return Verdict::CULLED;
        }
        let code = refine(frame, surface, depth_spans(&hull.part), None);
        return verdict(code, PixelBox::whole(frame));
    }
    let (x, y) = on_screen(frame, &hull.part);
    let seen = hull.seen(frame, nearest, &x, &y);
    if !seen.is_in_view(frame) {
        return Verdict::CULLED;
    }
    seen.verdict(frame, surface, hull.extents(frame, &x, &y))
}

/// The pixels that drawing the surface inside a hull can touch.
#[inline(always)]
fn pixels_of(frame: &Frame, hull: &Hull) -> PixelBox {
    let nearest = hull.nearest();
    if nearest < frame.near {
        return PixelBox::whole(frame);
    }
    let (x, y) = on_screen(frame, &hull.part);
    hull.seen(frame, nearest, &x, &y).pixels(frame)
}

/// The verdict by the rules of Weber's program.
fn bound_weber(
    frame: &Frame,
    patch: &Patch,
    record: Option<&Patch>,
    object: &Object,
    surface: Surface,
) -> Verdict {
    let net = Net::in_eye_space(patch, object);
    let faces = record.map(|record| Faces::in_eye_space(record, object));
    let code = weber::code(frame, &net, faces.as_ref(), surface);
    let hull = match record {
        Some(record) => Hull::of_gregory(frame, patch, record, object, surface),
        None => Hull::of_bezier(patch, object, surface),
    };
    verdict(code, if code == DRAW { pixels_of(frame, &hull) } else { PixelBox::EMPTY })
}

/// Largest magnitude of all sixteen.
#[inline(always)]
fn largest(c: &[f32; 16]) -> f32 {
    max(fold(c, max), neg(fold(c, min)))
}

impl Verdict {
    /// Not visible.
    pub(super) const CULLED: Self = Self { code: CULL, columns: 0, rows: 0 };
}

#[inline(always)]
fn verdict(code: u32, pixels: PixelBox) -> Verdict {
    let [left, right, top, bottom] = pixels.0;
    Verdict { code, columns: left as u32 | (right as u32) << 16, rows: top as u32 | (bottom as u32) << 16 }
}

/// Splits along the direction that wants it more; at the deepest level, or where the range cannot be
/// halved any further, the surface is drawn as it is. The other direction is tried when it too is too long.
#[inline(always)]
fn refine(frame: &Frame, surface: Surface, (u, v): (f32, f32), limit: Option<f32>) -> u32 {
    let open_u = surface.u_level() < MAX_SPLITS;
    let open_v = surface.v_level() < MAX_SPLITS;
    let too_long = |extent| limit.is_some_and(|limit| extent > limit);
    if surface.level() + 1 >= frame.levels {
        DRAW_LIMITED
    } else if u > v {
        if open_u {
            SPLIT_U
        } else if open_v && too_long(v) {
            SPLIT_V
        } else {
            DRAW_LIMITED
        }
    } else if open_v {
        SPLIT_V
    } else if open_u && too_long(u) {
        SPLIT_U
    } else {
        DRAW_LIMITED
    }
}

/// Does the whole hull lie on the outer side of one side plane of the view? Holds behind the eye too.
#[inline(always)]
fn beside_the_view(frame: &Frame, part: &Net, slack: f32) -> bool {
    beyond(frame, part, &part.x, frame.centre_x, slack) || beyond(frame, part, &part.y, frame.centre_y, slack)
}

/// Does the hull lie beyond one of the two planes that cut the coordinate `c` at `half` pixels?
#[inline(always)]
fn beyond(frame: &Frame, part: &Net, c: &[f32; 16], half: f32, slack: f32) -> bool {
    // A point error of `slack` along each axis moves the plane distance by at most this much.
    let tolerance = mul(slack, add(frame.focal, half));
    let (mut low, mut high) = ([0.0; 16], [0.0; 16]);
    for l in 0..16 {
        let offset = mul(c[l], frame.focal);
        let edge = mul(neg(part.z[l]), half);
        low[l] = add(edge, offset);
        high[l] = sub(edge, offset);
    }
    add(fold(&low, max), tolerance) < 0.0 || add(fold(&high, max), tolerance) < 0.0
}

/// How much the distance to the eye plane varies along u and along v: splitting the direction in which it
/// varies more separates what is before the near plane from what is behind it.
#[inline(always)]
fn depth_spans(part: &Net) -> (f32, f32) {
    let z = &part.z;
    let (mut along_u, mut along_v) = (0.0, 0.0);
    for l in 0..4 {
        along_u = max(along_u, span([z[l], z[4 + l], z[8 + l], z[12 + l]]));
        along_v = max(along_v, span([z[4 * l], z[4 * l + 1], z[4 * l + 2], z[4 * l + 3]]));
    }
    (along_u, along_v)
}

#[inline(always)]
fn span([a, b, c, d]: [f32; 4]) -> f32 {
    sub(max(max(a, b), max(c, d)), min(min(a, b), min(c, d)))
}

/// Pixel offsets of the control points from the optical axis.
#[inline(always)]
fn on_screen(frame: &Frame, part: &Net) -> ([f32; 16], [f32; 16]) {
    let (mut xs, mut ys) = ([0.0; 16], [0.0; 16]);
    for l in 0..16 {
        [xs[l], ys[l]] = point_on_screen(frame, [part.x[l], part.y[l], part.z[l]]);
    }
    (xs, ys)
}

/// Pixel offsets of one point from the optical axis.
#[inline(always)]
pub(super) fn point_on_screen(frame: &Frame, point: [f32; 3]) -> [f32; 2] {
    let (x, y, _) = perspective(frame, point);
    [clamp(x, neg(FAR_OFF), FAR_OFF), clamp(y, neg(FAR_OFF), FAR_OFF)]
}

#[inline(always)]
pub(super) fn distance([ax, ay]: [f32; 2], [bx, by]: [f32; 2]) -> f32 {
    let (dx, dy) = (sub(bx, ax), sub(by, ay));
    sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY))
}

#[inline(always)]
fn segment(x: &[f32; 16], y: &[f32; 16], from: usize, to: usize) -> f32 {
    distance([x[from], y[from]], [x[to], y[to]])
}

/// Length in pixels of the longest control polygon along u.
#[inline(always)]
fn length_u(x: &[f32; 16], y: &[f32; 16]) -> f32 {
    let mut lengths = [0.0; 12];
    for (l, length) in lengths.iter_mut().enumerate() {
        *length = segment(x, y, l, l + 4);
    }
    let mut polygons = [0.0; 4];
    for (j, polygon) in polygons.iter_mut().enumerate() {
        *polygon = add(add(lengths[j], lengths[4 + j]), lengths[8 + j]);
    }
    max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]))
}

/// Length in pixels of the longest control polygon along v.
#[inline(always)]
fn length_v(x: &[f32; 16], y: &[f32; 16]) -> f32 {
    let mut lengths = [0.0; 15];
    for (l, length) in lengths.iter_mut().enumerate() {
        *length = segment(x, y, l, l + 1); // every fourth joins two rows and is not used
    }
    let mut polygons = [0.0; 4];
    for (i, polygon) in polygons.iter_mut().enumerate() {
        *polygon = add(add(lengths[4 * i], lengths[4 * i + 1]), lengths[4 * i + 2]);
    }
    max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]))
}

/// Left, right, top and bottom in pixels; right and bottom are one past the last.
struct PixelBox([i32; 4]);

impl PixelBox {
    const EMPTY: Self = Self([0; 4]);

    fn whole(frame: &Frame) -> Self {
        Self([0, frame.width as i32, 0, frame.height as i32])
    }

    #[inline(always)]
    fn around(frame: &Frame, seen: &Seen, margin: f32) -> Self {
        let (left, right) = seen.x.pixels(frame.centre_x, frame.width, margin);
        let (top, bottom) = seen.y.pixels(frame.centre_y, frame.height, margin);
        Self([left, right, top, bottom])
    }

    #[inline(always)]
    fn is_empty(&self) -> bool {
        self.0[0] >= self.0[1] || self.0[2] >= self.0[3]
    }
}
