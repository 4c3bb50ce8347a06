//! Pictures read from files: any channels, as floats.

use std::collections::BTreeMap;
use std::path::Path;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use image::{ColorType, DynamicImage};

use crate::error::{Error, Result};

/// An image of any channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Values by name of their channel, row after row from the top. Of PNG files as they are encoded, from 0 to 1.
    pub channels: BTreeMap<String, Vec<f32>>,
}

impl Picture {
    /// Reads a PNG file (8 or 16 bits) or the first layer of an EXR file.
    ///
    /// # Errors
    /// [`Error::Read`], or [`Error::Content`] if it is not such a file.
    pub fn load(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let wrong = |why: String| Error::content(path, why, "give a PNG or an EXR file that is whole");
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("png") => Self::from_png(&bytes).map_err(|error| wrong(error.to_string())),
            Some("exr") => Self::from_exr(&bytes).map_err(|error| wrong(error.to_string())),
            _ => {
                Err(Error::content(path, "not a .png or .exr file", "convert it, or rename it if it is one"))
            }
        }
    }

    fn from_png(bytes: &[u8]) -> image::ImageResult<Self> {
        let read = image::load_from_memory_with_format(bytes, image::ImageFormat::Png)?;
        let names: &[&str] = match read.color() {
            ColorType::L8 | ColorType::L16 => &["Y"],
            ColorType::La8 | ColorType::La16 => &["Y", "A"],
            ColorType::Rgb8 | ColorType::Rgb16 => &["R", "G", "B"],
            _ => &["R", "G", "B", "A"],
        };
        let (width, height) = (read.width() as usize, read.height() as usize);
        let values = levels(&read);
        let channel = |k: usize| values.iter().skip(k).step_by(names.len()).copied().collect();
        let channels = names.iter().enumerate().map(|(k, name)| ((*name).to_owned(), channel(k))).collect();
        Ok(Self { width, height, channels })
    }

    fn from_exr(bytes: &[u8]) -> exr::error::Result<Self> {
        let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = reader.all_attributes().from_buffered(std::io::Cursor::new(bytes))?;
        let layer = image.layer_data;
        let channels = layer.channel_data.list.into_iter().map(|channel| {
            let values = match channel.sample_data {
                FlatSamples::F16(all) => all.into_iter().map(f32::from).collect(),
                FlatSamples::F32(all) => all,
                FlatSamples::U32(all) => all.into_iter().map(|value| value as f32).collect(),
            };
            (channel.name.to_string(), values)
        });
        Ok(Self { width: layer.size.width(), height: layer.size.height(), channels: channels.collect() })
    }

    /// Number of pixels.
    pub(crate) fn pixels(&self) -> usize {
        self.width * self.height
    }
}

/// All values of a PNG file from 0 to 1, in order.
fn levels(image: &DynamicImage) -> Vec<f32> {
    let eight = |all: &[u8]| all.iter().map(|level| f32::from(*level) / 255.0).collect();
    let sixteen = |all: &[u16]| all.iter().map(|level| f32::from(*level) / 65535.0).collect();
    match image {
        DynamicImage::ImageLuma16(all) => sixteen(all.as_raw()),
        DynamicImage::ImageLumaA16(all) => sixteen(all.as_raw()),
        DynamicImage::ImageRgb16(all) => sixteen(all.as_raw()),
        DynamicImage::ImageRgba16(all) => sixteen(all.as_raw()),
        other => eight(other.as_bytes()),
    }
}
