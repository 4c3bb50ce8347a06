//! The lattice: corners of a mesh as integers.

use libm::{exp2, floor, frexp};

use super::exact::each;
use crate::accel::bounds::Bounds;

/// Bits of a coordinate: the largest mesh whose planes are still words (see [`super::plane`]).
pub const LATTICE_BITS: u32 = 20;
/// Eyes are less than so many units from the lattice's origin, along each axis.
pub const FARTHEST: i64 = 1 << 29;

/// A corner: coordinates from 0 to 2²⁰ - 1.
pub type Point = [i32; 3];

/// A cubic lattice about a box. Its unit is a power of two, so that corners with few digits are on it, and what is flat
/// stays flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    low: [f64; 3],
    unit: f64,
    /// Exact, too.
    units_per_length: f64,
}

impl Lattice {
    /// About a box of finite coordinates.
    #[must_use]
    pub fn new(bounds: &Bounds) -> Self {
        let side = |axis: usize| f64::from(bounds.high[axis]) - f64::from(bounds.low[axis]);
        let largest = side(0).max(side(1)).max(side(2));
        // side < 2^exponent; two units are for rounding.
        let (_, exponent) = frexp(if largest > 0.0 { largest * (1.0 + 1.0e-5) } else { 1.0 });
        let unit = exp2(f64::from(exponent - LATTICE_BITS as i32));
        Self {
            low: bounds.low.map(|low| floor(f64::from(low) / unit) * unit),
            unit,
            units_per_length: 1.0 / unit,
        }
    }

    /// Length of a unit.
    #[must_use]
    pub const fn unit(&self) -> f64 {
        self.unit
    }

    /// A place in units of the lattice.
    #[inline]
    #[must_use]
    pub fn units(&self, place: [f64; 3]) -> [f64; 3] {
        each(|axis| (place[axis] - self.low[axis]) * self.units_per_length)
    }

    /// The place of units of the lattice.
    #[must_use]
    pub fn place(&self, units: [f64; 3]) -> [f64; 3] {
        each(|axis| self.low[axis] + units[axis] * self.unit)
    }

    /// The corner next to a place in the box.
    #[inline]
    #[must_use]
    pub fn snap(&self, place: [f32; 3]) -> Point {
        // Nothing in the box is below 0, so that what is cut off is what `floor` takes off.
        each(|axis| ((f64::from(place[axis]) - self.low[axis]) * self.units_per_length + 0.5) as i32)
    }

    /// The eye next to a place; `None` if it is too far away.
    #[must_use]
    pub fn eye(&self, place: [f64; 3]) -> Option<[i64; 3]> {
        let units = self.units(place);
        units.iter().all(|c| c.abs() < (FARTHEST - 1) as f64).then(|| units.map(|c| floor(c + 0.5) as i64))
    }
}
