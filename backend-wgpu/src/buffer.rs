//! A block of device memory with a layout.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use micropoly_core::abi::{
    FLAG_FLAT, FLAG_INSTANCES, FLAG_WEBER, FLAG_WHOLE, Frame, Layout, Object, Patch, Shared,
};

use crate::error::WgpuError;

/// What of a frame only the kernels for any patch and profile know.
const GENERAL: u32 = FLAG_WEBER | FLAG_WHOLE | FLAG_FLAT | FLAG_INSTANCES;

/// Entries of one layout in the device's memory.
#[derive(Debug)]
pub struct WgpuBuffer {
    name: &'static str,
    layout: Layout,
    entries: u64,
    memory: wgpu::Buffer,
    /// Patches have a second piece, for those that the first has no room for.
    more: Option<wgpu::Buffer>,
    /// Was anything ever written to it that only the kernels for any patch and profile know?
    is_general: AtomicBool,
    allocated: Arc<AtomicU64>,
}

impl WgpuBuffer {
    /// Takes over `memory`, which is zeroed, and adds the size of its entries to `allocated`.
    pub(crate) fn new(
        name: &'static str,
        layout: Layout,
        entries: u64,
        (memory, more): (wgpu::Buffer, Option<wgpu::Buffer>),
        allocated: &Arc<AtomicU64>,
    ) -> Self {
        allocated.fetch_add(entries * layout.size as u64, Ordering::Relaxed);
        let (is_general, allocated) = (AtomicBool::new(false), Arc::clone(allocated));
        Self { name, layout, entries, memory, more, is_general, allocated }
    }

    /// Number of its entries.
    pub(crate) fn entries(&self) -> u64 {
        self.entries
    }

    /// Takes note of what is written.
    pub(crate) fn note<T: Shared>(&self, data: &[T]) {
        let is_general = if T::LAYOUT == Patch::LAYOUT {
            bytemuck::cast_slice::<T, Patch>(data).iter().any(|patch| patch.faces > 0 || patch.kind > 0)
        } else if T::LAYOUT == Object::LAYOUT {
            bytemuck::cast_slice::<T, Object>(data).iter().any(|object| object.reach > 0.0)
        } else if T::LAYOUT == Frame::LAYOUT {
            bytemuck::cast_slice::<T, Frame>(data).iter().any(|frame| frame.flags & GENERAL != 0)
        } else {
            false
        };
        self.is_general.fetch_or(is_general, Ordering::Relaxed);
    }

    /// Does it need the kernels for any patch and profile?
    pub(crate) fn is_general(&self) -> bool {
        self.is_general.load(Ordering::Relaxed)
    }

    /// Its second piece.
    pub(crate) fn more(&self) -> Option<&wgpu::Buffer> {
        self.more.as_ref()
    }

    /// The piece that has the byte at `offset`, the offset within it, and how many bytes it has from there on.
    pub(crate) fn piece(&self, offset: u64) -> (&wgpu::Buffer, u64, u64) {
        match &self.more {
            Some(more) if offset >= self.memory.size() => {
                let within = offset - self.memory.size();
                (more, within, more.size() - within)
            }
            _ => (&self.memory, offset, self.memory.size() - offset),
        }
    }

    /// The memory itself, for the caller's own commands on [`crate::WgpuDevice::device`]: its entries lie one after
    /// the other as their layout says, from the start on. Besides what stages need, it can be copied, and bound as
    /// vertices and as indices.
    ///
    /// Stages that were dispatched must be submitted first: [`crate::WgpuDevice::submit`]. Patches that do not fit one
    /// buffer continue in another, which is not this one.
    #[must_use]
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.memory
    }

    /// The memory itself.
    pub(crate) fn memory(&self) -> &wgpu::Buffer {
        &self.memory
    }

    /// Does it hold entries of this layout?
    pub(crate) fn check_layout(&self, layout: Layout) -> Result<(), WgpuError> {
        if layout == self.layout {
            return Ok(());
        }
        Err(WgpuError::Mismatch { buffer: self.name, wanted: layout.name })
    }

    /// Bytes of the first `entries` entries of another buffer, if they go here; pieces cannot be copied.
    pub(crate) fn bytes_from(&self, from: &Self, entries: u64) -> Result<u64, WgpuError> {
        let fits = entries <= self.entries.min(from.entries);
        if from.layout == self.layout && fits && self.more.is_none() {
            return Ok(entries * self.layout.size as u64);
        }
        Err(WgpuError::Mismatch { buffer: self.name, wanted: from.layout.name })
    }

    /// Offset in bytes of `count` entries from `first` on, if it has them.
    pub(crate) fn offset_of<T: Shared>(&self, first: u64, count: usize) -> Result<u64, WgpuError> {
        self.check_layout(T::LAYOUT)?;
        if first.saturating_add(count as u64) <= self.entries {
            return Ok(first * size_of::<T>() as u64);
        }
        Err(WgpuError::Mismatch { buffer: self.name, wanted: T::LAYOUT.name })
    }
}

impl Drop for WgpuBuffer {
    fn drop(&mut self) {
        self.allocated.fetch_sub(self.entries * self.layout.size as u64, Ordering::Relaxed);
    }
}
