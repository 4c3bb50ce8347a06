//! The canvas: pixels of all parts of an image, as they come.

use std::time::Instant;

use glam::Vec3;
use micropoly_core::abi::Pixel;
use micropoly_core::backend::Device;
use micropoly_core::camera::FrameOptions;
use micropoly_core::kernel::displace::normal_at;
use micropoly_core::pattern::Window;
use rayon::prelude::*;

use crate::error::Result;
use crate::film::Film;
use crate::image::{Encoder, Image};
use crate::render::Subject;

/// Rows that are read from the device and encoded at once.
const ROWS: usize = 16;

/// Pixels, encoded as they come, and as they are if somebody wants them.
pub(crate) struct Canvas {
    window: Window,
    encoder: Encoder,
    background: Vec3,
    rgb: Vec<u8>,
    pixels: Vec<Pixel>,
    /// Time that reading and encoding took.
    pub(crate) seconds: f64,
}

impl Canvas {
    /// For these pixels of an image.
    pub(crate) fn new(window: Window, background: Vec3, keeps: bool) -> Self {
        let count = window.pixels() as usize;
        let pixels = if keeps { vec![Pixel::default(); count] } else { Vec::new() };
        let encoder = Encoder::new(background);
        Self { window, encoder, background, rgb: vec![0; 3 * count], pixels, seconds: 0.0 }
    }

    /// Takes the pixels of a part.
    pub(crate) fn take<D: Device>(
        &mut self,
        device: &mut D,
        buffer: &D::Buffer,
        part: Window,
    ) -> std::result::Result<(), D::Error> {
        let start = Instant::now();
        let wide = part.width() as usize;
        let mut block = vec![Pixel::default(); wide * ROWS.min(part.height() as usize)];
        let first = (part.left - self.window.left) as usize;
        for top in (part.top..part.bottom).step_by(ROWS) {
            let rows = ROWS.min((part.bottom - top) as usize);
            let block = &mut block[..rows * wide];
            device.read(buffer, u64::from(top - part.top) * wide as u64, block)?;
            for (row, pixels) in block.chunks_exact(wide).enumerate() {
                let row = (top - self.window.top) as usize + row;
                self.put(row * self.window.width() as usize + first, pixels);
            }
        }
        self.seconds += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Takes pixels of a row, from one of the canvas on.
    fn put(&mut self, at: usize, pixels: &[Pixel]) {
        self.encoder.encode_row(pixels, &mut self.rgb[3 * at..]);
        if let Some(kept) = self.pixels.get_mut(at..at + pixels.len()) {
            kept.copy_from_slice(pixels);
        }
    }

    /// What it shows as linear values; normals are those of the moment when the shutter opens, seen through the middle of
    /// the lens.
    ///
    /// # Errors
    /// As [`crate::Shot::view`].
    pub(crate) fn film(&mut self, subject: Subject<'_>, options: &FrameOptions) -> Result<Film> {
        let Subject { scene, shot, patches } = subject;
        let camera = shot.camera(scene, shot.time)?;
        let (frame, objects) = scene.view(&camera, shot.time, options)?;
        let to_world = camera.view.matrix3.transpose();
        let normal = |pixel: &Pixel| {
            if pixel.depth == 0 {
                return [0.0; 3];
            }
            let normal = normal_at(&frame, &objects, patches, pixel.patch_id, pixel.u, pixel.v);
            (to_world * Vec3::from(normal).as_dvec3()).as_vec3().to_array()
        };
        let pixels = std::mem::take(&mut self.pixels);
        let normals = pixels.par_iter().map(normal).collect();
        let size = (options.width, options.height);
        Ok(Film { window: self.window, size, background: self.background, pixels, normals })
    }

    /// What it shows.
    pub(crate) fn image(self) -> Image {
        Image { width: self.window.width(), height: self.window.height(), rgb: self.rgb }
    }
}
