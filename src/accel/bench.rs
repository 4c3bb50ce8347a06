//! What building costs on the CPU, beside the fastest preset of the `obvhs` crate: both on all cores, turn and turn about, and
//! the quality of all by the same function.

use std::time::{Duration, Instant};

use micropoly_backend_cpu::CpuDevice;
use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::morton::Precision;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use serde::Serialize;

use super::{areas, cpu, elapsed};
use crate::error::Result;

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Who builds.
    pub builder: &'static str,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Milliseconds, the median of all runs.
    pub milliseconds: f64,
    /// Those in shares of the `obvhs` crate's.
    pub time_ratio: f64,
    /// Areas of all boxes, in shares of the root's.
    pub sah: f64,
    /// Those in shares of the `obvhs` crate's.
    pub sah_ratio: f64,
}

/// Who builds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Builder {
    Own(Precision),
    Obvhs,
}

impl Builder {
    /// All; the one with which the others are compared is last.
    const ALL: [Self; 3] = [Self::Own(Precision::Bits30), Self::Own(Precision::Bits63), Self::Obvhs];

    const fn name(self) -> &'static str {
        match self {
            Self::Own(Precision::Bits30) => "LBVH, 30 bits",
            Self::Own(Precision::Bits63) => "LBVH, 63 bits",
            Self::Obvhs => "obvhs, fastest",
        }
    }

    /// Builds a tree: milliseconds, and what it is worth.
    fn run(self, input: &Input<'_>) -> (f64, f64) {
        let start = Instant::now();
        match self {
            Self::Own(precision) => {
                let tree = input.device.build_lbvh(input.boxes, precision);
                (elapsed(start), areas(tree.nodes.iter().map(|node| node.bounds())))
            }
            Self::Obvhs => {
                let tree =
                    build_bvh2(&input.aabbs, BvhBuildParams::fastest_build(), &mut Duration::default());
                (elapsed(start), areas(tree.nodes.iter().map(|node| bounds(node.aabb()))))
            }
        }
    }
}

/// The same boxes as either builder wants them.
struct Input<'a> {
    device: CpuDevice,
    boxes: &'a [Bounds],
    aabbs: Vec<Aabb>,
}

/// Builds trees over boxes with each builder in turn, `repeat` times, after a first time that does not count. The last row is
/// that of `obvhs`.
///
/// # Errors
/// [`crate::Error::Device`] if the threads cannot be started.
pub fn measure(boxes: &[Bounds], repeat: u32) -> Result<Vec<Row>> {
    let input = Input { device: cpu()?, boxes, aabbs: boxes.iter().map(aabb).collect() };
    let mut times = Builder::ALL.map(|_| Vec::new());
    let mut sah = [0.0; Builder::ALL.len()];
    for turn in 0..=repeat {
        for (place, builder) in Builder::ALL.into_iter().enumerate() {
            let milliseconds;
            (milliseconds, sah[place]) = builder.run(&input);
            if turn > 0 {
                times[place].push(milliseconds);
            }
        }
    }
    let medians = times.map(median);
    let last = Builder::ALL.len() - 1;
    let row = |(place, builder): (usize, Builder)| Row {
        builder: builder.name(),
        triangles: boxes.len(),
        milliseconds: medians[place],
        time_ratio: medians[place] / medians[last],
        sah: sah[place],
        sah_ratio: sah[place] / sah[last],
    };
    Ok(Builder::ALL.into_iter().enumerate().map(row).collect())
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

fn aabb(bounds: &Bounds) -> Aabb {
    Aabb { min: bounds.low.into(), max: bounds.high.into() }
}

fn bounds(aabb: &Aabb) -> Bounds {
    Bounds { low: aabb.min.to_array(), high: aabb.max.to_array() }
}
