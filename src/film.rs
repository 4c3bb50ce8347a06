//! Film: what a frame shows as linear values, and the files that can hold them.

use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, IntegerBounds, Layer, LayerAttributes,
    SmallVec, Vec2, WritableImage, f16,
};
use glam::Vec3;
use image::ExtendedColorType;
use micropoly_core::abi::{PARAM_STEP, Pixel};
use micropoly_core::pattern::Window;

use crate::error::{Error, Result};
use crate::image::{over, srgb_from_linear, write_png};

/// Linear values of a frame, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Which pixels of the image.
    pub window: Window,
    /// Width and height of the image.
    pub size: (u32, u32),
    /// Colour where nothing is, linear RGB.
    pub background: Vec3,
    /// The pixels.
    pub pixels: Vec<Pixel>,
    /// Unit normals, in world space, of what each shows; zero where nothing is. Outwards is where u runs to the right and v
    /// upwards.
    pub normals: Vec<[f32; 3]>,
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
        let levels = self.pixels.iter().flat_map(|pixel| over(pixel, self.background).map(level));
        let bytes: Vec<u8> = levels.flat_map(u16::to_ne_bytes).collect();
        write_png(path, &bytes, (self.window.width(), self.window.height()), ExtendedColorType::Rgb16)
    }

    /// Writes an EXR file. `R`, `G`, `B` (without the background) and `A` (coverage), linear, are filtered; what the nearest
    /// sample of each pixel shows is not: `Z`, the distance along the view axis, infinite where nothing is; `N.X`, `N.Y` and
    /// `N.Z`, the normal in world space; `u` and `v` within the patch; `patch`, its number, 2³² - 1 where none is; and
    /// `samples`, how many of the pixel's own samples show something.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save_exr(&self, path: &Path, precision: Precision) -> Result<()> {
        let mut list: SmallVec<[AnyChannel<FlatSamples>; 4]> = SmallVec::new();
        for (k, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            let values = self.pixels.iter().map(|pixel| pixel.rgba[k]);
            list.push(AnyChannel::new(name, floats(values, precision)));
        }
        for (k, name) in ["N.X", "N.Y", "N.Z"].into_iter().enumerate() {
            let values = self.normals.iter().map(|normal| normal[k]);
            list.push(AnyChannel::new(name, floats(values, precision)));
        }
        let exact = |value: fn(&Pixel) -> f32| FlatSamples::F32(self.pixels.iter().map(value).collect());
        list.push(AnyChannel::new("Z", exact(|pixel| 1.0 / f32::from_bits(pixel.depth))));
        list.push(AnyChannel::new("u", exact(|pixel| pixel.u as f32 * PARAM_STEP)));
        list.push(AnyChannel::new("v", exact(|pixel| pixel.v as f32 * PARAM_STEP)));
        let whole = |value: fn(&Pixel) -> u32| FlatSamples::U32(self.pixels.iter().map(value).collect());
        list.push(AnyChannel::new("patch", whole(|p| if p.depth > 0 { p.patch_id } else { u32::MAX })));
        list.push(AnyChannel::new("samples", whole(|pixel| pixel.covered)));
        let size = (self.window.width() as usize, self.window.height() as usize);
        let layer_position = Vec2(self.window.left as i32, self.window.top as i32);
        let software_name = Some("micropoly".into());
        let attributes = LayerAttributes { software_name, layer_position, ..Default::default() };
        let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
        let mut image = ExrImage::from_layer(layer);
        // A cropped image lies in its place in the whole one.
        image.attributes.display_window =
            IntegerBounds::from_dimensions((self.size.0 as usize, self.size.1 as usize));
        image
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
