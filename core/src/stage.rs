//! The stages as data: names, bindings and group sizes, so that plans are data too and mirrors can be
//! checked against this table by reflection.

use crate::abi::{
    Colour, Control, Draw, Frame, Group, Layout, Limits, MeshPlace, MeshTotals, MeshVertex, Object, Patch,
    Question, Sample, Shared, Slot, Surface, Verdict,
};

/// How a stage uses a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// It only reads.
    Read,
    /// It writes, and may read.
    Write,
}

/// One buffer that a stage needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Its name, the same on every device.
    pub name: &'static str,
    /// Layout of its entries.
    pub layout: Layout,
    /// What the stage does with it.
    pub access: Access,
}

const fn read<T: Shared>(name: &'static str) -> Binding {
    Binding { name, layout: T::LAYOUT, access: Access::Read }
}

const fn write<T: Shared>(name: &'static str) -> Binding {
    Binding { name, layout: T::LAYOUT, access: Access::Write }
}

/// How many items a stage works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Items {
    /// So many; the host knows.
    Count(u32),
    /// One a surface of the batch in flight: [`Control::taken`], known on the device.
    Taken,
    /// So many groups of LOCAL, each with all that its memory has room for.
    Groups(u32),
    /// The image, and for each part of it all draws in the draw buffer: [`Control::waiting`] +
    /// [`Control::fresh`], known on the device.
    Image {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Dice rate: [`crate::abi::Frame::rate`].
        rate: u32,
    },
}

/// The stages of a frame, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// The next batch: [`crate::kernel::take`].
    Take,
    /// Cull, draw or split: [`crate::kernel::bound`].
    Bound,
    /// Places of all outputs: [`crate::kernel::scan`].
    Scan,
    /// Children to the stack, the rest to the draw buffer: [`crate::kernel::split`].
    Split,
    /// LOCAL: each group works on its own stack: [`crate::kernel::local`].
    Local,
    /// LOCAL: counts, and what each group will have next: [`crate::kernel::balance`].
    Balance,
    /// LOCAL: surfaces to their new groups, draws to the draw buffer: [`crate::kernel::deal`].
    Deal,
    /// Dice, shade and sample each drawn surface, fused: [`crate::kernel::dice`],
    /// [`crate::kernel::shade`], [`crate::kernel::sample`].
    Draw,
    /// Places of all drawn surfaces in a mesh: [`crate::kernel::mesh::places`].
    MeshPlaces,
    /// Dice each drawn surface into a mesh: [`crate::kernel::mesh::mesh`].
    Mesh,
    /// Empties the draw buffer: [`crate::kernel::take::flush`].
    Flush,
    /// Does the device compute as it must? [`crate::kernel::known_answers`].
    KnownAnswers,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 12] = [
        Self::Take,
        Self::Bound,
        Self::Scan,
        Self::Split,
        Self::Local,
        Self::Balance,
        Self::Deal,
        Self::Draw,
        Self::MeshPlaces,
        Self::Mesh,
        Self::Flush,
        Self::KnownAnswers,
    ];

    /// Its name: that of its file on every device.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Take => "take",
            Self::Bound => "bound",
            Self::Scan => "scan",
            Self::Split => "split",
            Self::Local => "local",
            Self::Balance => "balance",
            Self::Deal => "deal",
            Self::Draw => "draw",
            Self::MeshPlaces => "mesh_places",
            Self::Mesh => "mesh",
            Self::Flush => "flush",
            Self::KnownAnswers => "known_answers",
        }
    }

    /// The buffers it needs, in the order in which they are passed.
    #[must_use]
    pub const fn bindings(self) -> &'static [Binding] {
        match self {
            Self::Take => {
                const { &[read::<Limits>("limits"), read::<Surface>("stack"), write::<Control>("control")] }
            }
            Self::Bound => {
                const {
                    &[
                        read::<Frame>("frame"),
                        read::<Object>("objects"),
                        read::<Patch>("patches"),
                        read::<Control>("control"),
                        read::<Surface>("stack"),
                        write::<Surface>("batch"),
                        write::<Verdict>("verdicts"),
                    ]
                }
            }
            Self::Scan => {
                const {
                    &[
                        read::<Limits>("limits"),
                        read::<Verdict>("verdicts"),
                        write::<Slot>("slots"),
                        write::<Control>("control"),
                    ]
                }
            }
            Self::Split => {
                const {
                    &[
                        read::<Control>("control"),
                        read::<Surface>("batch"),
                        read::<Verdict>("verdicts"),
                        read::<Slot>("slots"),
                        write::<Surface>("stack"),
                        write::<Draw>("draws"),
                    ]
                }
            }
            Self::Local => {
                const {
                    &[
                        read::<Frame>("frame"),
                        read::<Object>("objects"),
                        read::<Patch>("patches"),
                        read::<Surface>("dealt"),
                        write::<Group>("groups"),
                        write::<Surface>("stack"),
                        write::<Draw>("fresh"),
                    ]
                }
            }
            Self::Balance => {
                const { &[read::<Limits>("limits"), write::<Group>("groups"), write::<Control>("control")] }
            }
            Self::Deal => {
                const {
                    &[
                        read::<Control>("control"),
                        read::<Group>("groups"),
                        read::<Surface>("stack"),
                        read::<Draw>("fresh"),
                        write::<Surface>("dealt"),
                        write::<Draw>("draws"),
                    ]
                }
            }
            Self::Draw => {
                const {
                    &[
                        read::<Frame>("frame"),
                        read::<Object>("objects"),
                        read::<Patch>("patches"),
                        read::<Control>("control"),
                        read::<Draw>("draws"),
                        write::<Sample>("samples"),
                        write::<Colour>("colours"),
                    ]
                }
            }
            Self::MeshPlaces => {
                const {
                    &[
                        read::<Control>("control"),
                        read::<Draw>("draws"),
                        write::<MeshPlace>("places"),
                        write::<MeshTotals>("totals"),
                    ]
                }
            }
            Self::Mesh => {
                const {
                    &[
                        read::<Frame>("frame"),
                        read::<Object>("objects"),
                        read::<Patch>("patches"),
                        read::<Draw>("draws"),
                        read::<MeshPlace>("places"),
                        write::<MeshVertex>("vertices"),
                        write::<u32>("indices"),
                    ]
                }
            }
            Self::Flush => const { &[write::<Control>("control")] },
            Self::KnownAnswers => {
                const { &[read::<Frame>("frame"), read::<Question>("questions"), write::<u32>("answers")] }
            }
        }
    }
}
