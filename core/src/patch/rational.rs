//! Rational bicubic Bézier patches (Farin, Curves and Surfaces for CAGD, ch. 13): every control point has a weight.
//!
//! Weights are above 0, so a part of a patch lies in the convex hull of its own control points, and curves are no longer
//! than their control polygons: `bound` needs to know nothing else about them.

use crate::abi::Patch;
use crate::kernel::dice::Vertex;
use crate::num::{mul, recip, sub};
use crate::patch::bezier::{blend3, blend4, blossom, cubic, cubic_slope, param};
use crate::patch::net::{combine_u, combine_v};
use crate::patch::{Net, Range};

/// The weights of a rational patch; index `4·i + j` with `i` along `u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights(pub [f32; 16]);

/// Control points multiplied by their weights, a coordinate an array; the last are the weights.
type Homogeneous = [[f32; 16]; 4];

impl Weights {
    /// From the record that holds them.
    #[inline(always)]
    #[must_use]
    pub const fn of(record: &Patch) -> Self {
        Self(record.x)
    }

    #[inline(always)]
    fn homogeneous(&self, net: &Net) -> Homogeneous {
        let weighted = |c: &[f32; 16]| {
            let mut out = *c;
            for (out, weight) in out.iter_mut().zip(self.0) {
                *out = mul(*out, weight);
            }
            out
        };
        [weighted(&net.x), weighted(&net.y), weighted(&net.z), self.0]
    }

    /// Control points, not multiplied by their weights, of a part of the patch.
    #[inline(always)]
    #[must_use]
    pub fn between(&self, net: &Net, [u, v]: Range) -> Net {
        let (along_u, along_v) = (blossom(u[0], u[1]), blossom(v[0], v[1]));
        let [mut x, mut y, mut z, weights] =
            self.homogeneous(net).map(|c| combine_v(&combine_u(&c, &along_u), &along_v));
        for l in 0..16 {
            let scale = recip(weights[l]);
            (x[l], y[l], z[l]) = (mul(x[l], scale), mul(y[l], scale), mul(z[l], scale));
        }
        Net { x, y, z }
    }

    /// A vertex of the patch, and its derivatives by the quotient rule.
    #[inline(always)]
    #[must_use]
    pub fn evaluate(&self, net: &Net, u: u32, v: u32) -> Vertex {
        let (u, v) = (param(u), param(v));
        let (along_u, slope_u) = (cubic(u), cubic_slope(u));
        let (along_v, slope_v) = (cubic(v), cubic_slope(v));
        let (mut point, mut du, mut dv) = ([0.0; 4], [0.0; 4], [0.0; 4]);
        for (k, c) in self.homogeneous(net).iter().enumerate() {
            let (mut curve, mut across) = ([0.0; 4], [0.0; 4]);
            for i in 0..4 {
                let p = [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]];
                curve[i] = blend4(along_v, p);
                across[i] = blend3(slope_v, steps(p));
            }
            point[k] = blend4(along_u, curve);
            du[k] = blend3(slope_u, steps(curve));
            dv[k] = blend4(along_u, across);
        }
        let scale = recip(point[3]);
        let at = [mul(point[0], scale), mul(point[1], scale), mul(point[2], scale)];
        Vertex { point: at, du: quotient(at, du, scale), dv: quotient(at, dv, scale) }
    }
}

#[inline(always)]
const fn steps(p: [f32; 4]) -> [f32; 3] {
    [sub(p[1], p[0]), sub(p[2], p[1]), sub(p[3], p[2])]
}

/// The derivative of a quotient that is `at`, given those of numerator and denominator and 1 / denominator.
#[inline(always)]
const fn quotient(at: [f32; 3], slope: [f32; 4], scale: f32) -> [f32; 3] {
    [
        mul(sub(slope[0], mul(at[0], slope[3])), scale),
        mul(sub(slope[1], mul(at[1], slope[3])), scale),
        mul(sub(slope[2], mul(at[2], slope[3])), scale),
    ]
}
