//! What can go wrong in a plan, with the numbers in it.

use core::fmt;

/// A plan cannot run, or could not finish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanError {
    /// A size, option or count that no frame can have.
    Invalid {
        /// Which option.
        option: &'static str,
        /// The value that was asked for.
        value: u64,
        /// Smallest allowed value.
        least: u64,
        /// Largest allowed value.
        most: u64,
    },
    /// The memory budget is too small for the frame.
    Budget {
        /// Bytes the budget has.
        have: u64,
        /// Bytes the smallest possible plan needs.
        needed: u64,
    },
    /// BREADTH: a level needs larger buffers than the memory budget allows.
    Level {
        /// Surfaces of the level.
        surfaces: u64,
        /// Bytes the budget has.
        have: u64,
        /// Bytes that are held at once while the buffers grow, with everything else that the device holds.
        needed: u64,
    },
    /// A buffer that does not depend on the batch is larger than the device reserves in one piece.
    TooLarge {
        /// Name of the buffer.
        buffer: &'static str,
        /// Its size in bytes.
        bytes: u64,
        /// Largest size in bytes.
        limit: u64,
    },
    /// What is to be tessellated contradicts itself.
    Tessellation {
        /// In which way, and what to do about it.
        why: &'static str,
    },
    /// A device ends loops too early for a question about a tree to be answered.
    Unfinished {
        /// Name of the stage.
        stage: &'static str,
    },
    /// BREADTH cannot make a mesh: its buffers of draws have no bound.
    BreadthMesh,
    /// A buffer ran full although its size was proven: smaller buffers were passed than the plan asked for.
    Overflow {
        /// Name of the buffer.
        buffer: &'static str,
        /// Entries beyond its size that were needed.
        excess: u64,
    },
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Invalid { option, value, least, most } => {
                write!(f, "{option} is {value}, but must be {least} to {most}")
            }
            Self::Budget { have, needed } => {
                write!(
                    f,
                    "a memory budget of {have} bytes is too small; this frame needs at least {needed} bytes"
                )
            }
            Self::Level { surfaces, have, needed } => {
                write!(
                    f,
                    "a level of {surfaces} surfaces needs at least {needed} bytes, so that a memory budget of {have} bytes \
                     is too small for the breadth scheduler"
                )
            }
            Self::TooLarge { buffer, bytes, limit } => {
                write!(
                    f,
                    "the {buffer} buffer needs {bytes} bytes, but the device binds {limit} bytes at most at once"
                )
            }
            Self::Tessellation { why } => f.write_str(why),
            Self::Unfinished { stage } => {
                write!(f, "the device's driver ends loops of {stage} before they are through")
            }
            Self::BreadthMesh => {
                write!(f, "the breadth scheduler cannot make a mesh; use any other, the mesh is the same")
            }
            Self::Overflow { buffer, excess } => {
                write!(f, "the {buffer} buffer is {excess} entries too small")
            }
        }
    }
}

impl core::error::Error for PlanError {}
