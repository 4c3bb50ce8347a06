//! bound: cull, draw or split a surface, by the control hull of its parameter range.
//!
//! Unlike the 3×3 point samples of Weber 2014 (sec. 4.2) the hull contains the surface, so nothing visible
//! is ever culled, and the control polygons are at least as long as the curves they control.

use crate::abi::{
    CULL, DRAW, DRAW_LIMITED, FAR_OFF, FLAG_FLAT, FLAG_WEBER, FLAG_WHOLE, Frame, JOINED_SPLITS,
    KIND_HALF_SHIFT, KIND_HALVED, KIND_RATIONAL, LENGTH_TINY, MAX_SPLITS, Object, Patch, ROUNDING, SPLIT_U,
    SPLIT_V, Surface, Verdict,
};
use crate::border::{SIDES, Side, corners_of};
use crate::kernel::dice_gregory::evaluate_gregory;
use crate::kernel::flat::{around, enclosed, flatness, part_flatness, side_flatness, strictness};
use crate::kernel::project::perspective;
use crate::kernel::sides::{
    Lengths, Strays, divide, is_half_way, polygon, rates, sides_of_gregory, with_half_lines,
};
use crate::kernel::weber;
use crate::num::{add, clamp, float, floor, largest3, max, min, mul, neg, recip, scale3, sqrt, sub};
use crate::patch::half::{Line, half_lines, joined_position};
use crate::patch::instance::instance;
use crate::patch::net::fold;
use crate::patch::{Faces, Net, Range, Weights, range_of};

/// The verdict on one surface of any patch, by the rules of the frame's profile.
#[inline(always)]
#[must_use]
pub fn bound_any(frame: &Frame, objects: &[Object], patches: &[Patch], surface: Surface) -> Verdict {
    let known = instance(frame, objects, patches, surface.patch_id);
    let patch = &patches[known.record as usize];
    let object = &objects[known.object as usize];
    if frame.flags & FLAG_WEBER != 0 {
        return bound_weber(frame, patches, patch, object, surface);
    }
    judge(frame, surface, &Hull::of(frame, patches, patch, object, surface))
}

/// The verdict on one surface of a Bézier patch, whose sides are its own.
#[inline(always)]
#[must_use]
pub fn bound(frame: &Frame, patch: &Patch, object: &Object, surface: Surface) -> Verdict {
    judge(frame, surface, &Hull::of_bezier(&[], patch, object, surface))
}

/// Control hull of a surface, and how far outside of it the surface can be.
struct Hull<'a> {
    /// All patches, for what lies on halves of their sides.
    patches: &'a [Patch],
    patch: &'a Patch,
    object: &'a Object,
    /// Of the whole patch.
    whole: Net,
    part: Net,
    /// The weights of a rational patch.
    weights: Option<Weights>,
    /// Pieces of larger patches' sides, where the surface's sides are halves of them.
    lines: [Option<Line>; 4],
    /// What rounding can do, in eye space.
    slack: f32,
    /// What displacement can do, along any axis of eye space.
    reach: f32,
    /// Only for a Gregory patch.
    apart: Option<Apart>,
}

/// How a surface of a Gregory patch differs from the one whose hull is known.
struct Apart {
    faces: Faces,
    /// Largest distance between the two along any axis.
    spread: f32,
    /// Control points of one that is even nearer: its lengths are the surface's, but it bounds nothing.
    follower: Net,
}

impl<'a> Hull<'a> {
    #[inline(always)]
    fn of(
        frame: &Frame,
        patches: &'a [Patch],
        patch: &'a Patch,
        object: &'a Object,
        surface: Surface,
    ) -> Self {
        if patch.faces == 0 {
            return Self::of_bezier(patches, patch, object, surface);
        }
        let record = &patches[patch.faces as usize];
        if patch.kind & KIND_RATIONAL != 0 {
            return Self::of_rational(patch, record, object, surface);
        }
        Self::of_gregory(frame, patch, record, object, surface)
    }

    #[inline(always)]
    fn of_bezier(patches: &'a [Patch], patch: &'a Patch, object: &'a Object, surface: Surface) -> Self {
        let whole = Net::in_eye_space(patch, object);
        Self {
            patches,
            patch,
            object,
            part: whole.restricted(surface),
            weights: None,
            lines: half_lines(patches, object, patch, surface),
            slack: mul(whole.extent(), ROUNDING),
            reach: object.reach,
            apart: None,
            whole,
        }
    }

    #[inline(never)]
    fn of_rational(patch: &'a Patch, record: &Patch, object: &'a Object, surface: Surface) -> Self {
        let (whole, weights) = (Net::in_eye_space(patch, object), Weights::of(record));
        Self {
            patches: &[],
            patch,
            object,
            part: weights.between(&whole, range_of(surface)),
            weights: Some(weights),
            lines: [None; 4],
            // Numerator and denominator each round, and so does the quotient.
            slack: mul(mul(whole.extent(), ROUNDING), 4.0),
            reach: object.reach,
            apart: None,
            whole,
        }
    }

    /// The hull of a Bézier patch that is near a Gregory patch everywhere.
    #[inline(never)]
    fn of_gregory(
        frame: &Frame,
        patch: &'a Patch,
        record: &Patch,
        object: &'a Object,
        surface: Surface,
    ) -> Self {
        let mut whole = Net::in_eye_space(patch, object);
        let faces = Faces::in_eye_space(record, object);
        let slack = mul(max(whole.extent(), faces.extent()), ROUNDING);
        let exchanged = frame.flags & FLAG_WEBER != 0;
        let spread = faces.centre_inner(&mut whole, range_of(surface), exchanged);
        let part = whole.restricted(surface);
        let mut follower = part;
        faces.follow(&mut follower, range_of(surface), exchanged);
        Self {
            patches: &[],
            patch,
            object,
            part,
            weights: None,
            lines: [None; 4],
            slack,
            reach: object.reach,
            apart: Some(Apart { faces, spread, follower }),
            whole,
        }
    }

    /// Largest distance, along any axis, between what is drawn and the surface whose hull it is.
    #[inline(always)]
    fn spread(&self) -> f32 {
        match &self.apart {
            Some(apart) => add(apart.spread, self.reach),
            None => self.reach,
        }
    }

    /// Smallest distance of what is drawn from the eye plane.
    #[inline(always)]
    fn nearest(&self) -> f32 {
        sub(neg(fold(&self.part.z, max)), self.spread())
    }

    /// Smallest distance of the surface from the eye plane before it is displaced.
    #[inline(always)]
    fn nearest_smooth(&self) -> f32 {
        let apart = self.apart.as_ref().map_or(0.0, |apart| apart.spread);
        sub(neg(fold(&self.part.z, max)), apart)
    }

    /// What is nearer than this is measured as if it were this far away: where displacement can move things by so much,
    /// a smaller distance means nothing.
    #[inline(always)]
    const fn measured_from(&self, frame: &Frame) -> f32 {
        max(frame.near, self.reach)
    }

    /// Largest distance of what is drawn from the eye plane.
    #[inline(always)]
    fn farthest(&self) -> f32 {
        add(neg(fold(&self.part.z, min)), self.spread())
    }

    /// Corners that have strayed from the surface.
    #[inline(always)]
    fn strays(&self, frame: &Frame, surface: Surface) -> Option<Strays> {
        Strays::of(frame, surface, self.reach, |u, v| match (&self.apart, &self.weights) {
            (None, None) => joined_position(self.patches, self.object, self.patch, &self.whole, u, v),
            (None, Some(weights)) => weights.evaluate(&self.whole, u, v).point,
            (Some(apart), _) => evaluate_gregory(&self.whole, &apart.faces, frame, u, v).point,
        })
    }

    /// What the image shows of a hull that lies beyond the near plane, `nearest` away.
    #[inline(always)]
    fn seen(&self, frame: &Frame, nearest: f32, x: &[f32; 16], y: &[f32; 16]) -> Seen {
        let spread = self.spread();
        let wobble =
            if spread > 0.0 { wobble(frame, max(largest(x), largest(y)), spread, nearest) } else { 0.0 };
        let margin = add(margin(frame, self.slack, nearest), wobble);
        Seen { x: Reach::of(x), y: Reach::of(y), margin }
    }

    /// Lengths on screen of a hull whose control points are measured to be at `points`.
    #[inline(always)]
    fn lengths(&self, frame: &Frame, surface: Surface, points: &Net) -> Lengths {
        let near = self.measured_from(frame);
        if frame.flags & FLAG_FLAT != 0 {
            return self.flatness(frame, surface);
        }
        let own = Lengths::new(polygons_u(points), polygons_v(points));
        let Some(apart) = &self.apart else {
            return with_half_lines(frame, near, &self.lines, own);
        };
        let sides = sides_of_gregory(frame, near, &self.whole, &apart.faces, surface, own.sides);
        let points = measured(frame, near, &apart.follower);
        Lengths::new(polygons_u(&points), polygons_v(&points)).with_sides(sides)
    }

    /// How far a surface and its sides are from being flat.
    #[inline(never)]
    fn flatness(&self, frame: &Frame, surface: Surface) -> Lengths {
        let near = self.measured_from(frame);
        let own = match &self.apart {
            None => with_half_lines(frame, near, &self.lines, flatness(frame, near, &self.part)),
            Some(apart) => {
                let whole = part_flatness(frame, near, &apart.follower);
                Lengths { u: whole, v: whole, sides: self.lines_of_gregory(frame, surface) }
            }
        };
        let mut sides = own.sides;
        for side in SIDES {
            sides[side] = mul(self.strictness(surface, side), sides[side]);
        }
        let own = Lengths { sides, ..own }.with_sides(sides);
        if surface.keeps_its_corners() { own } else { self.astray(frame, surface, own) }
    }

    /// How far the sides of a surface of a Gregory patch are from their chords, each by itself: a surface's own net, which
    /// is another one on the other side of a line, has no part in it.
    #[inline(never)]
    fn lines_of_gregory(&self, frame: &Frame, surface: Surface) -> [f32; 4] {
        let near = self.measured_from(frame);
        SIDES.map(|side| {
            let [first, last] = corners_of(side).map(|corner| surface.seeming_corner(corner));
            side_flatness(frame, near, &self.between(around(first, last, last)), side)
        })
    }

    /// With what is enclosed by corners that have strayed, in place of the surface itself. The same goes for live sides that
    /// begin or end with such a corner.
    #[inline(never)]
    fn astray(&self, frame: &Frame, surface: Surface, own: Lengths) -> Lengths {
        let near = self.measured_from(frame);
        let off = |range: Range| part_flatness(frame, near, &self.between(range));
        let mut sides = own.sides;
        for side in SIDES {
            let [first, last] = corners_of(side);
            let has_strayed = surface.has_strayed(first) || surface.has_strayed(last);
            if has_strayed && surface.side(side).steps == 0 {
                let (from, to) = (surface.corner(first), surface.corner(last));
                let strictness = self.strictness(surface, side);
                sides[side] = max(sides[side], mul(strictness, off(around(from, to, to))));
            }
        }
        let [first, second] = enclosed(surface);
        let most = max(off(first), off(second));
        Lengths { u: most, v: most, sides }.with_sides(sides)
    }

    /// How many times as flat as a surface one of its sides has to be: the same for whoever has it.
    #[inline(always)]
    fn strictness(&self, surface: Surface, side: usize) -> f32 {
        let bits = surface.extent_of(side).1;
        strictness(if self.lines[side].is_some() { bits - 1 } else { bits })
    }

    /// Control points of a part of the patch, or of a Bézier patch that is nearly the same there.
    #[inline(always)]
    fn between(&self, range: Range) -> Net {
        match (&self.apart, &self.weights) {
            (None, None) => self.whole.between(range),
            (None, Some(weights)) => weights.between(&self.whole, range),
            (Some(Apart { faces, .. }), _) => {
                let mut net = self.whole;
                let _ = faces.centre_inner(&mut net, range, false);
                let mut part = net.between(range);
                faces.follow(&mut part, range, false);
                part
            }
        }
    }
}

/// How far, in pixels, rounding and the snap can move what is drawn of a surface that is `nearest` away.
#[inline(always)]
pub(super) fn margin(frame: &Frame, slack: f32, nearest: f32) -> f32 {
    add(1.0, mul(mul(frame.focal, slack), recip(nearest)))
}

/// How far, in pixels, points up to `off_axis` pixels from the axis move on screen if they move by `spread` along any
/// axis, and come no nearer than `nearest`.
#[inline(always)]
pub(super) fn wobble(frame: &Frame, off_axis: f32, spread: f32, nearest: f32) -> f32 {
    mul(mul(add(frame.focal, off_axis), spread), recip(nearest))
}

/// Least and largest of one coordinate on screen, in pixels from the optical axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) low: f32,
    pub(super) high: f32,
}

impl Reach {
    #[inline(always)]
    pub(super) fn of(offsets: &[f32; 16]) -> Self {
        Self { low: fold(offsets, min), high: fold(offsets, max) }
    }

    /// As far as `by` around one place.
    #[inline(always)]
    pub(super) const fn around(offset: f32, by: f32) -> Self {
        Self { low: sub(offset, by), high: add(offset, by) }
    }

    /// Both, and all that lies between them.
    #[inline(always)]
    pub(super) const fn joined(self, other: Self) -> Self {
        Self { low: min(self.low, other.low), high: max(self.high, other.high) }
    }

    /// First pixel that it, widened by `margin`, can touch, and one past the last; among those from `first` to `end`.
    #[inline(always)]
    fn pixels(self, centre: f32, (first, end): (u32, u32), margin: f32) -> (i32, i32) {
        let (first, end) = (float(first as i32), float(end as i32));
        let low = sub(add(self.low, centre), margin);
        let high = add(add(self.high, centre), add(margin, 1.0));
        (floor(clamp(low, first, end)), floor(clamp(high, first, end)))
    }
}

/// Where on screen the control points of a surface lie, and corners that have strayed from it.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) x: Reach,
    pub(super) y: Reach,
    /// How far what is drawn can be outside of their hull, pixels.
    pub(super) margin: f32,
}

impl Seen {
    #[inline(always)]
    pub(super) fn with_strays(self, strays: Option<Strays>) -> Self {
        match strays {
            None => self,
            Some(Strays { x, y, .. }) => Self { x: self.x.joined(x), y: self.y.joined(y), ..self },
        }
    }

    /// The pixels that drawing it can touch; none if no pixel's sample can lie on the surface.
    #[inline(always)]
    pub(super) fn pixels(&self, frame: &Frame) -> PixelBox {
        PixelBox::around(frame, self, self.margin)
    }
}

/// The verdict on a surface in view that is so long.
#[inline(always)]
pub(super) fn by_length(
    frame: &Frame,
    surface: Surface,
    kind: u32,
    lengths: &Lengths,
    pixels: PixelBox,
) -> Verdict {
    let code = by_extents(frame, surface, kind, (lengths.u, lengths.v));
    with_sides(frame, surface, kind, lengths, verdict(code, pixels))
}

/// What becomes of a surface in view, of a patch of this kind, that is so long.
#[inline(always)]
fn by_extents(frame: &Frame, surface: Surface, kind: u32, extents: (f32, f32)) -> u32 {
    if frame.flags & FLAG_FLAT != 0 {
        return quartered(frame, surface, kind, max(extents.0, extents.1));
    }
    if is_halved(kind, 3) && surface.u_level() == 0 {
        return if may_split(frame, surface, 1) { SPLIT_U } else { DRAW_LIMITED };
    }
    if is_halved(kind, 12) && surface.v_level() == 0 {
        return if may_split(frame, surface, 1) { SPLIT_V } else { DRAW_LIMITED };
    }
    if max(extents.0, extents.1) <= frame.bound { DRAW } else { refine(frame, surface, kind, extents) }
}

/// Does a patch of this kind have two others beside one of these sides, a bit a side?
#[inline(always)]
const fn is_halved(kind: u32, sides: u32) -> bool {
    kind & KIND_HALVED & sides != 0
}

/// Is there a level for each of so many splits?
#[inline(always)]
const fn may_split(frame: &Frame, surface: Surface, times: u32) -> bool {
    surface.level() + times < frame.levels
}

/// Most halvings of a patch of this kind along either parameter.
#[inline(always)]
const fn most_splits(kind: u32) -> u32 {
    if kind & (KIND_HALVED | KIND_HALVED << KIND_HALF_SHIFT) != 0 { JOINED_SPLITS } else { MAX_SPLITS }
}

/// What becomes of a surface that is so far from being flat: it is split into four, in two steps, so that a stack has room
/// for it as for any other.
#[inline(always)]
fn quartered(frame: &Frame, surface: Surface, kind: u32, off: f32) -> u32 {
    if is_half_way(frame, surface) {
        return SPLIT_V;
    }
    let is_whole = surface.level() == 0 && is_halved(kind, KIND_HALVED);
    if off <= frame.bound && !is_whole {
        DRAW
    } else if surface.u_level() < most_splits(kind) && may_split(frame, surface, 2) {
        SPLIT_U
    } else {
        DRAW_LIMITED
    }
}

/// The verdict, with sides and rates.
#[inline(always)]
fn with_sides(frame: &Frame, surface: Surface, kind: u32, lengths: &Lengths, verdict: Verdict) -> Verdict {
    let sides = divide(frame, surface, kind, lengths, verdict.code);
    let is_split = verdict.code == SPLIT_U || verdict.code == SPLIT_V;
    let rates = if is_split { [0; 2] } else { rates(frame, surface, &sides, lengths) };
    verdict.with_sides(sides, rates)
}

/// The verdict on the surface inside a hull.
#[inline(always)]
fn judge(frame: &Frame, surface: Surface, hull: &Hull) -> Verdict {
    let (near, kind) = (hull.measured_from(frame), hull.patch.kind);
    if frame.flags & FLAG_WHOLE != 0 {
        let lengths = hull.lengths(frame, surface, &measured(frame, near, &hull.part));
        return by_length(frame, surface, kind, &lengths, PixelBox::whole(frame));
    }
    let (nearest, farthest) = (hull.nearest(), hull.farthest());
    let strays = hull.strays(frame, surface);
    let end = strays.map_or(farthest, |strays| max(farthest, strays.farthest));
    if add(end, hull.slack) < frame.near {
        return Verdict::CULLED;
    }
    let crosses = nearest < frame.near && add(farthest, hull.slack) >= frame.near;
    // Boxes of what is displaced are wide where it is near.
    let is_vague = crosses || hull.reach > 0.0;
    if is_vague && strays.is_none() && beside_the_view(frame, &hull.part, add(hull.slack, hull.spread())) {
        return Verdict::CULLED;
    }
    let points = measured(frame, near, &hull.part);
    let lengths = hull.lengths(frame, surface, &points);
    if crosses {
        let pixels =
            if strays.is_some() { PixelBox::whole(frame) } else { pixels_if_cut(frame, hull, farthest) };
        let is_cut = hull.nearest_smooth() < near && frame.flags & FLAG_FLAT == 0;
        let extents = if is_cut { extents_if_cut(frame, near, &hull.part) } else { (lengths.u, lengths.v) };
        let code = by_extents(frame, surface, kind, extents);
        return with_sides(frame, surface, kind, &lengths, verdict(code, pixels));
    }
    let pixels = match strays {
        Some(strays) if min(nearest, strays.nearest) < frame.near => PixelBox::whole(frame),
        _ => hull.seen(frame, nearest, &points.x, &points.y).with_strays(strays).pixels(frame),
    };
    if pixels.is_empty() {
        return Verdict::CULLED;
    }
    by_length(frame, surface, kind, &lengths, pixels)
}

/// The pixels that drawing the surface inside a hull can touch.
#[inline(always)]
fn pixels_of(frame: &Frame, hull: &Hull) -> PixelBox {
    let nearest = hull.nearest();
    if nearest < frame.near || frame.flags & FLAG_WHOLE != 0 {
        return PixelBox::whole(frame);
    }
    let points = measured(frame, frame.near, &hull.part);
    hull.seen(frame, nearest, &points.x, &points.y).pixels(frame)
}

/// The verdict by the rules of Weber's program.
fn bound_weber(
    frame: &Frame,
    patches: &[Patch],
    patch: &Patch,
    object: &Object,
    surface: Surface,
) -> Verdict {
    let net = Net::in_eye_space(patch, object);
    let record = if patch.faces > 0 { Some(&patches[patch.faces as usize]) } else { None };
    let faces = record.map(|record| Faces::in_eye_space(record, object));
    let code = weber::code(frame, &net, faces.as_ref(), surface);
    let hull = Hull::of(frame, patches, patch, object, surface);
    let pixels = if code == DRAW { pixels_of(frame, &hull) } else { PixelBox::EMPTY };
    verdict(code, pixels).with_sides([Side::LIVE; 4], [frame.rate; 2])
}

/// Largest magnitude of all sixteen.
#[inline(always)]
fn largest(c: &[f32; 16]) -> f32 {
    max(fold(c, max), neg(fold(c, min)))
}

impl Verdict {
    /// Not visible.
    pub(super) const CULLED: Self = Self { code: CULL, columns: 0, rows: 0, along_u: 0, along_v: 0 };
}

#[inline(always)]
fn verdict(code: u32, pixels: PixelBox) -> Verdict {
    let [left, right, top, bottom] = pixels.0;
    let (columns, rows) = (left as u32 | (right as u32) << 16, top as u32 | (bottom as u32) << 16);
    Verdict { code, columns, rows, along_u: 0, along_v: 0 }
}

/// Splits along the direction that wants it more; at the deepest level, or where the range cannot be
/// halved any further, the surface is drawn as it is. The other direction is tried when it too is too long.
#[inline(always)]
fn refine(frame: &Frame, surface: Surface, kind: u32, (u, v): (f32, f32)) -> u32 {
    let open_u = surface.u_level() < most_splits(kind);
    let open_v = surface.v_level() < most_splits(kind);
    let too_long = |extent| extent > frame.bound;
    if !may_split(frame, surface, 1) {
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

/// Lengths along u and along v, in pixels, of a surface that crosses the near plane: as if all of it were there, and
/// turned to the eye. No part of it that can be seen is longer.
#[inline(always)]
fn extents_if_cut(frame: &Frame, near: f32, part: &Net) -> (f32, f32) {
    let scale = mul(frame.focal, recip(near));
    let mut points = *part;
    for l in 0..16 {
        for c in [&mut points.x[l], &mut points.y[l], &mut points.z[l]] {
            *c = clamp(mul(*c, scale), neg(FAR_OFF), FAR_OFF);
        }
    }
    let lengths = Lengths::new(polygons_u(&points), polygons_v(&points));
    (lengths.u, lengths.v)
}

/// The pixels that drawing a surface can touch of which parts lie as near as the near plane.
#[inline(always)]
fn pixels_if_cut(frame: &Frame, hull: &Hull, farthest: f32) -> PixelBox {
    let (at_near, at_far) = (recip(frame.near), recip(max(add(farthest, hull.slack), frame.near)));
    let seen = |c: f32, by: f32| mul(mul(c, frame.focal), by);
    // What is off the axis is seen farthest off it at the near plane.
    let reach = |low: f32, high: f32| Reach {
        low: seen(low, if low < 0.0 { at_near } else { at_far }),
        high: seen(high, if high > 0.0 { at_near } else { at_far }),
    };
    let around = add(hull.slack, hull.spread());
    let x = reach(fold(&hull.part.x, min), fold(&hull.part.x, max));
    let y = reach(neg(fold(&hull.part.y, max)), neg(fold(&hull.part.y, min)));
    let margin = margin(frame, around, frame.near);
    PixelBox::around(frame, &Seen { x, y, margin }, margin)
}

/// Where the control points are for measuring lengths.
#[inline(always)]
fn measured(frame: &Frame, near: f32, part: &Net) -> Net {
    let mut out = Net { x: [0.0; 16], y: [0.0; 16], z: [0.0; 16] };
    for l in 0..16 {
        [out.x[l], out.y[l], out.z[l]] = measured_point(frame, near, [part.x[l], part.y[l], part.z[l]]);
    }
    out
}

/// Where a point is for measuring lengths: its pixel offsets, at depth 0; or, if the mesh is to be whole, on a
/// sheet of pixels that surrounds the eye, flat where it can see.
#[inline(always)]
pub(super) fn measured_point(frame: &Frame, near: f32, point: [f32; 3]) -> [f32; 3] {
    if frame.flags & FLAG_WHOLE == 0 {
        let [x, y] = point_on_screen(frame, near, point);
        return [x, y, 0.0];
    }
    let before = max(neg(point[2]), mul(largest3(point), frame.around));
    let scale = mul(frame.focal, recip(max(before, near)));
    scale3(point, scale)
}

/// Pixel offsets from the optical axis of a point that is `near` away or farther, or taken to be.
#[inline(always)]
pub(super) fn point_on_screen(frame: &Frame, near: f32, point: [f32; 3]) -> [f32; 2] {
    let (x, y, _) = perspective(frame, near, point);
    [clamp(x, neg(FAR_OFF), FAR_OFF), clamp(y, neg(FAR_OFF), FAR_OFF)]
}

#[inline(always)]
pub(super) fn distance([ax, ay, az]: [f32; 3], [bx, by, bz]: [f32; 3]) -> f32 {
    let (dx, dy, dz) = (sub(bx, ax), sub(by, ay), sub(bz, az));
    sqrt(add(add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz)), LENGTH_TINY))
}

#[inline(always)]
fn segment(points: &Net, from: usize, to: usize) -> f32 {
    let at = |l: usize| [points.x[l], points.y[l], points.z[l]];
    distance(at(from), at(to))
}

/// Lengths in pixels of the control polygons along u.
#[inline(always)]
fn polygons_u(points: &Net) -> [f32; 4] {
    let mut lengths = [0.0; 12];
    for (l, length) in lengths.iter_mut().enumerate() {
        *length = segment(points, l, l + 4);
    }
    let mut polygons = [0.0; 4];
    for (j, out) in polygons.iter_mut().enumerate() {
        *out = polygon(lengths[j], lengths[4 + j], lengths[8 + j]);
    }
    polygons
}

/// Lengths in pixels of the control polygons along v.
#[inline(always)]
fn polygons_v(points: &Net) -> [f32; 4] {
    let mut lengths = [0.0; 15];
    for (l, length) in lengths.iter_mut().enumerate() {
        *length = segment(points, l, l + 1); // every fourth joins two rows and is not used
    }
    let mut polygons = [0.0; 4];
    for (i, out) in polygons.iter_mut().enumerate() {
        *out = polygon(lengths[4 * i], lengths[4 * i + 1], lengths[4 * i + 2]);
    }
    polygons
}

/// Left, right, top and bottom in pixels; right and bottom are one past the last.
pub(super) struct PixelBox([i32; 4]);

impl PixelBox {
    const EMPTY: Self = Self([0; 4]);

    fn whole(frame: &Frame) -> Self {
        Self([frame.left as i32, frame.right as i32, frame.top as i32, frame.bottom as i32])
    }

    #[inline(always)]
    fn around(frame: &Frame, seen: &Seen, margin: f32) -> Self {
        let (left, right) = seen.x.pixels(frame.centre_x, (frame.left, frame.right), margin);
        let (top, bottom) = seen.y.pixels(frame.centre_y, (frame.top, frame.bottom), margin);
        Self([left, right, top, bottom])
    }

    #[inline(always)]
    pub(super) const fn is_empty(&self) -> bool {
        self.0[0] >= self.0[1] || self.0[2] >= self.0[3]
    }
}
