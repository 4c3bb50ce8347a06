//! bound for many surfaces of Bézier patches at once, a lane each: the verdicts of [`mod@super::bound`], sooner.
//!
//! Every loop over lanes is a short plain one, so that compilers turn it into vector instructions. What is rare
//! (patches of other kinds, the near plane, the profile of Weber's program) is left to `bound_any`, surface by
//! surface.

use crate::abi::{FLAG_FLAT, FLAG_WEBER, FLAG_WHOLE, Frame, Object, Patch, ROUNDING, Surface, Verdict};
use crate::kernel::bound::{Reach, Seen, bound_any, by_length, distance, margin, point_on_screen};
use crate::kernel::dice::position_at;
use crate::kernel::sides::{Lengths, Strays, polygon};
use crate::num::{add, max, min, mul, neg};
use crate::patch::Net;
use crate::patch::bezier::{blend4, blossom};
use crate::patch::instance::{Instance, instance};
use crate::patch::net::fold;

/// Surfaces that are bounded at once.
pub const LANES: usize = 16;
/// Fewer than this many are bounded one by one.
const WORTH_IT: usize = 4;

/// One number a surface.
type Lane = [f32; LANES];
/// Sixteen control points a surface, one coordinate of them.
type Points = [Lane; 16];

/// Room to work in; what it holds at first does not matter.
#[derive(Clone, Debug)]
pub struct Lanes {
    /// Control points in eye space: of the whole patch, then of the part that the surface covers.
    net: [Points; 3],
    /// Control points of the part along u, of the whole along v.
    strip: [Points; 3],
    /// Pixels from the optical axis, right of it and below.
    seen: [Points; 2],
    /// The least of them, and the largest.
    low: [Lane; 2],
    high: [Lane; 2],
    slack: Lane,
    nearest: Lane,
    farthest: Lane,
    /// Lengths of the four control polygons along u and along v.
    lengths: [[Lane; 4]; 2],
    /// Low and high ends of the ranges of u and v.
    ranges: [[[u32; LANES]; 2]; 2],
    /// Blossoms of the ranges of u and v.
    weights: [[[Lane; 4]; 4]; 2],
    /// Is the lane's surface one that has to be bounded by itself?
    alone: [bool; LANES],
}

impl Default for Lanes {
    fn default() -> Self {
        Self {
            net: [[[0.0; LANES]; 16]; 3],
            strip: [[[0.0; LANES]; 16]; 3],
            seen: [[[0.0; LANES]; 16]; 2],
            low: [[0.0; LANES]; 2],
            high: [[0.0; LANES]; 2],
            slack: [0.0; LANES],
            nearest: [0.0; LANES],
            farthest: [0.0; LANES],
            lengths: [[[0.0; LANES]; 4]; 2],
            ranges: [[[0; LANES]; 2]; 2],
            weights: [[[[0.0; LANES]; 4]; 4]; 2],
            alone: [false; LANES],
        }
    }
}

/// The verdicts on surfaces of any patches, one each: those of [`bound_any`].
#[inline(always)]
pub fn bound_lanes(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    surfaces: &[Surface],
    verdicts: &mut [Verdict],
    lanes: &mut Lanes,
) {
    for (surfaces, verdicts) in surfaces.chunks(LANES).zip(verdicts.chunks_mut(LANES)) {
        if frame.flags & (FLAG_FLAT | FLAG_WEBER | FLAG_WHOLE) != 0 || surfaces.len() < WORTH_IT {
            lanes.alone = [true; LANES];
        } else {
            lanes.load(frame, objects, patches, surfaces);
            lanes.measure(frame);
        }
        for (l, (surface, verdict)) in surfaces.iter().zip(verdicts).enumerate() {
            let known =
                if lanes.alone[l] { None } else { lanes.verdict(frame, objects, patches, *surface, l) };
            *verdict = match known {
                Some(verdict) => verdict,
                None => bound_any(frame, objects, patches, *surface),
            };
        }
    }
}

impl Lanes {
    /// A surface a lane; the lanes that are left over keep what they have.
    #[inline(always)]
    fn load(&mut self, frame: &Frame, objects: &[Object], patches: &[Patch], surfaces: &[Surface]) {
        let mut known = None;
        for (l, surface) in surfaces.iter().enumerate() {
            let Instance { record, object } = instance(frame, objects, patches, surface.patch_id);
            let (patch, object) = (&patches[record as usize], &objects[object as usize]);
            self.alone[l] = patch.faces > 0 || patch.kind > 0 || object.reach > 0.0;
            // Neighbours on the stack are mostly of one patch.
            let (_, net, slack) = match known {
                Some(last @ (patch_id, _, _)) if patch_id == surface.patch_id => last,
                _ => {
                    let net = Net::in_eye_space(patch, object);
                    (surface.patch_id, net, mul(net.extent(), ROUNDING))
                }
            };
            known = Some((surface.patch_id, net, slack));
            self.put(l, &net, slack, *surface);
        }
    }

    #[inline(always)]
    fn put(&mut self, l: usize, net: &Net, slack: f32, surface: Surface) {
        for k in 0..16 {
            (self.net[0][k][l], self.net[1][k][l], self.net[2][k][l]) = (net.x[k], net.y[k], net.z[k]);
        }
        self.slack[l] = slack;
        let (low, high) = (surface.u, surface.u + surface.u_size());
        (self.ranges[0][0][l], self.ranges[0][1][l]) = (low, high);
        let (low, high) = (surface.v, surface.v + surface.v_size());
        (self.ranges[1][0][l], self.ranges[1][1][l]) = (low, high);
    }

    /// From the control points of the patches to distances and lengths on screen.
    #[inline(always)]
    fn measure(&mut self, frame: &Frame) {
        let Self { net, strip, seen, ranges, weights, lengths, .. } = self;
        for (weights, ranges) in weights.iter_mut().zip(ranges) {
            blossoms(ranges, weights);
        }
        for (net, strip) in net.iter_mut().zip(strip) {
            for line in 0..4 {
                restrict(&weights[0], net, strip, line, 4);
            }
            for line in 0..4 {
                restrict(&weights[1], strip, net, 4 * line, 1);
            }
        }
        for l in 0..LANES {
            let z = column(&net[2], l);
            (self.nearest[l], self.farthest[l]) = (neg(fold(&z, max)), neg(fold(&z, min)));
        }
        for k in 0..16 {
            for l in 0..LANES {
                let point = [net[0][k][l], net[1][k][l], net[2][k][l]];
                [seen[0][k][l], seen[1][k][l]] = point_on_screen(frame, frame.near, point);
            }
        }
        for axis in 0..2 {
            for l in 0..LANES {
                let Reach { low, high } = Reach::of(&column(&seen[axis], l));
                (self.low[axis][l], self.high[axis][l]) = (low, high);
            }
        }
        polygons(seen, [0, 1, 2, 3], 4, &mut lengths[0]);
        polygons(seen, [0, 4, 8, 12], 1, &mut lengths[1]);
    }

    /// What becomes of the surface in lane `l`, unless it, or a corner that has strayed, crosses the near plane.
    #[inline(always)]
    fn verdict(
        &self,
        frame: &Frame,
        objects: &[Object],
        patches: &[Patch],
        surface: Surface,
        l: usize,
    ) -> Option<Verdict> {
        let [nearest, farthest, slack] = [self.nearest[l], self.farthest[l], self.slack[l]];
        let strays =
            if surface.keeps_its_corners() { None } else { strays(frame, objects, patches, surface) };
        if let Some(strays) = strays {
            if strays.nearest < frame.near {
                return None;
            }
        } else if add(farthest, slack) < frame.near {
            return Some(Verdict::CULLED);
        }
        if nearest < frame.near {
            return None;
        }
        let seen = Seen { x: self.reach(0, l), y: self.reach(1, l), margin: margin(frame, slack, nearest) };
        let pixels = seen.with_strays(strays).pixels(frame);
        if pixels.is_empty() {
            return Some(Verdict::CULLED);
        }
        let polygons = |axis: usize| {
            let [a, b, c, d] = &self.lengths[axis];
            [a[l], b[l], c[l], d[l]]
        };
        Some(by_length(frame, surface, 0, &Lengths::new(polygons(0), polygons(1)), pixels))
    }

    #[inline(always)]
    fn reach(&self, axis: usize, l: usize) -> Reach {
        Reach { low: self.low[axis][l], high: self.high[axis][l] }
    }
}

/// The blossoms of a range a lane.
#[inline(always)]
fn blossoms(ranges: &[[u32; LANES]; 2], weights: &mut [[Lane; 4]; 4]) {
    for l in 0..LANES {
        let blossom = blossom(ranges[0][l], ranges[1][l]);
        for k in 0..4 {
            for i in 0..4 {
                weights[k][i][l] = blossom[k][i];
            }
        }
    }
}

/// Control points of the part of one line of a net: those at `first`, `first + step` …
#[inline(always)]
fn restrict(weights: &[[Lane; 4]; 4], from: &Points, to: &mut Points, first: usize, step: usize) {
    for l in 0..LANES {
        let at = |k: usize| first + k * step;
        let points = [from[at(0)][l], from[at(1)][l], from[at(2)][l], from[at(3)][l]];
        for k in 0..4 {
            let [a, b, c, d] = &weights[k];
            to[at(k)][l] = blend4([a[l], b[l], c[l], d[l]], points);
        }
    }
}

/// Lengths of four control polygons, whose points are `step` apart.
#[inline(always)]
fn polygons(seen: &[Points; 2], first: [usize; 4], step: usize, out: &mut [Lane; 4]) {
    for (out, first) in out.iter_mut().zip(first) {
        for l in 0..LANES {
            let at = |k: usize| [seen[0][first + k * step][l], seen[1][first + k * step][l], 0.0];
            out[l] = polygon(distance(at(0), at(1)), distance(at(1), at(2)), distance(at(2), at(3)));
        }
    }
}

/// Corners that have strayed from a surface of a Bézier patch that is not displaced.
#[inline(never)]
fn strays(frame: &Frame, objects: &[Object], patches: &[Patch], surface: Surface) -> Option<Strays> {
    let Instance { record, object } = instance(frame, objects, patches, surface.patch_id);
    let net = Net::in_eye_space(&patches[record as usize], &objects[object as usize]);
    Strays::of(frame, surface, 0.0, |u, v| position_at(&net, u, v))
}

/// The points of one lane.
#[inline(always)]
fn column(points: &Points, l: usize) -> [f32; 16] {
    let mut out = [0.0; 16];
    for (out, points) in out.iter_mut().zip(points) {
        *out = points[l];
    }
    out
}
