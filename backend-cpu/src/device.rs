//! The CPU as a device: a pool of threads and main memory.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use micropoly_core::abi::{Layout, Shared};
use micropoly_core::backend::Device;
use micropoly_core::error::PlanError;
use micropoly_core::stage::{Extent, Items, Stage};

use crate::buffer::CpuBuffer;
use crate::draw::{Lists, Steps};
use crate::sort_last::{self, Keys};
use crate::tessellate::{self, Evaluate, Levels, OwnSteps};
use crate::{bsp, draw, local, pixels, stages, trees};

/// What can go wrong on the CPU.
#[derive(Debug)]
pub enum CpuError {
    /// The plan itself cannot run.
    Plan(PlanError),
    /// The operating system has not got the memory.
    OutOfMemory {
        /// Which buffer.
        name: &'static str,
        /// Its size.
        bytes: u64,
    },
    /// A buffer has another layout, or fewer entries, than was asked for.
    Mismatch {
        /// Which buffer.
        buffer: &'static str,
        /// Name of the layout that was asked for.
        wanted: &'static str,
    },
    /// A stage was given the same buffer twice, once to write.
    InUse {
        /// Which buffer.
        buffer: &'static str,
    },
    /// A stage was given another number of buffers than it has bindings.
    Bindings {
        /// Which stage.
        stage: &'static str,
    },
    /// The threads could not be started.
    Threads(String),
}

impl fmt::Display for CpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::OutOfMemory { name, bytes } => {
                write!(f, "no memory for the {name} buffer of {bytes} bytes")
            }
            Self::Mismatch { buffer, wanted } => {
                write!(f, "buffer {buffer} does not hold that many {wanted}")
            }
            Self::InUse { buffer } => write!(f, "buffer {buffer} is passed twice to a stage that writes it"),
            Self::Bindings { stage } => write!(f, "stage {stage} was given the wrong number of buffers"),
            Self::Threads(why) => write!(f, "cannot start threads: {why}"),
        }
    }
}

impl std::error::Error for CpuError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Plan(error) => Some(error),
            _ => None,
        }
    }
}

impl From<PlanError> for CpuError {
    fn from(error: PlanError) -> Self {
        Self::Plan(error)
    }
}

/// A pool of threads that runs the stages.
#[derive(Debug)]
pub struct CpuDevice {
    pool: rayon::ThreadPool,
    allocated: Arc<AtomicU64>,
    /// Of the sort-middle rasteriser.
    lists: Lists,
    /// Of the sort-last rasteriser.
    keys: Keys,
    steps: Option<Steps>,
    /// Of the tessellator.
    own: OwnSteps,
}

impl CpuDevice {
    /// Starts `threads` threads; 0 = one a core.
    ///
    /// # Errors
    /// [`CpuError::Threads`] if the operating system refuses.
    pub fn new(threads: usize) -> Result<Self, CpuError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| CpuError::Threads(error.to_string()))?;
        let allocated = Arc::default();
        let (lists, keys) = (Lists::new(&allocated), Keys::new(&allocated));
        Ok(Self { pool, lists, keys, allocated, steps: None, own: OwnSteps::default() })
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// From now on the tessellator takes the levels of patches from the caller; from its own control again with `None`.
    pub fn control_tessellation(&mut self, levels: Option<Arc<Levels>>) {
        self.own.levels = levels;
    }

    /// From now on the tessellator's vertices are the caller's; those of its own evaluation again with `None`.
    pub fn evaluate_tessellation(&mut self, evaluate: Option<Arc<Evaluate>>) {
        self.own.evaluate = evaluate;
    }

    /// Does something on the device's threads.
    pub(crate) fn install<T: Send>(&self, job: impl FnOnce() -> T + Send) -> T {
        self.pool.install(job)
    }

    /// What the device is called in reports.
    #[must_use]
    pub fn name(&self) -> String {
        format!("CPU ({})", std::env::consts::ARCH)
    }
}

impl Device for CpuDevice {
    type Buffer = CpuBuffer;
    type Error = CpuError;

    fn allocate(&mut self, name: &'static str, layout: Layout, entries: u64) -> Result<CpuBuffer, CpuError> {
        CpuBuffer::new(name, layout, entries, &self.allocated)
    }

    fn bytes_allocated(&self) -> u64 {
        self.allocated.load(Ordering::Relaxed)
    }

    fn time_steps(&mut self) {
        self.steps = Some(Steps::default());
    }

    fn tell_steps(&mut self, tell: &mut dyn FnMut(&'static str, f64)) {
        for (name, milliseconds) in self.steps.as_mut().map(Steps::take).into_iter().flatten() {
            tell(name, milliseconds);
        }
    }

    fn write<T: Shared>(&mut self, buffer: &CpuBuffer, data: &[T]) -> Result<(), CpuError> {
        buffer.write(data)
    }

    fn read<T: Shared>(&mut self, buffer: &CpuBuffer, first: u64, out: &mut [T]) -> Result<(), CpuError> {
        buffer.read(first, out)
    }

    fn copy(&mut self, from: &CpuBuffer, to: &CpuBuffer, entries: u64) -> Result<(), CpuError> {
        to.copy(from, entries)
    }

    fn own_bytes(&self, extent: Extent) -> u64 {
        if extent.sort_last { sort_last::own_bytes(&extent) } else { draw::own_bytes(&extent) }
    }

    fn clear(&mut self, buffer: &CpuBuffer) -> Result<(), CpuError> {
        buffer.clear(&self.pool)
    }

    fn dispatch(&mut self, stage: Stage, items: Items, buffers: &[&CpuBuffer]) -> Result<(), CpuError> {
        let bindings = stage.bindings();
        if bindings.len() != buffers.len() {
            return Err(CpuError::Bindings { stage: stage.name() });
        }
        for (binding, buffer) in bindings.iter().zip(buffers) {
            if binding.layout != buffer.layout() {
                return Err(CpuError::Mismatch { buffer: buffer.name(), wanted: binding.layout.name });
            }
        }
        let threads = self.threads();
        match (stage, items) {
            (Stage::Take, _) => stages::take(buffers),
            (Stage::Bound, Items::Taken) => stages::bound(&self.pool, buffers),
            (Stage::Scan, Items::Taken) => stages::scan(buffers),
            (Stage::Split, Items::Taken) => stages::split(buffers),
            (Stage::Local, Items::Groups(count)) => local::local(&self.pool, buffers, count),
            (Stage::Balance, _) => local::balance(buffers),
            (Stage::Deal, Items::Groups(count)) => local::deal(buffers, count),
            (Stage::Draw, Items::Image(_)) => {
                draw::draw(&self.pool, threads, buffers, &mut self.lists, self.steps.as_ref())
            }
            (Stage::SortLast, Items::Image(extent)) => {
                sort_last::sort_last(&self.pool, buffers, &extent, &mut self.keys)
            }
            (Stage::Blend, Items::Count(count)) => pixels::blend(&self.pool, buffers, count),
            (Stage::Filter, Items::Count(_)) => pixels::filter(&self.pool, buffers),
            (Stage::MeshPlaces, _) => stages::mesh_places(buffers),
            (Stage::Mesh, Items::Count(count)) => stages::mesh(&self.pool, buffers, count),
            (Stage::TessControl, _) => tessellate::tess_control(&self.pool, buffers, &self.own),
            (Stage::TessPlaces, _) => tessellate::tess_places(buffers),
            (Stage::TessEvaluate, _) => tessellate::tess_evaluate(&self.pool, buffers, &self.own),
            (
                Stage::AccelExtent
                | Stage::AccelCodes
                | Stage::AccelCount
                | Stage::AccelScan
                | Stage::AccelScatter
                | Stage::AccelTree
                | Stage::AccelBoxes
                | Stage::AccelSee
                | Stage::AccelFill
                | Stage::AccelRays
                | Stage::AccelNearest,
                Items::Count(count),
            ) => trees::run(&self.pool, stage, count, buffers),
            (Stage::BspSides | Stage::BspCells | Stage::BspRank, Items::Count(_)) => {
                bsp::stages::run(&self.pool, stage, buffers)
            }
            (Stage::Flush, _) => stages::flush(buffers),
            (Stage::KnownAnswers, Items::Count(count)) => stages::known_answers(buffers, count),
            _ => Err(CpuError::Bindings { stage: stage.name() }),
        }
    }
}
