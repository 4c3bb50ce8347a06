//! The stages as data: names, bindings and group sizes, so that plans are data too and mirrors can be
//! checked against this table by reflection.

use crate::abi::{
    AccelFrame, Bounds, BspFrame, BspNode, BspPlane, Colour, Control, Draw, FLAG_SORT_LAST, Finding, Frame,
    Frustum, Group, Layout, Limits, MeshPlace, MeshTotals, MeshVertex, Node, Object, Patch, Pixel, Probe,
    Question, Sample, Shared, Slot, SortKey, Surface, Tap, TessFrame, TessLevels, TessPatch, TessRecord,
    TessTotals, TessVertex, Triangle, Verdict,
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
    /// The frame's samples, and for each part of them all draws in the draw buffer: [`Control::waiting`] +
    /// [`Control::fresh`], known on the device.
    Image(Extent),
}

/// What a device must know of a frame to draw it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Columns of samples.
    pub columns: u32,
    /// Rows of samples.
    pub rows: u32,
    /// Log2 of the columns (and rows) of samples of a tile; 0 = as the device likes it.
    pub tile_bits: u32,
    /// Dice rate: [`Frame::rate`].
    pub rate: u32,
    /// Samples of the buffers: those of a blurred frame are more than its columns times rows.
    pub samples: u64,
    /// Is it drawn sort-last?
    pub sort_last: bool,
}

impl Extent {
    /// Of a frame whose buffers have so many samples.
    #[must_use]
    pub const fn of(frame: &Frame, samples: u64) -> Self {
        Self {
            columns: frame.sample_right.saturating_sub(frame.sample_left),
            rows: frame.sample_bottom.saturating_sub(frame.sample_top),
            tile_bits: frame.tile_bits,
            rate: frame.rate,
            samples,
            sort_last: frame.flags & FLAG_SORT_LAST != 0,
        }
    }
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
    /// [`crate::kernel::shade`], [`crate::kernel::sample`]. Sort-middle: grids are sorted into tiles of the image, and a
    /// tile's samples are found together (Eisenacher & Loop 2010).
    Draw,
    /// The same, sort-last: each grid is sampled by itself, wherever it is, and samples are merged without locks: who is
    /// nearest, then who of those has the smallest identity, and only that one's colour ([`crate::kernel::sort_last`]).
    SortLast,
    /// The layer found goes behind those before it: [`crate::kernel::blend`].
    Blend,
    /// Samples become pixels: [`crate::kernel::filter`].
    Filter,
    /// Places of all drawn surfaces in a mesh: [`crate::kernel::mesh::places`].
    MeshPlaces,
    /// Dice each drawn surface into a mesh: [`crate::kernel::mesh::mesh`].
    Mesh,
    /// The tessellator: levels of each patch, and what it becomes: [`crate::kernel::tess_control`].
    TessControl,
    /// The tessellator: where patches go in a chunk: [`crate::kernel::tess_places`].
    TessPlaces,
    /// The tessellator: vertices and indices: [`crate::kernel::tess_evaluate`].
    TessEvaluate,
    /// Trees: the box about all primitives: [`crate::accel::extent`].
    AccelExtent,
    /// Trees: where primitives are: [`crate::accel::morton`].
    AccelCodes,
    /// Trees: how many keys of each block have which digit: [`crate::accel::sort::count`].
    AccelCount,
    /// Trees: sums of the counts before each: [`crate::accel::sort::scan`].
    AccelScan,
    /// Trees: keys to their places: [`crate::accel::sort::scatter`].
    AccelScatter,
    /// Trees: children and parents: [`crate::accel::hierarchy`].
    AccelTree,
    /// Trees: boxes from the leaves upwards: [`crate::accel::tree::fit`].
    AccelBoxes,
    /// Trees: how many leaves of each block a frustum sees: [`crate::accel::query`].
    AccelSee,
    /// Trees: which ones: [`crate::accel::query`].
    AccelFill,
    /// Trees: what rays hit first: [`crate::accel::ray`].
    AccelRays,
    /// Trees: what is nearest to points: [`crate::accel::nearest`].
    AccelNearest,
    /// BSP-grids: which planes the eye is before: [`crate::accel::bsp::plane`].
    BspSides,
    /// BSP-grids: how many pieces the cells have, far to near: [`crate::accel::bsp::cells`].
    BspCells,
    /// BSP-grids: the order of all pieces: [`crate::accel::bsp::rank`].
    BspRank,
    /// Empties the draw buffer: [`crate::kernel::take::flush`].
    Flush,
    /// Does the device compute as it must? [`crate::kernel::known_answers`].
    KnownAnswers,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 32] = [
        Self::Take,
        Self::Bound,
        Self::Scan,
        Self::Split,
        Self::Local,
        Self::Balance,
        Self::Deal,
        Self::Draw,
        Self::SortLast,
        Self::Blend,
        Self::Filter,
        Self::MeshPlaces,
        Self::Mesh,
        Self::TessControl,
        Self::TessPlaces,
        Self::TessEvaluate,
        Self::AccelExtent,
        Self::AccelCodes,
        Self::AccelCount,
        Self::AccelScan,
        Self::AccelScatter,
        Self::AccelTree,
        Self::AccelBoxes,
        Self::AccelSee,
        Self::AccelFill,
        Self::AccelRays,
        Self::AccelNearest,
        Self::BspSides,
        Self::BspCells,
        Self::BspRank,
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
            Self::SortLast => "sort_last",
            Self::Blend => "blend",
            Self::Filter => "filter",
            Self::MeshPlaces => "mesh_places",
            Self::Mesh => "mesh",
            Self::TessControl => "tess_control",
            Self::TessPlaces => "tess_places",
            Self::TessEvaluate => "tess_evaluate",
            Self::AccelExtent => "accel_extent",
            Self::AccelCodes => "accel_codes",
            Self::AccelCount => "accel_count",
            Self::AccelScan => "accel_scan",
            Self::AccelScatter => "accel_scatter",
            Self::AccelTree => "accel_tree",
            Self::AccelBoxes => "accel_boxes",
            Self::AccelSee => "accel_see",
            Self::AccelFill => "accel_fill",
            Self::AccelRays => "accel_rays",
            Self::AccelNearest => "accel_nearest",
            Self::BspSides => "bsp_sides",
            Self::BspCells => "bsp_cells",
            Self::BspRank => "bsp_rank",
            Self::Flush => "flush",
            Self::KnownAnswers => "known_answers",
        }
    }

    /// The buffers it needs, in the order in which they are passed.
    #[must_use]
    pub const fn bindings(self) -> &'static [Binding] {
        match self {
            Self::Take => {
                const {
                    &[
                        read::<Limits>("limits"),
                        read::<u32>("roots"),
                        read::<Surface>("stack"),
                        write::<Surface>("batch"),
                        write::<Control>("control"),
                    ]
                }
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
                        read::<u32>("roots"),
                        read::<Group>("groups"),
                        read::<Surface>("stack"),
                        read::<Draw>("fresh"),
                        write::<Surface>("dealt"),
                        write::<Draw>("draws"),
                    ]
                }
            }
            Self::Draw | Self::SortLast => {
                const {
                    &[
                        read::<Frame>("frame"),
                        read::<Object>("objects"),
                        read::<Patch>("patches"),
                        read::<Control>("control"),
                        read::<Draw>("draws"),
                        read::<Sample>("behind"),
                        write::<Sample>("samples"),
                        write::<Colour>("colours"),
                    ]
                }
            }
            Self::Blend => {
                const {
                    &[
                        write::<Sample>("samples"),
                        read::<Colour>("colours"),
                        write::<Sample>("behind"),
                        write::<Sample>("front"),
                        write::<Colour>("layers"),
                        write::<u32>("more"),
                    ]
                }
            }
            Self::Filter => {
                const {
                    &[
                        read::<Frame>("frame"),
                        read::<Tap>("taps"),
                        read::<Sample>("samples"),
                        read::<Colour>("colours"),
                        write::<Pixel>("pixels"),
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
            Self::TessControl => {
                const {
                    &[
                        read::<TessFrame>("tess_frame"),
                        read::<TessPatch>("tess_patches"),
                        read::<TessLevels>("levels"),
                        write::<TessRecord>("records"),
                    ]
                }
            }
            Self::TessPlaces => {
                const {
                    &[
                        read::<TessFrame>("tess_frame"),
                        write::<TessRecord>("records"),
                        write::<TessTotals>("totals"),
                    ]
                }
            }
            Self::TessEvaluate => {
                const {
                    &[
                        read::<TessFrame>("tess_frame"),
                        read::<TessPatch>("tess_patches"),
                        read::<f32>("heights"),
                        read::<TessRecord>("records"),
                        read::<TessTotals>("totals"),
                        write::<TessVertex>("tess_vertices"),
                        write::<u32>("indices"),
                    ]
                }
            }
            Self::AccelExtent => {
                const { &[read::<AccelFrame>("accel_frame"), read::<Bounds>("boxes"), write::<u32>("extent")] }
            }
            Self::AccelCodes => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<Bounds>("boxes"),
                        read::<u32>("extent"),
                        write::<SortKey>("keys"),
                    ]
                }
            }
            Self::AccelCount => {
                const { &[read::<AccelFrame>("accel_frame"), read::<SortKey>("keys"), write::<u32>("counts")] }
            }
            Self::AccelScan => const { &[read::<AccelFrame>("accel_frame"), write::<u32>("counts")] },
            Self::AccelScatter => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<SortKey>("keys"),
                        read::<u32>("counts"),
                        write::<SortKey>("sorted"),
                    ]
                }
            }
            Self::AccelTree => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<SortKey>("keys"),
                        write::<Node>("nodes"),
                        write::<u32>("parents"),
                    ]
                }
            }
            Self::AccelBoxes => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<Bounds>("boxes"),
                        read::<u32>("parents"),
                        write::<u32>("visits"),
                        write::<Node>("nodes"),
                    ]
                }
            }
            Self::AccelSee => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<Node>("nodes"),
                        read::<Frustum>("frusta"),
                        write::<u32>("counts"),
                    ]
                }
            }
            Self::AccelFill => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<Node>("nodes"),
                        read::<Frustum>("frusta"),
                        read::<u32>("counts"),
                        write::<u32>("seen"),
                    ]
                }
            }
            Self::AccelRays | Self::AccelNearest => {
                const {
                    &[
                        read::<AccelFrame>("accel_frame"),
                        read::<Node>("nodes"),
                        read::<Triangle>("triangles"),
                        read::<Probe>("probes"),
                        write::<Finding>("found"),
                    ]
                }
            }
            Self::BspSides => {
                const { &[read::<BspFrame>("bsp_frame"), read::<BspPlane>("planes"), write::<u32>("is_before")] }
            }
            Self::BspCells => {
                const { &[read::<BspFrame>("bsp_frame"), read::<u32>("first_pieces"), write::<u32>("counts")] }
            }
            Self::BspRank => {
                const {
                    &[
                        read::<BspFrame>("bsp_frame"),
                        read::<BspNode>("bsp_nodes"),
                        read::<u32>("first_nodes"),
                        read::<u32>("first_pieces"),
                        read::<u32>("is_before"),
                        read::<u32>("counts"),
                        write::<u32>("places"),
                        write::<u32>("order"),
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
