//! Large scenes from a seed: the same patches for the same seed, on every platform.

use serde::Deserialize;

use crate::shape::BezierPatch;

/// What can be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Generator {
    /// Balls in the unit cube, 8 patches each.
    Spheres,
    /// Thin curved ribbons that stand on a ball, 1 patch each.
    Hair,
    /// Round columns on a grid, 13 patches each.
    Columns,
    /// Blocks on a street grid, 5 patches each.
    City,
}

impl Generator {
    /// Patches of one generated thing.
    #[must_use]
    pub const fn patches_each(self) -> u32 {
        match self {
            Self::Spheres => 8,
            Self::Hair => 1,
            Self::Columns => 13,
            Self::City => 5,
        }
    }
}

/// Generates `count` things.
#[must_use]
pub fn generate(kind: Generator, count: u32, seed: u64) -> Vec<BezierPatch> {
    let mut random = Random(seed);
    let side = (f64::from(count)).sqrt().ceil() as u32;
    let cell = |index: u32| (f64::from(index % side), f64::from(index / side));
    (0..count)
        .flat_map(|index| match kind {
            Generator::Spheres => sphere(random.point(), random.between(0.02, 0.08)),
            Generator::Hair => vec![hair(&mut random)],
            Generator::Columns => column(cell(index), &mut random),
            Generator::City => block(cell(index), &mut random),
        })
        .collect()
}

/// The handle of a cubic Bézier quarter circle of radius 1: error below 2.8e-4.
const QUARTER: f64 = 0.552_284_749_831;

type Point = [f64; 3];

fn patch(points: [Point; 16]) -> BezierPatch {
    BezierPatch { points: points.map(|point| point.map(|value| value as f32)) }
}

/// Eight octants; each has one side collapsed into a pole.
fn sphere(centre: Point, radius: f64) -> Vec<BezierPatch> {
    let profile = [(0.0, 1.0), (QUARTER, 1.0), (1.0, QUARTER), (1.0, 0.0)];
    let mut patches = Vec::with_capacity(8);
    for pole in [1.0, -1.0] {
        for quarter in quarters(QUARTER) {
            let points = std::array::from_fn(|k| {
                // Below, the other way round, so that the outer side is the front there too.
                let along = if pole > 0.0 { k % 4 } else { 3 - k % 4 };
                let ((out, up), (x, y)) = (profile[k / 4], quarter[along]);
                [centre[0] + radius * out * x, centre[1] + radius * out * y, centre[2] + radius * up * pole]
            });
            patches.push(patch(points));
        }
    }
    patches
}

/// Control points of the four quarters of a circle of radius 1.
fn quarters(handle: f64) -> [[(f64, f64); 4]; 4] {
    let first = [(1.0, 0.0), (1.0, handle), (handle, 1.0), (0.0, 1.0)];
    let turn = |quarter: [(f64, f64); 4]| quarter.map(|(x, y)| (-y, x));
    let second = turn(first);
    let third = turn(second);
    [first, second, third, turn(third)]
}

/// A ribbon from the unit sphere outwards, bent to one side and hanging.
fn hair(random: &mut Random) -> BezierPatch {
    let z = random.between(-1.0, 1.0);
    let angle = random.between(0.0, std::f64::consts::TAU);
    let (sine, cosine) = libm::sincos(angle);
    let flat = (1.0 - z * z).max(0.0).sqrt();
    let root = [flat * cosine, flat * sine, z];
    let length = random.between(0.5, 0.9);
    let bend = [random.between(-0.3, 0.3), random.between(-0.3, 0.3), -random.between(0.2, 0.6)];
    let width = [-sine * 0.006, cosine * 0.006, 0.0];
    patch(std::array::from_fn(|k| {
        let (along, across) = ((k / 4) as f64 / 3.0, (k % 4) as f64 / 3.0 - 0.5);
        let thin = across * (1.0 - 0.8 * along);
        std::array::from_fn(|axis| {
            root[axis] * (1.0 + along * length) + bend[axis] * along * along + width[axis] * thin
        })
    }))
}

/// Base, shaft and capital of four quarters each, and a slab on top.
fn column((x, y): (f64, f64), random: &mut Random) -> Vec<BezierPatch> {
    let height = random.between(3.0, 4.0);
    let turn = [(0.36, 0.0), (0.36, 0.1), (0.26, 0.2), (0.26, 0.35)];
    let shaft = [(0.26, 0.35), (0.27, 0.4 * height), (0.24, 0.7 * height), (0.22, height)];
    let capital = [(0.22, height), (0.22, height + 0.1), (0.34, height + 0.15), (0.36, height + 0.25)];
    let mut patches = Vec::with_capacity(13);
    for profile in [turn, shaft, capital] {
        for quarter in quarters(QUARTER) {
            patches.push(patch(std::array::from_fn(|k| {
                let ((radius, up), (cosine, sine)) = (profile[k / 4], quarter[k % 4]);
                [2.0 * x + radius * cosine, 2.0 * y + radius * sine, up]
            })));
        }
    }
    patches.push(plane(2.0 * x, 2.0 * y, height + 0.25, 0.4));
    patches
}

/// A horizontal square.
fn plane(x: f64, y: f64, z: f64, half: f64) -> BezierPatch {
    patch(std::array::from_fn(|k| {
        let at = |index: usize| (index as f64 / 1.5 - 1.0) * half;
        [x + at(k / 4), y + at(k % 4), z]
    }))
}

/// Four walls, slightly bulging, and a roof.
fn block((x, y): (f64, f64), random: &mut Random) -> Vec<BezierPatch> {
    let (height, half) = (random.between(0.5, 4.0) * random.between(0.3, 1.0), random.between(0.3, 0.42));
    let bulge = random.between(0.0, 0.06);
    let mut patches = Vec::with_capacity(5);
    for side in 0..4 {
        patches.push(patch(std::array::from_fn(|k| {
            let (along, up) = ((k / 4) as f64 / 1.5 - 1.0, (k % 4) as f64 / 3.0);
            let inner = matches!(k / 4, 1 | 2) && matches!(k % 4, 1 | 2);
            let (mut a, mut b) = (along * half, -half - if inner { bulge } else { 0.0 });
            for _ in 0..side {
                (a, b) = (-b, a);
            }
            [x + a, y + b, up * height]
        })));
    }
    patches.push(plane(x, y, height, half));
    patches
}

/// SplitMix64 (Steele, Lea & Flood 2014): its sequence is part of what a seed means here, so it is ours.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn point(&mut self) -> Point {
        std::array::from_fn(|_| self.between(0.0, 1.0))
    }
}
