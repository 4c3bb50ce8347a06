//! How long micropolygons are on screen: the measure of an adaptive dice rate.

use micropoly_core::abi::{CULL, DRAW, DRAW_LIMITED, Draw, Surface};
use micropoly_core::camera::FrameOptions;
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::dice::{Grid, dice};
use micropoly_core::kernel::dice_gregory::dice_gregory;
use micropoly_core::patch::gregory::patch_count;
use micropoly_core::patch::{Faces, Net};
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
        let seen = scene.for_device(options)?;
        let (mut out, mut grid) = (Self::default(), Box::new(Grid::default()));
        for patch in 0..patch_count(&seen.patches) as u32 {
            for_each_draw(&seen, patch, |draw| {
                dice_any(&seen, draw, &mut grid);
                out.add(draw, &grid, options.size);
            });
        }
        Ok(out)
    }

    /// Share of sides that are as long as the target or up to half as long.
    #[must_use]
    pub fn share_in_range(&self) -> f64 {
        let within: u64 = self.sides[CLASSES / 2..CLASSES].iter().sum();
        let all: u64 = self.sides.iter().sum::<u64>();
        within as f64 / all as f64
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

/// Everything that is drawn of a patch.
fn for_each_draw(seen: &DeviceScene, patch: u32, mut each: impl FnMut(Draw)) {
    let mut stack = vec![Surface::root(patch)];
    while let Some(surface) = stack.pop() {
        let verdict = bound_any(&seen.frame, &seen.objects, &seen.patches, surface);
        match verdict.code {
            CULL => {}
            DRAW | DRAW_LIMITED => each(Draw::new(surface, verdict)),
            _ => stack.extend(surface.halves(verdict)),
        }
    }
}

fn dice_any(seen: &DeviceScene, draw: Draw, grid: &mut Grid) {
    let patch = &seen.patches[draw.patch_id as usize];
    let object = &seen.objects[patch.object as usize];
    let net = Net::in_eye_space(patch, object);
    match patch.faces {
        0 => dice(&net, &seen.frame, draw, grid),
        record => {
            let faces = Faces::in_eye_space(&seen.patches[record as usize], object);
            dice_gregory(&net, &faces, &seen.frame, draw, grid);
        }
    }
}
