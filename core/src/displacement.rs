//! Displacement of an object, as users describe it, and what kernels need to know of it. Host side, in f64.

use crate::abi::{MAX_OCTAVES, Object, ROUNDING};
use glam::{DMat3, DVec3};

/// Bumps, by which the vertices of an object move along their normals ([`crate::kernel::displace`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// Largest displacement, in object units, outwards and inwards.
    pub height: f32,
    /// Coarsest bumps on a unit of length in object space.
    pub frequency: f32,
    /// How often bumps are added, each time twice as fine and half as high: 1 to [`MAX_OCTAVES`].
    pub octaves: u32,
}

/// Numbers may not be smaller, nor their reciprocals: far from the denormals.
const LEAST: f32 = 1.0e-12;
/// No slope may be steeper.
const STEEPEST: f64 = 1.0e6;
/// Bumps farther from the origin than so many of them would lose their shape to rounding.
const MOST_BUMPS: f64 = (1 << 20) as f64;

/// Why an object cannot be displaced so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// Height, frequency or octaves are out of range.
    Number,
    /// Height × frequency is beyond a million.
    Steep,
    /// The finest bumps are too fine for an object so far from its origin.
    Fine,
}

impl Displacement {
    /// Can an object be displaced so whose control points have no coordinate beyond `extent`?
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self, extent: f64) -> Result<(), Unfit> {
        let Self { height, frequency, octaves } = *self;
        let is_sound = |x: f32| (LEAST..=1.0 / LEAST).contains(&x);
        if !is_sound(height) || !is_sound(frequency) || !(1..=MAX_OCTAVES).contains(&octaves) {
            return Err(Unfit::Number);
        }
        let (height, frequency) = (f64::from(height), f64::from(frequency));
        let finest = frequency * f64::from(1_u32 << (octaves - 1));
        if height * frequency > STEEPEST {
            Err(Unfit::Steep)
        } else if extent * finest > MOST_BUMPS {
            Err(Unfit::Fine)
        } else {
            Ok(())
        }
    }

    /// The sum of all octaves is no higher than this share of the first one's.
    fn sum(self) -> f64 {
        2.0 - libm::exp2(1.0 - f64::from(self.octaves))
    }
}

impl Object {
    /// The object with its vertices displaced; no coordinate of its control points is beyond `extent`.
    #[must_use]
    pub fn displaced(self, displacement: &Displacement, extent: f64) -> Self {
        let Displacement { height, frequency, octaves } = *displacement;
        let rows =
            [0, 1, 2].map(|k| DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(self.to_eye[4 * k + c]))));
        let moved = |k: usize| {
            // What rounding adds: evaluation takes place in object space, and is then moved.
            let farthest = rows[k].abs().element_sum() * extent + f64::from(self.to_eye[4 * k + 3].abs());
            rows[k].length() * f64::from(height) * 1.0001 + 2.0 * farthest * f64::from(ROUNDING)
        };
        Self {
            // Never 0, which means that there is no displacement, nor a denormal, which some devices take for it.
            reach: moved(0).max(moved(1)).max(moved(2)).max(1.0e-30) as f32,
            height: (f64::from(height) / displacement.sum()) as f32,
            frequency,
            octaves,
            normal_to_eye: cofactors(rows),
            ..self
        }
    }
}

/// The cofactors of a matrix given by rows, scaled by a power of two so that the largest lies in 1 ..< 2; what is so
/// small beside it that products could become denormal is 0.
fn cofactors([x, y, z]: [DVec3; 3]) -> [f32; 9] {
    let all = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)).to_cols_array();
    let largest = all.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let scale = if largest > 0.0 { libm::exp2(-libm::floor(libm::log2(largest))) } else { 0.0 };
    all.map(|c| c * scale).map(|c| if c.abs() < 1.0e-12 { 0.0 } else { c as f32 })
}
