//! A camera's path: keys at some frames, and the camera at any moment between them.
//!
//! Every coordinate is a monotone cubic (Fritsch & Butland 1984) of the frame: smooth, and between two keys it
//! never leaves the range that these two span. So a camera between two keys above the ground stays above it,
//! which Catmull-Rom splines do not promise, and one between two equal keys stands still.

use glam::DVec3;
use micropoly_core::camera::Camera;

use crate::error::{Error, Result};

/// Where the camera is at one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraKey {
    /// The frame.
    pub frame: u32,
    /// Where the eye is.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
    /// What points upwards in the image.
    pub up: DVec3,
    /// Vertical field of view in degrees, between 0 and 180. Its logarithm is interpolated, so that zooms look
    /// even.
    pub fov: f64,
}

/// Two keys or more, in the order of their frames.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    keys: Vec<CameraKey>,
}

/// Coordinates of a key: eye, target, up and the logarithm of the field of view.
type Coordinates = [f64; 10];

impl CameraKey {
    /// The camera at this key, whose near plane is so far away; `None` as in [`Camera::look_at`].
    #[must_use]
    pub fn camera(&self, near: f64) -> Option<Camera> {
        Camera::look_at(self.eye, self.target, self.up, self.fov, near)
    }

    fn coordinates(&self) -> Coordinates {
        let Self { eye, target, up, fov, .. } = *self;
        let fov = libm::log(fov);
        [eye.x, eye.y, eye.z, target.x, target.y, target.z, up.x, up.y, up.z, fov]
    }

    fn from_coordinates([ex, ey, ez, tx, ty, tz, ux, uy, uz, fov]: Coordinates) -> Self {
        let (eye, target, up) = (DVec3::new(ex, ey, ez), DVec3::new(tx, ty, tz), DVec3::new(ux, uy, uz));
        Self { frame: 0, eye, target, up, fov: libm::exp(fov) }
    }
}

impl CameraPath {
    /// A path through these keys.
    ///
    /// # Errors
    /// [`Error::Scene`] if there are less than two, or frames do not ascend.
    pub fn new(keys: Vec<CameraKey>) -> Result<Self> {
        if keys.len() < 2 {
            return Err(Error::scene("a path needs two keys at least", "add one, or have no path"));
        }
        if let Some(pair) = keys.windows(2).find(|pair| pair[0].frame >= pair[1].frame) {
            let problem = format!("a key at frame {} follows one at frame {}", pair[1].frame, pair[0].frame);
            return Err(Error::scene(problem, "let frames ascend from key to key"));
        }
        Ok(Self { keys })
    }

    /// Its keys.
    #[must_use]
    pub fn keys(&self) -> &[CameraKey] {
        &self.keys
    }

    /// Its first and its last frame.
    #[must_use]
    pub fn frames(&self) -> (u32, u32) {
        (self.keys[0].frame, self.keys[self.keys.len() - 1].frame)
    }

    /// So many frames, evenly spaced from the first to the last; a single one is the first.
    pub fn evenly(&self, count: u32) -> impl Iterator<Item = f64> + use<> {
        let (first, last) = self.frames();
        let steps = f64::from(count.saturating_sub(1).max(1));
        (0..count).map(move |step| f64::from(first) + f64::from(last - first) * f64::from(step) / steps)
    }

    /// The camera at a frame, which need not be whole; its near plane is so far away.
    ///
    /// # Errors
    /// [`Error::Scene`] if the path has no such frame, or the camera looks nowhere there.
    pub fn at(&self, frame: f64, near: f64) -> Result<Camera> {
        let (first, last) = self.frames();
        if !(f64::from(first)..=f64::from(last)).contains(&frame) {
            let problem = format!("the camera's path has no frame {frame}");
            return Err(Error::scene(problem, format!("choose a frame from {first} to {last}")));
        }
        let key = self.keys.iter().find(|key| f64::from(key.frame) == frame).copied();
        key.unwrap_or_else(|| self.between(frame)).camera(near).ok_or_else(|| {
            let problem = format!("at frame {frame} the camera looks nowhere, or straight along `up`");
            Error::scene(problem, "add a key there, or move eye, target or up of those around it")
        })
    }

    /// What a key at this frame would be, between the two around it: a cubic in each coordinate.
    fn between(&self, frame: f64) -> CameraKey {
        let after = self.keys.partition_point(|key| f64::from(key.frame) <= frame);
        let right = after.clamp(1, self.keys.len() - 1);
        let (from, to) = (&self.keys[right - 1], &self.keys[right]);
        let length = f64::from(to.frame - from.frame);
        let t = (frame - f64::from(from.frame)) / length;
        let (start, end) = (from.coordinates(), to.coordinates());
        let (leaving, arriving) = (self.slopes(right - 1), self.slopes(right));
        CameraKey::from_coordinates(std::array::from_fn(|c| {
            hermite(t, (start[c], end[c]), (leaving[c] * length, arriving[c] * length))
        }))
    }

    /// How fast each coordinate changes at a key: as before the key and after it, but never so fast that it
    /// would leave the range of two keys.
    fn slopes(&self, key: usize) -> Coordinates {
        let before = key.checked_sub(1).map(|left| self.secants(left));
        let after = (key + 1 < self.keys.len()).then(|| self.secants(key));
        match (before, after) {
            (Some(before), Some(after)) => std::array::from_fn(|c| monotone(before[c], after[c])),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => [0.0; 10],
        }
    }

    /// How fast each coordinate changes between a key and the next, on average.
    fn secants(&self, left: usize) -> Coordinates {
        let (from, to) = (&self.keys[left], &self.keys[left + 1]);
        let (start, end) = (from.coordinates(), to.coordinates());
        std::array::from_fn(|c| (end[c] - start[c]) / f64::from(to.frame - from.frame))
    }
}

/// Harmonic mean of two slopes; 0 where they have different signs, because there the extremum is.
fn monotone(before: f64, after: f64) -> f64 {
    if before * after > 0.0 { 2.0 * before * after / (before + after) } else { 0.0 }
}

/// The cubic with these values and slopes at 0 and 1.
fn hermite(t: f64, (start, end): (f64, f64), (leaving, arriving): (f64, f64)) -> f64 {
    let rest = 1.0 - t;
    let (from, to) = (rest * rest * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t));
    start * from + end * to + t * rest * (leaving * rest - arriving * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(frame: u32, eye: [f64; 3], fov: f64) -> CameraKey {
        let eye = DVec3::from(eye);
        CameraKey { frame, eye, target: eye + DVec3::new(0.3, 1.0, -0.1), up: DVec3::Z, fov }
    }

    fn path() -> CameraPath {
        CameraPath::new(vec![
            key(0, [0.0, 0.0, 18.0], 50.0),
            key(10, [5.0, 1.0, 0.5], 50.0),
            key(40, [9.0, 20.0, 0.5], 50.0),
            key(45, [3.0, 22.0, 4.0], 2.0),
        ])
        .expect("a path")
    }

    fn eye(frame: f64) -> DVec3 {
        path().at(frame, 0.1).expect("a camera").view.inverse().translation
    }

    #[test]
    fn the_camera_is_at_each_key_when_its_frame_comes() {
        for key in path().keys() {
            let there = path().at(f64::from(key.frame), 0.1).expect("a camera");
            assert_eq!(Some(there), key.camera(0.1), "frame {}", key.frame);
            let near = path().at((f64::from(key.frame) + 1e-9).min(45.0), 0.1).expect("a camera");
            assert!(near.view.abs_diff_eq(there.view, 1e-6), "frame {}", key.frame);
            assert!((near.fov - there.fov).abs() < 1e-6, "frame {}", key.frame);
        }
    }

    #[test]
    fn between_two_keys_the_camera_stays_in_their_box() {
        for pair in path().keys().windows(2) {
            let (low, high) = (pair[0].eye.min(pair[1].eye), pair[0].eye.max(pair[1].eye));
            for step in 0..=100 {
                let frame = f64::from(pair[0].frame)
                    + f64::from(pair[1].frame - pair[0].frame) * f64::from(step) / 100.0;
                let eye = eye(frame);
                assert!(eye.cmpge(low - 1e-9).all() && eye.cmple(high + 1e-9).all(), "frame {frame}: {eye}");
            }
        }
    }

    #[test]
    fn the_camera_does_not_jerk_at_a_key() {
        for frame in [10.0, 40.0] {
            let (before, after) = ((eye(frame) - eye(frame - 1e-4)), (eye(frame + 1e-4) - eye(frame)));
            assert!((before - after).length() < 1e-7, "frame {frame}: {before}, then {after}");
        }
    }

    #[test]
    fn zooms_are_even() {
        let ends = |first: f64, last: f64| {
            CameraPath::new(vec![key(0, [0.0; 3], first), key(8, [0.0; 3], last)]).expect("a path")
        };
        let fov = ends(64.0, 4.0).at(4.0, 0.1).expect("a camera").fov;
        assert!((fov - 16.0).abs() < 1e-9, "{fov}");
    }

    #[test]
    fn frames_are_evenly_spaced_and_reach_both_ends() {
        assert_eq!(path().evenly(4).collect::<Vec<_>>(), [0.0, 15.0, 30.0, 45.0]);
        assert_eq!(path().evenly(1).collect::<Vec<_>>(), [0.0]);
    }

    #[test]
    fn what_is_no_path_is_refused() {
        let (first, second) = (key(3, [0.0; 3], 50.0), key(3, [1.0; 3], 50.0));
        for keys in [vec![], vec![first], vec![first, second]] {
            assert!(CameraPath::new(keys).is_err());
        }
        for frame in [-0.5, 45.5, f64::NAN] {
            assert!(path().at(frame, 0.1).is_err(), "frame {frame}");
        }
        let turn = |frame, z| CameraKey { target: DVec3::new(0.0, 0.0, z), ..key(frame, [0.0; 3], 50.0) };
        let through_the_eye = CameraPath::new(vec![turn(0, 1.0), turn(2, -1.0)]).expect("a path");
        assert!(through_the_eye.at(1.0, 0.1).is_err());
    }
}
