//! An OpenCL device: one context, one queue that keeps order, and its kernels.
#![allow(unsafe_code)] // OpenCL's calls; buffers are checked against the stage before each of them

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use micropoly_core::abi::{
    LOCAL_BATCH, LOCAL_DRAWS, LOCAL_STACK, Layout, SEE_BLOCK, SORT_BLOCK, SORT_RUN, Sample, Shared,
};
use micropoly_core::backend::Device;
use micropoly_core::kernel::sort_last::{NOBODY, Turn};
use micropoly_core::known;
use micropoly_core::stage::{Extent, Items, Stage};
use opencl3::command_queue::CommandQueue;
use opencl3::context::Context;
use opencl3::device::Device as ClDevice;
use opencl3::kernel::Kernel;

use crate::buffer::OclBuffer;
use crate::chunk;
use crate::error::OclError;
use crate::list::{DeviceInfo, found, info};
use crate::program::{GROUP, Kind, Part, Unbuilt, Which};

/// Work-groups that deal what one group of LOCAL has: an item an entry of its stack, or a draw.
const DEAL_ROWS: u64 =
    (if LOCAL_STACK > LOCAL_DRAWS { LOCAL_STACK } else { LOCAL_DRAWS }) as u64 / GROUP as u64;
/// Bytes of local memory that a work-group needs at most.
const LOCAL_MEMORY: u64 = 16 << 10;

// Each work-item has a run of a block's keys, and a leaf of a block.
const _: () = assert!(SORT_BLOCK == SORT_RUN * GROUP as u32 && SEE_BLOCK == GROUP as u32);
// In LOCAL each work-item has a surface of the batch.
const _: () = assert!(LOCAL_BATCH == GROUP as u32);

/// Gives a kernel file's name and source, takes the source to be built.
pub type Edit<'a> = &'a dyn Fn(&str, &str) -> String;

/// How to open a device.
#[derive(Clone, Default)]
pub struct OpenOptions<'a> {
    /// More options for the driver's compiler.
    pub build_options: String,
    /// XOR a zero, known at run time only, into every float result: then no compiler option can change bits.
    pub barrier: bool,
    /// Open the device even if known answers come out wrong. For tests.
    pub skip_check: bool,
    /// Changes kernels before they are built. For tests.
    pub edit: Option<Edit<'a>>,
    /// Stages whose kernels are built at once, with those of the same [`Part`]; the others are built when one of them is
    /// first dispatched. Where there are none, and no step of the tessellator is the caller's own, those of a frame.
    pub first: &'a [Stage],
    /// The tessellator's control, in OpenCL C: the levels of a patch. It must define
    ///
    /// ```c
    /// static TessLevels levels_of(__constant TessFrame *frame, __global const TessPatch *patches,
    ///                             __global const TessLevels *levels, uint index)
    /// ```
    ///
    /// `index` is that of the patch; `levels` has an entry a patch only with `TESS_GIVEN`. Where patches share an edge, it
    /// must have the same level in all of them.
    ///
    /// The structs and constants are those of `micropoly_core::abi`. Floats are to be computed with the functions of
    /// `kernel/num.cl` (`add`, `mul`, …), after `const uint zero = frame->zero;`: then the bits are the same on every device.
    /// `levels_by_frame(frame, patches + index)` is what the frame asks for.
    ///
    /// With a step of the caller's own the tessellator is built as the device is opened; [`OclError::OwnStep`] if it does not
    /// compile.
    pub tess_control: Option<String>,
    /// The tessellator's evaluation, in OpenCL C as [`OpenOptions::tess_control`]: a vertex of a patch. It must define
    ///
    /// ```c
    /// static TessVertex evaluated(__constant TessFrame *frame, __global const TessPatch *patches,
    ///                             __global const float *heights, uint index, uint3 coordinates)
    /// ```
    ///
    /// `index` is that of the patch; `coordinates` are (u, v, w) in units of 2⁻¹⁶, on quadrilaterals and isolines w = 0.
    /// `shares(frame->zero, coordinates)` has them as floats, `weights_of(frame, coordinates)` has the corners' shares, and
    /// `height_at(frame, heights, place)` looks up a height.
    pub tess_evaluate: Option<String>,
}

impl OpenOptions<'_> {
    /// Is a part built at once?
    fn is_first(&self, part: Part) -> bool {
        let has_own_steps = self.tess_control.is_some() || self.tess_evaluate.is_some();
        match part {
            Part::Frame if self.first.is_empty() => !has_own_steps,
            Part::Tessellator if has_own_steps => true,
            _ => self.first.iter().any(|stage| Part::of(*stage) == part),
        }
    }
}

impl fmt::Debug for OpenOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OpenOptions")
            .field("build_options", &self.build_options)
            .field("barrier", &self.barrier)
            .field("skip_check", &self.skip_check)
            .field("edit", &self.edit.is_some())
            .field("first", &self.first)
            .field("tess_control", &self.tess_control)
            .field("tess_evaluate", &self.tess_evaluate)
            .finish()
    }
}

/// A device that runs the stages through OpenCL.
#[derive(Debug)]
pub struct OclDevice {
    info: DeviceInfo,
    /// As [`Which::ALL`], those that are built.
    kernels: [Option<Kernel>; Which::ALL.len()],
    /// Parts whose kernels are not.
    unbuilt: Vec<Unbuilt>,
    /// As [`chunk::own`]; kept from frame to frame, none before the first that needs it.
    own: [Option<OclBuffer>; 3],
    queue: CommandQueue,
    context: Context,
    allocated: Arc<AtomicU64>,
}

impl OclDevice {
    /// Opens device number `index` of [`crate::devices`], builds the kernels and asks the known answers.
    ///
    /// # Errors
    /// When there is no such device, its driver fails, or it does not compute as it must.
    pub fn open(index: usize, options: &OpenOptions<'_>) -> Result<Self, OclError> {
        let all = found()?;
        let (platform, device) = all.get(index).ok_or(OclError::NoSuchDevice { index, found: all.len() })?;
        let info = info(platform, device)?;
        check_size(&info)?;
        let mut opened = Self::start(device, info, options)?;
        if !options.skip_check {
            opened.check_answers()?;
        }
        Ok(opened)
    }

    fn start(device: &ClDevice, info: DeviceInfo, options: &OpenOptions<'_>) -> Result<Self, OclError> {
        let context = Context::from_device(device).map_err(OclError::driver("opening the device"))?;
        let queue = CommandQueue::create_default(&context, 0).map_err(OclError::driver("making a queue"))?;
        let mut started = Self {
            info,
            kernels: [const { None }; Which::ALL.len()],
            unbuilt: Part::ALL.map(|part| Unbuilt::new(part, options)).into(),
            own: [const { None }; 3],
            queue,
            context,
            allocated: Arc::default(),
        };
        for part in Part::ALL.into_iter().filter(|part| options.is_first(*part)) {
            started.build(part)?;
        }
        Ok(started)
    }

    /// Builds the kernels of a part, if they are not built.
    fn build(&mut self, part: Part) -> Result<(), OclError> {
        let Some(at) = self.unbuilt.iter().position(|unbuilt| unbuilt.part == part) else { return Ok(()) };
        for (which, kernel) in self.unbuilt[at].build(&self.context, &self.info.name)? {
            self.kernels[which.index()] = Some(kernel);
        }
        self.unbuilt.remove(at);
        Ok(())
    }

    /// Makes sure that a stage can run. Any part that is built knows the known answers.
    fn build_for(&mut self, stage: Stage) -> Result<(), OclError> {
        let any = self.unbuilt.len() < Part::ALL.len();
        if stage == Stage::KnownAnswers && any { Ok(()) } else { self.build(Part::of(stage)) }
    }

    fn check_answers(&mut self) -> Result<(), OclError> {
        match known::check(self)? {
            None => Ok(()),
            Some(mismatch) => Err(OclError::WrongAnswer { device: self.name(), mismatch }),
        }
    }

    /// What the device is called in reports.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{} ({}, {})", self.info.name, self.info.platform, self.info.driver)
    }

    /// What is known of the device.
    #[must_use]
    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn enqueue(&self, which: Which, buffers: &[&OclBuffer], grid: Grid) -> Result<(), OclError> {
        if grid.groups.contains(&0) {
            return Ok(()); // drivers may refuse to do nothing
        }
        let Some(kernel) = &self.kernels[which.index()] else {
            return Err(OclError::Bindings { stage: which.name() });
        };
        let failed = OclError::driver(which.name());
        for (place, buffer) in (0..).zip(buffers) {
            // SAFETY: the kernel takes these buffers; those of a stage were checked against its bindings.
            unsafe { kernel.set_arg(place, &buffer.handle()) }.map_err(&failed)?;
        }
        if let Some(number) = grid.number {
            // SAFETY: kernels that are told a number take it after their buffers.
            unsafe { kernel.set_arg(buffers.len() as u32, &number) }.map_err(&failed)?;
        }
        let global = [grid.groups[0] * GROUP, grid.groups[1]];
        let local = [GROUP, 1];
        // SAFETY: two dimensions, two sizes each; kernels stay within their buffers.
        unsafe {
            self.queue.enqueue_nd_range_kernel(
                kernel.get(),
                2,
                std::ptr::null(),
                global.as_ptr(),
                local.as_ptr(),
                &[],
            )
        }
        .map_err(&failed)?;
        Ok(())
    }

    /// Runs a stage that draws, chunk by chunk. How many chunks there are only the device knows; the rest does nothing.
    fn draw(&mut self, extent: &Extent, buffers: &[&OclBuffer]) -> Result<(), OclError> {
        let &[_, _, _, _, draws, ..] = buffers else {
            return Err(OclError::Bindings { stage: Stage::Draw.name() });
        };
        if extent.columns == 0 || extent.rows == 0 {
            return Ok(());
        }
        self.reserve_own(extent)?;
        for chunk in 0..draws.entries().div_ceil(chunk::DRAWS) {
            self.draw_chunk(chunk as u32, extent, buffers)?;
        }
        Ok(())
    }

    /// Makes sure that there are the buffers that a stage that draws has for itself, and that they are large enough.
    fn reserve_own(&mut self, extent: &Extent) -> Result<(), OclError> {
        for (kept, own) in self.own.iter_mut().zip(chunk::own(extent)) {
            if own.2 > kept.as_ref().map_or(0, OclBuffer::entries) {
                *kept = None; // the smaller one goes first
                let limit = self.info.max_allocation;
                let buffer = OclBuffer::new((&self.context, &self.queue), own, limit, &self.allocated)?;
                if own.1 == Sample::LAYOUT {
                    buffer.fill(&self.queue, NOBODY, own.2)?; // keys, as they are between two chunks
                }
                *kept = Some(buffer);
            }
        }
        Ok(())
    }

    fn draw_chunk(&self, chunk: u32, extent: &Extent, buffers: &[&OclBuffer]) -> Result<(), OclError> {
        let (
            &[frame, objects, patches, control, draws, behind, samples, colours],
            [Some(grids), lists, keys],
        ) = (buffers, &self.own)
        else {
            return Err(OclError::Bindings { stage: Stage::Draw.name() });
        };
        let each = Grid::of_groups(chunk::DRAWS, 1);
        self.enqueue(Which::ArrangeDraw, &[control, grids], Grid::of_groups(1, 1).told(chunk))?;
        self.enqueue(Which::Draw, &[frame, objects, patches, draws, grids], each)?;
        if let (true, Some(keys)) = (extent.sort_last, keys) {
            let sampled = [frame, draws, grids, behind, samples, colours, keys];
            for turn in 0..Turn::ALL.len() as u32 {
                self.enqueue(Which::SortLast, &sampled, each.told(turn))?;
            }
            let all = Grid::of_groups(u64::from(extent.columns).div_ceil(GROUP as u64), extent.rows.into());
            return self.enqueue(Which::MergeKeys, &[frame, samples, keys], all);
        }
        let Some(lists) = lists else { return Err(OclError::Bindings { stage: Stage::Draw.name() }) };
        lists.fill(&self.queue, 0_u32, chunk::tiles(extent))?;
        self.enqueue(Which::CountTiles, &[frame, grids, lists], Grid::of_items(chunk::DRAWS))?;
        self.enqueue(Which::ScanTiles, &[frame, lists], Grid::of_groups(1, 1))?;
        self.enqueue(Which::WriteTiles, &[frame, grids, lists], Grid::of_items(chunk::DRAWS))?;
        let [columns, rows] = chunk::blocks(extent);
        for kind in [Kind::Near, Kind::General] {
            let sampled = [frame, draws, grids, lists, behind, samples, colours];
            self.enqueue(Which::Tiles(kind), &sampled, Grid::of_groups(columns, rows))?;
        }
        Ok(())
    }
}

fn check_size(info: &DeviceInfo) -> Result<(), OclError> {
    let too_small = |what, has, needed| OclError::TooSmall { device: info.name.clone(), what, has, needed };
    if info.max_work_group < GROUP {
        return Err(too_small("a largest work-group of", info.max_work_group as u64, GROUP as u64));
    }
    if info.local_memory < LOCAL_MEMORY {
        return Err(too_small("local memory in bytes of", info.local_memory, LOCAL_MEMORY));
    }
    Ok(())
}

/// Work-groups of a kernel, and the number that it is told.
#[derive(Clone, Copy)]
struct Grid {
    groups: [usize; 2],
    number: Option<u32>,
}

impl Grid {
    /// The work-groups a stage needs for its items, or `None` if they do not go together.
    fn of(stage: Stage, items: Items, buffers: &[&OclBuffer]) -> Option<Self> {
        match (stage, items) {
            (Stage::KnownAnswers, Items::Count(count)) => Self::counted(count, &buffers[1..3]),
            (Stage::Blend, Items::Count(count)) => Self::counted(count, &buffers[..5]),
            (Stage::Filter, Items::Count(count)) => Self::counted(count, &buffers[4..]),
            (Stage::Take | Stage::Flush | Stage::Balance | Stage::MeshPlaces, _)
            | (Stage::Scan, Items::Taken) => Some(Self::of_groups(1, 1)),
            // How many are taken only the device knows; the rest of the batch does nothing.
            (Stage::Bound, Items::Taken) => Some(Self::of_items(buffers[5].entries())),
            (Stage::Split, Items::Taken) => Some(Self::of_items(buffers[1].entries())),
            (Stage::Local, Items::Groups(count)) => Self::a_column_each(count, 1, buffers[4]),
            (Stage::Deal, Items::Groups(count)) => Self::a_column_each(count, DEAL_ROWS, buffers[2]),
            (Stage::Mesh, Items::Count(count)) => Self::a_column_each(count, 1, buffers[4]),
            (Stage::TessControl, Items::Count(count)) => {
                (u64::from(count) <= buffers[3].entries()).then(|| Self::of_items(count.into()))
            }
            (Stage::TessPlaces, _) => Some(Self::of_groups(1, 1)),
            (Stage::TessEvaluate, Items::Count(pieces)) => Some(Self::of_groups(pieces.into(), 1)),
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
            ) => Some(Self::of_items(count.into())),
            (Stage::AccelScan, _) => Some(Self::of_groups(1, 1)),
            // A group a block.
            (
                Stage::AccelCount | Stage::AccelScatter | Stage::AccelSee | Stage::AccelFill,
                Items::Count(blocks),
            ) => Some(Self::of_groups(blocks.into(), 1)),
            _ => None,
        }
    }

    fn counted(count: u32, buffers: &[&OclBuffer]) -> Option<Self> {
        let fits = buffers.iter().all(|buffer| u64::from(count) <= buffer.entries());
        fits.then(|| Self::of_items(u64::from(count)).told(count))
    }

    /// A column of work-groups a group of LOCAL, or a draw; there may be more than devices have room for in a column.
    fn a_column_each(count: u32, rows: u64, all: &OclBuffer) -> Option<Self> {
        (u64::from(count) <= all.entries()).then(|| Self::of_groups(count.into(), rows))
    }

    fn of_items(items: u64) -> Self {
        Self::of_groups(items.div_ceil(GROUP as u64), 1)
    }

    fn of_groups(columns: u64, rows: u64) -> Self {
        Self { groups: [columns as usize, rows as usize], number: None }
    }

    fn told(self, number: u32) -> Self {
        Self { number: Some(number), ..self }
    }
}

fn check_bindings(stage: Stage, buffers: &[&OclBuffer]) -> Result<(), OclError> {
    let bindings = stage.bindings();
    if bindings.len() != buffers.len() {
        return Err(OclError::Bindings { stage: stage.name() });
    }
    for (binding, buffer) in bindings.iter().zip(buffers) {
        if binding.layout != buffer.layout() {
            return Err(OclError::Mismatch { buffer: buffer.name(), wanted: binding.layout.name });
        }
    }
    Ok(())
}

impl Device for OclDevice {
    type Buffer = OclBuffer;
    type Error = OclError;

    fn allocate(&mut self, name: &'static str, layout: Layout, entries: u64) -> Result<OclBuffer, OclError> {
        let limit = self.info.max_allocation;
        OclBuffer::new((&self.context, &self.queue), (name, layout, entries), limit, &self.allocated)
    }

    fn bytes_allocated(&self) -> u64 {
        self.allocated.load(Ordering::Relaxed)
    }

    fn max_buffer_bytes(&self, _layout: Layout) -> u64 {
        self.info.max_allocation
    }

    fn own_bytes(&self, extent: Extent) -> u64 {
        chunk::bytes(&extent)
    }

    fn write<T: Shared>(&mut self, buffer: &OclBuffer, data: &[T]) -> Result<(), OclError> {
        buffer.write(&self.queue, data)
    }

    fn read<T: Shared>(&mut self, buffer: &OclBuffer, first: u64, out: &mut [T]) -> Result<(), OclError> {
        buffer.read(&self.queue, first, out)
    }

    fn copy(&mut self, from: &OclBuffer, to: &OclBuffer, entries: u64) -> Result<(), OclError> {
        to.copy(&self.queue, from, entries)
    }

    fn clear(&mut self, buffer: &OclBuffer) -> Result<(), OclError> {
        buffer.fill(&self.queue, 0_u32, buffer.entries())
    }

    fn dispatch(&mut self, stage: Stage, items: Items, buffers: &[&OclBuffer]) -> Result<(), OclError> {
        check_bindings(stage, buffers)?;
        self.build_for(stage)?;
        if let (Stage::Draw | Stage::SortLast, Items::Image(extent)) = (stage, items) {
            self.draw(&Extent { sort_last: stage == Stage::SortLast, ..extent }, buffers)?;
        } else {
            let grid = Grid::of(stage, items, buffers).ok_or(OclError::Bindings { stage: stage.name() })?;
            self.enqueue(Which::Stage(stage), buffers, grid)?;
        }
        self.queue.flush().map_err(OclError::driver(stage.name()))
    }
}
