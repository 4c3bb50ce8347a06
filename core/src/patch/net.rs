//! Sixteen control points, a coordinate an array, index `4·i + j` with `i` along `u`: in eye space, or where vertices are
//! displaced, in the space of their object.

use crate::abi::{Object, Patch};
use crate::num::{abs, add, max, mul};
use crate::patch::bezier::{blend4, blossom};

use crate::abi::Surface;

/// Control net of a bicubic patch or of a part of it, mostly in eye space (the eye looks along -z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Net {
    /// x of the control points.
    pub x: [f32; 16],
    /// y of the control points.
    pub y: [f32; 16],
    /// z of the control points.
    pub z: [f32; 16],
}

impl Net {
    /// Control net of the whole patch, in the space of its object.
    #[inline(always)]
    #[must_use]
    pub const fn in_object_space(patch: &Patch) -> Self {
        Self { x: patch.x, y: patch.y, z: patch.z }
    }

    /// Control net of the whole patch, moved to eye space.
    #[inline(always)]
    #[must_use]
    pub fn in_eye_space(patch: &Patch, object: &Object) -> Self {
        let m = &object.to_eye;
        Self {
            x: transformed(patch, [m[0], m[1], m[2], m[3]]),
            y: transformed(patch, [m[4], m[5], m[6], m[7]]),
            z: transformed(patch, [m[8], m[9], m[10], m[11]]),
        }
    }

    /// Largest magnitude among all coordinates: the measure for rounding errors.
    #[inline(always)]
    #[must_use]
    pub fn extent(&self) -> f32 {
        let mut largest = [0.0; 16];
        for (l, largest) in largest.iter_mut().enumerate() {
            *largest = max(max(abs(self.x[l]), abs(self.y[l])), abs(self.z[l]));
        }
        fold(&largest, max)
    }

    /// Control net of the part of the patch that `surface` covers: its convex hull contains that part.
    ///
    /// Computed by blossoming (Ramshaw 1989): every new control point is a convex combination of old ones.
    #[inline(always)]
    #[must_use]
    pub fn restricted(&self, surface: Surface) -> Self {
        self.between(range_of(surface))
    }

    /// The same of a range.
    #[inline(always)]
    #[must_use]
    pub fn between(&self, [u, v]: Range) -> Self {
        let (along_u, along_v) = (blossom(u[0], u[1]), blossom(v[0], v[1]));
        Self {
            x: combine_v(&combine_u(&self.x, &along_u), &along_v),
            y: combine_v(&combine_u(&self.y, &along_u), &along_v),
            z: combine_v(&combine_u(&self.z, &along_u), &along_v),
        }
    }
}

/// A range of parameters: the low and the high end of `u`, then those of `v`.
pub type Range = [[u32; 2]; 2];

/// The range of a surface.
#[inline(always)]
#[must_use]
pub const fn range_of(surface: Surface) -> Range {
    [[surface.u, surface.u + surface.u_size()], [surface.v, surface.v + surface.v_size()]]
}

/// One eye-space coordinate of all control points.
#[inline(always)]
fn transformed(patch: &Patch, row: [f32; 4]) -> [f32; 16] {
    let mut out = [0.0; 16];
    for (l, out) in out.iter_mut().enumerate() {
        *out = row_of_matrix(row, [patch.x[l], patch.y[l], patch.z[l]]);
    }
    out
}

/// One coordinate of a point that is moved by a matrix, given the row of it.
#[inline(always)]
const fn row_of_matrix(row: [f32; 4], point: [f32; 3]) -> f32 {
    let xy = add(mul(row[0], point[0]), mul(row[1], point[1]));
    add(add(xy, mul(row[2], point[2])), row[3])
}

impl Object {
    /// A point of the object's space, moved to eye space.
    #[inline(always)]
    #[must_use]
    pub const fn point_to_eye(&self, point: [f32; 3]) -> [f32; 3] {
        let m = &self.to_eye;
        [
            row_of_matrix([m[0], m[1], m[2], m[3]], point),
            row_of_matrix([m[4], m[5], m[6], m[7]], point),
            row_of_matrix([m[8], m[9], m[10], m[11]], point),
        ]
    }
}

/// `weights` applied along `u`: four weighted sums of the rows of the net.
#[inline(always)]
pub(super) fn combine_u(c: &[f32; 16], weights: &[[f32; 4]; 4]) -> [f32; 16] {
    let mut out = [0.0; 16];
    for (k, w) in weights.iter().enumerate() {
        for j in 0..4 {
            out[4 * k + j] = blend4(*w, [c[j], c[4 + j], c[8 + j], c[12 + j]]);
        }
    }
    out
}

/// `weights` applied along `v`: four weighted sums of the columns of the net.
#[inline(always)]
pub(super) fn combine_v(c: &[f32; 16], weights: &[[f32; 4]; 4]) -> [f32; 16] {
    let mut out = [0.0; 16];
    for i in 0..4 {
        for (l, w) in weights.iter().enumerate() {
            out[4 * i + l] = blend4(*w, [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]]);
        }
    }
    out
}

/// All sixteen numbers reduced to one in a fixed tree.
#[inline(always)]
pub(crate) fn fold(lanes: &[f32; 16], join: impl Fn(f32, f32) -> f32) -> f32 {
    let mut lanes = *lanes;
    let mut width = 8;
    while width > 0 {
        for l in 0..width {
            lanes[l] = join(lanes[l], lanes[l + width]);
        }
        width /= 2;
    }
    lanes[0]
}
