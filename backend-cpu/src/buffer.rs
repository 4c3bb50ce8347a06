//! A block of memory with a layout; which stage may write it is checked when it is borrowed.

use std::cell::{Ref, RefCell, RefMut};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use micropoly_core::abi::{Layout, Shared};

use rayon::prelude::*;

use crate::device::CpuError;

/// Blocks that one thread clears at a time.
const CLEAR_CHUNK: usize = 1 << 14;

/// Bytes that something of the device's own holds, as the device counts them; they only ever rise.
#[derive(Debug)]
pub(crate) struct Claim {
    bytes: u64,
    allocated: Arc<AtomicU64>,
}

impl Claim {
    pub(crate) fn new(allocated: &Arc<AtomicU64>) -> Self {
        Self { bytes: 0, allocated: Arc::clone(allocated) }
    }

    /// Claims so many bytes, unless they are claimed already.
    pub(crate) fn raise_to(&mut self, bytes: u64) {
        if bytes > self.bytes {
            self.allocated.fetch_add(bytes - self.bytes, Ordering::Relaxed);
            self.bytes = bytes;
        }
    }
}

/// Storage unit: keeps every entry aligned.
type Block = [u32; 4];

/// Entries of one layout in main memory.
#[derive(Debug)]
pub struct CpuBuffer {
    name: &'static str,
    layout: Layout,
    entries: usize,
    blocks: RefCell<Box<[Block]>>,
    bytes: u64,
    allocated: Arc<AtomicU64>,
}

impl CpuBuffer {
    /// Reserves zeroed memory and adds its size to `allocated`.
    pub(crate) fn new(
        name: &'static str,
        layout: Layout,
        entries: u64,
        allocated: &Arc<AtomicU64>,
    ) -> Result<Self, CpuError> {
        let bytes = entries.saturating_mul(layout.size as u64);
        let out_of_memory = || CpuError::OutOfMemory { name, bytes };
        let blocks =
            usize::try_from(bytes.div_ceil(size_of::<Block>() as u64)).map_err(|_| out_of_memory())?;
        // Zeroed by the operating system, page by page, when first used.
        let blocks = bytemuck::allocation::try_zeroed_slice_box(blocks).map_err(|()| out_of_memory())?;
        allocated.fetch_add(bytes, Ordering::Relaxed);
        Ok(Self {
            name,
            layout,
            entries: entries as usize,
            blocks: RefCell::new(blocks),
            bytes,
            allocated: Arc::clone(allocated),
        })
    }

    /// Name given when it was reserved.
    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// Layout of its entries.
    pub(crate) fn layout(&self) -> Layout {
        self.layout
    }

    fn check<T: Shared>(&self, entries: usize) -> Result<(), CpuError> {
        if T::LAYOUT == self.layout && entries <= self.entries {
            return Ok(());
        }
        Err(CpuError::Mismatch { buffer: self.name, wanted: T::LAYOUT.name })
    }

    /// The entries, to be read.
    pub(crate) fn view<T: Shared>(&self) -> Result<Ref<'_, [T]>, CpuError> {
        self.check::<T>(0)?;
        let blocks = self.blocks.try_borrow().map_err(|_| CpuError::InUse { buffer: self.name })?;
        let bytes = self.entries * size_of::<T>();
        Ok(Ref::map(blocks, |b| bytemuck::cast_slice(&bytemuck::cast_slice::<_, u8>(b)[..bytes])))
    }

    /// The entries, to be written.
    pub(crate) fn view_mut<T: Shared>(&self) -> Result<RefMut<'_, [T]>, CpuError> {
        self.check::<T>(0)?;
        let blocks = self.blocks.try_borrow_mut().map_err(|_| CpuError::InUse { buffer: self.name })?;
        let bytes = self.entries * size_of::<T>();
        Ok(RefMut::map(blocks, |b| {
            bytemuck::cast_slice_mut(&mut bytemuck::cast_slice_mut::<_, u8>(b)[..bytes])
        }))
    }

    /// Copies `data` to the start.
    pub(crate) fn write<T: Shared>(&self, data: &[T]) -> Result<(), CpuError> {
        self.check::<T>(data.len())?;
        self.view_mut::<T>()?[..data.len()].copy_from_slice(data);
        Ok(())
    }

    /// Copies the first `entries` entries of another buffer.
    pub(crate) fn copy(&self, from: &Self, entries: u64) -> Result<(), CpuError> {
        let bytes = entries.saturating_mul(self.layout.size as u64);
        if from.layout != self.layout || bytes > self.bytes.min(from.bytes) {
            return Err(CpuError::Mismatch { buffer: self.name, wanted: from.layout.name });
        }
        let source = from.blocks.try_borrow().map_err(|_| CpuError::InUse { buffer: from.name })?;
        let mut target = self.blocks.try_borrow_mut().map_err(|_| CpuError::InUse { buffer: self.name })?;
        let bytes = bytes as usize;
        let source: &[u8] = bytemuck::cast_slice(&source);
        bytemuck::cast_slice_mut::<_, u8>(&mut target)[..bytes].copy_from_slice(&source[..bytes]);
        Ok(())
    }

    /// Sets all bits to zero.
    pub(crate) fn clear(&self, pool: &rayon::ThreadPool) -> Result<(), CpuError> {
        let mut blocks = self.blocks.try_borrow_mut().map_err(|_| CpuError::InUse { buffer: self.name })?;
        let blocks: &mut [Block] = &mut blocks;
        pool.install(|| blocks.par_chunks_mut(CLEAR_CHUNK).for_each(|chunk| chunk.fill([0; 4])));
        Ok(())
    }

    /// Copies entries from `first` on to `out`.
    pub(crate) fn read<T: Shared>(&self, first: u64, out: &mut [T]) -> Result<(), CpuError> {
        let first = usize::try_from(first).unwrap_or(usize::MAX);
        self.check::<T>(first.saturating_add(out.len()))?;
        out.copy_from_slice(&self.view::<T>()?[first..first + out.len()]);
        Ok(())
    }
}

impl Drop for CpuBuffer {
    fn drop(&mut self) {
        self.allocated.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}
