//! Cells of a uniform grid, and in which order an eye sees them.

use super::lattice::Point;
use super::plane::Plane;

/// Slabs of cells along one axis: slab `k` holds coordinates above `ends[k - 1]`, up to `ends[k]`.
///
/// Slab by slab, those far from the eye first, first along x, then y, then z, is itself an exact order: any two cells are
/// apart by one of these planes.
pub fn far_to_near(slabs: u32, eye_slab: u32) -> impl Iterator<Item = u32> + Clone {
    let near = if eye_slab < slabs { Some(eye_slab) } else { None };
    (0..eye_slab.min(slabs)).chain((eye_slab.saturating_add(1)..slabs).rev()).chain(near)
}

/// The slab that a coordinate is in; as many as there are slabs if it is beyond the last one. What is before the first slab
/// is in it: all others are behind it.
#[must_use]
pub fn slab_of(ends: &[i32], at: i64) -> u32 {
    ends.partition_point(|end| i64::from(*end) < at) as u32
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
