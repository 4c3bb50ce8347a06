//! sides: how the four sides of a surface are divided, and how finely its grid is diced. Part of `bound`.
//!
//! A side's length on screen is that of the control polygon of its own curve, from control points that both
//! neighbours have bit by bit, in an order that is the same from either end. What is nearer than the near plane is
//! taken at the near plane; or farther away, where displacement reaches farther.

use crate::abi::{
    DRAW_LIMITED, FLAG_FIXED, FLAG_FLAT, FLAG_NAIVE, Frame, KIND_HALVED, PARAM_BITS, PARAM_ONE, Surface,
};
use crate::border::{SIDES, Side};
use crate::kernel::bound::{Reach, distance, measured_point, point_on_screen, wobble};
use crate::kernel::dice_gregory::evaluate_gregory;
use crate::kernel::flat::line_flatness;
use crate::num::{abs, add, clamp, float, floor, max, min, mul, neg, sub};
use crate::patch::half::{Line, is_outer};
use crate::patch::{Faces, Net};

/// Lengths in pixels: of the longest lines of the surface along `u` and along `v`, and of its sides; or how far it is from
/// being flat ([`crate::kernel::flat`]).
#[derive(Clone, Copy, Debug)]
pub struct Lengths {
    /// Along `u`.
    pub u: f32,
    /// Along `v`.
    pub v: f32,
    /// Of the sides, by number.
    pub sides: [f32; 4],
}

impl Lengths {
    /// Of a surface whose control polygons along `u` and along `v` are so long, each in order.
    #[inline(always)]
    pub(super) fn new(u: [f32; 4], v: [f32; 4]) -> Self {
        Self { u: longest(u), v: longest(v), sides: [u[0], u[3], v[0], v[3]] }
    }

    /// A surface is no shorter than its sides.
    #[inline(always)]
    pub(super) fn with_sides(self, sides: [f32; 4]) -> Self {
        let [a, b, c, d] = sides;
        Self { u: max(self.u, max(a, b)), v: max(self.v, max(c, d)), sides }
    }
}

#[inline(always)]
fn longest([a, b, c, d]: [f32; 4]) -> f32 {
    max(max(a, b), max(c, d))
}

/// Length of a polygon of three pieces; the same from either end.
#[inline(always)]
pub(super) const fn polygon(a: f32, b: f32, c: f32) -> f32 {
    add(add(a, c), b)
}

/// Steps of a line that is so long on screen.
#[inline(always)]
#[must_use]
pub fn steps(frame: &Frame, length: f32) -> u32 {
    let most = float(frame.rate as i32);
    let steps = clamp(mul(length, frame.density), 1.0, most);
    -floor(neg(steps)) as u32
}

/// How the sides of a surface of a patch of this kind are divided, given their lengths: as they were, unless they are live
/// and short enough; or long, but may not be halved any more. Half way through a split into four nothing is decided, so
/// that the middle of the four is a vertex.
#[inline(always)]
#[must_use]
pub fn divide(frame: &Frame, surface: Surface, kind: u32, lengths: &Lengths, code: u32) -> [Side; 4] {
    let mut out = [Side::LIVE; 4];
    for side in SIDES {
        let known = surface.side(side);
        let is_short = lengths.sides[side] <= frame.bound && !is_to_be_halved(surface, kind, side);
        let is_last = is_short && !is_half_way(frame, surface) || code == DRAW_LIMITED;
        out[side] = if known.steps == 0 && is_last && frame.flags & FLAG_NAIVE == 0 {
            Side { steps: steps(frame, lengths.sides[side]), bits: surface.extent_of(side).1 }
        } else {
            known
        };
    }
    out
}

/// Has a surface that is split into four been split once?
#[inline(always)]
pub(super) const fn is_half_way(frame: &Frame, surface: Surface) -> bool {
    frame.flags & FLAG_FLAT != 0 && surface.u_level() > surface.v_level()
}

/// Is a side all of one side of its patch, with two patches on the other side of it?
#[inline(always)]
const fn is_to_be_halved(surface: Surface, kind: u32, side: usize) -> bool {
    kind & KIND_HALVED & 1 << side != 0 && surface.extent_of(side).1 == PARAM_BITS && is_outer(surface, side)
}

/// Lengths of the sides of a surface, those replaced that are halves of other patches' sides, given what they are there.
#[inline(always)]
pub(super) fn with_half_lines(
    frame: &Frame,
    near: f32,
    lines: &[Option<Line>; 4],
    lengths: Lengths,
) -> Lengths {
    let mut sides = lengths.sides;
    for side in SIDES {
        if let Some(line) = &lines[side] {
            sides[side] = line_extent(frame, near, line);
        }
    }
    lengths.with_sides(sides)
}

/// Length of a line's control polygon on screen, or how far it is from its chord.
#[inline(always)]
fn line_extent(frame: &Frame, near: f32, line: &Line) -> f32 {
    if frame.flags & FLAG_FLAT != 0 {
        return line_flatness(frame, near, line);
    }
    let [a, b, c, d] = line.map(|point| measured_point(frame, near, point));
    polygon(distance(a, b), distance(b, c), distance(c, d))
}

/// Micropolygons along `u` and along `v` of a surface whose sides are divided: enough for its lengths, and for
/// every vertex of its sides.
#[inline(always)]
#[must_use]
pub fn rates(frame: &Frame, surface: Surface, sides: &[Side; 4], lengths: &Lengths) -> [u32; 2] {
    if frame.flags & FLAG_FIXED != 0 {
        return [frame.rate; 2];
    }
    let least = |length: f32, first: usize| {
        let bits = surface.extent_of(first).1;
        let needed = sides[first].steps_needed(bits).max(sides[first + 1].steps_needed(bits));
        steps(frame, length).max(needed)
    };
    [least(lengths.u, 0), least(lengths.v, 2)]
}

/// Lengths of the sides of a surface of a Gregory patch: a side on the patch's edge as it is in `lengths`, as if
/// the patch were a Bézier patch; a line inside the patch as four chords between its points.
pub(super) fn sides_of_gregory(
    frame: &Frame,
    near: f32,
    net: &Net,
    faces: &Faces,
    surface: Surface,
    lengths: [f32; 4],
) -> [f32; 4] {
    let (low, high) = ([surface.u, surface.v], [surface.u_size(), surface.v_size()]);
    let ends = [surface.v, surface.v + surface.v_size(), surface.u, surface.u + surface.u_size()];
    let mut out = lengths;
    for side in SIDES {
        if surface.side(side).steps > 0 || ends[side] == 0 || ends[side] == PARAM_ONE {
            continue;
        }
        let along = side / 2;
        let mut seen = [[0.0; 3]; 5];
        for (quarter, seen) in (0..).zip(&mut seen) {
            let mut at = [ends[side]; 2];
            at[along] = low[along] + quarter * (high[along] / 4);
            *seen = measured_point(frame, near, evaluate_gregory(net, faces, frame, at[0], at[1]).point);
        }
        let chord = |k: usize| distance(seen[k], seen[k + 1]);
        out[side] = add(add(chord(0), chord(3)), add(chord(1), chord(2)));
    }
    out
}

/// Where corners are that have strayed from a surface: it is drawn as far as there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strays {
    pub(super) x: Reach,
    pub(super) y: Reach,
    /// Smallest and largest distance from the eye plane.
    pub(super) nearest: f32,
    pub(super) farthest: f32,
}

impl Strays {
    /// Of a surface whose vertices lie at `position`, and can be displaced by `reach`; `None` if all its corners are its
    /// own.
    #[inline(always)]
    pub(super) fn of(
        frame: &Frame,
        surface: Surface,
        reach: f32,
        position: impl Fn(u32, u32) -> [f32; 3],
    ) -> Option<Self> {
        if surface.keeps_its_corners() {
            return None;
        }
        let mut found: Option<Self> = None;
        for corner in 0..4 {
            if !surface.has_strayed(corner) {
                continue;
            }
            let [u, v] = surface.corner(corner);
            let point = position(u, v);
            let ([x, y], distance) = (point_on_screen(frame, frame.near, point), neg(point[2]));
            let (nearest, farthest) = (sub(distance, reach), add(distance, reach));
            let by = wobble(frame, max(abs(x), abs(y)), reach, max(nearest, frame.near));
            let own = Self { x: Reach::around(x, by), y: Reach::around(y, by), nearest, farthest };
            found = Some(found.map_or(own, |others| others.joined(own)));
        }
        found
    }

    #[inline(always)]
    fn joined(self, other: Self) -> Self {
        Self {
            x: self.x.joined(other.x),
            y: self.y.joined(other.y),
            nearest: min(self.nearest, other.nearest),
            farthest: max(self.farthest, other.farthest),
        }
    }
}
