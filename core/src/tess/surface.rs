//! Built-in evaluation: where a point of a patch is and how it faces there (Stadlbauer 2019, Fig. 5.14).
//!
//! On an outer edge everything depends on the edge alone, and summands are paired so that they commute when the edge is
//! run the other way: patches that share it find the same bits.
#![deny(clippy::float_arithmetic)]

use super::corner::{corner_count, normal, point, shares, weights};
use crate::abi::{
    LENGTH_TINY, SHADE_TINY, TESS_BEZIER, TESS_COORDINATES, TESS_PHONG, TESS_PN, THIRD, TessFrame, TessPatch,
};
use crate::num::{add, add3, cross3, dot3, flush, flush3, mul, neg, recip, rsqrt, scale3, sub};
use crate::patch::bezier::{blend3, blend4, cubic, cubic_slope};

const SIXTH: f32 = 1.0 / 6.0;

/// A patch as it is evaluated: what all its points need.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TessSurface {
    /// Corners; for PN triangles two points and a normal an edge besides.
    corners: [[f32; 3]; 4],
    normals: [[f32; 3]; 4],
    /// Of edge `k`, from corner `k + 1` to corner `k + 2`: the point next to the first, and next to the last.
    next: [[[f32; 3]; 2]; 3],
    /// The point in the middle of a PN triangle.
    centre: [f32; 3],
    /// Normals in the middle of edges.
    bends: [[f32; 3]; 3],
}

impl TessSurface {
    /// Of a patch.
    #[inline(always)]
    #[must_use]
    pub const fn new(frame: &TessFrame, patch: &TessPatch) -> Self {
        let mut surface = Self {
            corners: [[0.0; 3]; 4],
            normals: [[0.0; 3]; 4],
            next: [[[0.0; 3]; 2]; 3],
            centre: [0.0; 3],
            bends: [[0.0; 3]; 3],
        };
        let mut corner = 0;
        while corner < corner_count(frame) {
            surface.corners[corner as usize] = point(patch, corner);
            surface.normals[corner as usize] = normal(patch, corner);
            corner += 1;
        }
        if frame.evaluation == TESS_PN {
            surface.bend();
        }
        surface
    }

    /// The control points of a PN triangle (Vlachos et al. 2001, sec. 3).
    #[inline(always)]
    const fn bend(&mut self) {
        let mut sum = [0.0; 3];
        let mut edge = 0;
        while edge < 3 {
            let (a, b) = ((edge + 1) % 3, (edge + 2) % 3);
            let (p, q) = (self.corners[a], self.corners[b]);
            let (m, n) = (self.normals[a], self.normals[b]);
            self.next[edge] = [next_to(p, m, q), next_to(q, n, p)];
            self.bends[edge] = bent(p, m, q, n);
            sum = add3(sum, add3(self.next[edge][0], self.next[edge][1]));
            edge += 1;
        }
        let corners = add3(add3(self.corners[0], self.corners[1]), self.corners[2]);
        // The mean of the six, and half of its way from the mean of the corners.
        self.centre = flush3(add3(scale3(sum, 0.25), scale3(corners, neg(SIXTH))));
    }

    /// A point and its normal.
    #[inline(always)]
    #[must_use]
    pub const fn at(&self, frame: &TessFrame, patch: &TessPatch, coordinates: [u32; 3]) -> [[f32; 3]; 2] {
        let weights = weights(frame, coordinates);
        match frame.evaluation {
            TESS_COORDINATES => [shares(coordinates), [0.0; 3]],
            TESS_BEZIER => bezier(patch, shares(coordinates)),
            TESS_PN => self.pn(shares(coordinates)),
            TESS_PHONG => [self.phong(frame.phong, weights), unit(sum(weights, &self.normals))],
            _ => [sum(weights, &self.corners), unit(sum(weights, &self.normals))],
        }
    }

    /// Cubic points and quadratic normals.
    #[inline(always)]
    const fn pn(&self, t: [f32; 3]) -> [[f32; 3]; 2] {
        let [u, v, w] = t;
        let squares = [mul(u, u), mul(v, v), mul(w, w), 0.0];
        let cubes = [mul(squares[0], u), mul(squares[1], v), mul(squares[2], w), 0.0];
        let mut points = sum(cubes, &self.corners);
        let mut edges = [[0.0; 3]; 4];
        let mut bends = [[0.0; 3]; 4];
        let mut edge = 0;
        while edge < 3 {
            let (a, b) = ((edge + 1) % 3, (edge + 2) % 3);
            let (near, far) = (mul(squares[a], t[b]), mul(squares[b], t[a]));
            let [p, q] = self.next[edge];
            edges[edge] = scale3(add3(scale3(p, near), scale3(q, far)), 3.0);
            bends[edge] = scale3(self.bends[edge], mul(t[a], t[b]));
            edge += 1;
        }
        points = add3(points, total(&edges));
        let point = add3(points, scale3(self.centre, mul(6.0, mul(mul(u, v), w))));
        let normal = add3(sum(squares, &self.normals), total(&bends));
        [flush3(point), unit(flush3(normal))]
    }

    /// Between the flat point and the mean of where the tangent planes at the corners have it.
    #[inline(always)]
    const fn phong(&self, share: f32, weights: [f32; 4]) -> [f32; 3] {
        let flat = sum(weights, &self.corners);
        let mut lifts = [[0.0; 3]; 4];
        let mut corner = 0;
        while corner < 4 {
            let n = self.normals[corner];
            let height = flush(dot3(flush3(minus(self.corners[corner], flat)), n));
            lifts[corner] = scale3(n, mul(height, weights[corner]));
            corner += 1;
        }
        flush3(add3(flat, scale3(flush3(total(&lifts)), share)))
    }
}

/// The control point next to corner `p`, whose normal is `n`, towards corner `q`: a third of the way, in the tangent plane.
#[inline(always)]
const fn next_to(p: [f32; 3], n: [f32; 3], q: [f32; 3]) -> [f32; 3] {
    let height = flush(dot3(flush3(minus(q, p)), n));
    let flat = add3(add3(p, p), q);
    flush3(scale3(minus(flat, scale3(n, height)), THIRD))
}

/// The normal in the middle of an edge: those at its ends together, mirrored on the plane across the edge.
#[inline(always)]
const fn bent(p: [f32; 3], m: [f32; 3], q: [f32; 3], n: [f32; 3]) -> [f32; 3] {
    let along = flush3(minus(q, p));
    let both = add3(m, n);
    let turned = mul(2.0, mul(flush(dot3(along, both)), recip(add(dot3(along, along), LENGTH_TINY))));
    unit(flush3(minus(both, scale3(along, flush(turned)))))
}

/// Corners times their shares.
#[inline(always)]
#[must_use]
pub const fn sum(weights: [f32; 4], points: &[[f32; 3]; 4]) -> [f32; 3] {
    let scaled = [
        scale3(points[0], weights[0]),
        scale3(points[1], weights[1]),
        scale3(points[2], weights[2]),
        scale3(points[3], weights[3]),
    ];
    flush3(total(&scaled))
}

/// Of four vectors; where two of them are zero it does not matter which.
#[inline(always)]
const fn total(points: &[[f32; 3]; 4]) -> [f32; 3] {
    add3(add3(points[0], points[1]), add3(points[2], points[3]))
}

#[inline(always)]
const fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [sub(a[0], b[0]), sub(a[1], b[1]), sub(a[2], b[2])]
}

/// A vector made one long; zero stays zero.
#[inline(always)]
const fn unit(a: [f32; 3]) -> [f32; 3] {
    let square = dot3(a, a);
    let scaled = flush3(scale3(a, rsqrt(square)));
    let is_long = square > SHADE_TINY;
    [
        if is_long { scaled[0] } else { 0.0 },
        if is_long { scaled[1] } else { 0.0 },
        if is_long { scaled[2] } else { 0.0 },
    ]
}

/// A point of a bicubic patch, and the normal of its tangents.
#[inline(always)]
const fn bezier(patch: &TessPatch, t: [f32; 3]) -> [[f32; 3]; 2] {
    let (wu, wv) = (cubic(t[0]), cubic(t[1]));
    let (su, sv) = (cubic_slope(t[0]), cubic_slope(t[1]));
    let (mut place, mut along_u, mut along_v) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let mut axis = 0;
    while axis < 3 {
        let (mut rows, mut slopes) = ([0.0; 4], [0.0; 4]);
        let mut i = 0;
        while i < 4 {
            let c = [
                flush(patch.points[12 * i + axis]),
                flush(patch.points[12 * i + 3 + axis]),
                flush(patch.points[12 * i + 6 + axis]),
                flush(patch.points[12 * i + 9 + axis]),
            ];
            rows[i] = blend4(wv, c);
            slopes[i] = blend3(sv, [sub(c[1], c[0]), sub(c[2], c[1]), sub(c[3], c[2])]);
            i += 1;
        }
        place[axis] = blend4(wu, rows);
        along_u[axis] = blend3(su, [sub(rows[1], rows[0]), sub(rows[2], rows[1]), sub(rows[3], rows[2])]);
        along_v[axis] = blend4(wu, slopes);
        axis += 1;
    }
    [flush3(place), unit(flush3(cross3(flush3(along_u), flush3(along_v))))]
}
