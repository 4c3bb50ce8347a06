//! Cells of a uniform grid, and in which order an eye sees them.

use super::exact::each;
use super::lattice::Point;
use super::plane::Plane;
use crate::abi::BspFrame;

/// The place of a slab of cells along one axis, far to near, and in turns the slab at a place: slab `k` holds coordinates
/// above `ends[k - 1]`, up to `ends[k]`. Those before the eye's come as they are, then the others from the last one to it.
///
/// Slab by slab, those far from the eye first, first along x, then y, then z, is itself an exact order: any two cells are
/// apart by one of these planes.
#[inline(always)]
#[must_use]
pub const fn far_to_near(slabs: u32, eye_slab: u32, slab: u32) -> u32 {
    if slab < eye_slab { slab } else { eye_slab + (slabs - 1 - slab) }
}

/// The place of a cell, far to near. Cells are numbered along z first, then y, then x.
#[inline(always)]
#[must_use]
pub const fn place_of(frame: &BspFrame, cell: u32) -> u32 {
    let ([slabs, rows, columns], [x, y, z]) = (frame.slabs, frame.eye_slabs);
    let row = cell / columns;
    let x = far_to_near(slabs, x, row / rows);
    let y = far_to_near(rows, y, row % rows);
    (x * rows + y) * columns + far_to_near(columns, z, cell % columns)
}

impl BspFrame {
    /// Of an eye before a grid whose slabs have these ends, and of so many planes.
    #[must_use]
    pub fn new(ends: [&[i32]; 3], planes: u32, eye: [i64; 3]) -> Self {
        let slabs = each(|axis| ends[axis].len() as u32);
        let eye_slabs = each(|axis| slab_of(ends[axis], eye[axis]));
        let cells = slabs.iter().product();
        Self { planes, cells, slabs, eye_slabs, eye: eye.map(|c| c as i32), zero: 0 }
    }
}

/// The slab that a coordinate is in; as many as there are slabs if it is beyond the last one. What is before the first slab
/// is in it: all others are behind it.
#[must_use]
pub fn slab_of(ends: &[i32], at: i64) -> u32 {
    let last = ends.len() - 1;
    let (first_end, last_end) = (i64::from(ends[0]), i64::from(ends[last]));
    if at <= first_end {
        return 0;
    }
    if at > last_end {
        return ends.len() as u32;
    }
    // Slabs are about as large as each other: this is the one, or next to it.
    let mut slab = ((at - first_end) as u64 * last as u64 / (last_end - first_end) as u64) as usize;
    while i64::from(ends[slab]) < at {
        slab += 1;
    }
    while slab > 0 && i64::from(ends[slab - 1]) >= at {
        slab -= 1;
    }
    slab as u32
}

/// Last coordinate of slab `k` of so many between two coordinates.
#[must_use]
pub const fn slab_end(low: i32, high: i32, slab: u32, slabs: u32) -> i32 {
    low + ((high - low) as i64 * (slab + 1) as i64 / slabs as i64) as i32
}

/// The plane behind a slab.
#[must_use]
pub const fn slab_plane(ends: &[i32], axis: usize, slab: u32) -> Plane {
    Plane::across(axis, ends[slab as usize])
}

/// First and last slab that a triangle touches along an axis.
#[must_use]
pub fn slabs_of(ends: &[i32], axis: usize, [a, b, c]: &[Point; 3]) -> [u32; 2] {
    let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
    [slab_of(ends, i64::from(low)), slab_of(ends, i64::from(high))]
}

/// In which of four cells about a corner of the grid, along two axes, a triangle has something that spans two slabs along
/// both: bit 0 before both slabs' ends, bit 1 beyond the first's, bit 2 beyond the second's, bit 3 beyond both. The corner
/// is at half of these coordinates, which are odd: no corner of a triangle has its.
#[must_use]
pub fn quadrants(triangle: &[Point; 3], axes: [usize; 2], corner: [i32; 2]) -> u32 {
    let away = |k: usize, axis: usize| 2 * i64::from(triangle[k][axes[axis]]) - i64::from(corner[axis]);
    let quadrant = |k: usize| usize::from(away(k, 0) > 0) | usize::from(away(k, 1) > 0) << 1;
    let (mut touched, mut turns) = (0, [0; 3]);
    for (k, turn) in turns.iter_mut().enumerate() {
        let next = (k + 1) % 3;
        let (x, y, next_x, next_y) = (away(k, 0), away(k, 1), away(next, 0), away(next, 1));
        *turn = (x * next_y - y * next_x).signum();
        touched |= 1 << quadrant(k);
        if quadrant(k) ^ quadrant(next) == 3 {
            touched |= passed(quadrant(k), *turn);
        }
    }
    if turns == [1; 3] || turns == [-1; 3] { 0b1111 } else { touched }
}

/// The quadrant between two that are opposite, through which a side goes that turns this way about the corner.
const fn passed(from: usize, turn: i64) -> u32 {
    // Counter-clockwise: 0 (below left), 1 (right of it), 3, 2.
    let next = [1, 3, 0, 2];
    match turn {
        1 => 1 << next[from],
        -1 => 1 << (next[from] ^ 3),
        _ => 0,
    }
}
