//! Gregory patches (Loop, Schaefer, Ni & Castaño 2009): bicubic nets whose four inner points depend on u and v.
//!
//! Each inner point is a blend of two face points. One has full weight on the border of constant u beside it,
//! the other on the border of constant v, so that the tangent planes of each border are that border's own.
//! Border curves are those of the net alone: plain cubics, the same as a Bézier patch has.

use crate::abi::{INNER_MOST, Object, PARAM_ONE, PARAM_STEP, Patch, THIRD};
use crate::num::{abs, add, float, largest3, max, min, mul, neg, recip, scale3, sub};
use crate::patch::bezier::{blossom, param};
use crate::patch::{Net, Range};

/// Where the inner points stand in a net: 2·i + j of them is the one beside the borders u = i and v = j.
pub const INNER: [usize; 4] = [5, 6, 9, 10];

/// The eight face points, mostly in eye space: those of the borders of constant u, then those of constant v, each in
/// the order of [`INNER`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faces {
    /// x of the points.
    pub x: [f32; 8],
    /// y of the points.
    pub y: [f32; 8],
    /// z of the points.
    pub z: [f32; 8],
}

/// How an inner point is blended: share of the face point of the border of constant u, and how it changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Blend {
    /// Its share; the rest belongs to the other face point.
    pub share: f32,
    /// Derivative of the share along u.
    pub along_u: f32,
    /// Derivative of the share along v.
    pub along_v: f32,
}

impl Faces {
    /// The face points of a patch, from the record [`Patch::faces`] names, moved to eye space.
    #[inline(always)]
    #[must_use]
    pub fn in_eye_space(record: &Patch, object: &Object) -> Self {
        let whole = Net::in_eye_space(record, object);
        let mut faces = Self { x: [0.0; 8], y: [0.0; 8], z: [0.0; 8] };
        for l in 0..8 {
            (faces.x[l], faces.y[l], faces.z[l]) = (whole.x[l], whole.y[l], whole.z[l]);
        }
        faces
    }

    /// The face points in the space of the object.
    #[inline(always)]
    #[must_use]
    pub const fn in_object_space(record: &Patch) -> Self {
        let mut faces = Self { x: [0.0; 8], y: [0.0; 8], z: [0.0; 8] };
        let mut l = 0;
        while l < 8 {
            (faces.x[l], faces.y[l], faces.z[l]) = (record.x[l], record.y[l], record.z[l]);
            l += 1;
        }
        faces
    }

    /// Largest magnitude among all coordinates.
    #[inline(always)]
    #[must_use]
    pub fn extent(&self) -> f32 {
        let mut largest = 0.0;
        for l in 0..8 {
            largest = max(largest, max(max(abs(self.x[l]), abs(self.y[l])), abs(self.z[l])));
        }
        largest
    }

    /// From the face point of the border of constant v to the other, at inner point `m`.
    #[inline(always)]
    #[must_use]
    pub fn difference(&self, m: usize) -> [f32; 3] {
        [sub(self.x[m], self.x[4 + m]), sub(self.y[m], self.y[4 + m]), sub(self.z[m], self.z[4 + m])]
    }

    /// Puts inner point `m`, at this share, into a net.
    #[inline(always)]
    pub fn put_inner(&self, net: &mut Net, m: usize, share: f32) {
        let [x, y, z] = scale3(self.difference(m), share);
        let at = INNER[m];
        (net.x[at], net.y[at], net.z[at]) =
            (add(self.x[4 + m], x), add(self.y[4 + m], y), add(self.z[4 + m], z));
    }

    /// The net that the patch has at one parameter.
    #[inline(always)]
    #[must_use]
    pub fn net_at(&self, net: &Net, blends: [Blend; 4]) -> Net {
        let mut at = *net;
        for (m, blend) in blends.iter().enumerate() {
            self.put_inner(&mut at, m, blend.share);
        }
        at
    }

    /// Puts the middles of all shares that occur on a surface, given by its range, into the net of the whole patch, and
    /// gives how far, along any axis, the surface can be from that net's.
    ///
    /// `exchanged`: with the blends of [`weber_blends`].
    #[inline(always)]
    #[must_use]
    pub fn centre_inner(&self, net: &mut Net, [along_u, along_v]: Range, exchanged: bool) -> f32 {
        let (first, second) = if exchanged { (along_v, along_u) } else { (along_u, along_v) };
        let mut spread = 0.0;
        for m in 0..4 {
            let (a, b) = (distances(first, m / 2), distances(second, m % 2));
            let (low, high) = (share(a.1, b.0), share(a.0, b.1));
            self.put_inner(net, m, middle(a, b));
            let across = (distances(along_u, m / 2), distances(along_v, m % 2));
            let weight = mul(inner_weight(across.0), inner_weight(across.1));
            let half = mul(0.5, sub(high, low));
            spread = add(spread, mul(mul(half, weight), largest3(self.difference(m))));
        }
        spread
    }

    /// Moves the control points of a surface, restricted from the net of [`Faces::centre_inner`], to where
    /// the shares at the surface's four corners, and between them, take them: lengths are then right to first
    /// order.
    #[inline(always)]
    pub fn follow(&self, part: &mut Net, range: Range, exchanged: bool) {
        let [along_u, along_v] = range;
        let (first, second) = if exchanged { (along_v, along_u) } else { (along_u, along_v) };
        let (weights_u, weights_v) = (blossom(along_u[0], along_u[1]), blossom(along_v[0], along_v[1]));
        for m in 0..4 {
            let (a, b) = (ends(first, m / 2), ends(second, m % 2));
            let (from, middle) =
                (self.difference(m), middle(distances(first, m / 2), distances(second, m % 2)));
            let corners = [share(a[0], b[0]), share(a[0], b[1]), share(a[1], b[0]), share(a[1], b[1])];
            for l in 0..16 {
                let (s, t) = (mul(float(l as i32 / 4), THIRD), mul(float(l as i32 % 4), THIRD));
                let (s, t) = if exchanged { (t, s) } else { (s, t) };
                let here = mix(mix(corners[0], corners[1], t), mix(corners[2], corners[3], t), s);
                let weight = mul(weights_u[l / 4][INNER[m] / 4], weights_v[l % 4][INNER[m] % 4]);
                let moved = scale3(from, mul(weight, sub(here, middle)));
                (part.x[l], part.y[l]) = (add(part.x[l], moved[0]), add(part.y[l], moved[1]));
                part.z[l] = add(part.z[l], moved[2]);
            }
        }
    }
}

/// Between two numbers, at `t` from 0 to 1.
#[inline(always)]
pub(crate) const fn mix(low: f32, high: f32, t: f32) -> f32 {
    add(low, mul(sub(high, low), t))
}

/// Distances of a range's low and high end from the end 0 or 1 of its parameter.
#[inline(always)]
const fn ends([low, high]: [u32; 2], end: usize) -> [f32; 2] {
    if end == 0 { [param(low), param(high)] } else { [param(PARAM_ONE - low), param(PARAM_ONE - high)] }
}

/// The middle of all shares at distances in two ranges.
#[inline(always)]
const fn middle(a: (f32, f32), b: (f32, f32)) -> f32 {
    mul(0.5, add(share(a.1, b.0), share(a.0, b.1)))
}

/// Least and largest distance of a range from the end 0 or 1 of its parameter.
#[inline(always)]
const fn distances(range: [u32; 2], end: usize) -> (f32, f32) {
    let [low, high] = ends(range, end);
    if end == 0 { (low, high) } else { (high, low) }
}

/// Largest inner Bernstein weight in a range of distances, or a little more.
#[inline(always)]
const fn inner_weight((low, high): (f32, f32)) -> f32 {
    let rest = sub(1.0, low);
    min(INNER_MOST, mul(mul(3.0, high), mul(rest, rest)))
}

/// Share of the face point of the border of constant u at distances `a` from it and `b` from the border of
/// constant v; at the corner, where it has no weight at all, 0.
#[inline(always)]
const fn share(a: f32, b: f32) -> f32 {
    mul(b, recip(max(add(a, b), PARAM_STEP)))
}

/// The blends of the four inner points at a parameter.
#[inline(always)]
#[must_use]
pub fn blends(u: f32, v: f32) -> [Blend; 4] {
    let (from_u, from_v) = ([u, sub(1.0, u)], [v, sub(1.0, v)]);
    let mut out = [Blend::default(); 4];
    for (m, out) in out.iter_mut().enumerate() {
        let (a, b) = (from_u[m / 2], from_v[m % 2]);
        let scale = recip(max(add(a, b), PARAM_STEP));
        let share = mul(b, scale);
        let (along_a, along_b) = (neg(mul(share, scale)), mul(mul(a, scale), scale));
        *out = Blend {
            share,
            along_u: if m / 2 == 0 { along_a } else { neg(along_a) },
            along_v: if m % 2 == 0 { along_b } else { neg(along_b) },
        };
    }
    out
}

/// The blends as Weber's program has them (2014): with u and v exchanged, so that normals jump at borders.
#[inline(always)]
#[must_use]
pub fn weber_blends(u: f32, v: f32) -> [Blend; 4] {
    let mut out = blends(v, u);
    for blend in &mut out {
        (blend.along_u, blend.along_v) = (blend.along_v, blend.along_u);
    }
    out
}

/// Number of patches among a scene's records: the others hold face points, one a Gregory patch.
#[must_use]
pub fn patch_count(records: &[Patch]) -> usize {
    records.len() - records.iter().filter(|record| record.faces > 0).count()
}
