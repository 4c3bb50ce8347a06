//! A shot: from when and where a scene is seen, while the shutter is open and through all of a lens.

use glam::{DAffine3, DMat3, DVec3};
use micropoly_core::abi::{Frame, Object};
use micropoly_core::camera::{Camera, FrameOptions};

use crate::error::{Error, Result};
use crate::scene::Scene;

/// Height of the sensor in scene units unless the scene says otherwise: that of a 35 mm film, if units are metres.
pub(crate) const DEFAULT_SENSOR: f64 = 0.024;

/// What keeps an image from being sharp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// How long the shutter is open, in frames; it opens at the frame. 0 = a moment.
    pub shutter: f64,
    /// The lens; without one all distances are sharp.
    pub lens: Option<Lens>,
    /// Height of the sensor in scene units: with the field of view it gives the focal length.
    pub sensor: f64,
}

impl Default for Blur {
    fn default() -> Self {
        Self { shutter: 0.0, lens: None, sensor: DEFAULT_SENSOR }
    }
}

impl Blur {
    /// Can kernels work with what it makes of a scene?
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let above_zero = |value: f64| value > 0.0 && value.is_finite();
        let lens = self.lens.is_none_or(|lens| above_zero(lens.fstop) && above_zero(lens.focus));
        self.shutter >= 0.0 && self.shutter.is_finite() && above_zero(self.sensor) && lens
    }
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Focal length over diameter.
    pub fstop: f64,
    /// Distance along the view axis that is sharp, in scene units.
    pub focus: f64,
}

/// When a scene is seen, and by which camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// The frame, which need not be whole.
    pub time: f64,
    /// A camera that stands still; `None` follows the scene's own path.
    pub still: Option<Camera>,
}

impl Shot {
    /// At frame 0, with the scene's own camera.
    #[must_use]
    pub const fn of(scene: &Scene) -> Self {
        Self { time: 0.0, still: Some(scene.camera) }
    }

    /// At a frame of the scene's animation: with the camera on its path, if it has one.
    ///
    /// # Errors
    /// [`Error::Scene`] if nothing moves, or the path has no such frame.
    pub fn at(scene: &Scene, time: f64) -> Result<Self> {
        if scene.path.is_some() {
            scene.camera_at(time)?;
            return Ok(Self { time, still: None });
        }
        if !scene.moves() {
            let problem = format!("{}: nothing moves, so there are no frames", scene.name);
            let remedy = "give the camera two [[camera.key]] or more, or an object a motion: see \"Scene files\" in the README";
            return Err(Error::scene(problem, remedy));
        }
        Ok(Self { time, still: Some(scene.camera) })
    }

    /// Does this blur make a difference?
    #[must_use]
    pub fn is_blurred(&self, scene: &Scene, blur: &Blur) -> bool {
        let moves = self.still.is_none() || scene.objects_move();
        blur.lens.is_some() || (blur.shutter > 0.0 && moves)
    }

    /// The camera at any moment of the shot.
    ///
    /// # Errors
    /// [`Error::Scene`] if the path has no such frame, or the camera looks nowhere there.
    pub fn camera(&self, scene: &Scene, now: f64) -> Result<Camera> {
        match (self.still, &scene.path) {
            (Some(camera), _) => Ok(camera),
            // The path's last frame is its end: the camera stops there.
            (None, Some(path)) => scene.camera_at(now.min(f64::from(path.frames().1))),
            (None, None) => Ok(scene.camera),
        }
    }

    /// The scene as devices read it, as seen when `time` of the shutter's opening has passed (0 to 1), from this place on a
    /// lens of radius 1.
    ///
    /// # Errors
    /// As [`Scene::for_device`].
    pub fn view(
        &self,
        scene: &Scene,
        options: &FrameOptions,
        blur: &Blur,
        (time, lens): (f64, [f64; 2]),
    ) -> Result<(Frame, Vec<Object>)> {
        let (camera, now) = self.moment(scene, blur, (time, lens))?;
        scene.view(&camera, now, options)
    }

    /// The camera of such a view, and the frame.
    ///
    /// # Errors
    /// As [`Shot::camera`].
    pub(crate) fn moment(
        &self,
        scene: &Scene,
        blur: &Blur,
        (time, lens): (f64, [f64; 2]),
    ) -> Result<(Camera, f64)> {
        let now = self.time + blur.shutter * time;
        let camera = self.camera(scene, now)?;
        Ok((blur.lens.map_or(camera, |thin| through(&camera, thin, blur.sensor, lens)), now))
    }
}

/// The camera from a place on its lens: moved there, and skewed so that what is in focus stays where it is.
fn through(camera: &Camera, lens: Lens, sensor: f64, [x, y]: [f64; 2]) -> Camera {
    let focal = 0.5 * sensor / libm::tan(camera.fov.to_radians() * 0.5);
    let radius = 0.5 * focal / lens.fstop;
    let (x, y) = (x * radius, y * radius);
    let skew = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(-x / lens.focus, -y / lens.focus, 1.0));
    let moved = DAffine3::from_mat3_translation(skew, DVec3::new(-x, -y, 0.0));
    Camera { view: moved * camera.view, ..*camera }
}
