//! A GPU as a device: stages are recorded and submitted when their results are needed.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

use micropoly_core::abi::{Layout, Shared};
use micropoly_core::backend::Device;
use micropoly_core::known;
use micropoly_core::stage::{Items, Stage};

use crate::buffer::WgpuBuffer;
use crate::error::WgpuError;
use crate::info::{adapters, describe, instance};
use crate::kernels::{self, Edit, Kernel};

/// Items that one group works on, in stages that have an item an invocation.
const ITEMS_A_GROUP: u32 = 64;
/// Most groups a dimension; more are spread over two.
const MOST_GROUPS: u32 = 65535;
/// Dispatches after which they are submitted although nobody waits for them.
const MOST_PENDING: u32 = 256;
/// Pixels a side of the tile that one group draws.
const TILE: u32 = 16;
/// How a GPU draws: all at once.
const ON_GPU: Rounds = Rounds { enough: 128, budget: u32::MAX };
/// How llvmpipe draws: in rounds of a hundred or so draws a tile, far from its limit of 65535 loop iterations
/// a dispatch (see `draw.wgsl`).
const ON_CPU: Rounds = Rounds { enough: 64, budget: 1 };
/// Place in `rounds.wgsl` of the mark that says that a loop was cut, and of what each draw starts anew.
const TRUNCATED: u64 = 8;
const RESTARTED: u64 = 12;
const PROGRESS: u64 = 20;
/// Largest piece that is read back at once, in bytes.
const STAGING_BYTES: u64 = 4 << 20;
const LOOPS_CUT: &str = "its driver ended a loop early (Mesa's llvmpipe does after 65535 iterations), so the image \
    is incomplete; use smaller micropolygons, the CPU or another driver";

/// A GPU whose arithmetic has been found exact.
#[derive(Debug)]
pub struct WgpuDevice {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    kernels: [Kernel; Stage::ALL.len()],
    arrange: Kernel,
    arrange_draw: Kernel,
    /// How the fused stage runs.
    rounds: Rounds,
    /// The same, and how far it is, on the device: as `Rounds` in `rounds.wgsl`.
    progress: wgpu::Buffer,
    /// Number of groups of an indirect dispatch.
    groups: wgpu::Buffer,
    staging: wgpu::Buffer,
    encoder: Option<wgpu::CommandEncoder>,
    pending: u32,
    failure: Arc<Mutex<Option<String>>>,
    allocated: Arc<AtomicU64>,
}

impl WgpuDevice {
    /// Opens device number `index` of [`crate::devices`], compiles all kernels and checks its arithmetic.
    ///
    /// `edit` may change each kernel file before it is compiled: for mutation tests.
    ///
    /// # Errors
    /// When there is no such device, it refuses, a kernel does not compile, or an operation is not exact.
    pub fn open(index: usize, edit: Option<Edit<'_>>) -> Result<Self, WgpuError> {
        let mut device = Self::open_unchecked(index, edit)?;
        match known::check(&mut device)? {
            None => Ok(device),
            Some(mismatch) => Err(WgpuError::Inexact { device: device.name, mismatch }),
        }
    }

    /// The same for tests, without a check of its arithmetic.
    ///
    /// # Errors
    /// When there is no such device, it refuses, or a kernel does not compile.
    pub fn open_unchecked(index: usize, edit: Option<Edit<'_>>) -> Result<Self, WgpuError> {
        let adapters = adapters(&instance());
        let adapter = adapters.get(index).ok_or(WgpuError::NoDevice { index, found: adapters.len() })?;
        Self::with_kernels(adapter, edit)
    }

    fn with_kernels(adapter: &wgpu::Adapter, edit: Option<Edit<'_>>) -> Result<Self, WgpuError> {
        let name = describe(adapter).name;
        let software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        let rounds = if software { ON_CPU } else { ON_GPU };
        let (device, queue) = request(adapter, &name)?;
        let failure = Arc::default();
        listen(&device, &failure);
        let kernels: Result<Vec<Kernel>, WgpuError> =
            Stage::ALL.into_iter().map(|stage| kernels::stage(&device, stage, edit)).collect();
        let usage = wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::STORAGE;
        let read = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        Ok(Self {
            name,
            kernels: kernels?.try_into().unwrap_or_else(|_| unreachable!("a kernel a stage")),
            arrange: kernels::arrange(&device, edit)?,
            arrange_draw: kernels::arrange_draw(&device, edit)?,
            progress: progress(&device, &queue, rounds, 1),
            rounds,
            groups: memory(&device, "groups", 12, usage),
            staging: memory(&device, "staging", STAGING_BYTES + 4, read),
            device,
            queue,
            encoder: None,
            pending: 0,
            failure,
            allocated: Arc::default(),
        })
    }

    /// What the device is called in reports.
    #[must_use]
    pub fn name(&self) -> String {
        self.name.clone()
    }

    /// Submits all dispatches recorded so far.
    fn submit(&mut self) {
        if let Some(encoder) = self.encoder.take() {
            self.queue.submit([encoder.finish()]);
        }
        self.pending = 0;
    }

    /// The first failure since the device was opened.
    fn checked(&self) -> Result<(), WgpuError> {
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        failure.as_ref().map_or(Ok(()), |reason| Err(WgpuError::Failed(reason.clone())))
    }

    /// Copies `out.len()` bytes of `from` at `offset` to the host; at most [`STAGING_BYTES`].
    fn read_piece(&mut self, from: &wgpu::Buffer, offset: u64, out: &mut [u8]) -> Result<(), WgpuError> {
        let bytes = out.len() as u64;
        let (staging, progress) = (self.staging.clone(), self.progress.clone());
        self.encoder().copy_buffer_to_buffer(from, offset, &staging, 0, bytes);
        self.encoder().copy_buffer_to_buffer(&progress, TRUNCATED, &staging, STAGING_BYTES, 4);
        self.submit();
        let (done, answer) = mpsc::channel();
        self.staging.map_async(wgpu::MapMode::Read, .., move |result| {
            let _ = done.send(result); // nobody listens only when polling failed
        });
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(failed)?;
        self.checked()?;
        answer.recv().map_err(failed)?.map_err(failed)?;
        out.copy_from_slice(&self.staging.get_mapped_range(..bytes).map_err(failed)?);
        let cut = self.staging.get_mapped_range(STAGING_BYTES..).map_err(failed)?.iter().any(|&b| b != 0);
        self.staging.unmap();
        if cut {
            return Err(failed(LOOPS_CUT));
        }
        Ok(())
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        let device = &self.device;
        self.encoder.get_or_insert_with(|| device.create_command_encoder(&Default::default()))
    }

    /// Records one kernel.
    fn record(&mut self, which: Which, buffers: &[&wgpu::Buffer], groups: Groups) {
        let kernel = match which {
            Which::Stage(stage) => &self.kernels[stage as usize],
            Which::Arrange => &self.arrange,
            Which::ArrangeDraw => &self.arrange_draw,
        };
        let bind_group = bind(&self.device, kernel, buffers);
        let device = &self.device;
        let encoder = self.encoder.get_or_insert_with(|| device.create_command_encoder(&Default::default()));
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        match groups {
            Groups::Known(columns, rows) => pass.dispatch_workgroups(columns, rows, 1),
            Groups::Arranged => pass.dispatch_workgroups_indirect(&self.groups, 0),
        }
        drop(pass);
        self.pending += 1;
    }

    /// Records the fused stage in as many rounds as it can need; those that it does not have no groups.
    fn draw(&mut self, buffers: &[&wgpu::Buffer], room: u64, (width, height): (u32, u32)) {
        let tiles = u64::from(width.div_ceil(TILE)) * u64::from(height.div_ceil(TILE));
        if self.progress.size() < PROGRESS + 4 * tiles {
            self.progress = progress(&self.device, &self.queue, self.rounds, tiles);
        }
        let (progress, groups) = (self.progress.clone(), self.groups.clone());
        self.encoder().clear_buffer(&progress, RESTARTED, None);
        let drawn: Vec<_> = buffers.iter().copied().chain([&progress]).collect();
        for _ in 0..self.rounds.most(room) {
            self.record(Which::ArrangeDraw, &[buffers[0], &progress, &groups], Groups::Known(1, 1));
            self.record(Which::Stage(Stage::Draw), &drawn, Groups::Arranged);
        }
    }

    /// Number of groups of a stage; arranges them on the device if only it knows them.
    fn groups(&mut self, stage: Stage, items: Items, buffers: &[&WgpuBuffer]) -> Result<Groups, WgpuError> {
        match (stage, items) {
            (Stage::Take | Stage::Flush, _) | (Stage::Scan, Items::Taken) => Ok(Groups::Known(1, 1)),
            (Stage::Seed | Stage::KnownAnswers, Items::Count(count)) => Ok(spread(count)),
            (Stage::Bound | Stage::Split, Items::Taken) => {
                let place = stage.bindings().iter().position(|binding| binding.name == "control");
                let control = place.ok_or(WgpuError::Bindings { stage: stage.name() })?;
                let groups = self.groups.clone();
                self.record(Which::Arrange, &[buffers[control].memory(), &groups], Groups::Known(1, 1));
                Ok(Groups::Arranged)
            }
            _ => Err(WgpuError::Bindings { stage: stage.name() }),
        }
    }
}

/// How the fused stage is cut into rounds; see `rounds.wgsl`.
#[derive(Clone, Copy, Debug)]
struct Rounds {
    enough: u32,
    budget: u32,
}

impl Rounds {
    /// Most rounds for `room` draws: each but the last draws more than `enough`, all of them within the budget.
    fn most(self, room: u64) -> u64 {
        if self.budget == u32::MAX { 1 } else { room.div_ceil(u64::from(self.enough)) }
    }
}

/// A kernel of the device.
enum Which {
    Stage(Stage),
    Arrange,
    ArrangeDraw,
}

/// How many groups run.
enum Groups {
    /// So many columns and rows of groups.
    Known(u32, u32),
    /// What the arranging kernel wrote.
    Arranged,
}

/// Groups for `count` items; mirrors `arrange.wgsl`.
fn spread(count: u32) -> Groups {
    let groups = count.div_ceil(ITEMS_A_GROUP);
    Groups::Known(groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS))
}

fn failed(error: impl ToString) -> WgpuError {
    WgpuError::Failed(error.to_string())
}

/// Opens an adapter with the limits that every WebGPU device has.
fn request(adapter: &wgpu::Adapter, name: &str) -> Result<(wgpu::Device, wgpu::Queue), WgpuError> {
    let defaults = wgpu::Limits::defaults();
    let required_limits = wgpu::Limits {
        max_storage_buffers_per_shader_stage: defaults.max_storage_buffers_per_shader_stage,
        max_compute_workgroup_storage_size: defaults.max_compute_workgroup_storage_size,
        ..wgpu::Limits::downlevel_defaults()
    };
    let wanted = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    pollster::block_on(adapter.request_device(&wanted))
        .map_err(|error| WgpuError::Refused { device: name.to_owned(), reason: error.to_string() })
}

/// Keeps the first error that nobody else catches, so that it becomes an `Err` rather than a panic.
fn listen(device: &wgpu::Device, failure: &Arc<Mutex<Option<String>>>) {
    let keep = |failure: &Mutex<Option<String>>, reason: String| {
        failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(reason);
    };
    let (errors, loss) = (Arc::clone(failure), Arc::clone(failure));
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| keep(&errors, error.to_string())));
    device.set_device_lost_callback(move |why, text| {
        if why != wgpu::DeviceLostReason::Destroyed {
            keep(&loss, format!("device lost: {text}"));
        }
    });
}

fn memory(device: &wgpu::Device, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let label = Some(label);
    device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
}

/// The state of the fused stage for `tiles` tiles.
fn progress(device: &wgpu::Device, queue: &wgpu::Queue, rounds: Rounds, tiles: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    let progress = memory(device, "progress", PROGRESS + 4 * tiles, usage);
    queue.write_buffer(&progress, 0, bytemuck::cast_slice(&[rounds.enough, rounds.budget]));
    progress
}

fn bind(device: &wgpu::Device, kernel: &Kernel, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .enumerate()
        .map(|(place, buffer)| wgpu::BindGroupEntry {
            binding: place as u32,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let (label, layout) = (None, &kernel.bindings);
    device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &entries })
}

impl Device for WgpuDevice {
    type Buffer = WgpuBuffer;
    type Error = WgpuError;

    fn allocate(
        &mut self,
        name: &'static str,
        layout: Layout,
        entries: u64,
    ) -> Result<WgpuBuffer, WgpuError> {
        let bytes = entries.max(1).saturating_mul(layout.size as u64);
        let limits = self.device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if bytes > limit {
            return Err(WgpuError::TooLarge { buffer: name, bytes, limit });
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let errors = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let memory = memory(&self.device, name, bytes, usage);
        if pollster::block_on(errors.pop()).is_some() {
            return Err(WgpuError::OutOfMemory { buffer: name, bytes });
        }
        Ok(WgpuBuffer::new(name, layout, entries, memory, &self.allocated))
    }

    fn bytes_allocated(&self) -> u64 {
        self.allocated.load(Ordering::Relaxed)
    }

    fn write<T: Shared>(&mut self, buffer: &WgpuBuffer, data: &[T]) -> Result<(), WgpuError> {
        let offset = buffer.offset_of::<T>(0, data.len())?;
        self.submit(); // what was dispatched before must not see the new data
        self.queue.write_buffer(buffer.memory(), offset, bytemuck::cast_slice(data));
        self.checked()
    }

    fn read<T: Shared>(&mut self, buffer: &WgpuBuffer, first: u64, out: &mut [T]) -> Result<(), WgpuError> {
        let mut offset = buffer.offset_of::<T>(first, out.len())?;
        for piece in bytemuck::cast_slice_mut::<T, u8>(out).chunks_mut(STAGING_BYTES as usize) {
            self.read_piece(buffer.memory(), offset, piece)?;
            offset += piece.len() as u64;
        }
        self.checked()
    }

    fn dispatch(&mut self, stage: Stage, items: Items, buffers: &[&WgpuBuffer]) -> Result<(), WgpuError> {
        let bindings = stage.bindings();
        if bindings.len() != buffers.len() {
            return Err(WgpuError::Bindings { stage: stage.name() });
        }
        for (binding, buffer) in bindings.iter().zip(buffers) {
            buffer.check_layout(binding.layout)?;
        }
        let memories: Vec<_> = buffers.iter().map(|buffer| buffer.memory()).collect();
        if let (Stage::Draw, Items::Image { width, height }) = (stage, items) {
            self.draw(&memories, buffers[4].entries(), (width, height));
            return self.checked();
        }
        let groups = self.groups(stage, items, buffers)?;
        self.record(Which::Stage(stage), &memories, groups);
        if self.pending >= MOST_PENDING {
            self.submit();
        }
        self.checked()
    }
}
