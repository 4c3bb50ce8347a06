//! What can go wrong with OpenCL, and what to do about it.

use std::fmt;

use micropoly_core::error::PlanError;
use micropoly_core::known::Mismatch;
use opencl3::error_codes::{
    CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_HOST_MEMORY, CL_OUT_OF_RESOURCES, ClError,
};

/// How to get a driver.
const DRIVERS: &str =
    "install the GPU maker's OpenCL driver, or on Debian: apt-get install pocl-opencl-icd ocl-icd-libopencl1";

/// What can go wrong on an OpenCL device.
#[derive(Debug)]
pub enum OclError {
    /// The plan itself cannot run.
    Plan(PlanError),
    /// There is no OpenCL library, or it knows no device.
    NoDriver {
        /// What is missing.
        what: &'static str,
    },
    /// There are fewer devices than that.
    NoSuchDevice {
        /// The index that was asked for.
        index: usize,
        /// Number of devices.
        found: usize,
    },
    /// The device is too small for the kernels.
    TooSmall {
        /// The device.
        device: String,
        /// What it has too little of.
        what: &'static str,
        /// How much it has.
        has: u64,
        /// How much is needed.
        needed: u64,
    },
    /// The driver's compiler refused the kernels.
    Build {
        /// The device.
        device: String,
        /// What the compiler said.
        log: String,
    },
    /// The driver's compiler refused a caller's own step of the tessellator, or what is made of it.
    OwnStep {
        /// The device.
        device: String,
        /// The functions that the caller's sources must define.
        defines: String,
        /// What the compiler said.
        log: String,
    },
    /// The device does not compute as it must.
    WrongAnswer {
        /// The device.
        device: String,
        /// The operation, its operands, and both answers.
        mismatch: Mismatch,
    },
    /// The device has not got the memory.
    OutOfMemory {
        /// Which buffer.
        name: &'static str,
        /// Its size.
        bytes: u64,
        /// Most that the device reserves in one piece.
        limit: u64,
    },
    /// A buffer has another layout, or fewer entries, than was asked for.
    Mismatch {
        /// Which buffer.
        buffer: &'static str,
        /// Name of the layout that was asked for.
        wanted: &'static str,
    },
    /// A stage was given the wrong number or kind of buffers or items.
    Bindings {
        /// Which stage.
        stage: &'static str,
    },
    /// The driver reported an error.
    Driver {
        /// What was being done.
        doing: &'static str,
        /// The driver's code and its name.
        code: ClError,
    },
}

impl OclError {
    /// The driver failed while `doing` something.
    pub(crate) fn driver(doing: &'static str) -> impl Fn(ClError) -> Self {
        move |code| Self::Driver { doing, code }
    }
}

impl fmt::Display for OclError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::NoDriver { what } => write!(f, "{what}\n  help: {DRIVERS}"),
            Self::NoSuchDevice { index, found } => {
                write!(
                    f,
                    "there is no OpenCL device {index}: {found} found, counted from 0\n  help: {DRIVERS}"
                )
            }
            Self::TooSmall { device, what, has, needed } => write!(
                f,
                "{device} has {what} {has}, but the kernels need {needed}\n  help: choose another device"
            ),
            Self::Build { device, log } => write!(
                f,
                "the OpenCL compiler of {device} refused the kernels\n  help: update the driver; its report:\n{log}"
            ),
            Self::OwnStep { device, defines, log } => write!(
                f,
                "the OpenCL compiler of {device} refused the tessellator with your own source in it\n  help: it must define `{defines}`; the compiler's report:\n{log}"
            ),
            Self::WrongAnswer { device, mismatch } => write_wrong_answer(f, device, mismatch),
            Self::OutOfMemory { name, bytes, limit } => write!(
                f,
                "no memory for the {name} buffer of {bytes} bytes; the device reserves {limit} bytes at most in one piece\n  help: try a smaller resolution or batch"
            ),
            Self::Mismatch { buffer, wanted } => {
                write!(f, "buffer {buffer} does not hold that many {wanted}")
            }
            Self::Bindings { stage } => write!(f, "stage {stage} was given the wrong buffers or items"),
            Self::Driver { doing, code } => {
                write!(f, "the OpenCL driver failed {doing}: {code} ({})", code.0)?;
                if out_of_memory(code) {
                    f.write_str("\n  help: the device ran out of memory: try a smaller resolution or batch")?;
                }
                Ok(())
            }
        }
    }
}

fn write_wrong_answer(f: &mut fmt::Formatter<'_>, device: &str, mismatch: &Mismatch) -> fmt::Result {
    let Mismatch { question, expected, found } = mismatch;
    write!(
        f,
        "{device} is refused: it computes {} otherwise: a {:08x}, b {:08x}, c {:08x} should give {expected:08x}, not {found:08x}\n  help: update its driver, or choose another device",
        mismatch.operation(),
        question.a,
        question.b,
        question.c
    )
}

/// Is this one of the codes by which drivers say that memory ran out?
pub(crate) fn out_of_memory(code: &ClError) -> bool {
    [CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY].contains(&code.0)
}

impl std::error::Error for OclError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Plan(error) => Some(error),
            _ => None,
        }
    }
}

impl From<PlanError> for OclError {
    fn from(error: PlanError) -> Self {
        Self::Plan(error)
    }
}
