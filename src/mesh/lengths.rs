//! How long micropolygons are on screen: the measure of an adaptive dice rate.

use micropoly_core::abi::Draw;
use micropoly_core::camera::FrameOptions;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::patch::instance::{Instance, instance};
use micropoly_core::schedule::for_each_draw;
use serde::Serialize;

use crate::error::Result;
use crate::scene::{DeviceScene, Scene};

/// Classes of [`Histogram`] up to the target length; as many lie beyond it.
const CLASSES: usize = 8;

/// Lengths of the sides of micropolygons on screen, collapsed ones left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Histogram {
    /// Sides by length: classes an eighth of [`FrameOptions::size`] wide; the last has all that are longer.
    pub sides: [u64; 2 * CLASSES],
    /// Sides that are in the first half of the classes because their whole patch is that narrow.
    pub narrow: u64,
    /// Micropolygons.
    pub micropolygons: u64,
    /// Surfaces drawn.
    pub drawn: u64,
}

impl Histogram {
    /// Of all that is drawn of a scene.
    ///
    /// # Errors
    /// As [`Scene::for_device`].
    pub fn of(scene: &Scene, options: &FrameOptions) -> Result<Self> {
        let DeviceScene { frame, objects, patches, patch_count } = scene.for_device(options)?;
        let (mut out, mut grid) = (Self::default(), Box::new(Grid::default()));
        for patch in 0..patch_count as u32 {
            let Instance { record, object } = instance(&frame, &objects, &patches, patch);
            let object = &objects[object as usize];
            for_each_draw(&frame, &objects, &patches, patch, |draw, _| {
                dice_any(&frame, &patches, record, object, draw, &mut grid);
                out.add(draw, &grid, options.size);
            });
        }
        Ok(out)
    }

    /// Share of sides between half of the target and all of it; 0 if there are none.
    #[must_use]
    pub fn share_in_range(&self) -> f64 {
        let within: u64 = self.sides[CLASSES / 2..CLASSES].iter().sum();
        let all: u64 = self.sides.iter().sum();
        within as f64 / all.max(1) as f64
    }

    fn add(&mut self, draw: Draw, grid: &Grid, size: f32) {
        self.drawn += 1;
        self.micropolygons += u64::from(draw.rate_u() * draw.rate_v());
        let surface = draw.surface();
        let whole =
            [surface.u_level() == 0 && draw.rate_u() == 1, surface.v_level() == 0 && draw.rate_v() == 1];
        for row in 0..grid.rows {
            for column in 0..grid.stride {
                let at = row * grid.stride + column;
                if column + 1 < grid.stride {
                    self.side(grid, at, at + 1, size, whole[0]);
                }
                if row + 1 < grid.rows {
                    self.side(grid, at, at + grid.stride, size, whole[1]);
                }
            }
        }
    }

    fn side(&mut self, grid: &Grid, from: usize, to: usize, size: f32, is_whole: bool) {
        if grid.w[from] == 0.0 || grid.w[to] == 0.0 || grid.point(from) == grid.point(to) {
            return;
        }
        let along = |c: &[i32]| f64::from(c[to] - c[from]) / 256.0;
        let length = along(&grid.x).hypot(along(&grid.y)) / f64::from(size);
        if is_whole && length < 0.5 {
            self.narrow += 1;
            return;
        }
        let class = (length * CLASSES as f64).ceil() as usize;
        self.sides[class.saturating_sub(1).min(2 * CLASSES - 1)] += 1;
    }
}
