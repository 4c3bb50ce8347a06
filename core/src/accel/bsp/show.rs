//! From a camera to rays of integers, and from a hit to a sample. Host side, in f64; the order of hits does not depend on it.

use glam::{DAffine3, DMat3, DVec3};

use super::lattice::Lattice;
use super::plane::Plane;
use super::sight::View;
use crate::abi::{Frame, SUBPIXELS, Sample};

/// Components of directions stay below this.
const DIRECTION: f64 = (1_u64 << 48) as f64;

/// A camera that looks at a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Its rays.
    pub view: View,
    /// From a place before the eye to distance, and distance times x and y.
    to_image: DMat3,
    /// Turns normals to eye space.
    to_eye: DMat3,
    /// Distance along the view axis after one length of a ray's direction.
    depth: f64,
    focal: f64,
    centre: [f64; 2],
}

impl Eye {
    /// From a camera's transform to eye space, with the image of a frame; `None` if it is too far away, or sees nothing.
    #[must_use]
    pub fn new(lattice: &Lattice, to_eye: &DAffine3, frame: &Frame) -> Option<Self> {
        let to_world = to_eye.matrix3.inverse();
        let eye = lattice.eye((to_world * -to_eye.translation).to_array())?;
        let focal = f64::from(frame.focal);
        let centre = [frame.width, frame.height].map(|pixels| 0.5 * f64::from(pixels));
        // In eye space the ray through (x, y), in snapped units, is scale · ((x / 256 - centre) / focal, …, -1).
        let longest = to_world.to_cols_array().iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let scale = DIRECTION / (3.0 * longest * (1.0 + (centre[0] + centre[1]) / focal));
        let step = scale / (focal * f64::from(SUBPIXELS));
        let right = to_world * DVec3::new(step, 0.0, 0.0);
        let down = to_world * DVec3::new(0.0, -step, 0.0);
        let first = DVec3::new(-centre[0] / focal, centre[1] / focal, -1.0) * scale;
        let whole = |direction: DVec3| direction.to_array().map(|c| libm::rint(c) as i64);
        let view = View { eye, ahead: whole(to_world * first), right: whole(right), down: whole(down) };
        let columns = [view.ahead, view.right, view.down].map(|c| DVec3::from(c.map(|c| c as f64)));
        let from_image = DMat3::from_cols(columns[0], columns[1], columns[2]);
        let is_sound = from_image.determinant().is_normal() && to_world.is_finite();
        let depth = scale * lattice.unit();
        let (to_image, to_eye) = (from_image.inverse(), to_world.transpose());
        is_sound.then_some(Self { view, to_image, to_eye, depth, focal, centre })
    }

    /// Where a place in units of the lattice is: its distance along the view axis, and its column and row times that, in
    /// snapped units.
    #[must_use]
    pub fn project(&self, at: [f64; 3]) -> [f64; 3] {
        let away = DVec3::from(at) - DVec3::from(self.view.eye.map(|c| c as f64));
        (self.to_image * away * self.depth).to_array()
    }

    /// Distance along the view axis of what a ray hits after so many lengths of its direction.
    #[must_use]
    pub const fn depth(&self, distance: f64) -> f64 {
        distance * self.depth
    }

    /// The place in eye space that is seen in a column and row of snapped units, so far away.
    #[must_use]
    pub fn point(&self, [x, y]: [i32; 2], depth: f64) -> [f32; 3] {
        let along =
            |at: i32, centre: f64| (f64::from(at) / f64::from(SUBPIXELS) - centre) / self.focal * depth;
        [along(x, self.centre[0]) as f32, -along(y, self.centre[1]) as f32, -depth as f32]
    }

    /// The unit normal of a plane in eye space.
    #[must_use]
    pub fn normal(&self, plane: &Plane) -> [f32; 3] {
        let normal = self.to_eye * DVec3::from(plane.normal.map(|c| c as f64));
        normal.normalize_or_zero().as_vec3().to_array()
    }
}

/// Which part of its patch a triangle is: patches have their corners at (u, v) = (0, 0), (1, 0), (1, 1) and (0, 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// All of one whose last two corners are the same.
    Whole,
    /// The first three corners.
    First,
    /// The first one and the last two.
    Second,
}

/// What a triangle is seen as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Number of its object.
    pub object: u32,
    /// Number of its patch.
    pub patch_id: u32,
    /// Which part of it.
    pub half: Half,
}

impl Face {
    /// The sample of a hit, given the weights of the corners and its depth.
    #[must_use]
    pub fn sample(&self, weights: [i128; 3], depth: f64) -> Sample {
        let [a, b, c] = weights.map(|weight| weight as f64);
        let all = a + b + c;
        let (u, v) = match self.half {
            Half::Whole => (b / (a + b), c / all),
            Half::First => ((b + c) / all, c / all),
            Half::Second => (b / all, (b + c) / all),
        };
        let place = |share: f64| (share.clamp(0.0, 1.0) * f64::from((1 << 24) - 1)) as u32;
        Sample { depth: ((1.0 / depth) as f32).to_bits(), patch_id: self.patch_id, u: place(u), v: place(v) }
    }
}
