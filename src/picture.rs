//! Pictures read from files: any channels, as numbers.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

use exr::meta::MetaData;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use image::{ColorType, DynamicImage, ImageFormat, ImageReader, Limits};

use crate::error::{Error, Result};

/// An image of any channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Values by name of their channel, row after row from the top. Of PNG files as they are encoded, from 0 to 1.
    pub channels: BTreeMap<String, Vec<f64>>,
}

/// No byte of a file stands for more bytes of a picture: deflate gets to 1032.
const MOST_A_BYTE: u64 = 4096;

impl Picture {
    /// Reads a PNG file (8 or 16 bits) or the first layer of an EXR file.
    ///
    /// # Errors
    /// [`Error::Read`], or [`Error::Content`] if it is not such a file.
    pub fn load(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let wrong = |why: String| Error::content(path, why, "give a PNG or an EXR file that is whole");
        match extension(path).as_str() {
            "png" => Self::from_png(&bytes).map_err(|error| wrong(error.to_string())),
            "exr" => Self::from_exr(&bytes).map_err(|error| wrong(error.to_string())),
            _ => {
                Err(Error::content(path, "not a .png or .exr file", "convert it, or rename it if it is one"))
            }
        }
    }

    fn from_png(bytes: &[u8]) -> image::ImageResult<Self> {
        let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        let mut limits = Limits::default();
        limits.max_alloc = Some(room_for(bytes));
        reader.limits(limits);
        let read = reader.decode()?;
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
        check_claims(bytes)?;
        let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = reader.all_attributes().from_buffered(Cursor::new(bytes))?;
        let layer = image.layer_data;
        let channels = layer.channel_data.list.into_iter().map(|channel| {
            let values = match channel.sample_data {
                FlatSamples::F16(all) => all.into_iter().map(f64::from).collect(),
                FlatSamples::F32(all) => all.into_iter().map(f64::from).collect(),
                FlatSamples::U32(all) => all.into_iter().map(f64::from).collect(),
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

/// The end of a file's name, in small letters: what kind of file it is.
#[must_use]
pub fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// Bytes that a picture can have whose file has these.
const fn room_for(bytes: &[u8]) -> u64 {
    bytes.len() as u64 * MOST_A_BYTE
}

/// Refuses files that claim to be larger than they can be, before anything is allocated for them.
fn check_claims(bytes: &[u8]) -> exr::error::Result<()> {
    let headers = MetaData::read_from_buffered(bytes, false)?.headers;
    let claimed = headers.iter().map(|header| {
        let pixels = header.layer_size.width() as u64 * header.layer_size.height() as u64;
        pixels.saturating_mul(4 * header.channels.list.len() as u64)
    });
    if claimed.fold(0, u64::saturating_add) > room_for(bytes) {
        return Err(exr::error::Error::Invalid("the file is too short for its size in pixels".into()));
    }
    Ok(())
}

/// All values of a PNG file from 0 to 1, in order.
fn levels(image: &DynamicImage) -> Vec<f64> {
    let eight = |all: &[u8]| all.iter().map(|level| f64::from(*level) / 255.0).collect();
    let sixteen = |all: &[u16]| all.iter().map(|level| f64::from(*level) / 65535.0).collect();
    match image {
        DynamicImage::ImageLuma16(all) => sixteen(all.as_raw()),
        DynamicImage::ImageLumaA16(all) => sixteen(all.as_raw()),
        DynamicImage::ImageRgb16(all) => sixteen(all.as_raw()),
        DynamicImage::ImageRgba16(all) => sixteen(all.as_raw()),
        other => eight(other.as_bytes()),
    }
}
