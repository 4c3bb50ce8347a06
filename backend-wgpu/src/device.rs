//! A GPU as a device: stages are recorded and submitted when their results are needed.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

use micropoly_core::abi::{Draw, Layout, Patch, Shared};
use micropoly_core::backend::Device;
use micropoly_core::known;
use micropoly_core::stage::{Extent, Items, Stage};

use crate::buffer::WgpuBuffer;
use crate::chunk::{self, Chunk};
use crate::error::WgpuError;
use crate::info::{adapters, describe, instance};
use crate::kernels::{self, Edit, Kernel, Kind, Slot, Step, Which};

/// Storage buffers that a kernel binds at most, and bytes that a group of it shares: what WebGPU promises everywhere.
const STORAGE_BUFFERS: u32 = 8;
const GROUP_BYTES: u32 = 16384;
/// Items that one group works on, in stages that have an item an invocation.
const ITEMS_A_GROUP: u32 = 64;
/// Most groups a dimension; more are spread over two.
const MOST_GROUPS: u32 = 65535;
/// Dispatches after which they are submitted although nobody waits for them.
const MOST_PENDING: u32 = 256;
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
    /// As [`Which::ALL`].
    kernels: Vec<Slot>,
    /// Kernels with a part that is the caller's own, in the place of ours.
    own: Vec<(Which, Kernel)>,
    /// What the fused stages need for themselves.
    chunk: Chunk,
    /// Numbers of groups of indirect dispatches.
    groups: wgpu::Buffer,
    staging: wgpu::Buffer,
    encoder: Option<wgpu::CommandEncoder>,
    pending: u32,
    failure: Arc<Mutex<Option<String>>>,
    allocated: Arc<AtomicU64>,
    buffer_limit: u64,
}

impl WgpuDevice {
    /// Opens device number `index` of [`crate::devices`], compiles its kernels (those that few frames need when they are
    /// first needed) and checks its arithmetic.
    ///
    /// `edit` may change each kernel file before it is compiled: for mutation tests.
    ///
    /// # Errors
    /// When there is no such device, it refuses, a kernel does not compile, or an operation is not exact.
    pub fn open(index: usize, edit: Option<Edit<'_>>) -> Result<Self, WgpuError> {
        Self::open_unchecked(index, edit)?.if_exact()
    }

    /// The same for tests, without a check of its arithmetic.
    ///
    /// # Errors
    /// When there is no such device, it refuses, or a kernel does not compile.
    pub fn open_unchecked(index: usize, edit: Option<Edit<'_>>) -> Result<Self, WgpuError> {
        let adapters = adapters(&instance());
        let adapter = adapters.get(index).ok_or(WgpuError::NoDevice { index, found: adapters.len() })?;
        let (device, queue) = request(adapter, &describe(adapter).name)?;
        let failure = Arc::default();
        listen(&device, &failure);
        Self::with_kernels(device, queue, failure, edit)
    }

    /// Uses a device that the caller has opened, and goes on using, with any limits from WebGPU's defaults upward: so
    /// that meshes lie where the caller can draw them ([`WgpuDevice::submit`] first). Errors that wgpu finds go to the
    /// caller's own handlers.
    ///
    /// # Errors
    /// When its limits are too small, a kernel does not compile, or an operation is not exact.
    pub fn on(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, WgpuError> {
        let (name, limits) = (device.adapter_info().name, device.limits());
        for (limit, has, needed) in [
            (
                "max_storage_buffers_per_shader_stage",
                limits.max_storage_buffers_per_shader_stage,
                STORAGE_BUFFERS,
            ),
            ("max_compute_workgroup_storage_size", limits.max_compute_workgroup_storage_size, GROUP_BYTES),
        ] {
            if has < needed {
                let reason = format!("its {limit} is {has}; request it with {needed} or more");
                return Err(WgpuError::Refused { device: name, reason });
            }
        }
        Self::with_kernels(device, queue, Arc::default(), None)?.if_exact()
    }

    fn if_exact(mut self) -> Result<Self, WgpuError> {
        match known::check(&mut self)? {
            None => Ok(self),
            Some(mismatch) => Err(WgpuError::Inexact { device: self.name, mismatch }),
        }
    }

    fn with_kernels(
        device: wgpu::Device,
        queue: wgpu::Queue,
        failure: Arc<Mutex<Option<String>>>,
        edit: Option<Edit<'_>>,
    ) -> Result<Self, WgpuError> {
        let info = device.adapter_info();
        let (name, software) = (info.name, info.device_type == wgpu::DeviceType::Cpu);
        let kernels: Result<Vec<Slot>, WgpuError> =
            Which::ALL.into_iter().map(|which| kernels::prepared(&device, which, edit)).collect();
        let allocated = Arc::default();
        let usage = wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::STORAGE;
        let read = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        Ok(Self {
            name,
            kernels: kernels?,
            own: Vec::new(),
            chunk: Chunk::new(&device, &queue, software, &allocated),
            groups: memory(&device, "groups", 24, usage),
            staging: memory(&device, "staging", STAGING_BYTES + 4, read),
            device,
            queue,
            encoder: None,
            pending: 0,
            failure,
            allocated,
            buffer_limit: u64::MAX,
        })
    }

    /// Pretends that no more bytes can be bound at once. For tests.
    pub fn limit_buffers(&mut self, bytes: u64) {
        self.buffer_limit = bytes;
    }

    /// Largest piece of whole entries that can be bound, in bytes.
    fn piece_bytes(&self, layout: Layout) -> u64 {
        let limits = self.device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(self.buffer_limit);
        limit - limit % layout.size as u64
    }

    /// From now on the tessellator takes the levels of patches from the caller's own WGSL; from its own control again with
    /// `None`.
    ///
    /// It must define `fn levels_of(index: u32) -> TessLevels`, where `index` is the number of a patch. Where patches share
    /// an edge, it must have the same level in all of them. It can use `tess_frame`, `tess_patches[index]`, `levels[index]`,
    /// the structs and constants of `kernel/gen.wgsl`, all functions of the kernel's files, such as `built_in_levels(index)`,
    /// and functions and constants of its own. What it computes is as exact as it is written: with `add`, `sub`, `mul` and
    /// the like of `kernel/num.wgsl` it has the same bits on every device.
    ///
    /// # Errors
    /// [`WgpuError::Own`] if it does not compile; then nothing changes.
    pub fn control_tessellation(&mut self, own: Option<&str>) -> Result<(), WgpuError> {
        self.put_own(Step::Control, own)
    }

    /// From now on the tessellator's vertices are those of the caller's own WGSL; those of its own evaluation again with
    /// `None`.
    ///
    /// It must define `fn evaluated(index: u32, coordinates: vec3<u32>) -> TessVertex`, where `index` is the number of a patch
    /// and coordinates are in units of 2⁻¹⁶. It can use `tess_frame`, `tess_patches[index]`, `heights` and what
    /// [`WgpuDevice::control_tessellation`] tells of; `evaluate(index, coordinates)` is our own vertex.
    ///
    /// # Errors
    /// [`WgpuError::Own`] if it does not compile; then nothing changes.
    pub fn evaluate_tessellation(&mut self, own: Option<&str>) -> Result<(), WgpuError> {
        self.put_own(Step::Evaluation, own)
    }

    fn put_own(&mut self, step: Step, own: Option<&str>) -> Result<(), WgpuError> {
        let kernel = own.map(|own| kernels::with_own(&self.device, step, own)).transpose()?;
        self.own.retain(|(which, _)| *which != step.kernel());
        self.own.extend(kernel.map(|kernel| (step.kernel(), kernel)));
        Ok(())
    }

    /// What the device is called in reports.
    #[must_use]
    pub fn name(&self) -> String {
        self.name.clone()
    }

    /// The device of wgpu's, for the caller's own commands, such as drawing a mesh where it is.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Submits all dispatches recorded so far: what the caller submits to [`WgpuDevice::queue`] afterwards sees what
    /// they wrote.
    pub fn submit(&mut self) {
        if let Some(encoder) = self.encoder.take() {
            self.queue.submit([encoder.finish()]);
        }
        self.pending = 0;
    }

    /// Submits them if they have become many.
    fn submit_if_many(&mut self) -> Result<(), WgpuError> {
        if self.pending >= MOST_PENDING {
            self.submit();
        }
        self.checked()
    }

    /// The first failure since the device was opened.
    fn checked(&self) -> Result<(), WgpuError> {
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        failure.as_ref().map_or(Ok(()), |reason| Err(WgpuError::Failed(reason.clone())))
    }

    /// Copies `out.len()` bytes of `from` at `offset` to the host; at most [`STAGING_BYTES`].
    fn read_piece(&mut self, from: &wgpu::Buffer, offset: u64, out: &mut [u8]) -> Result<(), WgpuError> {
        let bytes = out.len() as u64;
        let (staging, rounds) = (self.staging.clone(), self.chunk.rounds.clone());
        self.encoder().copy_buffer_to_buffer(from, offset, &staging, 0, bytes);
        self.encoder().copy_buffer_to_buffer(&rounds, chunk::TRUNCATED, &staging, STAGING_BYTES, 4);
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

    /// A kernel, compiled now if it was not needed before.
    fn kernel(&mut self, which: Which) -> Result<Kernel, WgpuError> {
        if let Some((_, kernel)) = self.own.iter().find(|(own, _)| *own == which) {
            return Ok(kernel.clone());
        }
        let slot = &mut self.kernels[which.index()];
        let kernel = match slot {
            Slot::Compiled(kernel) => return Ok(kernel.clone()),
            Slot::Source(source) => kernels::compiled(&self.device, which, source)?,
        };
        *slot = Slot::Compiled(kernel.clone());
        Ok(kernel)
    }

    /// Records one kernel.
    fn record(&mut self, which: Which, buffers: &[&wgpu::Buffer], groups: Groups) -> Result<(), WgpuError> {
        let whole: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
        self.record_parts(which, &whole, groups)
    }

    /// Records one kernel, on parts of buffers.
    fn record_parts(
        &mut self,
        which: Which,
        parts: &[wgpu::BindingResource<'_>],
        groups: Groups,
    ) -> Result<(), WgpuError> {
        let kernel = self.kernel(which)?;
        let bind_group = bind(&self.device, &kernel, parts);
        let device = &self.device;
        let encoder = self.encoder.get_or_insert_with(|| device.create_command_encoder(&Default::default()));
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        match groups {
            Groups::Known(columns, rows) => pass.dispatch_workgroups(columns, rows, 1),
            Groups::Arranged => pass.dispatch_workgroups_indirect(&self.groups, 0),
            Groups::ArrangedSecond => pass.dispatch_workgroups_indirect(&self.groups, 12),
        }
        drop(pass);
        self.pending += 1;
        Ok(())
    }

    /// Runs a fused stage, chunk by chunk. How many draws a chunk has, only the device knows: as many as their tiles'
    /// lists have room for.
    fn draw(&mut self, b: &DrawBuffers<'_>) -> Result<(), WgpuError> {
        self.chunk.fit(&self.device, &self.queue, b.stage, &b.extent)?;
        let (rounds, in_rounds) = (self.chunk.rounds.clone(), self.chunk.in_rounds);
        self.encoder().clear_buffer(&rounds, chunk::NEXT, Some(4));
        let mut left = b.room;
        while left > 0 {
            let chunks = if in_rounds { 1 } else { left.div_ceil(chunk::DRAWS) };
            for _ in 0..chunks {
                self.draw_chunk(b)?;
            }
            if !in_rounds && !chunk::is_large(&b.extent) {
                return Ok(());
            }
            let [mut after, near, general] = self.left()?;
            let mut unfinished = [near, general];
            while unfinished != [0; 2] {
                self.sample_tiles(b)?;
                [after, unfinished[0], unfinished[1]] = self.left()?;
            }
            left = after.into();
        }
        Ok(())
    }

    /// Dices the next chunk, shades it and samples it.
    fn draw_chunk(&mut self, b: &DrawBuffers<'_>) -> Result<(), WgpuError> {
        let (grids, rounds, groups) =
            (self.chunk.grids.clone(), self.chunk.rounds.clone(), self.groups.clone());
        let arranged = [b.frame, b.control, b.draws, &grids, &rounds, &groups];
        self.record(Which::ArrangeDraw, &arranged, Groups::Known(1, 1))?;
        let diced = [b.frame, b.objects, b.patches, b.draws, &grids, b.more_patches];
        self.record(if b.is_general { Which::DrawAny } else { Which::Draw }, &diced, Groups::Arranged)?;
        if b.stage == Stage::SortLast {
            return self.sample_draws(b);
        }
        self.sort_into_tiles(b)?;
        self.sample_tiles(b)
    }

    /// Lists the chunk's grids, tile by tile.
    fn sort_into_tiles(&mut self, b: &DrawBuffers<'_>) -> Result<(), WgpuError> {
        let (grids, bins) = (self.chunk.grids.clone(), self.chunk.bins.clone());
        self.encoder().clear_buffer(&bins, 0, Some(chunk::bins_head_bytes(&b.extent)));
        self.record(Which::CountBins, &[b.frame, &grids, &bins], Groups::Arranged)?;
        self.record(Which::ScanBins, &[b.frame, &bins], Groups::Known(1, 1))?;
        self.record(Which::WriteBins, &[b.frame, &grids, &bins], Groups::Arranged)
    }

    /// One round of the tiles.
    fn sample_tiles(&mut self, b: &DrawBuffers<'_>) -> Result<(), WgpuError> {
        let (grids, bins) = (self.chunk.grids.clone(), self.chunk.bins.clone());
        let (rounds, groups) = (self.chunk.rounds.clone(), self.groups.clone());
        self.record(Which::ArrangeTiles, &[b.frame, &bins, &rounds, &groups], Groups::Known(1, 1))?;
        let tiles = [b.frame, b.draws, &grids, &bins, b.behind, b.samples, b.colours, &rounds];
        self.record(Which::Tiles(Kind::Near), &tiles, Groups::Arranged)?;
        self.record(Which::Tiles(Kind::General), &tiles, Groups::ArrangedSecond)
    }

    /// All turns of sort-last.
    fn sample_draws(&mut self, b: &DrawBuffers<'_>) -> Result<(), WgpuError> {
        let (grids, keys) = (self.chunk.grids.clone(), self.chunk.keys.clone());
        let (rounds, turns) = (self.chunk.rounds.clone(), self.chunk.turns.clone());
        let draws = [b.frame, b.draws, &grids, b.behind, b.samples, b.colours, &keys, &rounds];
        for turn in 0..chunk::TURNS {
            self.encoder().copy_buffer_to_buffer(&turns, 4 * turn, &rounds, chunk::TURN, 4);
            self.record(Which::SortLast, &draws, Groups::ArrangedSecond)?;
        }
        let count = b.extent.columns * b.extent.rows;
        self.record(Which::Merge, &[b.frame, b.samples, &keys], spread(count.div_ceil(ITEMS_A_GROUP)))
    }

    /// How many draws are in no chunk yet, and whether a tile has draws left, of either kind.
    fn left(&mut self) -> Result<[u32; 3], WgpuError> {
        let rounds = self.chunk.rounds.clone();
        let mut left = [0; 3];
        self.read_piece(&rounds, chunk::LEFT, bytemuck::cast_slice_mut(&mut left))?;
        Ok(left)
    }

    /// Runs MESH on the first `count` draws: a group each, and the kernel knows how many there are by the length of
    /// what is bound.
    fn mesh(&mut self, count: u32, buffers: &[&WgpuBuffer]) -> Result<(), WgpuError> {
        let &[frame, objects, patches, draws, places, vertices, indices] = buffers else {
            return Err(WgpuError::Bindings { stage: Stage::Mesh.name() });
        };
        if u64::from(count) > draws.entries().min(places.entries()) {
            return Err(WgpuError::Bindings { stage: Stage::Mesh.name() });
        }
        let Some(bytes) = wgpu::BufferSize::new(u64::from(count) * Draw::LAYOUT.size as u64) else {
            return Ok(());
        };
        let more = patches.more().unwrap_or_else(|| patches.memory());
        let draws = wgpu::BufferBinding { buffer: draws.memory(), offset: 0, size: Some(bytes) };
        let parts = [
            frame.memory().as_entire_binding(),
            objects.memory().as_entire_binding(),
            patches.memory().as_entire_binding(),
            wgpu::BindingResource::Buffer(draws),
            places.memory().as_entire_binding(),
            vertices.memory().as_entire_binding(),
            indices.memory().as_entire_binding(),
            more.as_entire_binding(),
        ];
        self.record_parts(Which::Stage(Stage::Mesh), &parts, spread(count))
    }

    /// Number of groups of a stage; arranges them on the device if only it knows them.
    fn groups(&mut self, stage: Stage, items: Items, buffers: &[&WgpuBuffer]) -> Result<Groups, WgpuError> {
        match (stage, items) {
            (Stage::Take | Stage::Balance | Stage::MeshPlaces | Stage::TessPlaces | Stage::Flush, _)
            | (Stage::Scan, Items::Taken) => Ok(Groups::Known(1, 1)),
            (Stage::KnownAnswers | Stage::Filter | Stage::TessControl, Items::Count(count)) => {
                Ok(spread(count.div_ceil(ITEMS_A_GROUP)))
            }
            // Kernels know by their frame how many there are.
            (
                Stage::AccelExtent
                | Stage::AccelCodes
                | Stage::AccelTree
                | Stage::AccelBoxes
                | Stage::AccelRays
                | Stage::AccelNearest
                | Stage::BspSides
                | Stage::BspCells
                | Stage::BspRank,
                Items::Count(count),
            ) => Ok(spread(count.div_ceil(ITEMS_A_GROUP))),
            (Stage::AccelScan, _) => Ok(Groups::Known(1, 1)),
            // A group a block.
            (
                Stage::AccelCount | Stage::AccelScatter | Stage::AccelSee | Stage::AccelFill,
                Items::Count(blocks),
            ) => Ok(spread(blocks)),
            // A group a piece.
            (Stage::TessEvaluate, Items::Count(count)) => Ok(spread(count)),
            // The kernels know how many there are by the length of their buffer.
            (Stage::Blend, Items::Count(count)) if buffers[0].entries() == count.into() => {
                Ok(spread(count.div_ceil(ITEMS_A_GROUP)))
            }
            (Stage::Local | Stage::Deal, Items::Groups(count))
                if place_of(stage, "groups")
                    .is_some_and(|place| buffers[place].entries() == count.into()) =>
            {
                Ok(spread(count))
            }
            (Stage::Bound | Stage::Split, Items::Taken) => {
                let control =
                    place_of(stage, "control").ok_or(WgpuError::Bindings { stage: stage.name() })?;
                let groups = self.groups.clone();
                self.record(Which::Arrange, &[buffers[control].memory(), &groups], Groups::Known(1, 1))?;
                Ok(Groups::Arranged)
            }
            _ => Err(WgpuError::Bindings { stage: stage.name() }),
        }
    }
}

/// The buffers of a fused stage, in the order of its bindings, and its sizes.
struct DrawBuffers<'a> {
    stage: Stage,
    frame: &'a wgpu::Buffer,
    objects: &'a wgpu::Buffer,
    patches: &'a wgpu::Buffer,
    more_patches: &'a wgpu::Buffer,
    control: &'a wgpu::Buffer,
    draws: &'a wgpu::Buffer,
    behind: &'a wgpu::Buffer,
    samples: &'a wgpu::Buffer,
    colours: &'a wgpu::Buffer,
    /// Entries of the draw buffer.
    room: u64,
    extent: Extent,
    /// Does it need the kernels for any patch and profile?
    is_general: bool,
}

/// How many groups run.
enum Groups {
    /// So many columns and rows of groups.
    Known(u32, u32),
    /// What the arranging kernel wrote.
    Arranged,
    /// What it wrote as its second answer.
    ArrangedSecond,
}

/// Place of a buffer among a stage's.
fn place_of(stage: Stage, name: &str) -> Option<usize> {
    stage.bindings().iter().position(|binding| binding.name == name)
}

/// So many groups, over two dimensions if one is too small; mirrors `arrange.wgsl`.
fn spread(groups: u32) -> Groups {
    Groups::Known(groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS))
}

fn failed(error: impl ToString) -> WgpuError {
    WgpuError::Failed(error.to_string())
}

/// Opens an adapter with the limits that every WebGPU device has, but with its own largest buffers.
fn request(adapter: &wgpu::Adapter, name: &str) -> Result<(wgpu::Device, wgpu::Queue), WgpuError> {
    let own = adapter.limits();
    let required_limits = wgpu::Limits {
        max_storage_buffer_binding_size: own.max_storage_buffer_binding_size,
        max_buffer_size: own.max_buffer_size,
        max_storage_buffers_per_shader_stage: STORAGE_BUFFERS,
        max_compute_workgroup_storage_size: GROUP_BYTES,
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

pub(crate) fn memory(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let label = Some(label);
    device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
}

fn bind(device: &wgpu::Device, kernel: &Kernel, parts: &[wgpu::BindingResource<'_>]) -> wgpu::BindGroup {
    let entries: Vec<_> = parts
        .iter()
        .enumerate()
        .map(|(place, part)| wgpu::BindGroupEntry { binding: place as u32, resource: part.clone() })
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
        let limit = self.max_buffer_bytes(layout);
        if bytes > limit {
            return Err(WgpuError::TooLarge { buffer: name, bytes, limit });
        }
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::VERTEX // meshes are drawn from where they are
            | wgpu::BufferUsages::INDEX;
        let errors = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let first = bytes.min(self.piece_bytes(layout));
        let rest = (bytes - first).max(layout.size as u64);
        let memories = (
            memory(&self.device, name, first, usage),
            (layout == Patch::LAYOUT).then(|| memory(&self.device, "patches_more", rest, usage)),
        );
        if pollster::block_on(errors.pop()).is_some() {
            return Err(WgpuError::OutOfMemory { buffer: name, bytes });
        }
        Ok(WgpuBuffer::new(name, layout, entries, memories, &self.allocated))
    }

    fn bytes_allocated(&self) -> u64 {
        self.allocated.load(Ordering::Relaxed)
    }

    fn max_buffer_bytes(&self, layout: Layout) -> u64 {
        let pieces = if layout == Patch::LAYOUT { 2 } else { 1 };
        pieces * self.piece_bytes(layout)
    }

    fn own_bytes(&self, extent: Extent) -> u64 {
        chunk::bytes(&extent)
    }

    fn write<T: Shared>(&mut self, buffer: &WgpuBuffer, data: &[T]) -> Result<(), WgpuError> {
        let mut offset = buffer.offset_of::<T>(0, data.len())?;
        buffer.note(data);
        self.submit(); // what was dispatched before must not see the new data
        let mut data: &[u8] = bytemuck::cast_slice(data);
        while !data.is_empty() {
            let (piece, within, room) = buffer.piece(offset);
            let (now, later) = data.split_at(data.len().min(room as usize));
            self.queue.write_buffer(piece, within, now);
            (data, offset) = (later, offset + now.len() as u64);
        }
        self.checked()
    }

    fn read<T: Shared>(&mut self, buffer: &WgpuBuffer, first: u64, out: &mut [T]) -> Result<(), WgpuError> {
        let mut offset = buffer.offset_of::<T>(first, out.len())?;
        let mut out: &mut [u8] = bytemuck::cast_slice_mut(out);
        while !out.is_empty() {
            let (piece, within, room) = buffer.piece(offset);
            let (now, later) = out.split_at_mut(out.len().min(room.min(STAGING_BYTES) as usize));
            self.read_piece(piece, within, now)?;
            (out, offset) = (later, offset + now.len() as u64);
        }
        self.checked()
    }

    fn copy(&mut self, from: &WgpuBuffer, to: &WgpuBuffer, entries: u64) -> Result<(), WgpuError> {
        let bytes = to.bytes_from(from, entries)?;
        let (from, to) = (from.memory().clone(), to.memory().clone());
        self.encoder().copy_buffer_to_buffer(&from, 0, &to, 0, bytes);
        self.checked()
    }

    fn clear(&mut self, buffer: &WgpuBuffer) -> Result<(), WgpuError> {
        for piece in [Some(buffer.memory()), buffer.more()].into_iter().flatten() {
            self.encoder().clear_buffer(piece, 0, None);
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
        let more = buffers.iter().find_map(|buffer| buffer.more());
        let is_general = buffers.iter().any(|buffer| buffer.is_general());
        if let (Stage::Draw | Stage::SortLast, Items::Image(extent)) = (stage, items) {
            let &[frame, objects, patches, control, draws, behind, samples, colours] = &memories[..] else {
                return Err(WgpuError::Bindings { stage: stage.name() });
            };
            let room = buffers[4].entries();
            self.draw(&DrawBuffers {
                stage,
                frame,
                objects,
                patches,
                more_patches: more.unwrap_or(patches),
                control,
                draws,
                behind,
                samples,
                colours,
                room,
                extent,
                is_general,
            })?;
            return self.checked();
        }
        if let (Stage::Mesh, Items::Count(count)) = (stage, items) {
            self.mesh(count, buffers)?;
            return self.submit_if_many();
        }
        let groups = self.groups(stage, items, buffers)?;
        let memories: Vec<_> = memories.into_iter().chain(more).collect();
        let is_flat = buffers.iter().any(|buffer| buffer.is_flat());
        let which = match stage {
            Stage::Bound if is_flat => Which::BoundFlat,
            Stage::Local if is_flat => Which::LocalFlat,
            Stage::Bound if is_general => Which::BoundAny,
            Stage::Local if is_general => Which::LocalAny,
            _ => Which::Stage(stage),
        };
        self.record(which, &memories, groups)?;
        self.submit_if_many()
    }
}
