//! The kernels' sources, and pipelines made from them.

use micropoly_core::stage::{Access, Stage};

use crate::error::WgpuError;

/// Changes a kernel file before it is compiled, given its name and source: for mutation tests. Nothing at all
/// in the place of a kernel's own file leaves that kernel out: it is opened faster, and does nothing.
pub type Edit<'a> = &'a dyn Fn(&str, &str) -> String;

/// A kernel that does nothing.
const NOTHING: &str = "@compute @workgroup_size(1) fn main() {}";

/// One WGSL file: its name and its text.
pub type File = (&'static str, &'static str);

macro_rules! files {
    ($($constant:ident: $name:literal,)*) => {
        $(const $constant: File = (concat!($name, ".wgsl"), include_str!(concat!("kernel/", $name, ".wgsl")));)*
    };
}

files! {
    GEN: "gen",
    NUM: "num",
    ITEMS: "items",
    SURFACE: "surface",
    BORDER: "border",
    BEZIER: "bezier",
    NET: "net",
    EYE: "eye",
    AS_IT_IS: "as_it_is",
    PROJECT: "project",
    INSTANCE: "instance",
    OWNER: "owner",
    HALF: "half",
    RATIONAL: "rational",
    GREGORY: "gregory",
    WEBER: "weber",
    SIDES: "sides",
    FLAT: "flat",
    BOUND: "bound",
    BOUND_BEZIER: "bound_bezier",
    BOUND_ANY: "bound_any",
    BOUND_SIZED: "bound_sized",
    BOUND_FLAT: "bound_flat",
    BOUND_BATCH: "bound_batch",
    DICE: "dice",
    DICE_BEZIER: "dice_bezier",
    DICE_ANY: "dice_any",
    DICE_GREGORY: "dice_gregory",
    DICE_RATIONAL: "dice_rational",
    DISPLACE: "displace",
    SHADE: "shade",
    SITE: "site",
    ORDER: "order",
    WIDE: "wide",
    TRIANGLE: "triangle",
    CLIP: "clip",
    SAMPLE: "sample",
    NEAR: "near",
    GENERAL: "general",
    GRIDS: "grids",
    BLOCKS: "blocks",
    BINS: "bins",
    COUNT_BINS: "count_bins",
    SCAN_BINS: "scan_bins",
    WRITE_BINS: "write_bins",
    FILL_BINS: "fill_bins",
    ROUNDS: "rounds",
    LOOPS: "loops",
    DRAW: "draw",
    CANDIDATES: "candidates",
    TILES: "tiles",
    KEYS: "keys",
    SORT_LAST: "sort_last",
    MERGE: "merge",
    BLEND: "blend",
    FILTER: "filter",
    ARRANGE_DRAW: "arrange_draw",
    ARRANGE_TILES: "arrange_tiles",
    COUNTS: "counts",
    TAKE: "take",
    TAKE_BATCH: "take_batch",
    MESH_PLACES: "mesh_places",
    MESH: "mesh",
    FLUSH: "flush",
    SCAN: "scan",
    SCAN_BATCH: "scan_batch",
    SPLIT: "split",
    SPLIT_BATCH: "split_batch",
    LOCAL: "local",
    BALANCE: "balance",
    DEAL: "deal",
    KNOWN_ANSWERS: "known_answers",
    TESS_LEVEL: "tess_level",
    TESS_DIVISION: "tess_division",
    TESS_TOPOLOGY: "tess_topology",
    TESS_STRIP: "tess_strip",
    TESS_CORNER: "tess_corner",
    TESS_EDGES: "tess_edges",
    TESS_LEVELS_OF: "tess_levels_of",
    TESS_CONTROL: "tess_control",
    TESS_PLACES: "tess_places",
    TESS_SURFACE: "tess_surface",
    TESS_VERTEX: "tess_vertex",
    TESS_EVALUATED: "tess_evaluated",
    TESS_EVALUATE: "tess_evaluate",
    ACCEL_BOX: "accel_box",
    ACCEL_EXTENT: "accel_extent",
    ACCEL_CODES: "accel_codes",
    ACCEL_SORT: "accel_sort",
    ACCEL_COUNT: "accel_count",
    ACCEL_SCAN: "accel_scan",
    ACCEL_SCATTER: "accel_scatter",
    ACCEL_TREE: "accel_tree",
    ACCEL_BOXES: "accel_boxes",
    ACCEL_QUERY: "accel_query",
    ACCEL_SEE: "accel_see",
    ACCEL_FILL: "accel_fill",
    ACCEL_OFFSET: "accel_offset",
    ACCEL_WALK: "accel_walk",
    ACCEL_RAY: "accel_ray",
    ACCEL_POINT: "accel_point",
    ACCEL_RAYS: "accel_rays",
    ACCEL_NEAREST: "accel_nearest",
    BSP_SIDES: "bsp_sides",
    BSP_PLACE: "bsp_place",
    BSP_CELLS: "bsp_cells",
    BSP_RANK: "bsp_rank",
    ARRANGE: "arrange",
}

/// The files of a kernel that bounds any patch: what it needs besides, what the frame asks for, and what goes on from there.
macro_rules! for_any_patch {
    ($($besides:ident)?; $asked:ident; $($then:ident),*) => {
        &[
            GEN, ITEMS, $($besides,)? NUM, SURFACE, BORDER, BEZIER, NET, EYE, PROJECT, INSTANCE, OWNER, HALF, RATIONAL,
            GREGORY, WEBER, SIDES, FLAT, $asked, BOUND_ANY, BOUND, $($then),*
        ]
    };
}

/// The kernels: one a stage, those into which the fused stages are cut, and those that count groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// A stage other than the two fused ones; of `bound` and `local`, what plain scenes need: Bézier patches that have their
    /// sides for themselves and are not displaced, no two objects the same ones, in our own profile, by size.
    Stage(Stage),
    /// All of `bound`, where surfaces are to be small.
    BoundAny,
    /// All of `bound`, where surfaces are to be flat.
    BoundFlat,
    /// All of `local`, where surfaces are to be small.
    LocalAny,
    /// All of `local`, where surfaces are to be flat.
    LocalFlat,
    /// Turns a batch into a number of groups.
    Arrange,
    /// The next chunk of draws.
    ArrangeDraw,
    /// Dices and shades a chunk of a plain scene.
    Draw,
    /// Dices and shades a chunk.
    DrawAny,
    /// Counts the grids of each tile.
    CountBins,
    /// Where the list of each tile starts.
    ScanBins,
    /// Writes the lists.
    WriteBins,
    /// The next round of the tiles.
    ArrangeTiles,
    /// Samples a chunk tile by tile.
    Tiles(Kind),
    /// Samples a chunk draw by draw, for a turn of sort-last.
    SortLast,
    /// The samples after the last turn.
    Merge,
}

/// A kind of grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Small and whole: 32-bit integers do, nothing is clipped.
    Near,
    /// Any other.
    General,
}

impl Which {
    /// All kernels.
    pub const ALL: [Self; 46] = [
        Self::Stage(Stage::Take),
        Self::Stage(Stage::Bound),
        Self::BoundAny,
        Self::BoundFlat,
        Self::Stage(Stage::Scan),
        Self::Stage(Stage::Split),
        Self::Stage(Stage::Local),
        Self::LocalAny,
        Self::LocalFlat,
        Self::Stage(Stage::Balance),
        Self::Stage(Stage::Deal),
        Self::Stage(Stage::Blend),
        Self::Stage(Stage::Filter),
        Self::Stage(Stage::MeshPlaces),
        Self::Stage(Stage::Mesh),
        Self::Stage(Stage::TessControl),
        Self::Stage(Stage::TessPlaces),
        Self::Stage(Stage::TessEvaluate),
        Self::Stage(Stage::AccelExtent),
        Self::Stage(Stage::AccelCodes),
        Self::Stage(Stage::AccelCount),
        Self::Stage(Stage::AccelScan),
        Self::Stage(Stage::AccelScatter),
        Self::Stage(Stage::AccelTree),
        Self::Stage(Stage::AccelBoxes),
        Self::Stage(Stage::AccelSee),
        Self::Stage(Stage::AccelFill),
        Self::Stage(Stage::AccelRays),
        Self::Stage(Stage::AccelNearest),
        Self::Stage(Stage::BspSides),
        Self::Stage(Stage::BspCells),
        Self::Stage(Stage::BspRank),
        Self::Stage(Stage::Flush),
        Self::Stage(Stage::KnownAnswers),
        Self::Arrange,
        Self::ArrangeDraw,
        Self::Draw,
        Self::DrawAny,
        Self::CountBins,
        Self::ScanBins,
        Self::WriteBins,
        Self::ArrangeTiles,
        Self::Tiles(Kind::Near),
        Self::Tiles(Kind::General),
        Self::SortLast,
        Self::Merge,
    ];

    /// Its place in [`Which::ALL`].
    pub(crate) fn index(self) -> usize {
        Self::ALL.iter().position(|which| *which == self).expect("every kernel is in the list")
    }

    /// Is it compiled only when it is first needed? Those of LOCAL, of layers, of sort-last, of
    /// meshes, of the tessellator, of trees, of BSP-grids, and for any patch and profile are.
    const fn can_wait(self) -> bool {
        matches!(
            self,
            Self::Stage(
                Stage::Local
                    | Stage::Blend
                    | Stage::MeshPlaces
                    | Stage::Mesh
                    | Stage::TessControl
                    | Stage::TessPlaces
                    | Stage::TessEvaluate
                    | Stage::AccelExtent
                    | Stage::AccelCodes
                    | Stage::AccelCount
                    | Stage::AccelScan
                    | Stage::AccelScatter
                    | Stage::AccelTree
                    | Stage::AccelBoxes
                    | Stage::AccelSee
                    | Stage::AccelFill
                    | Stage::AccelRays
                    | Stage::AccelNearest
                    | Stage::BspSides
                    | Stage::BspCells
                    | Stage::BspRank
            ) | Self::BoundAny
                | Self::BoundFlat
                | Self::LocalAny
                | Self::LocalFlat
                | Self::DrawAny
                | Self::SortLast
                | Self::Merge
        )
    }

    /// Its name in messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stage(stage) => stage.name(),
            Self::Arrange => "arrange",
            Self::ArrangeDraw => "arrange_draw",
            Self::BoundAny => "bound (any)",
            Self::BoundFlat => "bound (flat)",
            Self::LocalAny => "local (any)",
            Self::LocalFlat => "local (flat)",
            Self::Draw => "draw",
            Self::DrawAny => "draw (any)",
            Self::CountBins => "count_bins",
            Self::ScanBins => "scan_bins",
            Self::WriteBins => "write_bins",
            Self::ArrangeTiles => "arrange_tiles",
            Self::Tiles(Kind::Near) => "tiles (near)",
            Self::Tiles(Kind::General) => "tiles (general)",
            Self::SortLast => "sort_last",
            Self::Merge => "merge",
        }
    }

    /// The stages that run it.
    #[must_use]
    pub const fn stages(self) -> &'static [Stage] {
        match self {
            Self::Stage(Stage::Take) => &[Stage::Take],
            Self::Stage(Stage::Bound) | Self::BoundAny | Self::BoundFlat => &[Stage::Bound],
            Self::Stage(Stage::Scan) => &[Stage::Scan],
            Self::Stage(Stage::Split) => &[Stage::Split],
            Self::Stage(Stage::Local) | Self::LocalAny | Self::LocalFlat => &[Stage::Local],
            Self::Stage(Stage::Balance) => &[Stage::Balance],
            Self::Stage(Stage::Deal) => &[Stage::Deal],
            Self::Stage(Stage::Blend) => &[Stage::Blend],
            Self::Stage(Stage::Filter) => &[Stage::Filter],
            Self::Stage(Stage::MeshPlaces) => &[Stage::MeshPlaces],
            Self::Stage(Stage::Mesh) => &[Stage::Mesh],
            Self::Stage(Stage::TessControl) => &[Stage::TessControl],
            Self::Stage(Stage::TessPlaces) => &[Stage::TessPlaces],
            Self::Stage(Stage::TessEvaluate) => &[Stage::TessEvaluate],
            Self::Stage(Stage::AccelExtent) => &[Stage::AccelExtent],
            Self::Stage(Stage::AccelCodes) => &[Stage::AccelCodes],
            Self::Stage(Stage::AccelCount) => &[Stage::AccelCount],
            Self::Stage(Stage::AccelScan) => &[Stage::AccelScan],
            Self::Stage(Stage::AccelScatter) => &[Stage::AccelScatter],
            Self::Stage(Stage::AccelTree) => &[Stage::AccelTree],
            Self::Stage(Stage::AccelBoxes) => &[Stage::AccelBoxes],
            Self::Stage(Stage::AccelSee) => &[Stage::AccelSee],
            Self::Stage(Stage::AccelFill) => &[Stage::AccelFill],
            Self::Stage(Stage::AccelRays) => &[Stage::AccelRays],
            Self::Stage(Stage::AccelNearest) => &[Stage::AccelNearest],
            Self::Stage(Stage::BspSides) => &[Stage::BspSides],
            Self::Stage(Stage::BspCells) => &[Stage::BspCells],
            Self::Stage(Stage::BspRank) => &[Stage::BspRank],
            Self::Stage(Stage::Flush) => &[Stage::Flush],
            Self::Stage(Stage::KnownAnswers) => &[Stage::KnownAnswers],
            Self::Arrange => &[Stage::Bound, Stage::Split],
            Self::ArrangeDraw | Self::Draw | Self::DrawAny => &[Stage::Draw, Stage::SortLast],
            Self::Stage(Stage::Draw)
            | Self::CountBins
            | Self::ScanBins
            | Self::WriteBins
            | Self::ArrangeTiles
            | Self::Tiles(_) => &[Stage::Draw],
            Self::Stage(Stage::SortLast) | Self::SortLast | Self::Merge => &[Stage::SortLast],
        }
    }

    /// The files that it is put together from, in order.
    #[must_use]
    pub const fn files(self) -> &'static [File] {
        match self {
            Self::Stage(Stage::Take) => &[GEN, COUNTS, SURFACE, TAKE, TAKE_BATCH],
            Self::Stage(Stage::Bound) => &[
                GEN,
                ITEMS,
                NUM,
                SURFACE,
                BORDER,
                BEZIER,
                NET,
                EYE,
                PROJECT,
                SIDES,
                BOUND_BEZIER,
                BOUND,
                BOUND_BATCH,
            ],
            Self::BoundAny => for_any_patch!(; BOUND_SIZED; BOUND_BATCH),
            Self::BoundFlat => for_any_patch!(; BOUND_FLAT; BOUND_BATCH),
            Self::Stage(Stage::Scan) => &[GEN, COUNTS, SURFACE, BORDER, SCAN, SCAN_BATCH],
            Self::Stage(Stage::Split) => &[GEN, ITEMS, SURFACE, BORDER, SPLIT, SPLIT_BATCH],
            Self::Stage(Stage::Local) => &[
                GEN,
                ITEMS,
                COUNTS,
                NUM,
                SURFACE,
                BORDER,
                BEZIER,
                NET,
                EYE,
                PROJECT,
                SIDES,
                BOUND_BEZIER,
                BOUND,
                TAKE,
                SCAN,
                SPLIT,
                LOCAL,
            ],
            Self::LocalAny => for_any_patch!(COUNTS; BOUND_SIZED; TAKE, SCAN, SPLIT, LOCAL),
            Self::LocalFlat => for_any_patch!(COUNTS; BOUND_FLAT; TAKE, SCAN, SPLIT, LOCAL),
            Self::Stage(Stage::Balance) => &[GEN, COUNTS, BALANCE],
            Self::Stage(Stage::Deal) => &[GEN, ITEMS, SURFACE, DEAL],
            Self::Stage(Stage::Blend) => &[GEN, ITEMS, NUM, BLEND],
            Self::Stage(Stage::Filter) => &[GEN, ITEMS, NUM, ORDER, FILTER],
            Self::Stage(Stage::MeshPlaces) => &[GEN, COUNTS, SURFACE, BORDER, MESH_PLACES],
            Self::Stage(Stage::Mesh) => &[
                GEN,
                ITEMS,
                NUM,
                SURFACE,
                BORDER,
                BEZIER,
                NET,
                AS_IT_IS,
                INSTANCE,
                OWNER,
                HALF,
                GREGORY,
                DICE,
                DICE_ANY,
                DICE_GREGORY,
                DICE_RATIONAL,
                DISPLACE,
                MESH,
            ],
            Self::Stage(Stage::TessControl) => &[
                GEN,
                ITEMS,
                COUNTS,
                NUM,
                TESS_LEVEL,
                TESS_DIVISION,
                TESS_STRIP,
                TESS_TOPOLOGY,
                TESS_CORNER,
                TESS_EDGES,
                TESS_LEVELS_OF,
                TESS_CONTROL,
            ],
            Self::Stage(Stage::TessPlaces) => &[GEN, COUNTS, TESS_PLACES],
            Self::Stage(Stage::TessEvaluate) => &[
                GEN,
                ITEMS,
                COUNTS,
                NUM,
                BEZIER,
                TESS_DIVISION,
                TESS_STRIP,
                TESS_TOPOLOGY,
                TESS_CORNER,
                TESS_SURFACE,
                TESS_VERTEX,
                TESS_EVALUATED,
                TESS_EVALUATE,
            ],
            Self::Stage(Stage::AccelExtent) => &[GEN, ITEMS, ACCEL_BOX, ACCEL_EXTENT],
            Self::Stage(Stage::AccelCodes) => &[GEN, ITEMS, COUNTS, NUM, ACCEL_BOX, ACCEL_CODES],
            Self::Stage(Stage::AccelCount) => &[GEN, ITEMS, COUNTS, ACCEL_SORT, ACCEL_COUNT],
            Self::Stage(Stage::AccelScan) => &[GEN, COUNTS, ACCEL_SCAN],
            Self::Stage(Stage::AccelScatter) => &[GEN, ITEMS, COUNTS, ACCEL_SORT, ACCEL_SCATTER],
            Self::Stage(Stage::AccelTree) => &[GEN, ITEMS, ACCEL_TREE],
            Self::Stage(Stage::AccelBoxes) => &[GEN, ITEMS, ACCEL_BOX, ACCEL_BOXES],
            Self::Stage(Stage::AccelSee) => &[GEN, ITEMS, NUM, ACCEL_QUERY, ACCEL_SEE],
            Self::Stage(Stage::AccelFill) => &[GEN, ITEMS, NUM, ACCEL_QUERY, ACCEL_FILL],
            Self::Stage(Stage::AccelRays) => {
                &[GEN, ITEMS, NUM, LOOPS, ACCEL_OFFSET, ACCEL_WALK, ACCEL_RAY, ACCEL_RAYS]
            }
            Self::Stage(Stage::AccelNearest) => {
                &[GEN, ITEMS, NUM, LOOPS, ACCEL_OFFSET, ACCEL_WALK, ACCEL_POINT, ACCEL_NEAREST]
            }
            Self::Stage(Stage::BspSides) => &[GEN, ITEMS, WIDE, BSP_SIDES],
            Self::Stage(Stage::BspCells) => &[GEN, ITEMS, BSP_PLACE, BSP_CELLS],
            Self::Stage(Stage::BspRank) => &[GEN, ITEMS, NUM, LOOPS, BSP_PLACE, BSP_RANK],
            Self::Stage(Stage::Flush) => &[GEN, FLUSH],
            Self::Stage(Stage::KnownAnswers) => &[GEN, ITEMS, NUM, KNOWN_ANSWERS],
            Self::Arrange => &[GEN, ITEMS, ARRANGE],
            Self::ArrangeDraw => &[GEN, SURFACE, BORDER, SITE, GRIDS, BLOCKS, BINS, ROUNDS, ARRANGE_DRAW],
            Self::Stage(Stage::Draw) | Self::Draw => &[
                GEN,
                GRIDS,
                NUM,
                SURFACE,
                BORDER,
                BEZIER,
                NET,
                EYE,
                PROJECT,
                SITE,
                BLOCKS,
                WIDE,
                TRIANGLE,
                DICE,
                DICE_BEZIER,
                SHADE,
                DRAW,
            ],
            Self::DrawAny => &[
                GEN,
                GRIDS,
                NUM,
                SURFACE,
                BORDER,
                BEZIER,
                NET,
                EYE,
                INSTANCE,
                OWNER,
                HALF,
                GREGORY,
                PROJECT,
                SITE,
                BLOCKS,
                WIDE,
                TRIANGLE,
                DICE,
                DICE_ANY,
                DICE_GREGORY,
                DICE_RATIONAL,
                DISPLACE,
                SHADE,
                DRAW,
            ],
            Self::CountBins => &[GEN, SITE, GRIDS, BLOCKS, BINS, COUNT_BINS, FILL_BINS],
            Self::ScanBins => &[GEN, SITE, GRIDS, BLOCKS, BINS, SCAN_BINS],
            Self::WriteBins => &[GEN, SITE, GRIDS, BLOCKS, BINS, WRITE_BINS, FILL_BINS],
            Self::ArrangeTiles => &[GEN, SITE, GRIDS, BLOCKS, BINS, ROUNDS, ARRANGE_TILES],
            Self::Tiles(Kind::Near) => &[
                GEN, GRIDS, NUM, SURFACE, BORDER, PROJECT, SITE, BLOCKS, BINS, ORDER, WIDE, TRIANGLE, SAMPLE,
                CANDIDATES, NEAR, ROUNDS, LOOPS, TILES,
            ],
            Self::Tiles(Kind::General) => &[
                GEN, GRIDS, NUM, SURFACE, BORDER, PROJECT, SITE, BLOCKS, BINS, ORDER, WIDE, TRIANGLE, CLIP,
                SAMPLE, CANDIDATES, GENERAL, ROUNDS, LOOPS, TILES,
            ],
            Self::Stage(Stage::SortLast) | Self::SortLast => &[
                GEN, GRIDS, NUM, SURFACE, BORDER, PROJECT, SITE, BLOCKS, ORDER, WIDE, TRIANGLE, CLIP, SAMPLE,
                GENERAL, ROUNDS, LOOPS, KEYS, SORT_LAST,
            ],
            Self::Merge => &[GEN, ITEMS, SITE, ORDER, KEYS, MERGE],
        }
    }

    /// Its buffers: names as in the kernel, and what it does with them.
    #[must_use]
    pub fn bindings(self) -> Vec<(&'static str, Access)> {
        let read =
            |names: &[&'static str]| names.iter().map(|name| (*name, Access::Read)).collect::<Vec<_>>();
        let write =
            |names: &[&'static str]| names.iter().map(|name| (*name, Access::Write)).collect::<Vec<_>>();
        match self {
            Self::BoundAny | Self::BoundFlat => Self::Stage(Stage::Bound).bindings(),
            Self::LocalAny | Self::LocalFlat => Self::Stage(Stage::Local).bindings(),
            Self::DrawAny => Self::Draw.bindings(),
            Self::Stage(stage) => {
                let own = stage.bindings().iter().map(|binding| (binding.name, binding.access));
                own.chain(more_patches(stage)).collect()
            }
            Self::Arrange => [read(&["control"]), write(&["groups"])].concat(),
            Self::ArrangeDraw => {
                [read(&["frame", "control", "draws"]), write(&["grids", "rounds", "groups"])].concat()
            }
            Self::Draw => {
                let own = [read(&["frame", "objects", "patches", "draws"]), write(&["grids"])].concat();
                own.into_iter().chain(more_patches(Stage::Draw)).collect()
            }
            Self::CountBins | Self::WriteBins => [read(&["frame", "grids"]), write(&["bins"])].concat(),
            Self::ScanBins => [read(&["frame"]), write(&["bins"])].concat(),
            Self::ArrangeTiles => [read(&["frame", "bins"]), write(&["rounds", "groups"])].concat(),
            Self::Tiles(_) => {
                let own = read(&["frame", "draws", "grids", "bins", "behind"]);
                [own, write(&["samples", "colours", "rounds"])].concat()
            }
            Self::SortLast => {
                let own = read(&["frame", "draws", "grids", "behind", "samples"]);
                [own, write(&["colours", "keys", "rounds"])].concat()
            }
            Self::Merge => [read(&["frame"]), write(&["samples", "keys"])].concat(),
        }
    }
}

/// The second half of the patches, for stages that read patches: one buffer may be too large to be bound.
fn more_patches(stage: Stage) -> Option<(&'static str, Access)> {
    let reads_patches = stage.bindings().iter().any(|binding| binding.name == "patches");
    reads_patches.then_some(("patches_more", Access::Read))
}

/// A compiled kernel and the layout of its bindings.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    pub(crate) pipeline: wgpu::ComputePipeline,
    pub(crate) bindings: wgpu::BindGroupLayout,
}

/// A kernel, or what it will be made of when it is first needed.
#[derive(Debug)]
pub(crate) enum Slot {
    Compiled(Kernel),
    Source(String),
}

/// Compiles a kernel; of those that few frames need and that take long, only the source is kept.
pub(crate) fn prepared(
    device: &wgpu::Device,
    which: Which,
    edit: Option<Edit<'_>>,
) -> Result<Slot, WgpuError> {
    let source = source(which.files(), edit);
    if which.can_wait() {
        return Ok(Slot::Source(source));
    }
    compiled(device, which, &source).map(Slot::Compiled)
}

/// Compiles a kernel.
pub(crate) fn compiled(device: &wgpu::Device, which: Which, source: &str) -> Result<Kernel, WgpuError> {
    let access: Vec<Access> = which.bindings().iter().map(|(_, access)| *access).collect();
    compile(device, which.name(), source, &access)
}

/// A step of the tessellator that callers may write themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Which levels a patch has.
    Control,
    /// Where a vertex is.
    Evaluation,
}

impl Step {
    /// The kernel that it is a part of.
    pub(crate) const fn kernel(self) -> Which {
        match self {
            Self::Control => Which::Stage(Stage::TessControl),
            Self::Evaluation => Which::Stage(Stage::TessEvaluate),
        }
    }

    /// The file that has it, and nothing else.
    const fn file(self) -> File {
        match self {
            Self::Control => TESS_LEVELS_OF,
            Self::Evaluation => TESS_EVALUATED,
        }
    }

    /// What is to be in the place of the file.
    const fn wanted(self) -> &'static str {
        match self {
            Self::Control => "fn levels_of(index: u32) -> TessLevels",
            Self::Evaluation => "fn evaluated(index: u32, coordinates: vec3<u32>) -> TessVertex",
        }
    }
}

/// Compiles the kernel of a step with the caller's own WGSL in its place.
pub(crate) fn with_own(device: &wgpu::Device, step: Step, own: &str) -> Result<Kernel, WgpuError> {
    // A last line of the caller's may lack its end.
    let edit = |name: &str, text: &str| {
        if name == step.file().0 { format!("{own}\n") } else { text.to_owned() }
    };
    let source = source(step.kernel().files(), Some(&edit));
    compiled(device, step.kernel(), &source).map_err(|error| match error {
        WgpuError::Kernel { stage, reason } => WgpuError::Own { stage, wanted: step.wanted(), reason },
        other => other,
    })
}

/// All files after each other; [`NOTHING`] if the kernel's own is edited away.
fn source(files: &[File], edit: Option<Edit<'_>>) -> String {
    let edited = |(name, text): &File| edit.map_or_else(|| (*text).to_owned(), |edit| edit(name, text));
    let texts: Vec<String> = files.iter().map(edited).collect();
    match texts.last() {
        Some(own) if own.is_empty() => NOTHING.to_owned(),
        _ => texts.concat(),
    }
}

fn compile(
    device: &wgpu::Device,
    name: &'static str,
    source: &str,
    access: &[Access],
) -> Result<Kernel, WgpuError> {
    let errors = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let kernel = create(device, name, source, access);
    let internal = pollster::block_on(internal.pop());
    match pollster::block_on(errors.pop()).or(internal) {
        None => Ok(kernel),
        Some(error) => Err(WgpuError::Kernel { stage: name, reason: error.to_string() }),
    }
}

fn create(device: &wgpu::Device, name: &str, source: &str, access: &[Access]) -> Kernel {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let bindings = binding_layout(device, name, access);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(name),
        bind_group_layouts: &[Some(&bindings)],
        ..Default::default()
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(name),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("main"),
        // Every kernel writes its shared memory before it reads it.
        compilation_options: wgpu::PipelineCompilationOptions {
            zero_initialize_workgroup_memory: false,
            ..Default::default()
        },
        cache: None,
    });
    Kernel { pipeline, bindings }
}

fn binding_layout(device: &wgpu::Device, name: &str, access: &[Access]) -> wgpu::BindGroupLayout {
    let entry = |(place, access): (usize, &Access)| wgpu::BindGroupLayoutEntry {
        binding: place as u32,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: *access == Access::Read },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries: Vec<_> = access.iter().enumerate().map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(name), entries: &entries })
}
