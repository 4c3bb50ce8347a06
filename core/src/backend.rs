//! What a backend must bring: buffers, and the stages run over them.
//!
//! A plan (`render.rs`, `schedule/`) exists once and knows no backend; a backend knows the stages of
//! [`crate::stage`] and no plan.

use crate::abi::{Layout, Shared};
use crate::error::PlanError;
use crate::stage::{Extent, Items, Stage};

/// A device that can run the stages.
pub trait Device {
    /// A block of entries of one layout, in the device's memory.
    type Buffer;
    /// What can go wrong on the device. The source of an error that a plan made is that [`PlanError`].
    type Error: core::error::Error + From<PlanError>;

    /// Reserves `entries` entries, all bits zero.
    ///
    /// # Errors
    /// When the device has not got the memory.
    fn allocate(
        &mut self,
        name: &'static str,
        layout: Layout,
        entries: u64,
    ) -> Result<Self::Buffer, Self::Error>;

    /// Bytes reserved by [`Device::allocate`] and not yet freed.
    fn bytes_allocated(&self) -> u64;

    /// Largest buffer of entries of this layout that [`Device::allocate`] can reserve, in bytes.
    fn max_buffer_bytes(&self, _layout: Layout) -> u64 {
        u64::MAX
    }

    /// Bytes that the device needs for itself, beside the plan's buffers, to draw a frame.
    fn own_bytes(&self, _extent: Extent) -> u64 {
        0
    }

    /// From now on takes the time of each step of drawing, if the device can.
    fn time_steps(&mut self) {}

    /// Tells name and milliseconds, of all threads together, of each step of drawing since this was last asked; nothing
    /// unless [`Device::time_steps`] was called on a device that can.
    fn tell_steps(&mut self, _tell: &mut dyn FnMut(&'static str, f64)) {}

    /// Copies `data` to the start of a buffer.
    ///
    /// # Errors
    /// When the buffer is too small or has another layout, or the transfer fails.
    fn write<T: Shared>(&mut self, buffer: &Self::Buffer, data: &[T]) -> Result<(), Self::Error>;

    /// Copies entries from `first` on out of a buffer, after all stages dispatched so far.
    ///
    /// # Errors
    /// When the buffer is too small or has another layout, or the device failed.
    fn read<T: Shared>(
        &mut self,
        buffer: &Self::Buffer,
        first: u64,
        out: &mut [T],
    ) -> Result<(), Self::Error>;

    /// Copies the first `entries` entries of one buffer to another of the same layout, after all stages
    /// dispatched so far.
    ///
    /// # Errors
    /// When a buffer is too small or the layouts differ, or the device failed.
    fn copy(&mut self, from: &Self::Buffer, to: &Self::Buffer, entries: u64) -> Result<(), Self::Error>;

    /// Sets all bits of a buffer to zero, after all stages dispatched so far.
    ///
    /// # Errors
    /// When the device failed.
    fn clear(&mut self, buffer: &Self::Buffer) -> Result<(), Self::Error>;

    /// Runs a stage over its buffers, given in the order of [`Stage::bindings`], after all stages
    /// dispatched before it.
    ///
    /// # Errors
    /// When the buffers do not match the stage, or the device failed.
    fn dispatch(&mut self, stage: Stage, items: Items, buffers: &[&Self::Buffer]) -> Result<(), Self::Error>;
}
