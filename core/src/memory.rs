//! How much memory a frame can ever need, as `const fn`s that every allocation uses.
//!
//! The bound on the surface stack sharpens Weber 2014, sec. 4.3: `n` roots, batches of `p`, levels
//! `0 .. k`, where level `k - 1` is never split. The stack stays sorted by level, and a batch that is full
//! always takes the deepest surfaces, so each level below the roots can leave at most one batch behind. Roots
//! that wait are counted, not stored, so `n` has no part in it. `docs/proofs/stack.md` has the proof.

use crate::abi::{
    Colour, Control, Draw, FLAG_LAYERS, Frame, Group, LOCAL_BATCH, LOCAL_DRAWS, LOCAL_STACK, Limits,
    MAX_LEVELS, MAX_RESOLUTION, Object, Patch, Pixel, Sample, Slot, Surface, Tap, Verdict,
};
use crate::error::PlanError;
use crate::schedule::Scheduler;

/// Largest stack.
pub const MAX_STACK: u64 = 1 << 31;
/// Batches for which ADAPTIVE has room beyond the smallest stack.
const ADAPTIVE_BATCHES: u64 = 4;
/// Largest batch that can be asked for.
pub const MAX_BATCH: u32 = 1 << 24;
/// Batch where neither batch nor memory is asked for: the buffers of a batch fit a second-level cache.
pub const DEFAULT_BATCH: u32 = 4096;
/// Most roots that can be listed at once.
pub const MOST_LISTED: u32 = 1 << 20;
/// The draw buffer holds several small batches, so that there is enough to rasterise at once …
const DRAW_BATCHES: u32 = 8;
/// … but no more than this many surfaces, unless a single batch is larger.
const DRAW_TARGET: u32 = 1 << 16;

/// Exact maximum of the stack for `n` roots, batches of `p` and `k` levels; all at least 1.
///
/// No more than `p` roots are taken at once. While a batch is not yet full everything can double; from then on
/// each level adds at most `p`.
#[must_use]
pub const fn stack_exact(n: u64, p: u64, k: u64) -> u64 {
    if k < 2 {
        return 0; // nothing is ever split
    }
    let (mut most, mut levels_left) = (if n < p { n } else { p }, k - 1);
    while levels_left > 0 && most < p {
        most *= 2;
        levels_left -= 1;
    }
    most.saturating_add(p.saturating_mul(levels_left))
}

/// Closed form that is never below [`stack_exact`], and equal to it for `n` ≥ `p` and `k` ≥ 2.
#[must_use]
pub const fn stack_bound(p: u64, k: u64) -> u64 {
    p.saturating_mul(k)
}

/// Smallest stack with which any scheduler can finish, however many roots there are: one surface at a time, depth
/// first.
#[must_use]
pub const fn stack_min(k: u64) -> u64 {
    k
}

/// Entries of the stack for ADAPTIVE: the capacity that was asked for, or, for 0, a few batches beyond the
/// smallest, which is hardly ever slower than the exact maximum; never more than that.
#[must_use]
pub const fn stack_adaptive(n: u64, p: u64, k: u64, capacity: u64) -> u64 {
    let wanted = if capacity > 0 { capacity } else { stack_min(k) + ADAPTIVE_BATCHES * p };
    let most = stack_exact(n, p, k);
    if wanted < most { wanted } else { most }
}

/// Entries of the stack of one of LOCAL's groups: its share of the capacity that was asked for, or, for 0, a few
/// batches beyond the smallest; never more than local memory has room for.
#[must_use]
pub const fn stack_local(groups: u64, k: u64, capacity: u64) -> u64 {
    let most = LOCAL_STACK as u64;
    let wanted =
        if capacity > 0 { capacity / groups } else { stack_min(k) + ADAPTIVE_BATCHES * LOCAL_BATCH as u64 };
    if wanted < most { wanted } else { most }
}

/// Sizes of all buffers of one frame, in entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Patches of the scene.
    pub patches: u32,
    /// Records of patches, and of what some kinds need besides: fewer than patches where objects have the same ones.
    pub records: u32,
    /// Objects of the scene.
    pub objects: u32,
    /// Roots that can be listed at once, up to [`MOST_LISTED`]; 0 = always all patches are roots.
    pub listed: u32,
    /// Surfaces a batch.
    pub batch: u32,
    /// How the stack is worked off.
    pub scheduler: Scheduler,
    /// Entries of the stack, or of all groups' stacks; 0 = what the scheduler asks for. Only ADAPTIVE and LOCAL can
    /// have less than that.
    pub capacity: u32,
    /// Levels `k`.
    pub levels: u32,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// What of the image is worked on at once; set from the frame.
    pub area: Area,
}

/// Buffers of the part of an image that is worked on at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// Samples.
    pub samples: u64,
    /// Pixels that are shown.
    pub pixels: u64,
    /// Samples that a pixel is made of.
    pub taps: u32,
    /// Can anything be seen through?
    pub layered: bool,
}

impl Area {
    /// Of a frame.
    #[must_use]
    pub const fn of(frame: &Frame) -> Self {
        Self {
            samples: frame.sample_count(),
            pixels: frame.shown_count(),
            taps: frame.taps,
            layered: frame.flags & FLAG_LAYERS != 0,
        }
    }

    /// As much as this or another area needs.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        const fn larger(a: u64, b: u64) -> u64 {
            if a > b { a } else { b }
        }
        Self {
            samples: larger(self.samples, other.samples),
            pixels: larger(self.pixels, other.pixels),
            taps: larger(self.taps as u64, other.taps as u64) as u32,
            layered: self.layered || other.layered,
        }
    }

    /// Entries of each buffer that only layers need; one if nothing can be seen through.
    #[must_use]
    pub const fn layer_entries(&self) -> u64 {
        if self.layered { self.samples } else { 1 }
    }

    /// Bytes of all its buffers.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        let (sample, colour) = (size_of::<Sample>() as u64, size_of::<Colour>() as u64);
        self.samples * (sample + colour)
            + self.layer_entries() * (2 * sample + colour)
            + self.pixels * size_of::<Pixel>() as u64
            + self.taps as u64 * size_of::<Tap>() as u64
            + size_of::<u32>() as u64
    }
}

impl Sizes {
    /// Checks every size against its limits.
    ///
    /// # Errors
    /// [`PlanError::Invalid`] names the first size that no frame can have.
    pub const fn checked(self) -> Result<Self, PlanError> {
        let limits = [
            ("number of patches", self.patches, 1, u32::MAX / 2),
            ("number of records of patches", self.records, 1, u32::MAX / 2),
            ("number of objects", self.objects, 1, u32::MAX / 2),
            ("number of roots in a list", self.listed, 0, MOST_LISTED),
            ("batch", self.batch, 1, MAX_BATCH),
            ("number of levels (max-depth)", self.levels, 1, MAX_LEVELS),
            ("image width", self.width, 1, MAX_RESOLUTION),
            ("image height", self.height, 1, MAX_RESOLUTION),
        ];
        let mut index = 0;
        while index < limits.len() {
            let (option, value, least, most) = limits[index];
            if value < least || value > most {
                return Err(invalid(option, value as u64, least as u64, most as u64));
            }
            index += 1;
        }
        let least = stack_min(self.levels as u64);
        if self.capacity != 0 && (self.capacity as u64) < least {
            return Err(invalid("number of stack entries (stack)", self.capacity as u64, least, MAX_STACK));
        }
        if self.stack_entries() > MAX_STACK {
            return Err(invalid("surface stack", self.stack_entries(), 1, MAX_STACK));
        }
        match self.scheduler {
            Scheduler::Stack => Ok(Self { batch: 1, ..self }),
            // Buffers grow to a level's size; a draw follows every level.
            Scheduler::Breadth => Ok(Self { batch: self.patches, ..self }),
            _ => Ok(self),
        }
    }

    /// Surfaces that the stack must hold; at least one, so that there is a buffer.
    #[must_use]
    pub const fn stack_entries(&self) -> u64 {
        let (n, p, k) = (self.patches as u64, self.batch as u64, self.levels as u64);
        let entries = match self.scheduler {
            Scheduler::Stack => stack_exact(n, 1, k),
            Scheduler::Bounded => stack_exact(n, p, k),
            Scheduler::Adaptive => stack_adaptive(n, p, k, self.capacity as u64),
            Scheduler::Local => self.groups() as u64 * self.group_stack(),
            Scheduler::Breadth => 2 * n,
        };
        if entries > 1 { entries } else { 1 }
    }

    /// Groups of LOCAL: enough for a batch, but no more than the capacity has a stack for.
    #[must_use]
    pub const fn groups(&self) -> u32 {
        let wanted = self.batch.div_ceil(LOCAL_BATCH);
        let most = self.capacity / stack_min(self.levels as u64) as u32;
        if self.capacity == 0 || wanted < most { wanted } else { most }
    }

    /// Entries of the stack of one of LOCAL's groups.
    #[must_use]
    pub const fn group_stack(&self) -> u64 {
        stack_local(self.groups() as u64, self.levels as u64, self.capacity as u64)
    }

    const fn if_local(&self, entries: u64, otherwise: u64) -> u64 {
        match self.scheduler {
            Scheduler::Local => entries,
            _ => otherwise,
        }
    }

    /// Surfaces that the buffers of a batch must hold; LOCAL has none.
    #[must_use]
    pub const fn batch_entries(&self) -> u64 {
        self.if_local(1, self.batch as u64)
    }

    /// Entries of the buffer of LOCAL's groups.
    #[must_use]
    pub const fn group_entries(&self) -> u64 {
        self.if_local(self.groups() as u64, 1)
    }

    /// Surfaces that can be dealt to LOCAL's groups: as many as their stacks hold.
    #[must_use]
    pub const fn dealt_entries(&self) -> u64 {
        self.if_local(self.stack_entries(), 1)
    }

    /// Surfaces that LOCAL's groups can draw in a round.
    #[must_use]
    pub const fn fresh_entries(&self) -> u64 {
        self.if_local(self.groups() as u64 * LOCAL_DRAWS as u64, 1)
    }

    /// Surfaces that can be drawn before the host can look: in a batch, or in a round of LOCAL's groups.
    const fn draws_at_once(&self) -> u64 {
        self.if_local(self.fresh_entries(), self.batch as u64)
    }

    /// Proven maximum of the stack; BREADTH has none.
    #[must_use]
    pub const fn stack_bound(&self) -> Option<u64> {
        match self.scheduler {
            Scheduler::Breadth => None,
            _ => Some(self.stack_entries()),
        }
    }

    /// Batches after which the draw buffer may be full.
    #[must_use]
    pub const fn batches_a_draw(&self) -> u32 {
        let fitting = DRAW_TARGET as u64 / self.draws_at_once();
        if fitting < 1 {
            1
        } else if fitting > DRAW_BATCHES as u64 {
            DRAW_BATCHES
        } else {
            fitting as u32
        }
    }

    /// Surfaces that the draw buffer must hold.
    #[must_use]
    pub const fn draw_entries(&self) -> u64 {
        self.draws_at_once() * self.batches_a_draw() as u64
    }

    /// Bytes of everything that does not depend on batch and scheduler: scene, and what of the image is worked on.
    #[must_use]
    pub const fn fixed_bytes(&self) -> u64 {
        self.patch_bytes()
            + self.objects as u64 * size_of::<Object>() as u64
            + self.root_entries() * size_of::<u32>() as u64
            + self.area.bytes()
            + (size_of::<Frame>() + size_of::<Control>() + size_of::<Limits>()) as u64
    }

    /// Bytes of all buffers together.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        let batch_entry = size_of::<Surface>() + size_of::<Verdict>() + size_of::<Slot>();
        self.fixed_bytes()
            + self.stack_entries() * size_of::<Surface>() as u64
            + self.batch_entries() * batch_entry as u64
            + self.local_bytes()
            + self.draw_entries() * size_of::<Draw>() as u64
    }

    /// Bytes of what LOCAL's groups need beside their stacks; next to nothing for the other schedulers.
    #[must_use]
    pub const fn local_bytes(&self) -> u64 {
        self.group_entries() * size_of::<Group>() as u64
            + self.dealt_entries() * size_of::<Surface>() as u64
            + self.fresh_entries() * size_of::<Draw>() as u64
    }

    /// Entries of the buffer of patches.
    #[must_use]
    pub const fn patch_entries(&self) -> u64 {
        self.records as u64
    }

    /// Entries of the list of roots; one if there is none.
    #[must_use]
    pub const fn root_entries(&self) -> u64 {
        if self.listed > 1 { self.listed as u64 } else { 1 }
    }

    const fn patch_bytes(&self) -> u64 {
        self.patch_entries() * size_of::<Patch>() as u64
    }

    /// Name and bytes of the largest buffer but the patches'.
    const fn largest_buffer(&self) -> (&'static str, u64) {
        let all = [
            ("objects", self.objects as u64 * size_of::<Object>() as u64),
            ("samples", self.area.samples * size_of::<Sample>() as u64),
            ("colours", self.area.samples * size_of::<Colour>() as u64),
            ("pixels", self.area.pixels * size_of::<Pixel>() as u64),
            ("stack", self.stack_entries() * size_of::<Surface>() as u64),
            ("draws", self.draw_entries() * size_of::<Draw>() as u64),
            ("batch", self.batch_entries() * size_of::<Surface>() as u64),
            ("fresh", self.fresh_entries() * size_of::<Draw>() as u64),
            ("roots", self.root_entries() * size_of::<u32>() as u64),
        ];
        let (mut largest, mut index) = (all[0], 1);
        while index < all.len() {
            if all[index].1 > largest.1 {
                largest = all[index];
            }
            index += 1;
        }
        largest
    }

    /// The buffer that is larger than what the device can reserve.
    const fn too_large(&self, room: Room) -> Option<PlanError> {
        let (bytes, limit) = (self.patch_bytes(), room.patch_bytes);
        if bytes > limit {
            return Some(PlanError::TooLarge { buffer: "patches", bytes, limit });
        }
        let (buffer, bytes) = self.largest_buffer();
        let limit = room.buffer_bytes;
        if bytes > limit { Some(PlanError::TooLarge { buffer, bytes, limit }) } else { None }
    }

    const fn fit(&self, room: Room) -> bool {
        self.bytes().saturating_add(room.taken) <= room.bytes && self.too_large(room).is_none()
    }

    /// The same frame with the largest batch, up to its own, whose buffers fit.
    ///
    /// # Errors
    /// If a batch of one surface does not fit: [`PlanError::TooLarge`] names a buffer,
    /// [`PlanError::Budget`] the smallest budget.
    pub const fn fitted(self, room: Room) -> Result<Self, PlanError> {
        if self.fit(room) {
            return Ok(self);
        }
        let smallest = match self.scheduler {
            // A level is a batch, and all patches are the first.
            Scheduler::Breadth => self,
            _ => Self { batch: 1, ..self },
        };
        if !smallest.fit(room) {
            if let Some(error) = smallest.too_large(room) {
                return Err(error);
            }
            let needed = smallest.bytes().saturating_add(room.taken);
            return Err(PlanError::Budget { have: room.bytes, needed });
        }
        let (mut fits, mut beyond) = (1, self.batch);
        while beyond - fits > 1 {
            let middle = fits + (beyond - fits) / 2;
            if (Self { batch: middle, ..self }).fit(room) {
                fits = middle;
            } else {
                beyond = middle;
            }
        }
        Ok(Self { batch: fits, ..self })
    }
}

/// What a frame's buffers must fit into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Room {
    /// Bytes of all buffers together.
    pub bytes: u64,
    /// Bytes of these that the device takes for itself.
    pub taken: u64,
    /// Bytes of the largest single buffer, unless it is that of the patches.
    pub buffer_bytes: u64,
    /// Bytes of the largest buffer of patches.
    pub patch_bytes: u64,
}

impl Room {
    /// No end of it.
    pub const UNLIMITED: Self =
        Self { bytes: u64::MAX, taken: 0, buffer_bytes: u64::MAX, patch_bytes: u64::MAX };
}

const fn invalid(option: &'static str, value: u64, least: u64, most: u64) -> PlanError {
    PlanError::Invalid { option, value, least, most }
}

// The published configuration of Weber 2014: 1024 roots, batches of 256, 25 levels in 7168 entries; without the
// roots that wait it takes 6400.
const _: () = assert!(stack_exact(1024, 256, 25) == 6400);
