//! diff: how much two pictures differ, and where.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::image::Image;
use crate::picture::Picture;

/// How much two pictures may differ; as OpenImageIO's `idiff` has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// A pixel fails if one of its channels differs by more than this.
    pub fail: f64,
    /// So many per cent of the pixels may fail.
    pub fail_percent: f64,
    /// No channel of any pixel may differ by more than this, however few do.
    pub hard_fail: f64,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self { fail: 0.0, fail_percent: 0.0, hard_fail: f64::INFINITY }
    }
}

/// The largest difference of a value, and where it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Largest {
    /// Column of the pixel.
    pub x: usize,
    /// Row of the pixel.
    pub y: usize,
    /// Its value in the first picture; like all here, text if it is not finite.
    #[serde(serialize_with = "number")]
    pub first: f64,
    /// Its value in the second picture.
    #[serde(serialize_with = "number")]
    pub second: f64,
    /// The difference.
    #[serde(serialize_with = "number")]
    pub difference: f64,
}

/// How much two pictures differ in one channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelDifference {
    /// Its name.
    pub name: String,
    /// Mean magnitude of the differences that are finite.
    pub mean: f64,
    /// Root of their mean square.
    pub rms: f64,
    /// 20 · log₁₀(1 / `rms`); nothing if there is no difference.
    pub psnr: Option<f64>,
    /// Values that differ infinitely: one of the two is infinite, or no number.
    pub infinite: usize,
    /// The largest difference, if there is any: of equal ones the first from the top.
    pub largest: Option<Largest>,
}

/// How much two pictures differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// By channel.
    pub channels: Vec<ChannelDifference>,
    /// Pixels that differ at all.
    pub different: usize,
    /// Pixels that differ by more than [`Thresholds::fail`].
    pub failing: usize,
    /// Largest difference among the channels of each pixel, row after row from the top.
    #[serde(skip)]
    pub map: Vec<f64>,
}

/// JSON has no infinities.
fn number<S: serde::Serializer>(value: &f64, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    if value.is_finite() { serializer.serialize_f64(*value) } else { serializer.collect_str(value) }
}

impl ChannelDifference {
    /// Compares the values of a channel, and raises `map` to the difference where it is larger.
    fn of(name: &str, values: [&[f64]; 2], width: usize, map: &mut [f64]) -> Self {
        let (mut sum, mut squares, mut infinite) = (0.0, 0.0, 0);
        let mut largest: Option<Largest> = None;
        for (at, (&first, &second)) in values[0].iter().zip(values[1]).enumerate() {
            let difference = apart(first, second);
            if difference.is_finite() {
                (sum, squares) = (sum + difference, squares + difference * difference);
            } else {
                infinite += 1;
            }
            map[at] = map[at].max(difference);
            if difference > largest.as_ref().map_or(0.0, |largest| largest.difference) {
                largest = Some(Largest { x: at % width, y: at / width, first, second, difference });
            }
        }
        let count = (map.len() - infinite).max(1) as f64;
        let rms = (squares / count).sqrt();
        let psnr = (rms > 0.0).then(|| -20.0 * rms.log10());
        Self { name: name.to_owned(), mean: sum / count, rms, psnr, infinite, largest }
    }
}

impl Difference {
    /// Compares two pictures, value by value. NaN equals NaN, and differs infinitely from anything else.
    ///
    /// # Errors
    /// [`Error::Scene`] if sizes or channels are not the same.
    pub fn of(first: &Picture, second: &Picture, thresholds: &Thresholds) -> Result<Self> {
        check_shapes(first, second)?;
        let mut map = vec![0.0; first.pixels()];
        let compare = |(name, values): (&String, &Vec<f64>)| {
            ChannelDifference::of(name, [values, &second.channels[name]], first.width, &mut map)
        };
        let channels = first.channels.iter().map(compare).collect();
        Ok(Self {
            width: first.width,
            height: first.height,
            channels,
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
        let largest = self.map.iter().fold(0.0, |most: f64, difference| most.max(*difference));
        self.failing_percent() <= thresholds.fail_percent && largest <= thresholds.hard_fail
    }

    /// A picture of the differences: black where there is none, then blue, red, yellow, and white from `white` on.
    #[must_use]
    pub fn heat(&self, white: f64) -> Image {
        let rgb = self.map.iter().flat_map(|difference| heat(difference / white)).collect();
        Image { width: self.width as u32, height: self.height as u32, rgb }
    }
}

fn apart(a: f64, b: f64) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        0.0
    } else if a.is_nan() || b.is_nan() {
        f64::INFINITY
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
const SCALE: [[f64; 3]; 5] =
    [[0.0, 0.0, 96.0], [32.0, 32.0, 255.0], [255.0, 32.0, 32.0], [255.0, 255.0, 32.0], [255.0; 3]];

fn heat(share: f64) -> [u8; 3] {
    if share <= 0.0 {
        return [0; 3];
    }
    let at = share.min(1.0) * (SCALE.len() - 1) as f64;
    let step = (at as usize).min(SCALE.len() - 2);
    let (from, to) = (SCALE[step], SCALE[step + 1]);
    [0, 1, 2].map(|k| (from[k] + (to[k] - from[k]) * (at - step as f64)).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, channels: &[(&str, &[f64])]) -> Picture {
        let height = channels[0].1.len() / width;
        let channels = channels.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec())).collect();
        Picture { width, height, channels }
    }

    #[test]
    fn differences_are_counted_by_pixel_and_found_by_channel() {
        let infinite = f64::INFINITY;
        let first = picture(2, &[("R", &[0.0, 0.5, 1.0, 0.25]), ("Z", &[1.0, 2.0, 3.0, infinite])]);
        let second = picture(2, &[("R", &[0.0, 0.75, 1.0, 0.25]), ("Z", &[1.0, 2.5, infinite, infinite])]);
        let thresholds = Thresholds { fail: 0.4, fail_percent: 50.0, hard_fail: infinite };
        let found = Difference::of(&first, &second, &thresholds).expect("the same shape");
        assert_eq!((found.different, found.failing), (2, 2));
        assert_eq!(found.map, [0.0, 0.5, infinite, 0.0]);
        let [red, depth] = found.channels.as_slice() else { panic!("two channels") };
        assert_eq!((red.mean, red.rms, red.infinite), (0.0625, 0.125, 0));
        assert_eq!((depth.mean, depth.infinite), (0.5 / 3.0, 1));
        let largest = red.largest.clone().expect("one");
        assert_eq!((largest.x, largest.y, largest.first, largest.second), (1, 0, 0.5, 0.75));
        assert_eq!(depth.largest.as_ref().map(|largest| (largest.x, largest.y)), Some((0, 1)));
        assert!(found.is_within(&thresholds));
        assert!(!found.is_within(&Thresholds { fail_percent: 49.0, ..thresholds }));
        assert!(!found.is_within(&Thresholds { hard_fail: 1.0e9, ..thresholds }));
    }

    #[test]
    fn nan_is_no_number_and_equals_itself() {
        let first = picture(1, &[("Y", &[f64::NAN, f64::NAN])]);
        let second = picture(1, &[("Y", &[f64::NAN, 0.0])]);
        let found = Difference::of(&first, &second, &Thresholds::default()).expect("the same shape");
        assert_eq!((found.failing, found.map[1]), (1, f64::INFINITY));
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
        assert_eq!(heat(f64::INFINITY), [255; 3]);
    }
}
