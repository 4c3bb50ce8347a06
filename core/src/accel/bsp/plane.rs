//! Planes of triangles and between cells, in integers.
//!
//! With corners of 20 bits a normal has 42, and a corner's value is a determinant of three differences, so below
//! (√3 · 2²⁰)³ < 2⁶³ (Hadamard 1893): words hold all of it.

use super::exact::each;
use super::lattice::Point;
use crate::abi::BspPlane;

/// Points `p` with `normal · p = offset`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Plane {
    /// Its normal; of a triangle that has no area, 0.
    pub normal: [i64; 3],
    /// Its distance from the origin, in lengths of its normal.
    pub offset: i64,
}

impl Plane {
    /// Of a triangle; its front is where the corners are counter-clockwise.
    #[inline]
    #[must_use]
    pub const fn of([a, b, c]: [Point; 3]) -> Self {
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        Self { normal, offset: dot(normal, a) }
    }

    /// Half way between coordinates `at` and `at + 1`, where no corner is.
    #[inline]
    #[must_use]
    pub const fn across(axis: usize, at: i32) -> Self {
        let mut normal = [0; 3];
        normal[axis] = 2;
        Self { normal, offset: 2 * at as i64 + 1 }
    }

    /// Is it of a triangle that has no area?
    #[inline(always)]
    #[must_use]
    pub const fn is_none(&self) -> bool {
        self.normal[0] == 0 && self.normal[1] == 0 && self.normal[2] == 0
    }

    /// How far before the plane a corner is, in lengths of its normal.
    #[inline(always)]
    #[must_use]
    pub const fn value(&self, corner: Point) -> i64 {
        dot(self.normal, corner) - self.offset
    }

    /// The same of all corners of a triangle.
    #[inline(always)]
    #[must_use]
    pub const fn values(&self, [a, b, c]: [Point; 3]) -> [i64; 3] {
        [self.value(a), self.value(b), self.value(c)]
    }

    /// Is an eye before the plane? It is less than 2²⁹ from the lattice's origin along each axis.
    #[inline(always)]
    #[must_use]
    pub const fn is_before(&self, eye: [i64; 3]) -> bool {
        self.words().is_before([eye[0] as i32, eye[1] as i32, eye[2] as i32])
    }

    /// The same in words, for devices.
    #[inline(always)]
    #[must_use]
    pub const fn words(&self) -> BspPlane {
        let ([x, y, z], [offset_low, offset_high]) = (self.normal, words(self.offset));
        let ([x, x_high], [y, y_high], [z, z_high]) = (words(x), words(y), words(z));
        BspPlane { low: [x, y, z], high: [x_high, y_high, z_high], offset_low, offset_high }
    }
}

/// Lower and upper word; the lower one has a sign, so that products of both are alike. Nothing here is near 2⁶³: offsets are
/// below (√3 · 2²⁰)³.
#[inline(always)]
const fn words(number: i64) -> [i32; 2] {
    let low = number as i32;
    [low, ((number - low as i64) >> 32) as i32]
}

impl BspPlane {
    /// Is an eye before the plane?
    ///
    /// An eye is below 2²⁹, so products of lower words are at most 2⁶⁰ and their sum fits 64 bits; upper words of normals are
    /// at most 2⁹. The sum's upper half then goes to the upper words.
    #[inline(always)]
    #[must_use]
    pub const fn is_before(&self, eye: [i32; 3]) -> bool {
        let low = sum_of(self.low, eye) - self.offset_low as i64;
        let high = sum_of(self.high, eye) - self.offset_high as i64 + (low >> 32);
        high > 0 || (high == 0 && low as u32 != 0)
    }
}

#[inline(always)]
const fn sum_of(words: [i32; 3], eye: [i32; 3]) -> i64 {
    words[0] as i64 * eye[0] as i64 + words[1] as i64 * eye[1] as i64 + words[2] as i64 * eye[2] as i64
}

#[inline(always)]
const fn minus(a: Point, b: Point) -> [i64; 3] {
    [(a[0] - b[0]) as i64, (a[1] - b[1]) as i64, (a[2] - b[2]) as i64]
}

#[inline(always)]
const fn dot(a: [i64; 3], b: Point) -> i64 {
    // The parts may not fit a word where the whole does.
    let (x, y) = (a[0].wrapping_mul(b[0] as i64), a[1].wrapping_mul(b[1] as i64));
    x.wrapping_add(y).wrapping_add(a[2].wrapping_mul(b[2] as i64))
}

/// A plane in floats, which say on which side of it most places are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rough {
    normal: [f64; 3],
    offset: f64,
    slack: f64,
}

impl Rough {
    /// Of a plane.
    #[inline]
    #[must_use]
    pub fn of(plane: &Plane) -> Self {
        let normal = each(|axis| plane.normal[axis] as f64);
        let [x, y, z] = each(|axis| normal[axis].abs());
        // Places are right to 2⁻³⁰ units (see `polygon.rs`), products and sums to as much of the sum of all components.
        let slack = (x + y + z) * (1.0 / (1 << 28) as f64);
        Self { normal, offset: plane.offset as f64, slack }
    }

    /// How far before the plane a place is, in lengths of its normal.
    #[inline(always)]
    #[must_use]
    pub fn value(&self, [x, y, z]: [f64; 3]) -> f64 {
        self.normal[0] * x + self.normal[1] * y + self.normal[2] * z - self.offset
    }

    /// Its normal and offset.
    #[inline(always)]
    pub(super) const fn parts(&self) -> ([f64; 3], f64) {
        (self.normal, self.offset)
    }

    /// What is nearer than this may be on the other side.
    #[inline(always)]
    #[must_use]
    pub const fn slack(&self) -> f64 {
        self.slack
    }

    /// The sign of a value, if it is certain.
    #[inline(always)]
    #[must_use]
    pub fn sign(&self, value: f64) -> Option<i32> {
        if value > self.slack {
            Some(1)
        } else if value < -self.slack {
            Some(-1)
        } else {
            None
        }
    }

    /// The value of places so many units before the plane.
    #[must_use]
    pub fn value_at(&self, units: f64) -> f64 {
        let [x, y, z] = self.normal;
        units * libm::sqrt(x * x + y * y + z * z)
    }
}
