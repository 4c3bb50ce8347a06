//! Inputs for every stage: random ones, and the nasty cases among them (collapsed and folded patches, points
//! at and behind the eye, control points far away, ranges that may not be split again, equal depths, full
//! buffers, every dice rate).

mod groups;
mod order;
mod scenes;
mod tessellations;
mod trees;

use std::ops::RangeInclusive;

use bytemuck::NoUninit;
use micropoly_core::abi::{
    CULL, Colour, Control, DRAW, DRAW_LIMITED, Draw, FLAG_CULL_BACKFACES, FLAG_LAYERS, FLAG_SMOOTH,
    FLAG_WEBER, Frame, Limits, MAX_LEVELS, MAX_RATE, MAX_SPLITS, MeshPlace, MeshTotals, MeshVertex,
    OPAQUE_DEPTH, Object, PARAM_BITS, PARAM_ONE, Patch, Pixel, SPLIT_U, SPLIT_V, Sample, Shared, Slot,
    Surface, Tap, Verdict,
};
use micropoly_core::border::{SIDES, Side};
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::kernel::mesh;
use micropoly_core::kernel::sample::{Band, sample as sample_grid};
use micropoly_core::kernel::scan::scan;
use micropoly_core::known::question;
use micropoly_core::patch::instance::{Instance, instance};
use micropoly_core::pattern::{Region, Samples, Window, tuples};
use micropoly_core::reconstruction::{Filter, Kernel, MAX_TAPS};
use micropoly_core::stage::{Extent, Items, Stage};

use self::scenes::{IDENTITY, PATCHES, crossing, scene};

use crate::stages::Input;

/// Inputs of one stage that a full comparison runs.
pub const ROUNDS: u64 = 40;
/// From this one on the draw stage is given what chance seldom brings about.
const RARE: u64 = 32;

fn words<T: NoUninit>(entries: &[T]) -> Vec<u32> {
    bytemuck::cast_slice::<T, u8>(entries)
        .chunks_exact(4)
        .map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
        .collect()
}

fn empty<T: Shared>(entries: usize) -> Vec<u32> {
    vec![0; entries * T::LAYOUT.size / 4]
}

/// Input number `round` of a stage: the same for the same number.
#[must_use]
pub fn input(stage: Stage, round: u64) -> Input {
    let mut random = fastrand::Rng::with_seed(round << 8 | number(stage));
    let (items, buffers) = match stage {
        Stage::Take => take(&mut random),
        Stage::Bound => bounds(&mut random),
        Stage::Scan => scans(&mut random),
        Stage::Split => splits(&mut random),
        Stage::Local => groups::local(&mut random),
        Stage::Balance => groups::balance(&mut random),
        Stage::Deal => groups::deal(&mut random),
        Stage::Draw | Stage::SortLast => draws(&mut random, round),
        Stage::Blend => blends(&mut random),
        Stage::Filter => filters(&mut random),
        Stage::MeshPlaces => mesh_places(&mut random),
        Stage::Mesh => meshes(&mut random),
        Stage::TessControl => tessellations::control(&mut random),
        Stage::TessPlaces => tessellations::places(&mut random),
        Stage::TessEvaluate => tessellations::evaluate(&mut random),
        Stage::AccelExtent => trees::extent(&mut random),
        Stage::AccelCodes => trees::codes(&mut random),
        Stage::AccelCount => trees::count(&mut random),
        Stage::AccelScan => trees::scan(&mut random),
        Stage::AccelScatter => trees::scatter(&mut random),
        Stage::AccelTree => trees::tree(&mut random),
        Stage::AccelBoxes => trees::fitted(&mut random),
        Stage::AccelSee => trees::see(&mut random),
        Stage::AccelFill => trees::fill(&mut random),
        Stage::AccelRays | Stage::AccelNearest => trees::probes(&mut random),
        Stage::BspSides => order::sides(&mut random),
        Stage::BspCells => order::cells(&mut random),
        Stage::BspRank => order::ranks(&mut random),
        Stage::Flush => (Items::Count(1), vec![words(&[control(&mut random)])]),
        Stage::KnownAnswers => known(&mut random),
    };
    Input { stage, items, buffers }
}

/// Tells stages apart; a new one leaves the inputs of all others as they are.
const fn number(stage: Stage) -> u64 {
    match stage {
        Stage::Take => 1,
        Stage::Bound => 2,
        Stage::Scan => 3,
        Stage::Split => 4,
        Stage::Draw => 5,
        Stage::Flush => 6,
        Stage::KnownAnswers => 7,
        Stage::Local => 8,
        Stage::Balance => 9,
        Stage::Deal => 10,
        Stage::MeshPlaces => 11,
        Stage::Mesh => 12,
        Stage::SortLast => 13,
        Stage::Blend => 14,
        Stage::Filter => 15,
        Stage::TessControl => 16,
        Stage::TessPlaces => 17,
        Stage::TessEvaluate => 18,
        Stage::AccelExtent => 19,
        Stage::AccelCodes => 20,
        Stage::AccelCount => 21,
        Stage::AccelScan => 22,
        Stage::AccelScatter => 23,
        Stage::AccelTree => 24,
        Stage::AccelBoxes => 25,
        Stage::AccelSee => 26,
        Stage::AccelFill => 27,
        Stage::AccelRays => 28,
        Stage::AccelNearest => 29,
        Stage::BspSides => 30,
        Stage::BspCells => 31,
        Stage::BspRank => 32,
    }
}

type Parts = (Items, Vec<Vec<u32>>);

fn control(random: &mut fastrand::Rng) -> Control {
    let mut any = || random.u32(0..100_000);
    Control {
        stack: any(),
        taken: any(),
        roots: any(),
        base: any(),
        next_root: any(),
        waiting: any(),
        fresh: any(),
        peak: any(),
        processed: any(),
        culled: any(),
        drawn: any(),
        limited: any(),
        micropolygons: any(),
        overflow: 0,
        listed: u32::from(random.bool()),
    }
}

fn take(random: &mut fastrand::Rng) -> Parts {
    let levels = random.u32(1..=41);
    let most = [4, 300, 6000][random.usize(0..3)];
    let count = random.u32(0..most);
    // Levels rise from the bottom to the top, as they do in every frame; now and then they do not.
    let mut all: Vec<u32> = (0..count).map(|_| random.u32(0..levels)).collect();
    if random.u8(0..8) > 0 {
        all.sort_unstable();
    }
    let stack: Vec<Surface> = all
        .iter()
        .map(|&level| Surface { shape: level.min(20) | level.saturating_sub(20) << 5, ..Surface::root(0) })
        .collect();
    let spare = [50, 2 * count + 50, 6 * count + 50][random.usize(0..3)];
    let stack_room = count + random.u32(1..spare);
    let most = [2 * count + 2, 8 * count + 8][random.usize(0..2)];
    let batch = random.u32(1..most);
    let most = [1, 20, 6000][random.usize(0..3)];
    let next_root = random.u32(0..1000);
    let patches = next_root + random.u32(0..most);
    let mut limits = Limits { patches, batch, levels, stack_room, ..Limits::default() };
    let control = Control { stack: count, next_root, ..control(random) };
    if count > 0 && random.u8(0..4) == 0 {
        // The batch has room for all roots, and the stack for whatever may become of its entries, but not of both.
        let wanted = random.u32(1..=count);
        (limits.batch, limits.patches) = (count + wanted, next_root + wanted);
        limits.stack_room = (2 * count + levels).saturating_sub(2) + random.u32(0..2 * wanted);
    }
    let room = if stack.is_empty() { vec![Surface::default()] } else { stack };
    let roots: Vec<u32> = (0..limits.patches.max(1)).map(|_| random.u32(..)).collect();
    let put = empty::<Surface>(limits.batch.min(limits.patches).max(1) as usize);
    (Items::Count(1), vec![words(&[limits]), roots, words(&room), put, words(&[control])])
}

/// A range anywhere, at a corner or about the middle; now and then one parameter is split to the end. Its sides have
/// up to `most` steps.
fn surface(random: &mut fastrand::Rng, patches: u32, splits: RangeInclusive<u32>, most: u32) -> Surface {
    let deepest = *splits.end();
    let splits = random.u32(splits);
    let along_u = if random.bool() { splits / 2 } else { random.u32(0..=splits) };
    let mut levels = [along_u, splits - along_u].map(|level| level.min(MAX_SPLITS));
    if deepest >= MAX_SPLITS && random.u8(0..4) == 0 {
        levels[random.usize(0..2)] = MAX_SPLITS;
    }
    let place = random.u8(0..8);
    let mut start = |level: u32| {
        let (count, size) = (1 << level, PARAM_ONE >> level);
        let index = match place {
            0 => 0,
            1 => count / 2,
            2 => (count / 2).max(1) - 1,
            3 => count - 1,
            _ => random.u32(0..count),
        };
        index * size
    };
    let at = [start(levels[0]), start(levels[1])];
    let patch_id = random.u32(0..patches);
    descendant(random, patch_id, at, levels, most)
}

/// The surface of a patch that starts at these parameters and was halved so often along each, in any order, while
/// its sides were divided somehow, into up to `most` steps.
fn descendant(
    random: &mut fastrand::Rng,
    patch_id: u32,
    at: [u32; 2],
    levels: [u32; 2],
    most: u32,
) -> Surface {
    let mut surface = Surface::root(patch_id);
    let seldom = [2, 8, u32::MAX][random.usize(0..3)];
    while [surface.u_level(), surface.v_level()] != levels {
        let left = [levels[0] - surface.u_level(), levels[1] - surface.v_level()];
        let is_u = left[1] == 0 || (left[0] > 0 && random.bool());
        let verdict = divided(random, surface, if is_u { SPLIT_U } else { SPLIT_V }, seldom, most);
        let [low, high] = surface.halves(verdict);
        let is_high = if is_u { at[0] >= high.u } else { at[1] >= high.v };
        surface = if is_high { high } else { low };
    }
    surface
}

/// A verdict on a surface, where one in `seldom` of its live sides is divided into up to `most` steps.
fn divided(random: &mut fastrand::Rng, surface: Surface, code: u32, seldom: u32, most: u32) -> Verdict {
    let mut sides = SIDES.map(|side| surface.side(side));
    for (side, out) in sides.iter_mut().enumerate() {
        let level = if side < 2 { surface.u_level() } else { surface.v_level() };
        if out.steps == 0 && random.u32(0..seldom) == 0 {
            *out = Side { steps: random.u32(1..=most), bits: PARAM_BITS - level };
        }
    }
    let rates = [random.u32(1..=most), random.u32(1..=most)];
    Verdict { code, ..Verdict::default() }.with_sides(sides, rates)
}

fn bounds(random: &mut fastrand::Rng) -> Parts {
    let (frame, mut objects, mut patches) = scene(random);
    if random.u8(0..4) == 0 {
        patches = (0..PATCHES).map(|_| crossing(random, &frame)).collect();
        objects.iter_mut().for_each(|object| object.to_eye = IDENTITY);
    }
    let (base, held) = (random.u32(0..300), random.u32(0..2000));
    let roots = random.u32(0..=PATCHES);
    let next_root = random.u32(roots..=PATCHES);
    let taken = roots + held;
    let deepest = [4, 12, 40][random.usize(0..3)];
    let stack: Vec<Surface> =
        (0..base + held).map(|_| surface(random, PATCHES, 0..=deepest, MAX_RATE)).collect();
    let listed = u32::from(random.bool());
    let control = Control { base, taken, roots, next_root, stack: base + held, listed, ..Control::default() };
    let room = (taken + random.u32(1..100)) as usize;
    let put: Vec<Surface> = (0..room).map(|_| Surface::root(random.u32(0..PATCHES))).collect();
    let stack = if stack.is_empty() { vec![Surface::default()] } else { stack };
    let buffers = vec![
        words(&[frame]),
        words(&objects),
        words(&patches),
        words(&[control]),
        words(&stack),
        words(&put),
        empty::<Verdict>(room),
    ];
    (Items::Taken, buffers)
}

/// A batch of surfaces with verdicts, and counts before it.
fn batch(random: &mut fastrand::Rng) -> (Control, Vec<Surface>, Vec<Verdict>) {
    let most = [3000, 80][random.usize(0..2)];
    let taken = random.u32(1..most);
    let surfaces: Vec<_> = (0..taken).map(|_| surface(random, PATCHES, 0..=18, MAX_RATE)).collect();
    let only = random.u32(0..8);
    let code = |random: &mut fastrand::Rng| {
        if only <= DRAW_LIMITED { only } else { random.u32(CULL..=DRAW_LIMITED) }
    };
    let verdict = |surface: &Surface| {
        let code = code(random);
        Verdict {
            columns: random.u32(..),
            rows: random.u32(..),
            ..divided(random, *surface, code, 3, MAX_RATE)
        }
    };
    let verdicts = surfaces.iter().map(verdict).collect();
    let before = Control { base: random.u32(0..1000), taken, waiting: random.u32(0..500), ..control(random) };
    (Control { fresh: 0, ..before }, surfaces, verdicts)
}

fn scans(random: &mut fastrand::Rng) -> Parts {
    let (control, _, verdicts) = batch(random);
    // Too little room now and then.
    let limits =
        Limits { stack_room: random.u32(500..8000), draw_room: random.u32(500..6000), ..Limits::default() };
    let slots = empty::<Slot>(verdicts.len());
    (Items::Taken, vec![words(&[limits]), words(&verdicts), slots, words(&[control])])
}

fn splits(random: &mut fastrand::Rng) -> Parts {
    let (control, surfaces, verdicts) = batch(random);
    let (stack_room, draw_room) = (control.base + 2 * control.taken, control.waiting + control.taken);
    let mut slots = vec![Slot::default(); verdicts.len()];
    let full = random.u8(0..6) == 0;
    let room = if full { 1 } else { stack_room };
    let control = scan(control, &verdicts, &mut slots, room, draw_room);
    let buffers = vec![
        words(&[control]),
        words(&surfaces),
        words(&verdicts),
        words(&slots),
        empty::<Surface>(stack_room as usize),
        empty::<Draw>(draw_room as usize),
    ];
    (Items::Taken, buffers)
}

/// Micropolygons of 16 to 60 pixels in small grids, whose areas have more bits than a float; and, every other
/// time, grids of one micropolygon that is cut by the near plane, where those that show their back are skipped.
fn rarely(frame: &mut Frame, round: u64) -> RangeInclusive<u32> {
    let is_cut = round % 2 == 1;
    frame.flags = if is_cut { FLAG_CULL_BACKFACES } else { 0 };
    frame.rate = if is_cut { 1 } else { 1 << (round / 2 % 2) };
    frame.density = 1.0 / 16.0;
    if is_cut { 0..=4 } else { 2..=4 }
}

/// Where patches look like ribbons, two thousand pixels wide and some fifty high, about the left edge of the image.
fn ribbons(frame: &Frame, object: &mut Object) {
    let (width, height, left) = (1000.0 / frame.focal, 25.0 / frame.focal, -frame.centre_x / frame.focal);
    object.to_eye = [width, 0.0, 0.0, left, 0.0, height, 0.0, 0.0, 0.0, 0.0, 0.01, -1.0];
}

fn draws(random: &mut fastrand::Rng, round: u64) -> Parts {
    let (mut frame, mut objects, patches) = scene(random);
    let mut splits = [0..=3, 4..=8, 7..=14][random.usize(0..3)].clone(); // the large ones hide the small ones
    if round >= RARE {
        splits = rarely(&mut frame, round);
        if round % 4 == 2 {
            (splits, frame.rate) = (0..=0, 1);
            objects.iter_mut().for_each(|object| ribbons(&frame, object));
        }
    }
    // Whatever is not culled is drawn, however large; but Weber's rules cull what is at the deepest level.
    frame.levels = if frame.flags & FLAG_WEBER == 0 { 1 } else { MAX_LEVELS };
    frame.bound = [4.0, 12.0, 40.0][random.usize(0..3)];
    objects[1].opacity = [1.0, 0.25][random.usize(0..2)];
    let (samples, region) = region(random, &frame);
    frame = frame.with_region(region, [0, 4, 8, 16, 32][random.usize(0..5)]);
    let places = frame.sample_count();
    // Fewer than there are tiles, some, more than are looked at at once.
    let most = [3, 60, 60, 200][random.usize(0..4)];
    let mut draws = Vec::new();
    for _ in 0..400 {
        let steps = frame.rate;
        let mut surface = surface(random, PATCHES, splits.clone(), steps);
        if frame.flags & FLAG_WEBER != 0 {
            surface.borders = [0; 4]; // by those rules no side is ever divided
        }
        // In no frame do two surfaces of a patch overlap: their micropolygons could have one identity and two colours.
        if draws.iter().any(|draw: &Draw| overlap(draw.surface(), surface)) {
            continue;
        }
        let mut verdict = bound_any(&frame, &objects, &patches, surface);
        // Here halves lie anywhere, and not where the large side is as in any frame; so do the vertices on them.
        let known = instance(&frame, &objects, &patches, surface.patch_id);
        if SIDES.into_iter().any(|side| patches[known.record as usize].is_half(side)) {
            verdict.columns = frame.left | frame.right << 16;
            verdict.rows = frame.top | frame.bottom << 16;
        }
        // Twice the same surface now and then: equal depths, equal identities.
        for _ in 0..random.usize(1..=2) {
            if matches!(verdict.code, DRAW | DRAW_LIMITED) && draws.len() < most {
                draws.push(Draw::new(surface, verdict));
            }
        }
    }
    let waiting = random.u32(0..=draws.len() as u32);
    let control = Control { waiting, fresh: draws.len() as u32 - waiting, ..Control::default() };
    draws.push(Draw::default());
    if random.u8(0..3) == 0 {
        let tuple = tuples(samples).nth(random.usize(0..64)).unwrap_or_else(|| unreachable!("there are 64"));
        frame = frame.with_tuple(samples, tuple);
    }
    frame.flags |= [0, FLAG_SMOOTH][random.usize(0..2)];
    let is_layered = random.u8(0..3) == 0;
    frame.flags |= if is_layered { FLAG_LAYERS } else { 0 };
    let real = &draws[..draws.len() - 1];
    let shown = rendered(&frame, (&objects, &patches), real, places as usize);
    let before: Vec<Sample> =
        shown.iter().map(|shown| rival(random, *shown).unwrap_or_else(|| sample(random))).collect();
    let behind: Vec<Sample> = match is_layered {
        true => shown.iter().map(|shown| rival(random, *shown).unwrap_or_else(|| layer(random))).collect(),
        false => vec![layer(random)],
    };
    let buffers = vec![
        words(&[frame]),
        words(&objects),
        words(&patches),
        words(&[control]),
        words(&draws),
        words(&behind),
        words(&before),
        empty::<Colour>(places as usize),
    ];
    (Items::Image(Extent::of(&frame, places)), buffers)
}

/// What draws show if nothing was there before.
fn rendered(
    frame: &Frame,
    (objects, patches): (&[Object], &[Patch]),
    draws: &[Draw],
    places: usize,
) -> Vec<Sample> {
    let (mut samples, mut colours) = (vec![Sample::default(); places], vec![Colour::default(); places]);
    let (pattern, mut grid) = (Pattern::new(frame), Box::new(Grid::default()));
    let mut band = Band::whole(frame, &mut samples, &mut colours);
    for draw in draws {
        let Instance { record, object } = instance(frame, objects, patches, draw.patch_id);
        dice_any(frame, patches, record, &objects[object as usize], *draw, &mut grid);
        sample_grid(frame, &pattern, (*draw, 1.0), &grid, &mut band);
    }
    samples
}

/// Now and then, of a sample that shows something, one that is as near and differs in one number of its identity at most.
fn rival(random: &mut fastrand::Rng, shown: Sample) -> Option<Sample> {
    let Sample { depth, patch_id, u, v } = shown;
    let beside = |random: &mut fastrand::Rng, number: u32| (number + random.u32(0..=2)).saturating_sub(1);
    match random.u8(0..8) {
        _ if depth == 0 => None,
        0 => Some(Sample { patch_id: beside(random, patch_id), ..shown }),
        1 => Some(Sample { u: beside(random, u), ..shown }),
        2 => Some(Sample { v: beside(random, v), ..shown }),
        _ => None,
    }
}

/// Are both of one patch, and have some of it in common?
fn overlap(a: Surface, b: Surface) -> bool {
    let apart = |a: u32, a_size: u32, b: u32, b_size: u32| a + a_size <= b || b + b_size <= a;
    a.patch_id == b.patch_id
        && !apart(a.u, a.u_size(), b.u, b.u_size())
        && !apart(a.v, a.v_size(), b.v, b.v_size())
}

/// Any number of samples, and any part of the image.
fn region(random: &mut fastrand::Rng, frame: &Frame) -> (Samples, Region) {
    let part = |random: &mut fastrand::Rng, whole: u32| {
        let first = random.u32(0..whole);
        if random.bool() { (0, whole) } else { (first, random.u32(first + 1..=whole)) }
    };
    let ((left, right), (top, bottom)) = (part(random, frame.width), part(random, frame.height));
    let window = Window { left, right, top, bottom };
    let most = 40_000 / window.pixels().max(1) as u32;
    let fitting = Samples::ALL.into_iter().filter(|samples| samples.count() <= most.max(1)).count();
    let samples = Samples::ALL[random.usize(0..fitting)];
    let ((left, right), (top, bottom)) = (part(random, window.width()), part(random, window.height()));
    let shown = Window {
        left: window.left + left,
        right: window.left + right,
        top: window.top + top,
        bottom: window.top + bottom,
    };
    (samples, Region { samples, window, shown })
}

/// The last layer that was found at a sample: none, one at any depth, or the last of all.
fn layer(random: &mut fastrand::Rng) -> Sample {
    match random.u8(0..4) {
        0 => Sample { depth: OPAQUE_DEPTH, ..sample(random) },
        1 => Sample::default(),
        _ => Sample { depth: (random.f32() * 2.0).to_bits(), patch_id: random.u32(0..24), u: 77, v: 99 },
    }
}

fn colour(random: &mut fastrand::Rng) -> Colour {
    let mut any = || random.f32() * 1.5;
    Colour { rgba: [any(), any(), any(), [0.25, 0.7, 1.0][random.usize(0..3)]] }
}

fn blends(random: &mut fastrand::Rng) -> Parts {
    let count = [1, 63, 1000][random.usize(0..3)];
    let mut all = |make: fn(&mut fastrand::Rng) -> Sample| -> Vec<Sample> {
        (0..count).map(|_| make(random)).collect()
    };
    let (samples, behind, front) = (all(sample), all(layer), all(sample));
    let opacity = [0.4, 1.0][random.usize(0..2)];
    let mut colours = |least: f32| -> Vec<Colour> {
        (0..count)
            .map(|_| {
                let Colour { rgba: [r, g, b, a] } = colour(random);
                Colour { rgba: [r, g, b, a.max(least)] }
            })
            .collect()
    };
    // Now and then all is opaque, so that nothing follows.
    let (found, layers) = (colours(opacity), colours(0.0));
    let buffers =
        vec![words(&samples), words(&found), words(&behind), words(&front), words(&layers), empty::<u32>(1)];
    (Items::Count(count), buffers)
}

fn filters(random: &mut fastrand::Rng) -> Parts {
    let (frame, _, _) = scene(random);
    let (samples, region) = region(random, &frame);
    let mut frame = frame.with_region(region, 0);
    let kernel = Kernel::ALL[random.usize(0..Kernel::ALL.len())];
    let radius = [kernel.usual_radius(), 0.5, 1.0 + random.f64() * 1.5][random.usize(0..3)];
    let mut taps = vec![Tap::default(); MAX_TAPS];
    frame.taps = Filter { kernel, radius }.taps(samples, &mut taps) as u32;
    taps.truncate(frame.taps as usize);
    let places = frame.sample_count() as usize;
    let found: Vec<Sample> = (0..places).map(|_| sample(random)).collect();
    // Where nothing is, a colour means nothing.
    let colours: Vec<Colour> = (0..places).map(|_| colour(random)).collect();
    let pixels = frame.shown_count();
    let buffers = vec![
        words(&[frame]),
        words(&taps),
        words(&found),
        words(&colours),
        empty::<Pixel>(pixels.max(1) as usize),
    ];
    (Items::Count(pixels as u32), buffers)
}

/// Draws of any patches, at any rates, and where they lie in a mesh behind `before`.
fn placed(
    random: &mut fastrand::Rng,
    count: u32,
    before: MeshTotals,
) -> (Vec<Draw>, Vec<MeshPlace>, MeshTotals) {
    let draw = |_| {
        let surface = surface(random, PATCHES, 0..=18, MAX_RATE);
        let verdict = divided(random, surface, DRAW, 3, MAX_RATE);
        let surface = surface.divided(verdict);
        let least = |first: usize| surface.steps_needed(first).max(surface.steps_needed(first + 1));
        let rates = [random.u32(1..=MAX_RATE).max(least(0)), random.u32(1..=MAX_RATE).max(least(2))];
        let sides = SIDES.map(|side| surface.side(side));
        Draw::new(surface, Verdict { code: DRAW, ..Verdict::default() }.with_sides(sides, rates))
    };
    let draws: Vec<Draw> = (0..count).map(draw).collect();
    let mut places = vec![MeshPlace::default(); draws.len()];
    let control = Control { waiting: count, ..Control::default() };
    let totals = mesh::places(&control, &draws, &mut places, before);
    (draws, places, totals)
}

fn mesh_places(random: &mut fastrand::Rng) -> Parts {
    let count = [random.u32(0..4), random.u32(0..3000)][random.usize(0..2)];
    let before = MeshTotals { vertices: random.u32(..), triangles: random.u32(..) };
    let (mut draws, places, _) = placed(random, count, before);
    let waiting = random.u32(0..=count);
    let control = Control { waiting, fresh: count - waiting, ..control(random) };
    draws.push(Draw::default());
    let places = empty::<MeshPlace>(places.len() + 1);
    (Items::Count(1), vec![words(&[control]), words(&draws), places, words(&[before])])
}

fn meshes(random: &mut fastrand::Rng) -> Parts {
    let (frame, objects, patches) = scene(random);
    let before = MeshTotals { vertices: random.u32(0..50), triangles: random.u32(0..50) };
    let count = random.u32(1..60);
    let (draws, places, totals) = placed(random, count, before);
    let buffers = vec![
        words(&[frame]),
        words(&objects),
        words(&patches),
        words(&draws),
        words(&places),
        empty::<MeshVertex>(totals.vertices as usize + 1),
        empty::<u32>(3 * totals.triangles as usize + 1),
    ];
    (Items::Count(count), buffers)
}

/// Nothing, or something that was drawn before at any depth.
fn sample(random: &mut fastrand::Rng) -> Sample {
    match random.u8(0..3) {
        0 => Sample { depth: (random.f32() * 2.0).to_bits(), patch_id: random.u32(0..24), u: 77, v: 99 },
        _ => Sample::default(),
    }
}

fn known(random: &mut fastrand::Rng) -> Parts {
    let first = random.u32(0..33_000); // up to operations that there are not
    let questions: Vec<_> = (first..first + 5000).map(question).collect();
    let frame = words(&[Frame::default()]);
    (Items::Count(5000), vec![frame, words(&questions), empty::<u32>(5000)])
}
