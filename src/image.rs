//! Images: linear colours to 8-bit sRGB, a hash of the pixels, PNG files.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use glam::Vec3;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use micropoly_core::abi::Pixel;

use crate::error::{Error, Result};

/// 8-bit sRGB pixels, row after row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
}

impl Image {
    /// `blake3:` and the hash of width, height and pixels.
    #[must_use]
    pub fn hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.width.to_le_bytes());
        hasher.update(&self.height.to_le_bytes());
        hasher.update(&self.rgb);
        format!("blake3:{}", hasher.finalize().to_hex())
    }

    /// Writes a PNG file.
    ///
    /// # Errors
    /// [`Error::Write`] names the file.
    pub fn save_png(&self, path: &Path) -> Result<()> {
        write_png(path, &self.rgb, (self.width, self.height), ExtendedColorType::Rgb8)
    }
}

/// Writes a PNG file.
pub(crate) fn write_png(
    path: &Path,
    bytes: &[u8],
    (width, height): (u32, u32),
    kind: ExtendedColorType,
) -> Result<()> {
    let failed = |why: String| Error::Write { path: path.to_owned(), why };
    let file = BufWriter::new(File::create(path).map_err(|error| failed(error.to_string()))?);
    PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Sub)
        .write_image(bytes, width, height, kind)
        .map_err(|error| failed(error.to_string()))
}

impl Image {
    /// Pixels as an image before a black background.
    #[must_use]
    pub fn from_pixels(width: u32, height: u32, pixels: &[Pixel]) -> Self {
        let mut rgb = vec![0; pixels.len() * 3];
        Encoder::new(Vec3::ZERO).encode_row(pixels, &mut rgb);
        Self { width, height, rgb }
    }
}

/// Steps of the table from linear values to sRGB: fine enough for the steepest part of the curve, where
/// one of 255 levels is 20 steps wide.
const STEPS: usize = 1 << 16;

/// Turns linear colours into 8-bit sRGB by table.
pub(crate) struct Encoder {
    level: Vec<u8>,
    background: Vec3,
}

impl Encoder {
    /// `background` (linear RGB) shows where nothing covers a sample.
    pub(crate) fn new(background: Vec3) -> Self {
        let mut level = vec![255; STEPS];
        let mut next = 0;
        for output in 0..255_u8 {
            let boundary = linear_from_srgb((f64::from(output) + 0.5) / 255.0);
            let end = (boundary * (STEPS - 1) as f64).ceil() as usize;
            level[next..end].fill(output);
            next = end;
        }
        Self { level, background }
    }

    fn encode(&self, linear: f32) -> u8 {
        self.level[(linear.clamp(0.0, 1.0) * (STEPS - 1) as f32 + 0.5) as usize]
    }

    /// Encodes pixels, red, green and blue of each.
    pub(crate) fn encode_row(&self, pixels: &[Pixel], rgb: &mut [u8]) {
        for (pixel, rgb) in pixels.iter().zip(rgb.as_chunks_mut::<3>().0) {
            *rgb = over(pixel, self.background).map(|value| self.encode(value));
        }
    }
}

/// What a pixel shows before a background, linear RGB.
pub(crate) fn over(pixel: &Pixel, background: Vec3) -> [f32; 3] {
    let [red, green, blue, coverage] = pixel.rgba;
    (Vec3::new(red, green, blue) + background * (1.0 - coverage)).to_array()
}

/// The linear value, 0 to 1, of an sRGB value, 0 to 1 (IEC 61966-2-1).
pub(crate) fn linear_from_srgb(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

/// The sRGB value, 0 to 1, of a linear value, which is first moved into that range.
pub(crate) fn srgb_from_linear(value: f64) -> f64 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.0031308 { value * 12.92 } else { 1.055 * libm::pow(value, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoding_is_the_nearest_srgb_level_and_reaches_all() {
        let encoder = Encoder::new(Vec3::ZERO);
        for level in 0..=255_u8 {
            let linear = linear_from_srgb(f64::from(level) / 255.0) as f32;
            assert_eq!(encoder.encode(linear), level);
        }
        assert_eq!(encoder.encode(-1.0), 0);
        assert_eq!(encoder.encode(2.0), 255);
        assert_eq!(encoder.encode(f32::NAN), 0);
    }

    #[test]
    fn the_curve_and_its_inverse_agree() {
        for level in 0..=1000 {
            let value = f64::from(level) / 1000.0;
            assert!((srgb_from_linear(linear_from_srgb(value)) - value).abs() < 1.0e-6, "{value}");
        }
    }
}
