//! A block of device memory with a layout.
#![allow(unsafe_code)] // OpenCL's calls; sizes are checked before each of them

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use micropoly_core::abi::{Layout, Shared};
use opencl3::command_queue::CommandQueue;
use opencl3::context::Context;
use opencl3::memory::{Buffer, CL_MEM_READ_WRITE, ClMem};
use opencl3::types::{CL_BLOCKING, cl_mem};

use crate::error::{OclError, out_of_memory};

/// Entries of one layout in the device's memory.
#[derive(Debug)]
pub struct OclBuffer {
    name: &'static str,
    layout: Layout,
    entries: u64,
    memory: RefCell<Buffer<u8>>,
    bytes: u64,
    allocated: Arc<AtomicU64>,
}

impl OclBuffer {
    /// Reserves zeroed memory and adds its size to `allocated`. `limit`: most bytes in one piece.
    pub(crate) fn new(
        (context, queue): (&Context, &CommandQueue),
        (name, layout, entries): (&'static str, Layout, u64),
        limit: u64,
        allocated: &Arc<AtomicU64>,
    ) -> Result<Self, OclError> {
        let bytes = entries.saturating_mul(layout.size as u64);
        let refused = OclError::OutOfMemory { name, bytes, limit };
        let Ok(size) = usize::try_from(bytes.max(4)) else { return Err(refused) };
        if bytes > limit {
            return Err(refused);
        }
        let memory = zeroed(context, queue, size).map_err(|code| {
            if out_of_memory(&code) { refused } else { OclError::driver("reserving memory")(code) }
        })?;
        allocated.fetch_add(bytes, Ordering::Relaxed);
        let allocated = Arc::clone(allocated);
        Ok(Self { name, layout, entries, memory: RefCell::new(memory), bytes, allocated })
    }

    /// Name given when it was reserved.
    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// Layout of its entries.
    pub(crate) fn layout(&self) -> Layout {
        self.layout
    }

    /// Number of entries.
    pub(crate) fn entries(&self) -> u64 {
        self.entries
    }

    /// What kernels take.
    pub(crate) fn handle(&self) -> cl_mem {
        self.memory.borrow().get()
    }

    fn check<T: Shared>(&self, first: u64, entries: usize) -> Result<(), OclError> {
        if T::LAYOUT == self.layout && first.saturating_add(entries as u64) <= self.entries {
            return Ok(());
        }
        Err(OclError::Mismatch { buffer: self.name, wanted: T::LAYOUT.name })
    }

    /// Copies the first `entries` entries of another buffer.
    pub(crate) fn copy(&self, queue: &CommandQueue, from: &Self, entries: u64) -> Result<(), OclError> {
        if from.layout != self.layout || entries > self.entries.min(from.entries) {
            return Err(OclError::Mismatch { buffer: self.name, wanted: from.layout.name });
        }
        let bytes = entries as usize * self.layout.size;
        if bytes == 0 {
            return Ok(());
        }
        // SAFETY: both have so many bytes, and the queue keeps order.
        unsafe {
            queue.enqueue_copy_buffer(&from.memory.borrow(), &mut self.memory.borrow_mut(), 0, 0, bytes, &[])
        }
        .map_err(OclError::driver("copying a buffer"))?;
        Ok(())
    }

    /// Fills the first `entries` entries with a pattern, whose size is a power of two that divides theirs.
    pub(crate) fn fill<T: Shared>(
        &self,
        queue: &CommandQueue,
        pattern: T,
        entries: u64,
    ) -> Result<(), OclError> {
        let pattern = bytemuck::bytes_of(&pattern);
        let bytes = entries.min(self.entries) as usize * self.layout.size;
        if bytes == 0 {
            return Ok(());
        }
        // SAFETY: there are so many bytes, a multiple of the pattern's, and the queue keeps order.
        unsafe { queue.enqueue_fill_buffer(&mut self.memory.borrow_mut(), pattern, 0, bytes, &[]) }
            .map_err(OclError::driver("filling a buffer"))?;
        Ok(())
    }

    /// Copies `data` to the start.
    pub(crate) fn write<T: Shared>(&self, queue: &CommandQueue, data: &[T]) -> Result<(), OclError> {
        self.check::<T>(0, data.len())?;
        if data.is_empty() {
            return Ok(());
        }
        let mut memory = self.memory.borrow_mut();
        let bytes = bytemuck::cast_slice(data);
        // SAFETY: the bytes fit, and the call returns only when they have been copied.
        unsafe { queue.enqueue_write_buffer(&mut memory, CL_BLOCKING, 0, bytes, &[]) }
            .map_err(OclError::driver("writing a buffer"))?;
        Ok(())
    }

    /// Copies entries from `first` on to `out`.
    pub(crate) fn read<T: Shared>(
        &self,
        queue: &CommandQueue,
        first: u64,
        out: &mut [T],
    ) -> Result<(), OclError> {
        self.check::<T>(first, out.len())?;
        if out.is_empty() {
            return Ok(());
        }
        let offset = first as usize * self.layout.size;
        let bytes = bytemuck::cast_slice_mut(out);
        // SAFETY: the bytes are there, and the call returns only when they have been copied.
        unsafe { queue.enqueue_read_buffer(&self.memory.borrow(), CL_BLOCKING, offset, bytes, &[]) }
            .map_err(OclError::driver("reading a buffer"))?;
        Ok(())
    }
}

fn zeroed(context: &Context, queue: &CommandQueue, size: usize) -> opencl3::Result<Buffer<u8>> {
    // SAFETY: no host memory is passed; all sizes are multiples of 4; the queue keeps order.
    unsafe {
        let mut memory = Buffer::<u8>::create(context, CL_MEM_READ_WRITE, size, std::ptr::null_mut())?;
        queue.enqueue_fill_buffer(&mut memory, &[0_u8; 4], 0, size, &[])?;
        Ok(memory)
    }
}

impl Drop for OclBuffer {
    fn drop(&mut self) {
        self.allocated.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}
