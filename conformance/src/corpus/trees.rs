//! Inputs for the stages of trees: soups of all sizes, with equal codes and places, the smallest and the largest coordinates.

use micropoly_core::abi::{
    AccelFrame, Bounds, Finding, Frustum, Node, Probe, SEE_BLOCK, SORT_BITS, SORT_DIGITS, SortKey, Triangle,
};
use micropoly_core::accel::extent::{Extent, bounds as box_of, with};
use micropoly_core::accel::morton::{Grid, Precision};
use micropoly_core::accel::query::{self, seen};
use micropoly_core::accel::sort;
use micropoly_core::accel::tree::{fit, inner, link};
use micropoly_core::stage::Items;

use super::{Parts, empty, words};

/// A coordinate about as large as others of its kind, or a nasty one.
fn coordinate(random: &mut fastrand::Rng, spread: f32) -> f32 {
    match random.u32(0..16) {
        0 => 0.0,
        1 => -0.0,
        2 => 3.0e-39, // denormal
        _ => spread * (random.f32() - 0.5),
    }
}

/// Triangles, some of them in the same place.
fn triangles(random: &mut fastrand::Rng, most: usize) -> Vec<Triangle> {
    let count = if random.u8(0..4) == 0 { random.usize(1..4) } else { random.usize(1..most) };
    let spread = [1.0, 4.0, 4.0, 4.0, 1.0e-20, 1.0e-40, 1.0e37, 0.0][random.usize(0..8)];
    let mut all: Vec<Triangle> = (0..count)
        .map(|_| {
            let place: [f32; 3] = std::array::from_fn(|_| coordinate(random, spread));
            let near = |k: usize| place[k % 3] + 0.2 * coordinate(random, spread);
            Triangle { corners: std::array::from_fn(near) }
        })
        .collect();
    for _ in 0..random.usize(0..=count / 2) {
        all[random.usize(0..count)] = all[random.usize(0..count)];
    }
    all
}

fn boxes(random: &mut fastrand::Rng, most: usize) -> Vec<Bounds> {
    triangles(random, most).iter().map(|triangle| Bounds::of(&triangle.points())).collect()
}

fn extent_of(boxes: &[Bounds]) -> Extent {
    boxes.iter().fold(Extent::default(), with)
}

fn precision(random: &mut fastrand::Rng) -> Precision {
    if random.bool() { Precision::Bits30 } else { Precision::Bits63 }
}

fn frame(boxes: &[Bounds], precision: Precision) -> AccelFrame {
    AccelFrame { count: boxes.len() as u32, bits: precision.bits(), ..AccelFrame::default() }
}

pub(super) fn extent(random: &mut fastrand::Rng) -> Parts {
    let boxes = boxes(random, 300);
    let frame = frame(&boxes, Precision::Bits30);
    (Items::Count(frame.count), vec![words(&[frame]), words(&boxes), vec![0; 6]])
}

pub(super) fn codes(random: &mut fastrand::Rng) -> Parts {
    let boxes = boxes(random, 300);
    let frame = frame(&boxes, precision(random));
    let extent = extent_of(&boxes);
    let keys = empty::<SortKey>(boxes.len());
    (Items::Count(frame.count), vec![words(&[frame]), words(&boxes), extent.to_vec(), keys])
}

fn keys(random: &mut fastrand::Rng) -> (AccelFrame, Vec<SortKey>) {
    let count = [random.u32(1..100), random.u32(1..5000), 2048][random.usize(0..3)];
    let few = random.bool();
    let code = |random: &mut fastrand::Rng| if few { random.u64(0..3) } else { random.u64(..) };
    let keys = (0..count).map(|primitive| SortKey::new(code(random), primitive)).collect();
    let counts = SORT_DIGITS * sort::blocks(count);
    let shift = SORT_BITS * random.u32(0..if few { 1 } else { 16 });
    (AccelFrame { count, counts, shift, ..AccelFrame::default() }, keys)
}

pub(super) fn count(random: &mut fastrand::Rng) -> Parts {
    let (frame, keys) = keys(random);
    let counts = empty::<u32>(frame.counts as usize + 1);
    (Items::Count(sort::blocks(frame.count)), vec![words(&[frame]), words(&keys), counts])
}

pub(super) fn scan(random: &mut fastrand::Rng) -> Parts {
    let counts = [random.u32(1..300), random.u32(1..5000), 256, 1024][random.usize(0..4)];
    let frame = AccelFrame { counts, ..AccelFrame::default() };
    let all: Vec<u32> = (0..=counts).map(|_| random.u32(0..1000)).collect();
    (Items::Count(1), vec![words(&[frame]), all])
}

pub(super) fn scatter(random: &mut fastrand::Rng) -> Parts {
    let (frame, keys) = keys(random);
    let blocks = sort::blocks(frame.count);
    let mut counts = vec![0; frame.counts as usize + 1];
    (0..blocks).for_each(|block| sort::count(&frame, &keys, block, &mut counts));
    sort::scan(&frame, &mut counts);
    let sorted = empty::<SortKey>(keys.len());
    (Items::Count(blocks), vec![words(&[frame]), words(&keys), counts, sorted])
}

fn sorted(boxes: &[Bounds], precision: Precision) -> Vec<SortKey> {
    let grid = Grid::new(&box_of(extent_of(boxes)), precision);
    let mut keys: Vec<SortKey> =
        (0..).zip(boxes).map(|(primitive, bounds)| SortKey::new(grid.code(bounds), primitive)).collect();
    keys.sort_by_key(SortKey::code);
    keys
}

pub(super) fn tree(random: &mut fastrand::Rng) -> Parts {
    let boxes = boxes(random, 500);
    let precision = precision(random);
    let mut keys = sorted(&boxes, precision);
    if random.u8(0..4) == 0 {
        // Codes that differ anywhere.
        keys.iter_mut()
            .for_each(|key| *key = SortKey::new(random.u64(..) >> random.u32(0..64), key.primitive));
        keys.sort_by_key(SortKey::code);
    }
    let count = 2 * keys.len() - 1;
    let buffers =
        vec![words(&[frame(&boxes, precision)]), words(&keys), empty::<Node>(count), empty::<u32>(count)];
    (Items::Count(count as u32), buffers)
}

/// Nodes and parents, without boxes.
fn linked(boxes: &[Bounds], precision: Precision) -> (Vec<Node>, Vec<u32>) {
    let keys = sorted(boxes, precision);
    let codes: Vec<u64> = keys.iter().map(SortKey::code).collect();
    let mut nodes: Vec<Node> = (0..codes.len() as u32 - 1).map(|index| inner(&codes, index)).collect();
    let above = nodes.len();
    nodes.extend(keys.iter().map(|key| Node::leaf(key.primitive, Bounds::default())));
    let mut parents = vec![0; nodes.len()];
    link(&nodes, &mut parents, above);
    (nodes, parents)
}

pub(super) fn fitted(random: &mut fastrand::Rng) -> Parts {
    let boxes = boxes(random, 500);
    let precision = precision(random);
    let (nodes, parents) = linked(&boxes, precision);
    let visits = empty::<u32>(6 * boxes.len());
    let buffers = vec![words(&[frame(&boxes, precision)]), words(&boxes), parents, visits, words(&nodes)];
    (Items::Count(6 * boxes.len() as u32), buffers)
}

fn built(boxes: &[Bounds]) -> Vec<Node> {
    let (mut nodes, parents) = linked(boxes, Precision::Bits30);
    fit(&mut nodes, &parents, boxes, &mut vec![0; boxes.len()]);
    nodes
}

fn frusta(random: &mut fastrand::Rng) -> Vec<Frustum> {
    let number = |random: &mut fastrand::Rng| match random.u32(0..12) {
        0 => 0.0,
        1 => 2.0e-30,
        _ => 2.0 * random.f32() - 1.0,
    };
    let plane = |random: &mut fastrand::Rng| {
        let mut plane: [f32; 4] = std::array::from_fn(|_| number(random));
        plane[3] += 0.5;
        plane
    };
    let some = |random: &mut fastrand::Rng| {
        let planes: Vec<[f32; 4]> = (0..random.usize(1..=6)).map(|_| plane(random)).collect();
        Frustum::new(&planes)
    };
    (0..random.usize(1..5)).map(|_| some(random)).collect()
}

/// What frusta are asked, and how many blocks there are.
fn asked(random: &mut fastrand::Rng) -> (AccelFrame, Vec<Node>, Vec<Frustum>) {
    let (mut boxes, frusta) = (boxes(random, 500), frusta(random));
    let even = boxes.len() / SEE_BLOCK as usize * SEE_BLOCK as usize;
    if even > 0 && random.bool() {
        boxes.truncate(even); // no block is short
    }
    let questions = frusta.len() as u32;
    let counts = questions * query::blocks(boxes.len() as u32);
    let frame = AccelFrame { questions, counts, ..frame(&boxes, Precision::Bits30) };
    (frame, built(&boxes), frusta)
}

pub(super) fn see(random: &mut fastrand::Rng) -> Parts {
    let (frame, nodes, frusta) = asked(random);
    let counts = empty::<u32>(frame.counts as usize + 1);
    (Items::Count(frame.counts), vec![words(&[frame]), words(&nodes), words(&frusta), counts])
}

pub(super) fn fill(random: &mut fastrand::Rng) -> Parts {
    let (frame, nodes, frusta) = asked(random);
    let count = |block| seen(&frame, &nodes, &frusta, block).count() as u32;
    let mut counts: Vec<u32> = (0..frame.counts).map(count).chain([0]).collect();
    sort::scan(&frame, &mut counts);
    let room = counts.last().map_or(1, |all| (*all).max(1));
    let out = vec![u32::MAX; room as usize];
    (Items::Count(frame.counts), vec![words(&[frame]), words(&nodes), words(&frusta), counts, out])
}

/// Rays and points, many of them near triangles, some of them along an axis.
pub(super) fn probes(random: &mut fastrand::Rng) -> Parts {
    let triangles = triangles(random, 200);
    let boxes: Vec<Bounds> = triangles.iter().map(|triangle| Bounds::of(&triangle.points())).collect();
    let probe = |random: &mut fastrand::Rng| {
        let mut origin: [f32; 3] = std::array::from_fn(|_| coordinate(random, 8.0));
        let aim = triangles[random.usize(0..triangles.len())].points();
        let direction = match random.u32(0..4) {
            0 => [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [-0.0, 2.0e-30, 1.0]][random.usize(0..3)],
            1 => std::array::from_fn(|axis| aim[0][axis] - origin[axis]), // to a corner
            _ => std::array::from_fn(|axis| {
                0.4 * aim[0][axis] + 0.3 * (aim[1][axis] + aim[2][axis]) - origin[axis]
            }),
        };
        if random.u32(0..8) == 0 {
            origin = aim[1];
        }
        Probe { origin, direction, far: [1.0e30, 2.0, 0.5][random.usize(0..3)] }
    };
    let probes: Vec<Probe> = (0..random.usize(1..200)).map(|_| probe(random)).collect();
    let questions = probes.len() as u32;
    let frame = AccelFrame { questions, ..frame(&boxes, Precision::Bits30) };
    let found = empty::<Finding>(probes.len());
    let buffers = vec![words(&[frame]), words(&built(&boxes)), words(&triangles), words(&probes), found];
    (Items::Count(questions), buffers)
}
