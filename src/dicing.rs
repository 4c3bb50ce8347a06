//! What adaptive, watertight dicing gives and costs: lengths of micropolygons, how many there are, time of a frame.

use micropoly_core::camera::{Borders, FrameOptions};
use serde::Serialize;

use crate::backend::render;
use crate::error::Result;
use crate::mesh::lengths::Histogram;
use crate::render::RenderOptions;
use crate::scene::Scene;

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Dicing {
    /// The scene.
    pub scene: String,
    /// Lengths of micropolygons.
    pub lengths: Histogram,
    /// Share of sides between half of the target and all of it.
    pub in_range: f64,
    /// Micropolygons of fixed 8×8 grids on surfaces of 8 micropolygons (Weber 2014), which are nowhere longer.
    pub fixed: u64,
    /// Seconds of a frame with naive borders, the shortest of all runs.
    pub naive_seconds: f64,
    /// Seconds of a frame with watertight borders, the shortest of all runs.
    pub watertight_seconds: f64,
}

impl Dicing {
    /// Measures a scene; frames with naive and with watertight borders take turns.
    ///
    /// # Errors
    /// As [`render`].
    pub fn measure(scene: &Scene, options: &RenderOptions, repeat: u32) -> Result<Self> {
        let frame = options.frame;
        let lengths = Histogram::of(scene, &frame)?;
        let fixed = FrameOptions { bound: 8.0 * frame.size, rate: 8, borders: Borders::Fixed, ..frame };
        let mut seconds = [f64::INFINITY; 2];
        for _ in 0..repeat.max(1) {
            for (shortest, borders) in seconds.iter_mut().zip([Borders::Naive, Borders::Watertight]) {
                let options = RenderOptions { frame: FrameOptions { borders, ..frame }, ..options.clone() };
                let taken = render(scene, &options, |_| {})?.seconds;
                *shortest = shortest.min(taken.bound + taken.split + taken.draw);
            }
        }
        let [naive_seconds, watertight_seconds] = seconds;
        Ok(Self {
            scene: scene.name.clone(),
            in_range: lengths.share_in_range(),
            fixed: Histogram::of(scene, &fixed)?.micropolygons,
            lengths,
            naive_seconds,
            watertight_seconds,
        })
    }
}
