//! Schedulers: how much of the stack is worked on at once, and which stage runs next. They know counts, never
//! surfaces. The image and the drawn surfaces are the same whichever is chosen.

pub mod adaptive;
mod bounded;
mod depth_first;

pub use bounded::{Bounded, Step};
pub use depth_first::for_each_draw;

/// How the stack is worked off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scheduler {
    /// One surface at a time, depth first: the reference.
    Stack,
    /// All surfaces of a level at once (Patney & Owens 2008). Its buffers grow when a level does not fit;
    /// nothing bounds them but the scene.
    Breadth,
    /// Batches of fixed size from the top of the stack, children in the place of their parents (Weber 2014,
    /// sec. 4.3).
    Bounded,
    /// Groups with a stack of their own each, in local memory; what they have left is dealt out anew after some
    /// batches, so that all have as much to do (after Weber 2014, sec. 4.4).
    Local,
    /// As many surfaces of the top, up to a batch, as are safe for the stack's capacity, however small it is:
    /// see `docs/proofs/stack.md`.
    #[default]
    Adaptive,
}

impl Scheduler {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Stack, Self::Breadth, Self::Bounded, Self::Local, Self::Adaptive];

    /// Can it do with a smaller stack than it asks for?
    #[must_use]
    pub const fn has_capacity(self) -> bool {
        matches!(self, Self::Local | Self::Adaptive)
    }

    /// Its name on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stack => "stack",
            Self::Breadth => "breadth",
            Self::Bounded => "bounded",
            Self::Local => "local",
            Self::Adaptive => "adaptive",
        }
    }
}
