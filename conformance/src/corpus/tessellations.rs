//! Inputs for the tessellator's stages: every domain, spacing, profile, control and evaluation; levels that are none; patches
//! that have collapsed.

use micropoly_core::abi::{
    TESS_BEZIER, TESS_CLOCKWISE, TESS_CONSTANT, TESS_COORDINATES, TESS_DISTANCE, TESS_GIVEN, TESS_ISOLINES,
    TESS_LENGTH, TESS_LINEAR, TESS_ODD, TESS_PHONG, TESS_PN, TESS_POINTS, TESS_QUADS, TESS_STADLBAUER,
    TESS_TRIANGLES, TessFrame, TessLevels, TessPatch, TessRecord, TessTotals, TessVertex,
};
use micropoly_core::kernel::tess_control::{control as control_one, record};
use micropoly_core::kernel::tess_evaluate::corners;
use micropoly_core::kernel::tess_places::places as place;
use micropoly_core::stage::Items;

use super::{Parts, empty, words};

/// Patches of an input of places: more than a work-group has items.
const MANY: u32 = 300;
/// Or as many as it has.
const FULL: u32 = 256;

/// A number about as large as others of its kind, or a nasty one.
fn coordinate(random: &mut fastrand::Rng) -> f32 {
    match random.u32(0..12) {
        0 => 0.0,
        1 => -0.0,
        2 => 1.0e-30,
        3 => 4.0e-39, // denormal
        4 => 1.0e6 * (random.f32() - 0.5),
        _ => 4.0 * random.f32() - 2.0,
    }
}

fn level(random: &mut fastrand::Rng) -> f32 {
    match random.u32(0..16) {
        0 => 1.0,
        1 => 1.0 + f32::EPSILON * random.f32() * 256.0,
        2 => random.u32(1..=64) as f32,
        3 => 1.0e6,
        4 => random.f32(),
        5 => f32::from(random.u8(0..=255)) / 4.0,
        _ => 1.0 + 20.0 * random.f32(),
    }
}

/// One in so many patches is dropped.
fn outer_level(random: &mut fastrand::Rng) -> f32 {
    match random.u32(0..40) {
        0 => [0.0, -0.0, -3.0, f32::NAN, f32::NEG_INFINITY][random.usize(0..5)],
        1 => f32::INFINITY,
        _ => level(random),
    }
}

fn levels(random: &mut fastrand::Rng) -> TessLevels {
    let mut levels = TessLevels::default();
    levels.outer.fill_with(|| outer_level(random));
    levels.inner.fill_with(|| if random.u32(0..20) == 0 { f32::NAN } else { level(random) });
    if random.u32(0..6) == 0 {
        levels = TessLevels { outer: [1.0; 4], inner: [1.0; 2] };
        match random.usize(0..6) {
            outer @ 0..4 => levels.outer[outer] = level(random),
            inner => levels.inner[inner - 4] = level(random),
        }
    }
    levels
}

fn patch(random: &mut fastrand::Rng) -> TessPatch {
    let mut patch = TessPatch::default();
    if random.u32(0..10) == 0 {
        return patch; // a point, and no normals
    }
    patch.points.fill_with(|| coordinate(random));
    let place = |random: &mut fastrand::Rng| [0.0, 1.0, -0.0, 3.0 * random.f32() - 1.0][random.usize(0..4)];
    patch.uv.fill_with(|| place(random));
    patch.edges.fill_with(|| place(random));
    patch.corners.fill_with(|| place(random));
    patch
}

fn frame(random: &mut fastrand::Rng, patch_count: u32) -> TessFrame {
    let domain = random.u32(TESS_TRIANGLES..=TESS_ISOLINES);
    let [flat, bent] =
        if domain == TESS_TRIANGLES { [TESS_LINEAR, TESS_PN] } else { [TESS_LINEAR, TESS_BEZIER] };
    let evaluation = [flat, bent, bent, bent, TESS_PHONG, TESS_COORDINATES][random.usize(0..6)];
    let has_heights = evaluation != TESS_BEZIER && random.bool();
    let mut frame = TessFrame {
        patch_count,
        domain,
        spacing: random.u32(0..=TESS_ODD),
        control: [TESS_CONSTANT, TESS_LENGTH, TESS_LENGTH, TESS_DISTANCE][random.usize(0..4)],
        evaluation,
        columns: if has_heights { random.u32(1..9) } else { 0 },
        rows: if has_heights { random.u32(1..9) } else { 0 },
        factor: [0.0, 1.0, 4.0, 12.0, 40.0, 1.0e6][random.usize(0..6)],
        scale: 2.0 * random.f32() - 1.0,
        phong: random.f32(),
        ..TessFrame::default()
    };
    for (chance, flag) in [(2, TESS_STADLBAUER), (4, TESS_CLOCKWISE), (8, TESS_POINTS)] {
        frame.flags |= if random.u32(0..chance) == 0 { flag } else { 0 };
    }
    if random.u32(0..3) == 0 {
        frame.control = TESS_GIVEN;
    }
    if random.u32(0..4) > 0 {
        frame.eye.fill_with(|| coordinate(random)); // or it is where patches are that have collapsed
    }
    TessFrame { outer: levels(random).outer, inner: levels(random).inner, ..frame }
}

pub(super) fn control(random: &mut fastrand::Rng) -> Parts {
    let count = random.u32(1..200);
    let mut frame = frame(random, count);
    if random.u32(0..3) == 0 {
        // Edges that are curves, neither very short nor very long.
        frame =
            TessFrame { domain: random.u32(TESS_QUADS..=TESS_ISOLINES), evaluation: TESS_BEZIER, ..frame };
        frame = TessFrame { control: TESS_LENGTH, factor: 5.0, eye: [1.0, 2.0, 3.0], columns: 0, ..frame };
    }
    let patches: Vec<TessPatch> = (0..count).map(|_| patch(random)).collect();
    let own: Vec<TessLevels> = (0..count).map(|_| levels(random)).collect();
    let records = empty::<TessRecord>(count as usize);
    (Items::Count(count), vec![words(&[frame]), words(&patches), words(&own), records])
}

/// Records before their places are known.
fn records(random: &mut fastrand::Rng, frame: &TessFrame) -> Vec<TessRecord> {
    (0..frame.patch_count).map(|_| record(frame, &levels(random))).collect()
}

pub(super) fn places(random: &mut fastrand::Rng) -> Parts {
    let count = if random.u32(0..4) == 0 { FULL } else { random.u32(1..MANY) };
    let frame = frame(random, count);
    let records = records(random, &frame);
    let (vertices, primitives) = totals_of(&records);
    let mut room = |all: u32| match random.u32(0..4) {
        0 => random.u32(0..=all),
        1 => all,
        _ => u32::MAX,
    };
    let rooms = [room(vertices), room(primitives)];
    let first = if random.bool() { 0 } else { random.u32(0..count) };
    let totals =
        TessTotals { first, vertex_room: rooms[0], primitive_room: rooms[1], ..TessTotals::default() };
    (Items::Count(1), vec![words(&[frame]), words(&records), words(&[totals])])
}

fn totals_of(records: &[TessRecord]) -> (u32, u32) {
    records.iter().fold((0, 0), |(vertices, primitives), record| {
        (vertices + record.vertices, primitives + record.primitives)
    })
}

pub(super) fn evaluate(random: &mut fastrand::Rng) -> Parts {
    let count = random.u32(1..30);
    let frame = frame(random, count);
    let patches: Vec<TessPatch> = (0..count).map(|_| patch(random)).collect();
    let own: Vec<TessLevels> = (0..count).map(|_| levels(random)).collect();
    let mut records: Vec<TessRecord> =
        (0..).zip(&patches).map(|(index, patch)| control_one(&frame, patch, &own, index)).collect();
    let first = if random.bool() { 0 } else { random.u32(0..count) };
    let totals =
        TessTotals { first, vertex_room: u32::MAX, primitive_room: u32::MAX, ..TessTotals::default() };
    let totals = place(&frame, &mut records, totals);
    let heights: Vec<f32> = (0..(frame.columns * frame.rows).max(1)).map(|_| random.f32()).collect();
    let vertices = empty::<TessVertex>(totals.vertices.max(1) as usize);
    let indices = empty::<u32>((corners(&frame) * totals.primitives).max(1) as usize);
    let buffers = vec![
        words(&[frame]),
        words(&patches),
        words(&heights),
        words(&records),
        words(&[totals]),
        vertices,
        indices,
    ];
    (Items::Count(totals.pieces), buffers)
}
