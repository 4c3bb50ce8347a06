//! A device that takes note of every surface that is drawn, in whatever order.

use micropoly_core::abi::{Control, Draw, Layout, Shared};
use micropoly_core::backend::Device;
use micropoly_core::stage::{Extent, Items, Stage};

/// Passes everything on to a device; before a draw it reads what is to be drawn.
pub(crate) struct Witness<'a, D> {
    device: &'a mut D,
    /// Sum of the hashes of all draws: the same for the same set, whoever comes first.
    sum: u128,
}

impl<'a, D: Device> Witness<'a, D> {
    pub(crate) fn new(device: &'a mut D) -> Self {
        Self { device, sum: 0 }
    }

    /// Stands for the set of all that was drawn.
    pub(crate) fn drawn_set(&self) -> String {
        format!("{:032x}", self.sum)
    }

    fn note(&mut self, control: &D::Buffer, draws: &D::Buffer) -> Result<(), D::Error> {
        let mut counts = [Control::default()];
        self.device.read(control, 0, &mut counts)?;
        let [Control { waiting, fresh, .. }] = counts;
        let mut all = vec![Draw::default(); (waiting + fresh) as usize];
        self.device.read(draws, 0, &mut all)?;
        self.sum = all.iter().fold(self.sum, |sum, draw| sum.wrapping_add(hash(draw)));
        Ok(())
    }
}

fn hash(draw: &Draw) -> u128 {
    let bytes = *blake3::hash(bytemuck::bytes_of(draw)).as_bytes();
    bytes[..16].iter().fold(0, |word, byte| word << 8 | u128::from(*byte))
}

impl<D: Device> Device for Witness<'_, D> {
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
        self.device.clear(buffer)
    }

    fn dispatch(&mut self, stage: Stage, items: Items, buffers: &[&D::Buffer]) -> Result<(), D::Error> {
        if matches!(stage, Stage::Draw | Stage::SortLast) {
            self.note(buffers[3], buffers[4])?;
        }
        self.device.dispatch(stage, items, buffers)
    }
}
