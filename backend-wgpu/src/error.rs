//! What can go wrong on a GPU, with what to do about it.

use std::fmt;

use micropoly_core::error::PlanError;
use micropoly_core::known::Mismatch;

/// What can go wrong on a GPU.
#[derive(Debug)]
pub enum WgpuError {
    /// The plan itself cannot run.
    Plan(PlanError),
    /// There is no device of that number.
    NoDevice {
        /// The number that was asked for.
        index: usize,
        /// How many devices there are.
        found: usize,
    },
    /// The driver does not hand out the device.
    Refused {
        /// The device.
        device: String,
        /// What the driver says.
        reason: String,
    },
    /// A kernel does not compile.
    Kernel {
        /// The stage.
        stage: &'static str,
        /// What the compiler says.
        reason: String,
    },
    /// The caller's own step of the tessellator does not compile.
    Own {
        /// The stage that it is a part of.
        stage: &'static str,
        /// The function that it must define.
        wanted: &'static str,
        /// What the compiler says.
        reason: String,
    },
    /// The device computes otherwise than it must, so images would differ.
    Inexact {
        /// The device.
        device: String,
        /// What it was asked and what it answered.
        mismatch: Mismatch,
    },
    /// A buffer is larger than the device allows.
    TooLarge {
        /// Which buffer.
        buffer: &'static str,
        /// Its size.
        bytes: u64,
        /// The largest size.
        limit: u64,
    },
    /// The device has not got the memory.
    OutOfMemory {
        /// Which buffer.
        buffer: &'static str,
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
    /// A stage was given another number of buffers, or items, than it works on.
    Bindings {
        /// Which stage.
        stage: &'static str,
    },
    /// The device failed while it was working.
    Failed(String),
}

impl fmt::Display for WgpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::NoDevice { index, found } => no_device(f, *index, *found),
            Self::Refused { device, reason } => {
                write!(f, "cannot open {device}: {reason}; update its driver or choose another device")
            }
            Self::Kernel { stage, reason } => write!(f, "the kernel {stage} does not compile: {reason}"),
            Self::Own { stage, wanted, reason } => write!(
                f,
                "your own part of the kernel {stage} does not compile: {reason}\nit must define `{wanted}`, and no name \
                 that the kernel has already"
            ),
            Self::Inexact { device, mismatch } => inexact(f, device, mismatch),
            Self::TooLarge { buffer, bytes, limit } => write!(
                f,
                "the {buffer} buffer of {bytes} bytes is larger than the {limit} bytes that wgpu allows; \
                 use a smaller batch, image or scene, or the CPU"
            ),
            Self::OutOfMemory { buffer, bytes } => {
                write!(f, "the device has no memory for the {buffer} buffer of {bytes} bytes")
            }
            Self::Mismatch { buffer, wanted } => {
                write!(f, "buffer {buffer} does not hold that many {wanted}")
            }
            Self::Bindings { stage } => {
                write!(f, "stage {stage} was given the wrong number of buffers or items")
            }
            Self::Failed(reason) => write!(f, "the device failed: {reason}"),
        }
    }
}

fn no_device(f: &mut fmt::Formatter<'_>, index: usize, found: usize) -> fmt::Result {
    if found == 0 {
        return write!(
            f,
            "no GPU driver found: install the driver of your GPU's maker, or Mesa's \
             (Debian: apt install mesa-vulkan-drivers libvulkan1)"
        );
    }
    write!(f, "there is no GPU number {index}; the last is number {}", found - 1)
}

fn inexact(f: &mut fmt::Formatter<'_>, device: &str, mismatch: &Mismatch) -> fmt::Result {
    let Mismatch { question, expected, found } = *mismatch;
    write!(
        f,
        "{device} is not exact: {} for a = {:#x}, b = {:#x}, c = {:#x} gave {found:#x} instead of \
         {expected:#x}, so its images would differ; use the CPU or another driver",
        mismatch.operation(),
        question.a,
        question.b,
        question.c
    )
}

impl std::error::Error for WgpuError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Plan(error) => Some(error),
            _ => None,
        }
    }
}

impl From<PlanError> for WgpuError {
    fn from(error: PlanError) -> Self {
        Self::Plan(error)
    }
}
