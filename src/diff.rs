//! diff: how much two pictures differ, and where.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::image::Image;
use crate::picture::Picture;

/// How much two pictures may differ; as OpenImageIO's `idiff` has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// A pixel fails if one of its channels differs by more than this.
    pub fail: f32,
    /// So many per cent of the pixels may fail.
    pub fail_percent: f64,
    /// No channel of any pixel may differ by more than this.
    pub hard_fail: f32,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self { fail: 0.0, fail_percent: 0.0, hard_fail: f32::INFINITY }
    }
}

/// The largest difference of a value, and where it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Largest {
    /// Column of the pixel.
    pub x: usize,
    /// Row of the pixel.
    pub y: usize,
    /// The channel.
    pub channel: String,
    /// Its value in the first picture.
    pub first: f32,
    /// Its value in the second picture.
    pub second: f32,
    /// The difference.
    pub difference: f32,
}

/// How much two pictures differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Names of the channels.
    pub channels: Vec<String>,
    /// Mean magnitude of all differences.
    pub mean: f64,
    /// Root of the mean square of all differences.
    pub rms: f64,
    /// 20 · log₁₀(1 / `rms`); nothing if there is no difference.
    pub psnr: Option<f64>,
    /// The largest difference, if there is any: the first one from the top.
    pub largest: Option<Largest>,
    /// Pixels that differ at all.
    pub different: usize,
    /// Pixels that differ by more than [`Thresholds::fail`].
    pub failing: usize,
    /// Largest difference among the channels of each pixel, row after row from the top.
    #[serde(skip)]
    pub map: Vec<f32>,
}

impl Difference {
    /// Compares two pictures, value by value. NaN equals NaN, and differs infinitely from anything else.
    ///
    /// # Errors
    /// [`Error::Scene`] if sizes or channels are not the same.
    pub fn of(first: &Picture, second: &Picture, thresholds: &Thresholds) -> Result<Self> {
        check_shapes(first, second)?;
        let (mut sum, mut squares) = (0.0, 0.0);
        let (mut map, mut largest): (_, Option<Largest>) = (vec![0.0_f32; first.pixels()], None);
        for (name, values) in &first.channels {
            for (at, (&a, &b)) in values.iter().zip(&second.channels[name]).enumerate() {
                let difference = apart(a, b);
                sum += f64::from(difference);
                squares += f64::from(difference) * f64::from(difference);
                map[at] = map[at].max(difference);
                if difference > largest.as_ref().map_or(0.0, |largest| largest.difference) {
                    let (x, y) = (at % first.width, at / first.width);
                    largest = Some(Largest { x, y, channel: name.clone(), first: a, second: b, difference });
                }
            }
        }
        let count = (map.len() * first.channels.len()).max(1) as f64;
        let rms = (squares / count).sqrt();
        Ok(Self {
            width: first.width,
            height: first.height,
            channels: first.channels.keys().cloned().collect(),
            mean: sum / count,
            rms,
            psnr: (rms > 0.0).then(|| -20.0 * rms.log10()),
            largest,
            different: map.iter().filter(|difference| **difference > 0.0).count(),
            failing: map.iter().filter(|difference| **difference > thresholds.fail).count(),
            map,
        })
    }

    /// Share of the pixels that fail, in per cent.
    #[must_use]
    pub fn failing_percent(&self) -> f64 {
        100.0 * self.failing as f64 / self.map.len().max(1) as f64
    }

    /// Do the pictures differ by no more than is allowed?
    #[must_use]
    pub fn is_within(&self, thresholds: &Thresholds) -> bool {
        let largest = self.largest.as_ref().map_or(0.0, |largest| largest.difference);
        self.failing_percent() <= thresholds.fail_percent && largest <= thresholds.hard_fail
    }

    /// A picture of the differences: black where there is none, then blue, red, yellow, and white from `white` on.
    #[must_use]
    pub fn heat(&self, white: f32) -> Image {
        let rgb = self.map.iter().flat_map(|difference| heat(difference / white)).collect();
        Image { width: self.width as u32, height: self.height as u32, rgb }
    }
}

fn apart(a: f32, b: f32) -> f32 {
    if a == b || (a.is_nan() && b.is_nan()) {
        0.0
    } else if a.is_nan() || b.is_nan() {
        f32::INFINITY
    } else {
        (a - b).abs()
    }
}

fn check_shapes(first: &Picture, second: &Picture) -> Result<()> {
    let size = |picture: &Picture| format!("{}x{}", picture.width, picture.height);
    let names = |picture: &Picture| picture.channels.keys().cloned().collect::<Vec<_>>().join(", ");
    if size(first) != size(second) {
        let problem = format!("the first picture has {} pixels, the second {}", size(first), size(second));
        return Err(Error::scene(problem, "compare pictures of the same size"));
    }
    if names(first) != names(second) {
        let problem =
            format!("the first picture has channels {}, the second {}", names(first), names(second));
        return Err(Error::scene(problem, "compare pictures of the same kind"));
    }
    Ok(())
}

/// Colours of the scale, evenly spaced; any difference at all is not black.
const SCALE: [[f32; 3]; 5] =
    [[0.0, 0.0, 96.0], [32.0, 32.0, 255.0], [255.0, 32.0, 32.0], [255.0, 255.0, 32.0], [255.0; 3]];

fn heat(share: f32) -> [u8; 3] {
    if share <= 0.0 {
        return [0; 3];
    }
    let at = share.min(1.0) * (SCALE.len() - 1) as f32;
    let step = (at as usize).min(SCALE.len() - 2);
    let (from, to) = (SCALE[step], SCALE[step + 1]);
    [0, 1, 2].map(|k| (from[k] + (to[k] - from[k]) * (at - step as f32)).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, channels: &[(&str, &[f32])]) -> Picture {
        let height = channels[0].1.len() / width;
        let channels = channels.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec())).collect();
        Picture { width, height, channels }
    }

    #[test]
    fn differences_are_counted_by_pixel_and_found() {
        let first = picture(2, &[("R", &[0.0, 0.5, 1.0, 0.25]), ("Z", &[1.0, 2.0, 3.0, f32::INFINITY])]);
        let second = picture(2, &[("R", &[0.0, 0.75, 1.0, 0.25]), ("Z", &[1.0, 2.5, 3.0, f32::INFINITY])]);
        let thresholds = Thresholds { fail: 0.4, fail_percent: 25.0, hard_fail: 0.5 };
        let found = Difference::of(&first, &second, &thresholds).expect("the same shape");
        assert_eq!((found.different, found.failing), (1, 1));
        assert_eq!(found.map, [0.0, 0.5, 0.0, 0.0]);
        assert!(
            (found.mean - 0.75 / 8.0).abs() < 1e-12 && (found.rms - (0.3125_f64 / 8.0).sqrt()).abs() < 1e-12
        );
        let largest = found.largest.clone().expect("one");
        assert_eq!((largest.x, largest.y, largest.channel.as_str()), (1, 0, "Z"));
        assert!(found.is_within(&thresholds));
        assert!(!found.is_within(&Thresholds { fail_percent: 24.0, ..thresholds }));
        assert!(!found.is_within(&Thresholds { hard_fail: 0.49, ..thresholds }));
    }

    #[test]
    fn nan_is_no_number_and_equals_itself() {
        let first = picture(1, &[("Y", &[f32::NAN, f32::NAN])]);
        let second = picture(1, &[("Y", &[f32::NAN, 0.0])]);
        let found = Difference::of(&first, &second, &Thresholds::default()).expect("the same shape");
        assert_eq!((found.failing, found.map[1]), (1, f32::INFINITY));
    }

    #[test]
    fn other_shapes_are_refused() {
        let first = picture(2, &[("Y", &[0.0; 4])]);
        for other in [picture(4, &[("Y", &[0.0; 4])]), picture(2, &[("R", &[0.0; 4])])] {
            assert!(Difference::of(&first, &other, &Thresholds::default()).is_err());
        }
    }

    #[test]
    fn heat_rises_from_black_to_white() {
        assert_eq!(heat(0.0), [0; 3]);
        assert_ne!(heat(1.0e-9), [0; 3]);
        assert_eq!(heat(1.0), [255; 3]);
        assert_eq!(heat(f32::INFINITY), [255; 3]);
    }
}
