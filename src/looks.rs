//! Looks: the ways to render a picture that conformance compares, on one device and between devices.

use std::fmt;

use micropoly_core::backend::Device;
use micropoly_core::camera::{FrameOptions, Rasteriser, Shading};
use micropoly_core::pattern::Samples;
use micropoly_core::reconstruction::{Filter, Kernel};

use crate::error::Result;
use crate::render::{RenderOptions, render_on};
use crate::scene::Scene;

/// How a picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Samples of a pixel.
    pub samples: Samples,
    /// How grids get to their samples: it must make no difference.
    pub rasteriser: Rasteriser,
    /// Pixels a side of a tile; 0 = as the device likes it. It must make no difference.
    pub tile: u32,
    /// From where colours come.
    pub shading: Shading,
    /// How samples become pixels.
    pub kernel: Kernel,
}

impl fmt::Display for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { samples, rasteriser, tile, shading, kernel } = self;
        write!(
            f,
            "{}, {} samples, {}, {}",
            rasteriser.name(),
            samples.count(),
            shading.name(),
            kernel.name()
        )?;
        if *tile > 0 && *rasteriser == Rasteriser::SortMiddle {
            write!(f, ", tiles of {tile}")
        } else {
            Ok(())
        }
    }
}

impl Look {
    /// Both rasterisers with 1, 4 and 16 samples; tiles, shading and filters take turns.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let turns = [
            (Samples::One, 0, Shading::Flat, Kernel::Box),
            (Samples::Four, 8, Shading::Smooth, Kernel::Mitchell),
            (Samples::Sixteen, 4, Shading::Smooth, Kernel::Gaussian),
        ];
        let both = turns.into_iter().flat_map(|(samples, tile, shading, kernel)| {
            Rasteriser::ALL.map(|rasteriser| Self { samples, rasteriser, tile, shading, kernel })
        });
        both.collect()
    }

    /// The same picture by the default rasteriser.
    #[must_use]
    pub const fn usual(self) -> Self {
        Self { rasteriser: Rasteriser::SortMiddle, tile: 0, ..self }
    }

    /// Hash of all pixels of a scene that looks so, before they are rounded.
    ///
    /// # Errors
    /// As [`render_on`].
    pub fn hash_on<D: Device>(
        self,
        device: &mut D,
        scene: &Scene,
        (width, height): (u32, u32),
    ) -> Result<String> {
        let Self { samples, rasteriser, tile, shading, kernel } = self;
        let frame =
            FrameOptions { width, height, samples, rasteriser, tile, shading, ..FrameOptions::default() };
        let options =
            RenderOptions { frame, filter: Filter::of(kernel), film: true, ..RenderOptions::default() };
        let rendering = render_on(device, String::new(), scene, &options, |_| {})?;
        let pixels = rendering.film.map(|film| film.pixels).unwrap_or_default();
        Ok(blake3::hash(bytemuck::cast_slice(&pixels)).to_hex().to_string())
    }
}
