//! What an eye sees of a piece along a ray, in integers.
//!
//! A ray through a place of the image hits a triangle where three determinants have one sign; they are the hit's weights,
//! so a plane's values at the corners say on which side of it the hit is. Where a sum is 0, the place is taken for one that
//! lies infinitely little to the right, or else below: so a ray hits one of two neighbours, and one piece of a triangle.

use super::exact::dot_sign;
use super::lattice::Point;

/// Eye and image: the ray through (x, y) has the direction `ahead + x · right + y · down`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Where all rays begin, in units of the lattice, less than 2²⁹.
    pub eye: [i64; 3],
    /// Direction of the ray through (0, 0); components below 2⁵⁰.
    pub ahead: [i64; 3],
    /// From a column to the next.
    pub right: [i64; 3],
    /// From a row to the next.
    pub down: [i64; 3],
}

/// A number at each place of the image: `at + x · right + y · down`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Ramp {
    at: i128,
    right: i128,
    down: i128,
}

impl Ramp {
    #[inline(always)]
    const fn value(&self, x: i32, y: i32) -> i128 {
        self.at + x as i128 * self.right + y as i128 * self.down
    }
}

/// A line of a triangle as an eye sees it, in floats: enough to say on which side of it most places of an image are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glance {
    at: f64,
    right: f64,
    down: f64,
    /// What is nearer to 0 than this may be on the other side.
    slack: f64,
}

/// Columns and rows of snapped units are below this.
const WIDEST: f64 = (1 << 24) as f64;
/// Products and sums of some floats are right to this share of all their magnitudes together.
const ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;

impl Glance {
    /// Is a place on the side where the line is above 0, if that is certain?
    #[inline(always)]
    #[must_use]
    pub fn is_within(&self, x: f64, y: f64) -> Option<bool> {
        let value = self.at + x * self.right + y * self.down;
        if value.abs() > self.slack { Some(value > 0.0) } else { None }
    }
}

/// A triangle as an eye sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sight {
    weights: [Ramp; 3],
    volume: i128,
}

impl Sight {
    /// Of a triangle; `None` if the eye is in its plane.
    #[must_use]
    pub fn new(view: &View, triangle: &[Point; 3]) -> Option<Self> {
        let [a, b, c] = triangle.map(|corner| from_eye(view, corner));
        let sides = [cross(b, c), cross(c, a), cross(a, b)];
        let volume = dot(sides[0], a);
        if volume == 0 {
            return None;
        }
        let way = volume.signum();
        let weights = sides.map(|side| Ramp {
            at: way * dot(side, view.ahead),
            right: way * dot(side, view.right),
            down: way * dot(side, view.down),
        });
        Some(Self { weights, volume: volume * way })
    }

    /// Weights of the corners where the ray through a place hits the triangle, if it does.
    #[inline(always)]
    #[must_use]
    pub fn hit(&self, x: i32, y: i32) -> Option<[i128; 3]> {
        let weights = self.weights.map(|weight| weight.value(x, y));
        for (weight, ramp) in weights.iter().zip(&self.weights) {
            if *weight < 0 || (*weight == 0 && (ramp.right, ramp.down) < (0, 0)) {
                return None;
            }
        }
        Some(weights)
    }

    /// Is a hit on the side of a line where it is above 0?
    #[inline]
    #[must_use]
    pub fn is_within(&self, hit: [i128; 3], line: [i64; 3]) -> bool {
        let mut sign = dot_sign(hit, line);
        if sign == 0 {
            sign = dot_sign(self.weights.map(|weight| weight.right), line);
        }
        if sign == 0 {
            sign = dot_sign(self.weights.map(|weight| weight.down), line);
        }
        sign > 0
    }

    /// A line of the triangle, in floats.
    #[must_use]
    pub fn glance(&self, line: [i64; 3]) -> Glance {
        let mut glance = Glance { at: 0.0, right: 0.0, down: 0.0, slack: 0.0 };
        for (ramp, value) in self.weights.iter().zip(line) {
            let value = value as f64;
            let [at, right, down] = [ramp.at, ramp.right, ramp.down].map(|c| c as f64 * value);
            glance.at += at;
            glance.right += right;
            glance.down += down;
            glance.slack += (at.abs() + WIDEST * (right.abs() + down.abs())) * ROUNDING;
        }
        glance
    }

    /// How far away a hit is, in lengths of the ray's direction.
    #[inline]
    #[must_use]
    pub fn distance(&self, hit: [i128; 3]) -> f64 {
        self.volume as f64 / (hit[0] + hit[1] + hit[2]) as f64
    }
}

const fn from_eye(view: &View, corner: Point) -> [i64; 3] {
    [corner[0] as i64 - view.eye[0], corner[1] as i64 - view.eye[1], corner[2] as i64 - view.eye[2]]
}

/// Components are below 2⁶⁰, as those of `a` and `b` are below 2²⁹ and 2²⁰ together.
const fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
const fn dot(a: [i64; 3], b: [i64; 3]) -> i128 {
    a[0] as i128 * b[0] as i128 + a[1] as i128 * b[1] as i128 + a[2] as i128 * b[2] as i128
}
