//! STACK, BOUNDED and ADAPTIVE: batches from the top of one stack (Weber 2014, sec. 4.3, Alg. 4.1). How large a
//! batch is, `take` decides on the device.
//!
//! The host asks the device for its counts only once a draw buffer, not once a batch.

use crate::abi::Control;

/// What the plan has to do next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Take, bound, scan and split one batch.
    Batch,
    /// Dice, shade and sample what waits in the draw buffer, and empty it.
    Draw,
    /// Read the counts and pass them to [`Bounded::answer`].
    Ask,
    /// The frame is complete.
    Done,
}

/// The state between two steps.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    next: Step,
    patches: u32,
    batches_a_draw: u32,
    batches: u32,
}

impl Bounded {
    /// Starts a frame; the draw buffer must have room for `batches_a_draw` whole batches.
    #[must_use]
    pub const fn new(patches: u32, batches_a_draw: u32) -> Self {
        Self { next: Step::Batch, patches, batches_a_draw, batches: 0 }
    }

    /// The step to take now.
    pub const fn step(&mut self) -> Step {
        let now = self.next;
        self.next = match now {
            Step::Batch => {
                self.batches += 1;
                if self.batches < self.batches_a_draw { Step::Batch } else { Step::Draw }
            }
            Step::Draw => {
                self.batches = 0;
                Step::Ask
            }
            Step::Ask => Step::Batch,
            Step::Done => Step::Done,
        };
        now
    }

    /// Takes note of the counts.
    pub const fn answer(&mut self, control: &Control) {
        if control.stack == 0 && control.next_root == self.patches {
            self.next = Step::Done;
        }
    }
}
