//! Film: what a frame shows as linear values, and the files that can hold them.

use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer, LayerAttributes, SmallVec,
    WritableImage, f16,
};
use glam::Vec3;
use image::ExtendedColorType;
use micropoly_core::abi::{Colour, Sample};

use crate::error::{Error, Result};
use crate::image::{srgb_from_linear, write_png};

/// Linear values of a frame, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Colour where nothing is, linear RGB.
    pub background: Vec3,
    /// Linear RGB, black where nothing is, and coverage.
    pub colours: Vec<Colour>,
    /// What is there.
    pub samples: Vec<Sample>,
}

/// How exactly an EXR file holds colours; depths are always 32 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 16 bits.
    #[default]
    Half,
    /// 32 bits.
    Float,
}

impl Film {
    /// Writes a PNG file of 16 bits a channel, in sRGB.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save_png16(&self, path: &Path) -> Result<()> {
        let level = |linear: f32| (srgb_from_linear(f64::from(linear)) * 65535.0).round() as u16;
        let levels = self.colours.iter().flat_map(|colour| self.shown(colour).map(level));
        let bytes: Vec<u8> = levels.flat_map(u16::to_ne_bytes).collect();
        write_png(path, &bytes, (self.width, self.height), ExtendedColorType::Rgb16)
    }

    /// The colour of a pixel, before the background.
    fn shown(&self, colour: &Colour) -> [f32; 3] {
        let [red, green, blue, coverage] = colour.rgba;
        if coverage > 0.0 { [red, green, blue] } else { self.background.to_array() }
    }

    /// Writes an EXR file: `R`, `G`, `B` without the background and `A` (coverage), linear; `Z`, the distance along the
    /// view axis, infinite where nothing is; and `patch`, the number of the patch, 2³² - 1 where none is.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save_exr(&self, path: &Path, precision: Precision) -> Result<()> {
        let mut list: SmallVec<[AnyChannel<FlatSamples>; 4]> = SmallVec::new();
        for (k, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            let values = self.colours.iter().map(|colour| colour.rgba[k]);
            list.push(AnyChannel::new(name, floats(values, precision)));
        }
        let depths = self.samples.iter().map(|sample| 1.0 / f32::from_bits(sample.depth)).collect();
        list.push(AnyChannel::new("Z", FlatSamples::F32(depths)));
        let patches = self.samples.iter().map(|s| if s.depth > 0 { s.patch_id } else { u32::MAX }).collect();
        list.push(AnyChannel::new("patch", FlatSamples::U32(patches)));
        let size = (self.width as usize, self.height as usize);
        let attributes = LayerAttributes { software_name: Some("micropoly".into()), ..Default::default() };
        let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
        ExrImage::from_layer(layer)
            .write()
            .to_file(path)
            .map_err(|error| Error::Write { path: path.to_owned(), why: error.to_string() })
    }
}

fn floats(values: impl Iterator<Item = f32>, precision: Precision) -> FlatSamples {
    match precision {
        Precision::Half => FlatSamples::F16(values.map(f16::from_f32).collect()),
        Precision::Float => FlatSamples::F32(values.collect()),
    }
}
