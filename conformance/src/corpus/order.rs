//! Inputs for the stages that put the pieces of a BSP-grid into order: eyes on planes, next to them and as far away as they may
//! be, cells without pieces, trees that are chains.

use micropoly_core::abi::{AccelFrame, BspFrame, BspNode};
use micropoly_core::accel::bsp::cells::place_of;
use micropoly_core::accel::bsp::lattice::{FARTHEST, LATTICE_BITS, Point};
use micropoly_core::accel::bsp::plane::Plane;
use micropoly_core::accel::sort;
use micropoly_core::stage::Items;

use super::{Parts, empty, words};

/// Corners have coordinates up to this one.
const LAST: i32 = (1 << LATTICE_BITS) - 1;
/// Offsets are below this, as (√3 · 2²⁰)³ is.
const LARGEST_OFFSET: i128 = 6 << 60;
/// Components of normals are below this.
const LARGEST_NORMAL: i64 = 1 << 41;

/// An eye: in the lattice, or somewhere else, up to as far away as it may be.
fn eye(random: &mut fastrand::Rng) -> [i64; 3] {
    let far = FARTHEST - 1;
    let kind = random.u32(0..4);
    std::array::from_fn(|_| match kind {
        0 => random.i64(0..=LAST.into()),
        1 => random.i64(-20..20),
        2 => random.i64(-far..=far),
        _ => {
            if random.bool() {
                far
            } else {
                -far
            }
        }
    })
}

fn corner(random: &mut fastrand::Rng) -> Point {
    std::array::from_fn(|_| match random.u32(0..4) {
        0 => 0,
        1 => LAST,
        _ => random.i32(0..=LAST),
    })
}

/// A normal: of a triangle, at right angles to the eye's direction, small, or as large as it may be.
fn normal(random: &mut fastrand::Rng, eye: [i64; 3]) -> [i64; 3] {
    let most = LARGEST_NORMAL - 1;
    match random.u32(0..4) {
        0 => Plane::of([0; 3].map(|_| corner(random))).normal,
        1 => {
            let (scale, other) = (random.i64(1..1 << 11), random.i64(-(1 << 31)..1 << 31));
            let k = random.usize(0..3);
            let mut normal = [other; 3];
            (normal[k], normal[(k + 1) % 3]) = (scale * eye[(k + 1) % 3], -scale * eye[k]);
            normal
        }
        2 => [0; 3].map(|_| random.i64(-3..=3)),
        _ => [0; 3].map(|_| [most, -most, random.i64(-most..=most)][random.usize(0..3)]),
    }
}

/// A plane through the eye, or near it, if it is one that triangles can have; any other plane if not.
fn plane(random: &mut fastrand::Rng, eye: [i64; 3]) -> Plane {
    let normal = normal(random, eye);
    let word = 1_i128 << 32;
    let away = [0, 1, -1, word, -word, word - 1, 1 - word, word / 2, -word / 2, 0][random.usize(0..10)];
    let offset: i128 = (0..3).map(|k| i128::from(normal[k]) * i128::from(eye[k])).sum::<i128>() - away;
    let any = random.i64(-(6 << 60)..=6 << 60) >> random.u32(0..63);
    let is_one = offset.abs() <= LARGEST_OFFSET;
    Plane { normal, offset: if is_one { offset as i64 } else { any } }
}

pub(super) fn sides(random: &mut fastrand::Rng) -> Parts {
    let eye = eye(random);
    let planes: Vec<_> = (0..random.usize(1..300)).map(|_| plane(random, eye).words()).collect();
    let frame = BspFrame { planes: planes.len() as u32, eye: eye.map(|c| c as i32), ..BspFrame::default() };
    (Items::Count(frame.planes), vec![words(&[frame]), words(&planes), vec![2; planes.len()]])
}

/// A grid, and an eye before it, in it or beyond it.
fn frame(random: &mut fastrand::Rng) -> BspFrame {
    let most = [2, 5, 9][random.usize(0..3)];
    let slabs = [0; 3].map(|_| random.u32(1..=most));
    let eye_slabs = slabs.map(|slabs| [0, random.u32(0..=slabs), slabs][random.usize(0..3)]);
    BspFrame { cells: slabs.iter().product(), slabs, eye_slabs, ..BspFrame::default() }
}

pub(super) fn cells(random: &mut fastrand::Rng) -> Parts {
    let frame = frame(random);
    let mut first_pieces = vec![random.u32(0..3)];
    for cell in 0..frame.cells as usize {
        let pieces = if random.bool() { 0 } else { random.u32(1..1000) };
        first_pieces.push(first_pieces[cell] + pieces);
    }
    let counts = vec![u32::MAX; frame.cells as usize + 1];
    (Items::Count(frame.cells), vec![words(&[frame]), first_pieces, counts])
}

/// How trees grow.
#[derive(Clone, Copy)]
enum Growth {
    /// Either way.
    Any,
    /// All that is left is before each node.
    ToFront,
    /// All that is left is behind each node.
    ToBack,
}

/// Adds a tree of so many nodes; gives its pieces.
fn grow(random: &mut fastrand::Rng, nodes: &mut Vec<BspNode>, count: usize, growth: Growth) -> u32 {
    if count == 0 {
        return 0;
    }
    let before = match growth {
        Growth::Any => random.usize(0..count),
        Growth::ToFront => count - 1,
        Growth::ToBack => 0,
    };
    let root = nodes.len();
    let own = if random.u8(0..3) == 0 { random.u32(2..6) } else { 1 };
    nodes.push(BspNode { triangle: random.u32(0..TRIANGLES), own, ..BspNode::default() });
    let front = grow(random, nodes, before, growth);
    let to_back = (nodes.len() - root) as u32;
    let back = grow(random, nodes, count - 1 - before, growth);
    let node = &mut nodes[root];
    (node.front, node.back) = (front, back);
    node.to_back = if back > 0 { to_back } else { 0 };
    own + front + back
}

/// Whose planes trees have.
const TRIANGLES: u32 = 50;

pub(super) fn ranks(random: &mut fastrand::Rng) -> Parts {
    let frame = frame(random);
    let (mut nodes, mut first_nodes, mut first_pieces) = (Vec::new(), vec![0], vec![0]);
    let mut counts = empty::<u32>(frame.cells as usize + 1);
    let mut all = 0;
    for cell in 0..frame.cells {
        let count = [0, 1, random.usize(0..30), random.usize(0..200)][random.usize(0..4)];
        let growth = [Growth::Any, Growth::Any, Growth::ToFront, Growth::ToBack][random.usize(0..4)];
        let pieces = grow(random, &mut nodes, count, growth);
        all += pieces;
        counts[place_of(&frame, cell) as usize] = pieces;
        first_nodes.push(nodes.len() as u32);
        first_pieces.push(all);
    }
    sort::scan(&AccelFrame { counts: frame.cells, ..AccelFrame::default() }, &mut counts);
    let is_before = (0..TRIANGLES).map(|_| random.u32(0..2)).collect();
    if nodes.is_empty() {
        nodes.push(BspNode::default());
    }
    let (places, order) = (vec![7; nodes.len()], vec![u32::MAX; all.max(1) as usize]);
    let buffers =
        vec![words(&[frame]), words(&nodes), first_nodes, first_pieces, is_before, counts, places, order];
    (Items::Count(frame.cells), buffers)
}
