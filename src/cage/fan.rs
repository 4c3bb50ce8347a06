//! Ways that spread in a plane from one to another, so that the sum of two neighbours is the same multiple of what is between
//! them everywhere.

use std::f64::consts::PI;

use glam::DVec3;
use libm::{cos, cosh, sin, sinh};

/// Shares of the first and the last way in those between: sines of an angle for each step, or hyperbolic ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fan {
    steps: usize,
    angle: f64,
    is_flat: bool,
    /// Twice this times a way is the sum of its two neighbours.
    pub(super) cosine: f64,
}

/// Two ways must differ from opposite ones by so much of their squared length, or their sum has no direction.
const LEAST: f64 = 0.1;
/// Halvings until an angle is found.
const HALVINGS: usize = 60;

impl Fan {
    /// The fan that reaches as far as some ways do that are to be replaced, as seen along the sum of the first and last.
    pub(super) fn between(
        first: DVec3,
        last: DVec3,
        inner: impl Iterator<Item = DVec3>,
        steps: usize,
    ) -> Option<Self> {
        let sum = first + last;
        let square = sum.length_squared();
        if square <= LEAST * (first.length_squared() + last.length_squared()) {
            return None;
        }
        Self::reaching(inner.map(|way| way.dot(sum)).sum::<f64>() / square, steps)
    }

    /// The fan whose inner shares have this sum.
    fn reaching(sum: f64, steps: usize) -> Option<Self> {
        let turn = PI / steps as f64;
        let (is_flat, [mut low, mut high]) = if sum >= 0.5 * (steps - 1) as f64 {
            (false, [0.0, turn])
        } else if sum > 0.0 {
            (true, [0.0, 20.0])
        } else if sum < -0.5 {
            (false, [turn, 2.0 * turn])
        } else {
            return None;
        };
        for _ in 0..HALVINGS {
            let angle = 0.5 * (low + high);
            let fan = Self::of(steps, angle, is_flat);
            let found: f64 = (1..steps).map(|place| fan.share(place)).sum();
            if (found < sum) == is_flat { high = angle } else { low = angle }
        }
        Some(Self::of(steps, 0.5 * (low + high), is_flat))
    }

    fn of(steps: usize, angle: f64, is_flat: bool) -> Self {
        Self { steps, angle, is_flat, cosine: if is_flat { cosh(angle) } else { cos(angle) } }
    }

    /// The share of the last way in the one so many steps from the first.
    pub(super) fn share(&self, place: usize) -> f64 {
        let sine = if self.is_flat { sinh } else { sin };
        sine(place as f64 * self.angle) / sine(self.steps as f64 * self.angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fan_reaches_as_far_as_it_should_and_turns_evenly() {
        for steps in 2..9 {
            for sum in [-40.0, -3.0, -0.6, 0.01, 0.3, 1.0, 2.7, 50.0] {
                let fan = Fan::reaching(sum, steps).expect("a fan");
                let found: f64 = (1..steps).map(|place| fan.share(place)).sum();
                assert!((found - sum).abs() < 1e-6 * (1.0 + sum.abs()), "{steps} steps, {sum}: {fan:?}");
                for place in 1..steps {
                    let around = fan.share(place - 1) + fan.share(place + 1);
                    let size = 1.0 + fan.share(place).abs() * (1.0 + fan.cosine.abs());
                    assert!((around - 2.0 * fan.cosine * fan.share(place)).abs() < 1e-9 * size);
                }
            }
        }
    }
}
