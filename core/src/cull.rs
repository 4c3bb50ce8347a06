//! Where in an image something can be seen at most, and how near: what culling of whole patches goes by. Host side; no stage
//! uses it.
//!
//! A patch is known by where its control points are seen: all that is ever drawn of it lies in their hull. Everything is
//! rounded outwards, so that it holds for the snapped vertices and the depths of the kernels, too: a depth that is
//! interpolated never leaves the range of its triangle's corners ([`crate::kernel::triangle::weighted`]).

use crate::abi::{Frame, KIND_RATIONAL, OWNER_SHIFT, Object, Patch, ROUNDING, SUBPIXELS, Sample};
use crate::border::SIDES;
use crate::kernel::project::perspective;
use crate::kernel::triangle::{place, samples_between};
use crate::num::{abs, add, clamp, float, floor, largest3, max, min, mul, neg, recip, sub};
use crate::patch::half::SIDE_POINTS;
use crate::patch::instance::instance;
use crate::patch::{Faces, Net};

/// Twice what rounding can do to a point of a patch, also to one of a rational patch: a share of its extent.
const SLACK: f32 = 8.0 * ROUNDING;
/// Several times what rounding can do to a place on screen, or to 1 / distance: a share of it.
const RELATIVE: f32 = 1.0 / (1 << 18) as f32;
/// Pixels by which a snapped vertex can be beside its point, twice.
const SNAPPED: f32 = 1.0 / SUBPIXELS as f32;
/// Farther from the optical axis, pixels, there is nothing to see.
const FAR: f32 = (1 << 20) as f32;

/// Where something can be seen at most, were the image without end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Least and largest offset to the right of the optical axis, pixels.
    x: [f32; 2],
    /// The same below it.
    y: [f32; 2],
    /// Nothing of it has a larger [`Sample::depth`].
    nearest: u32,
}

impl Sight {
    /// Nothing is seen.
    const NONE: Self = Self { x: [FAR, -FAR], y: [FAR, -FAR], nearest: 0 };

    /// Of all that can be drawn of a patch.
    #[must_use]
    pub fn of_patch(frame: &Frame, objects: &[Object], patches: &[Patch], patch_id: u32) -> Self {
        let known = instance(frame, objects, patches, patch_id);
        let (patch, object) = (&patches[known.record as usize], &objects[known.object as usize]);
        let net = Net::in_eye_space(patch, object);
        let mut hull = Hull::NONE.with(frame, &net.x, &net.y, &net.z);
        if patch.faces != 0 && patch.kind & KIND_RATIONAL == 0 {
            let faces = Faces::in_eye_space(&patches[patch.faces as usize], object);
            hull = hull.with(frame, &faces.x, &faces.y, &faces.z);
        }
        for side in SIDES.into_iter().filter(|side| patch.is_half(*side)) {
            let [x, y, z] = whole_side(patches, object, patch.owners[side]);
            hull = hull.with(frame, &x, &y, &z);
        }
        hull.seen(frame, object.reach)
    }
}

/// The points of the whole side of which another one is half, given that one's word: its vertices are found there.
fn whole_side(patches: &[Patch], object: &Object, word: u32) -> [[f32; 4]; 3] {
    let coarse = &patches[(word >> OWNER_SHIFT) as usize - 1];
    let side = (word >> 1 & 3) as usize;
    let points = SIDE_POINTS[side].map(|l| object.point_to_eye([coarse.x[l], coarse.y[l], coarse.z[l]]));
    [0, 1, 2].map(|axis| points.map(|point| point[axis]))
}

/// Points in eye space: their box, and where they are seen.
#[derive(Clone, Copy, Debug)]
struct Hull {
    low: [f32; 3],
    high: [f32; 3],
    /// Offsets from the optical axis, of points that are before the near plane.
    x: [f32; 2],
    y: [f32; 2],
}

impl Hull {
    const NONE: Self = Self { low: [f32::MAX; 3], high: [-f32::MAX; 3], x: Sight::NONE.x, y: Sight::NONE.y };

    #[inline(always)]
    fn with<const N: usize>(self, frame: &Frame, x: &[f32; N], y: &[f32; N], z: &[f32; N]) -> Self {
        let (mut across, mut down) = ([0.0; N], [0.0; N]);
        for l in 0..N {
            (across[l], down[l], _) = perspective(frame, frame.near, [x[l], y[l], z[l]]);
        }
        let mut hull = self;
        for l in 0..N {
            let point = [x[l], y[l], z[l]];
            for axis in 0..3 {
                hull.low[axis] = min(hull.low[axis], point[axis]);
                hull.high[axis] = max(hull.high[axis], point[axis]);
            }
            hull.x = [min(hull.x[0], across[l]), max(hull.x[1], across[l])];
            hull.y = [min(hull.y[0], down[l]), max(hull.y[1], down[l])];
        }
        hull
    }

    /// Where what is inside is seen, if displacement can move it by `reach` along any axis.
    fn seen(&self, frame: &Frame, reach: f32) -> Sight {
        let extent = max(largest3(self.low), largest3(self.high));
        let spread = add(mul(extent, SLACK), reach);
        let nearest = sub(neg(self.high[2]), spread);
        let farthest = add(neg(self.low[2]), spread);
        if farthest < frame.near {
            return Sight::NONE;
        }
        let first = max(nearest, frame.near);
        let (x, y) = if nearest < frame.near {
            let along = |low, high| cut(frame, sub(low, spread), add(high, spread), farthest);
            (along(self.low[0], self.high[0]), along(neg(self.high[1]), neg(self.low[1])))
        } else {
            let off_axis =
                [self.x[0], self.x[1], self.y[0], self.y[1]].into_iter().fold(0.0, |a, b| max(a, abs(b)));
            let by = mul(mul(add(frame.focal, off_axis), spread), recip(nearest));
            (widened(self.x, by), widened(self.y, by))
        };
        let rounded = |x| widened(x, add(SNAPPED, mul(max(abs(x[0]), abs(x[1])), RELATIVE)));
        let nearest = mul(recip(first), add(1.0, RELATIVE)).to_bits();
        Sight { x: rounded(x), y: rounded(y), nearest }
    }
}

fn widened([low, high]: [f32; 2], by: f32) -> [f32; 2] {
    [sub(low, by), add(high, by)].map(|offset| clamp(offset, -FAR, FAR))
}

/// Least and largest offset, in pixels, of what lies from `low` to `high`, between the near plane and `farthest`: what is off
/// the axis is seen farthest off it where it is nearest.
fn cut(frame: &Frame, low: f32, high: f32, farthest: f32) -> [f32; 2] {
    let seen = |offset: f32, is_near: bool| {
        let at = if is_near { frame.near } else { max(farthest, frame.near) };
        clamp(mul(mul(offset, recip(at)), frame.focal), -FAR, FAR)
    };
    [seen(low, low < 0.0), seen(high, high > 0.0)]
}

/// What something can cover of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outline {
    /// Columns of samples: the first, and one past the last; counted from the frame's first.
    pub columns: [u32; 2],
    /// Rows of samples.
    pub rows: [u32; 2],
    /// Nothing in it has a larger [`Sample::depth`].
    pub nearest: u32,
}

impl Outline {
    /// `None` if it can never own a sample of the frame.
    #[must_use]
    pub fn of(frame: &Frame, sight: &Sight) -> Option<Self> {
        let columns = touched(frame, sight.x, frame.width, (frame.sample_left, frame.sample_right))?;
        let rows = touched(frame, sight.y, frame.height, (frame.sample_top, frame.sample_bottom))?;
        Some(Self { columns, rows, nearest: sight.nearest })
    }
}

/// The samples along one axis that something so far off the axis can touch, in an image of so many pixels, if there are any
/// among those of the frame.
fn touched(frame: &Frame, [low, high]: [f32; 2], pixels: u32, (first, end): (u32, u32)) -> Option<[u32; 2]> {
    let half = pixels as i32 * (SUBPIXELS / 2);
    let unit = float(SUBPIXELS);
    // Products with a power of two are exact.
    let (low, high) = (floor(mul(low, unit)) + half, floor(mul(high, unit)) + 1 + half);
    let (from, to) = samples_between(frame, low, high);
    let (from, to) = (from.max(first as i32), to.min(end as i32));
    (from < to).then(|| [from as u32 - first, to as u32 - first])
}

impl Frame {
    /// One past the last place of its samples in the buffers.
    #[must_use]
    pub const fn place_end(&self) -> u64 {
        if self.sample_left >= self.sample_right || self.sample_top >= self.sample_bottom {
            return 0;
        }
        place(self, self.sample_right as i32 - 1, self.sample_bottom as i32 - 1) as u64 + 1
    }
}

/// Depths of the samples of one of the frame's rows, counted from its first; there is one.
pub fn depths_of_row<'a>(frame: &Frame, samples: &'a [Sample], row: u32) -> impl Iterator<Item = u32> + 'a {
    let first = place(frame, frame.sample_left as i32, (frame.sample_top + row) as i32);
    let last = place(frame, frame.sample_right as i32 - 1, (frame.sample_top + row) as i32);
    samples[first..=last].iter().step_by(frame.place_column as usize).map(|sample| sample.depth)
}
