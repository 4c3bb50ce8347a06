//! The camera of a RIB file, and the one it becomes here.
//!
//! RenderMan's camera looks along its +z, x to the right and y up: a left-handed space. Ours looks along -z. So the
//! view is the world-to-camera transform and then a change of z's sign, which mirrors nothing in the image: x and y on
//! screen stay what they are. Worlds stay as they are written; where that is left-handed, the view mirrors.

use glam::{DAffine3, DVec3};
use micropoly_core::abi::MIN_NEAR;
use micropoly_core::camera::Camera;

use crate::shot::{Blur, DEFAULT_SENSOR, Lens};

/// Near plane where `Clipping` does not say: RenderMan's is nearer than floats can tell.
const DEFAULT_NEAR: f64 = 1.0e-3;

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RibCamera {
    /// World space to RenderMan's camera space: x right, y up, it looks along +z.
    pub from_world: DAffine3,
    /// Field of view in degrees, of the smaller side of a frame.
    pub fov: f64,
    /// Width of the frame over its height.
    pub aspect: Option<f64>,
    /// Width and height of the image in pixels.
    pub resolution: Option<[usize; 2]>,
    /// Half the height of the screen window, where the field of view reaches to 1.
    pub half_height: Option<f64>,
    /// Distance of the near plane.
    pub near: Option<f64>,
    /// The lens; without one all distances are sharp.
    pub lens: Option<RibLens>,
}

/// A thin lens, as `DepthOfField` has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RibLens {
    /// Focal length over diameter.
    pub fstop: f64,
    /// In scene units.
    pub focal_length: f64,
    /// Distance that is sharp.
    pub focus: f64,
}

impl RibCamera {
    /// Vertical field of view in degrees. The file's is that of the smaller side: the height, unless the frame is
    /// upright; frames are not unless the file says so.
    #[must_use]
    pub fn vertical_fov(&self) -> f64 {
        let half_height = self.half_height.unwrap_or_else(|| 1.0 / self.aspect.unwrap_or(1.0).min(1.0));
        let slope = libm::tan(self.fov.to_radians() * 0.5) * half_height;
        (2.0 * libm::atan(slope)).to_degrees()
    }

    /// The camera that shows the same.
    #[must_use]
    pub fn camera(&self) -> Camera {
        let view = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)) * self.from_world;
        let near = self.near.unwrap_or(DEFAULT_NEAR).max(f64::from(MIN_NEAR));
        Camera { view, fov: self.vertical_fov(), near }
    }

    /// Its lens. The sensor is as high as makes the focal length that of the file.
    #[must_use]
    pub fn blur(&self) -> Blur {
        let Some(RibLens { fstop, focal_length, focus }) = self.lens else {
            return Blur { shutter: 0.0, lens: None, sensor: DEFAULT_SENSOR };
        };
        let sensor = 2.0 * focal_length * libm::tan(self.vertical_fov().to_radians() * 0.5);
        Blur { shutter: 0.0, lens: Some(Lens { fstop, focus }), sensor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> RibCamera {
        RibCamera {
            from_world: DAffine3::from_translation(DVec3::new(0.0, 0.0, 5.0)),
            fov: 90.0,
            aspect: None,
            resolution: None,
            half_height: None,
            near: None,
            lens: None,
        }
    }

    #[test]
    fn what_is_to_the_right_stays_there() {
        let view = camera().camera().view;
        assert_eq!(view.transform_point3(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(1.0, 2.0, -8.0));
    }

    #[test]
    fn the_field_of_view_is_that_of_the_smaller_side() {
        let fov = |aspect, half_height| RibCamera { aspect, half_height, ..camera() }.vertical_fov();
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
        near(fov(None, None), 90.0);
        near(fov(Some(2.0), None), 90.0);
        near(fov(Some(0.5), None), 2.0 * libm::atan(2.0).to_degrees());
        near(fov(Some(2.0), Some(0.5)), 2.0 * libm::atan(0.5).to_degrees());
    }

    #[test]
    fn the_focal_length_is_that_of_the_lens() {
        let lens = Some(RibLens { fstop: 2.0, focal_length: 0.05, focus: 3.0 });
        let blur = RibCamera { lens, ..camera() }.blur();
        assert_eq!(blur.lens, Some(Lens { fstop: 2.0, focus: 3.0 }));
        assert!((blur.sensor - 0.1).abs() < 1e-12);
    }
}
