//! A device that takes the time of every stage.

use std::time::Instant;

use micropoly_core::abi::{Layout, Shared};
use micropoly_core::backend::Device;
use micropoly_core::stage::{Extent, Items, Stage};
use serde::Serialize;

/// Wall time by stage, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Reading the scene.
    pub load: f64,
    /// Opening the device, buffers and uploads.
    pub setup: f64,
    /// Finding out which patches are outside or hidden, and reading depths for it.
    pub cull: f64,
    /// Bounding surfaces.
    pub bound: f64,
    /// Taking batches, prefix sums, and moving surfaces to the stack and the draw buffer.
    pub split: f64,
    /// Dicing, shading and sampling, fused.
    pub draw: f64,
    /// From linear samples to pixels.
    pub resolve: f64,
    /// Compressing and writing the image file.
    pub encode: f64,
    /// All of it.
    pub total: f64,
}

/// Passes everything on to a device and adds up the time each stage takes.
pub(crate) struct Timed<'a, D> {
    device: &'a mut D,
    pub(crate) seconds: Seconds,
}

impl<'a, D> Timed<'a, D> {
    pub(crate) fn new(device: &'a mut D) -> Self {
        Self { device, seconds: Seconds::default() }
    }
}

impl<D: Device> Device for Timed<'_, D> {
    type Buffer = D::Buffer;
    type Error = D::Error;

    fn allocate(&mut self, name: &'static str, layout: Layout, entries: u64) -> Result<D::Buffer, D::Error> {
        self.device.allocate(name, layout, entries)
    }

    fn bytes_allocated(&self) -> u64 {
        self.device.bytes_allocated()
    }

    fn max_buffer_bytes(&self, layout: Layout) -> u64 {
        self.device.max_buffer_bytes(layout)
    }

    fn own_bytes(&self, extent: Extent) -> u64 {
        self.device.own_bytes(extent)
    }

    fn write<T: Shared>(&mut self, buffer: &D::Buffer, data: &[T]) -> Result<(), D::Error> {
        self.device.write(buffer, data)
    }

    fn read<T: Shared>(&mut self, buffer: &D::Buffer, first: u64, out: &mut [T]) -> Result<(), D::Error> {
        self.device.read(buffer, first, out)
    }

    fn copy(&mut self, from: &D::Buffer, to: &D::Buffer, entries: u64) -> Result<(), D::Error> {
        self.device.copy(from, to, entries)
    }

    fn clear(&mut self, buffer: &D::Buffer) -> Result<(), D::Error> {
        let start = Instant::now();
        let outcome = self.device.clear(buffer);
        self.seconds.draw += start.elapsed().as_secs_f64();
        outcome
    }

    fn dispatch(&mut self, stage: Stage, items: Items, buffers: &[&D::Buffer]) -> Result<(), D::Error> {
        let start = Instant::now();
        let outcome = self.device.dispatch(stage, items, buffers);
        let seconds = match stage {
            Stage::Bound | Stage::Local => &mut self.seconds.bound,
            Stage::Draw | Stage::SortLast | Stage::Blend => &mut self.seconds.draw,
            Stage::Filter => &mut self.seconds.resolve,
            _ => &mut self.seconds.split,
        };
        *seconds += start.elapsed().as_secs_f64();
        outcome
    }
}
