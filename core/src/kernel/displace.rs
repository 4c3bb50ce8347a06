//! displace: vertices move along their normals, by bumps that are a function of where they are in object space.
//!
//! The bumps are value noise (Ebert et al., Texturing & Modeling, ch. 2): heights at the points of a lattice, smoothly
//! interpolated, in octaves. A displaced vertex is a pure function of patch and parameter, evaluated on the patch that
//! owns it ([`crate::patch::owner`]), in the space of its object: so neighbours agree, and the camera does not matter.
//! Its normal is tilted by the slope of the bumps (Blinn 1978): right to first order in height times curvature.

use crate::abi::{
    Draw, FLAT, Frame, HASH_FIRST, HASH_OCTAVE, HASH_SECOND, HASH_X, HASH_Y, HASH_Z, KIND_RATIONAL,
    LATTICE_END, LATTICE_NEAR, LATTICE_STEP, Object, Patch, SHADE_TINY,
};
use crate::kernel::dice::{
    Grid, LANES, Vertex, evaluate_bezier, load3, normal_of, prepare_grid, project_all, size, store,
};
use crate::kernel::dice_gregory::evaluate_gregory;
use crate::num::{
    add, add3, clamp, dot3, float, floor, flush, flush3, largest3, max, mul, neg, rsqrt, scale3, sub,
    unit_scale,
};
use crate::patch::gregory::mix;
use crate::patch::instance::{Instance, instance};
use crate::patch::owner::Owner;
use crate::patch::{Faces, Net, Weights};

/// A number that varies in space, and its derivatives along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bump {
    /// The number.
    pub value: f32,
    /// How it changes.
    pub slope: [f32; 3],
}

/// How far points of an object are displaced, in object units, and how that changes along x, y and z.
#[inline(always)]
#[must_use]
pub fn bump<const N: usize>(object: &Object, point: &[[f32; N]; 3]) -> ([f32; N], [[f32; N]; 3]) {
    let (mut height, mut frequency) = (object.height, object.frequency);
    let (mut value, mut slope) = ([0.0; N], [[0.0; N]; 3]);
    for octave in 0..object.octaves {
        for l in 0..N {
            let noise = noise(scale3(lane(point, l), frequency), octave);
            let steep = flush3(scale3(noise.slope, mul(height, frequency)));
            value[l] = add(value[l], flush(mul(height, noise.value)));
            slope[0][l] = add(slope[0][l], steep[0]);
            slope[1][l] = add(slope[1][l], steep[1]);
            slope[2][l] = add(slope[2][l], steep[2]);
        }
        (height, frequency) = (mul(0.5, height), mul(2.0, frequency));
    }
    (value, slope)
}

/// Value noise: from -1 to 1, with one value a unit cube's corner.
#[inline(always)]
#[must_use]
pub fn noise(point: [f32; 3], octave: u32) -> Bump {
    let (mut cell, mut weight, mut slope) = ([0; 3], [0.0; 3], [0.0; 3]);
    for k in 0..3 {
        let c = clamp(flush(point[k]), neg(LATTICE_END), LATTICE_END);
        cell[k] = floor(c);
        let within = sub(c, float(cell[k]));
        (weight[k], slope[k]) = fade(if within < LATTICE_NEAR { 0.0 } else { within });
    }
    let at = |x: i32, y: i32, z: i32| lattice([cell[0] + x, cell[1] + y, cell[2] + z], octave);
    let low = square([[at(0, 0, 0), at(1, 0, 0)], [at(0, 1, 0), at(1, 1, 0)]], weight, slope);
    let high = square([[at(0, 0, 1), at(1, 0, 1)], [at(0, 1, 1), at(1, 1, 1)]], weight, slope);
    Bump {
        value: mix(low.value, high.value, weight[2]),
        slope: [
            mix(low.slope[0], high.slope[0], weight[2]),
            mix(low.slope[1], high.slope[1], weight[2]),
            mul(sub(high.value, low.value), slope[2]),
        ],
    }
}

/// The same between the corners of a unit square, in rows along x.
#[inline(always)]
fn square(rows: [[f32; 2]; 2], weight: [f32; 3], slope: [f32; 3]) -> Bump {
    let [low, high] = rows.map(|[a, b]| (mix(a, b, weight[0]), mul(sub(b, a), slope[0])));
    Bump {
        value: mix(low.0, high.0, weight[1]),
        slope: [mix(low.1, high.1, weight[1]), mul(sub(high.0, low.0), slope[1]), 0.0],
    }
}

/// From 0 to 1, smooth to the second derivative at both ends (Perlin 2002), and its derivative.
#[inline(always)]
const fn fade(t: f32) -> (f32, f32) {
    let (s, tt) = (sub(1.0, t), mul(t, t));
    let inner = add(mul(t, sub(mul(6.0, t), 15.0)), 10.0);
    (mul(mul(tt, t), inner), mul(30.0, mul(tt, mul(s, s))))
}

/// The height at a point of the lattice: -1 ..< 1, exactly.
#[inline(always)]
const fn lattice(at: [i32; 3], octave: u32) -> f32 {
    let [x, y, z] = [at[0] as u32, at[1] as u32, at[2] as u32];
    let place = x.wrapping_mul(HASH_X) ^ y.wrapping_mul(HASH_Y) ^ z.wrapping_mul(HASH_Z);
    let hash = mixed(place.wrapping_add(octave.wrapping_mul(HASH_OCTAVE)));
    sub(mul(float((hash >> 8) as i32), LATTICE_STEP), 1.0)
}

/// Every bit of the result depends on every bit given.
#[inline(always)]
const fn mixed(hash: u32) -> u32 {
    let first = (hash ^ hash >> 16).wrapping_mul(HASH_FIRST);
    let second = (first ^ first >> 15).wrapping_mul(HASH_SECOND);
    second ^ second >> 16
}

/// What a patch is evaluated from, in the space of its object.
#[derive(Clone, Copy, Debug)]
struct Source {
    net: Net,
    more: More,
    /// Tangents no longer than this have vanished.
    flat: f32,
}

/// What some kinds of patches have besides their control points.
#[derive(Clone, Copy, Debug)]
enum More {
    Nothing,
    Faces(Faces),
    Weights(Weights),
}

impl Source {
    #[inline(always)]
    fn new(patches: &[Patch], patch_id: u32) -> Self {
        let patch = &patches[patch_id as usize];
        let net = Net::in_object_space(patch);
        let more = match patch.faces {
            0 => More::Nothing,
            record if patch.kind & KIND_RATIONAL != 0 => {
                More::Weights(Weights::of(&patches[record as usize]))
            }
            record => More::Faces(Faces::in_object_space(&patches[record as usize])),
        };
        Self { more, flat: mul(size(&net), FLAT), net }
    }

    /// The same seen from the eye.
    #[inline(always)]
    fn in_eye_space(patches: &[Patch], patch_id: u32, object: &Object) -> Self {
        let patch = &patches[patch_id as usize];
        let net = Net::in_eye_space(patch, object);
        let more = match Self::new(patches, patch_id).more {
            More::Faces(_) => More::Faces(Faces::in_eye_space(&patches[patch.faces as usize], object)),
            same => same,
        };
        Self { more, flat: mul(size(&net), FLAT), net }
    }

    /// The point at a parameter, and the unit normal there.
    #[inline(always)]
    fn vertex(&self, frame: &Frame, u: u32, v: u32) -> ([f32; 3], [f32; 3]) {
        let vertex = self.evaluate(frame, u, v);
        (vertex.point, normal_of(&self.net, &vertex, u, v, self.flat))
    }

    #[inline(always)]
    fn evaluate(&self, frame: &Frame, u: u32, v: u32) -> Vertex {
        match &self.more {
            More::Nothing => evaluate_bezier(&self.net, u, v),
            More::Faces(faces) => evaluate_gregory(&self.net, faces, frame, u, v),
            More::Weights(weights) => weights.evaluate(&self.net, u, v),
        }
    }
}

/// Fills positions, normals and snapped vertices of a surface of an object that is displaced, as
/// [`crate::kernel::dice::dice`] does of one that is not.
#[inline(always)]
pub fn dice_displaced(
    frame: &Frame,
    patches: &[Patch],
    record: u32,
    object: &Object,
    draw: Draw,
    grid: &mut Grid,
) {
    prepare_grid(draw, grid);
    dice_smooth(frame, patches, record, draw, grid);
    for block in grid.blocks() {
        displace_block(object, block, grid);
    }
    project_all(frame, grid);
}

/// Positions and unit normals before they are displaced, each on its owner, in the space of the object.
#[inline(never)]
fn dice_smooth(frame: &Frame, patches: &[Patch], record: u32, draw: Draw, grid: &mut Grid) {
    let patch = &patches[record as usize];
    let own = Source::new(patches, record);
    for at in 0..grid.stride * grid.rows {
        let [u, v] = draw.vertex((at / grid.stride) as u32, (at % grid.stride) as u32);
        let Owner { patch_id, u, v } = patch.owner(record, u, v);
        let (point, normal) = if patch_id == record {
            own.vertex(frame, u, v)
        } else {
            Source::new(patches, patch_id).vertex(frame, u, v)
        };
        grid.put(at, point, normal);
    }
}

/// The unit normal, in eye space, of what is drawn at a parameter of a patch, displaced or not.
#[must_use]
pub fn normal_at(
    frame: &Frame,
    objects: &[Object],
    patches: &[Patch],
    patch_id: u32,
    u: u32,
    v: u32,
) -> [f32; 3] {
    let Instance { record, object } = instance(frame, objects, patches, patch_id);
    let object = &objects[object as usize];
    if object.reach > 0.0 {
        let Owner { patch_id, u, v } = patches[record as usize].owner(record, u, v);
        let (point, normal) = Source::new(patches, patch_id).vertex(frame, u, v);
        let slope = lane(&bump(object, &point.map(|k| [k; LANES])).1, 0);
        let along = add3(slope, scale3(normal, neg(dot3(slope, normal))));
        return object.normal_to_eye(add3(normal, scale3(along, -1.0)));
    }
    Source::in_eye_space(patches, record, object).vertex(frame, u, v).1
}

/// Displaces [`LANES`] vertices, and moves them to eye space.
#[inline(always)]
fn displace_block(object: &Object, block: usize, grid: &mut Grid) {
    let (point, normal) = (load3(&grid.position, block), load3(&grid.normal, block));
    let (mut points, mut normals) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
    let (value, slope) = bump(object, &point);
    for l in 0..LANES {
        let (point, normal, slope) = (lane(&point, l), lane(&normal, l), lane(&slope, l));
        let along = add3(slope, scale3(normal, neg(dot3(slope, normal))));
        let moved = object.point_to_eye(add3(point, scale3(normal, value[l])));
        let turned = object.normal_to_eye(add3(normal, scale3(along, -1.0)));
        for k in 0..3 {
            (points[k][l], normals[k][l]) = (moved[k], turned[k]);
        }
    }
    for k in 0..3 {
        store(&mut grid.position[k], block, &points[k]);
        store(&mut grid.normal[k], block, &normals[k]);
    }
}

#[inline(always)]
const fn lane<const N: usize>(all: &[[f32; N]; 3], l: usize) -> [f32; 3] {
    [all[0][l], all[1][l], all[2][l]]
}

impl Object {
    /// The unit vector, in eye space, of a normal in the object's space.
    #[inline(always)]
    #[must_use]
    pub fn normal_to_eye(&self, normal: [f32; 3]) -> [f32; 3] {
        let m = &self.normal_to_eye;
        let normal = scale3(normal, unit_scale(largest3(normal)));
        let [x, y, z] =
            [[m[0], m[1], m[2]], [m[3], m[4], m[5]], [m[6], m[7], m[8]]].map(|row| dot3(row, normal));
        let turned = scale3([x, y, z], unit_scale(largest3([x, y, z])));
        let unit = scale3(turned, rsqrt(max(dot3(turned, turned), SHADE_TINY)));
        if largest3(unit) > 0.5 { flush3(unit) } else { [0.0, 0.0, 1.0] }
    }
}
