//! A whole tessellation, in chunks that fit a memory budget.
//!
//! Control runs once and says how large the mesh is. Then, as often as it takes: places for as many patches as there is room
//! for, their vertices and indices, and whoever wants them is called.

use core::ops::ControlFlow;

use crate::abi::{
    Shared, TESS_BEZIER, TESS_GIVEN, TESS_ISOLINES, TESS_PN, TESS_TRIANGLES, TessFrame, TessLevels,
    TessPatch, TessRecord, TessTotals, TessVertex,
};
use crate::backend::Device;
use crate::error::PlanError;
use crate::kernel::tess_evaluate::corners;
use crate::stage::{Items, Stage};

/// Vertices of the largest patch: a quadrilateral of level 64.
pub const MOST_VERTICES: u64 = 65 * 65;
/// Primitives of the largest patch.
pub const MOST_PRIMITIVES: u64 = 2 * 64 * 64;

/// Most columns and rows of a height map.
const MOST_TEXELS: u32 = 1 << 24;

/// What is tessellated.
#[derive(Clone, Copy, Debug)]
pub struct TessInput<'a> {
    /// How; [`TessFrame::patch_count`] is set by the plan.
    pub frame: TessFrame,
    /// The patches. Coordinates are up to 2⁴⁰ in magnitude, normals about 1 long, texture coordinates up to 2²⁰. Lengths below
    /// 2⁻²⁰ are taken for that where levels and PN triangles are found by lengths.
    pub patches: &'a [TessPatch],
    /// A level a patch with [`crate::abi::TESS_GIVEN`], else nothing.
    pub levels: &'a [TessLevels],
    /// Heights, row by row, if [`TessFrame::columns`] is not 0.
    pub heights: &'a [f32],
}

/// How a tessellation goes through a memory budget.
#[derive(Clone, Copy, Debug)]
pub struct TessPlan<'a> {
    input: &'a TessInput<'a>,
    frame: TessFrame,
    memory: u64,
}

/// What a tessellation comes to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TessCounts {
    /// Vertices of all patches.
    pub vertices: u64,
    /// Triangles or lines of all patches.
    pub primitives: u64,
    /// Chunks.
    pub chunks: u64,
}

/// Buffers of a tessellation in the device's memory.
#[derive(Debug)]
pub struct TessBuffers<B> {
    frame: B,
    patches: B,
    heights: B,
    /// Entries are [`TessRecord`], one a patch.
    pub records: B,
    totals: B,
    /// Entries are [`TessVertex`].
    pub vertices: B,
    /// Entries are `u32`.
    pub indices: B,
    rooms: [u32; 2],
    counts: TessCounts,
}

impl<B> TessBuffers<B> {
    /// What the whole mesh comes to, known before the first chunk; but for how many chunks it takes.
    #[must_use]
    pub const fn counts(&self) -> TessCounts {
        self.counts
    }
}

/// A part of the mesh, whole patches of it, at the start of the buffers.
#[derive(Debug)]
pub struct Chunk<'a, B> {
    /// Entries are [`TessVertex`].
    pub vertices: &'a B,
    /// Entries are `u32`, three a triangle and two a line; they count from the chunk's first vertex.
    pub indices: &'a B,
    /// Entries are [`TessRecord`]; those of the chunk's patches say where each of them is.
    pub records: &'a B,
    /// Which patches, and how much of both there is.
    pub totals: TessTotals,
    /// Vertices of all chunks before.
    pub before: u64,
}

impl<'a> TessPlan<'a> {
    /// A plan for an input, within `memory` bytes of the device's.
    ///
    /// # Errors
    /// [`PlanError::Tessellation`] if the input contradicts itself; [`PlanError::Budget`] if the memory is too small even
    /// patch by patch.
    pub fn new(input: &'a TessInput<'a>, memory: u64) -> Result<Self, PlanError> {
        check(input)?;
        let frame = TessFrame { patch_count: input.patches.len() as u32, ..input.frame };
        let plan = Self { input, frame, memory };
        let needed = plan.fixed_bytes() + bytes(plan.most());
        if memory < needed {
            return Err(PlanError::Budget { have: memory, needed });
        }
        Ok(plan)
    }

    /// Vertices and indices of the largest patch.
    const fn most(&self) -> [u64; 2] {
        [MOST_VERTICES, MOST_PRIMITIVES * corners(&self.frame) as u64]
    }

    /// Bytes of all buffers but those of the mesh.
    const fn fixed_bytes(&self) -> u64 {
        let input = self.input;
        let patch = size_of::<TessPatch>() + size_of::<TessRecord>();
        let levels = size_of::<TessLevels>() * entries(input.levels.len()) as usize;
        (size_of::<TessFrame>()
            + size_of::<TessTotals>()
            + 4 * entries(input.heights.len()) as usize
            + levels) as u64
            + patch as u64 * entries(input.patches.len())
    }

    /// Reserves the buffers, and runs control.
    ///
    /// # Errors
    /// What the device reports.
    pub fn prepare<D: Device>(&self, device: &mut D) -> Result<TessBuffers<D::Buffer>, D::Error> {
        let input = self.input;
        let count = entries(input.patches.len());
        let frame = filled(device, "tess_frame", &[self.frame])?;
        let patches = filled(device, "tess_patches", input.patches)?;
        let levels = filled(device, "levels", input.levels)?;
        let heights = filled(device, "heights", input.heights)?;
        let records = device.allocate("records", TessRecord::LAYOUT, count)?;
        let totals = device.allocate("totals", TessTotals::LAYOUT, 1)?;
        device.dispatch(
            Stage::TessControl,
            Items::Count(self.frame.patch_count),
            &[&frame, &patches, &levels, &records],
        )?;
        let counts = self.count(device, [&frame, &records, &totals])?;
        let rooms = self.rooms(device, counts);
        let index_room = u64::from(rooms[1]) * u64::from(corners(&self.frame));
        let vertices = device.allocate("tess_vertices", TessVertex::LAYOUT, u64::from(rooms[0].max(1)))?;
        let indices = device.allocate("indices", u32::LAYOUT, index_room.max(1))?;
        Ok(TessBuffers { frame, patches, heights, records, totals, vertices, indices, rooms, counts })
    }

    /// How large the whole mesh is.
    fn count<D: Device>(
        &self,
        device: &mut D,
        [frame, records, totals]: [&D::Buffer; 3],
    ) -> Result<TessCounts, D::Error> {
        let mut counts = TessCounts::default();
        let mut first = 0;
        while first < self.frame.patch_count {
            let all = [u32::MAX; 2];
            let window = place(device, [frame, records, totals], first, all)?;
            counts.vertices += u64::from(window.vertices);
            counts.primitives += u64::from(window.primitives);
            first = window.end;
        }
        Ok(counts)
    }

    /// How many vertices and primitives a chunk has at most: as memory allows, but no more than there are.
    fn rooms<D: Device>(&self, device: &D, counts: TessCounts) -> [u32; 2] {
        let corners = u64::from(corners(&self.frame));
        let least = self.most();
        let rest = self.memory - self.fixed_bytes();
        // As many times the largest patch as fit.
        let times = |kind: usize, entries: u64| {
            (least[kind] as u128 * rest as u128 / bytes(least) as u128).min(entries as u128) as u64
        };
        let vertices = times(0, device.max_buffer_bytes(TessVertex::LAYOUT) / size_of::<TessVertex>() as u64);
        let indices = times(1, device.max_buffer_bytes(u32::LAYOUT) / size_of::<u32>() as u64);
        let limit = |room: u64, all: u64| room.min(all).min(u64::from(u32::MAX)) as u32;
        [limit(vertices, counts.vertices), limit(indices / corners, counts.primitives)]
    }

    /// Tessellates; `each` is given chunk by chunk, in the order of the patches, and may read it or use it where it is; it says
    /// whether to go on.
    ///
    /// # Errors
    /// What the device reports, and what `each` does.
    pub fn run<D: Device>(
        &self,
        device: &mut D,
        buffers: &TessBuffers<D::Buffer>,
        mut each: impl FnMut(&mut D, &Chunk<'_, D::Buffer>) -> Result<ControlFlow<()>, D::Error>,
    ) -> Result<TessCounts, D::Error> {
        let TessBuffers { frame, patches, heights, records, totals, vertices, indices, .. } = buffers;
        let mut counts = TessCounts { vertices: 0, primitives: 0, ..buffers.counts };
        let mut first = 0;
        while first < self.frame.patch_count {
            let chunk = place(device, [frame, records, totals], first, buffers.rooms)?;
            if chunk.end == first {
                let (buffer, bytes) = ("tess_vertices", bytes(self.most()));
                let limit = device.max_buffer_bytes(TessVertex::LAYOUT);
                return Err(PlanError::TooLarge { buffer, bytes, limit }.into());
            }
            let before = counts.vertices;
            counts.vertices += u64::from(chunk.vertices);
            counts.primitives += u64::from(chunk.primitives);
            counts.chunks += 1;
            first = chunk.end;
            if chunk.pieces > 0 {
                let all = [frame, patches, heights, records, totals, vertices, indices];
                device.dispatch(Stage::TessEvaluate, Items::Count(chunk.pieces), &all)?;
                if each(device, &Chunk { vertices, indices, records, totals: chunk, before })?.is_break() {
                    break;
                }
            }
        }
        Ok(counts)
    }
}

/// Gives patches from `first` on their places.
fn place<D: Device>(
    device: &mut D,
    [frame, records, totals]: [&D::Buffer; 3],
    first: u32,
    rooms: [u32; 2],
) -> Result<TessTotals, D::Error> {
    let mut found =
        [TessTotals { first, vertex_room: rooms[0], primitive_room: rooms[1], ..TessTotals::default() }];
    device.write(totals, &found)?;
    device.dispatch(Stage::TessPlaces, Items::Count(1), &[frame, records, totals])?;
    device.read(totals, 0, &mut found)?;
    Ok(found[0])
}

/// Entries of a buffer, of which none is empty.
const fn entries(count: usize) -> u64 {
    if count == 0 { 1 } else { count as u64 }
}

/// Bytes of so many vertices and indices.
const fn bytes([vertices, indices]: [u64; 2]) -> u64 {
    vertices * size_of::<TessVertex>() as u64 + indices * size_of::<u32>() as u64
}

fn filled<D: Device, T: Shared>(
    device: &mut D,
    name: &'static str,
    data: &[T],
) -> Result<D::Buffer, D::Error> {
    let buffer = device.allocate(name, T::LAYOUT, entries(data.len()))?;
    device.write(&buffer, data)?;
    Ok(buffer)
}

fn check(input: &TessInput<'_>) -> Result<(), PlanError> {
    let TessFrame { domain, evaluation, control, columns, rows, .. } = input.frame;
    let wrong = |why| Err(PlanError::Tessellation { why });
    if evaluation == TESS_PN && domain != TESS_TRIANGLES {
        return wrong("only triangles can be PN triangles: choose linear or phong");
    }
    if evaluation == TESS_BEZIER && domain == TESS_TRIANGLES {
        return wrong("a Bézier patch is a quadrilateral, not a triangle");
    }
    if evaluation == TESS_BEZIER && columns > 0 {
        return wrong(
            "Bézier patches that share an edge need not have the same normals there, so that heights would tear them apart",
        );
    }
    let is_even = (columns > 0) == (rows > 0) && columns <= MOST_TEXELS && rows <= MOST_TEXELS;
    let heights = input.heights.len();
    if !is_even || u64::from(columns) * u64::from(rows) != heights as u64 || u32::try_from(heights).is_err() {
        return wrong(
            "there must be as many heights as the height map has columns times rows, each of them at most 2^24",
        );
    }
    let wanted = if control == TESS_GIVEN { input.patches.len() } else { 0 };
    if input.levels.len() != wanted {
        return wrong(
            "patches that have levels of their own need as many levels as there are patches, and others none",
        );
    }
    if u32::try_from(input.patches.len()).is_err() {
        return wrong("there are more patches than 32 bits can count");
    }
    if domain > TESS_ISOLINES {
        return wrong("patches are triangles, quadrilaterals or isolines, and the domain is none of these");
    }
    Ok(())
}
