//! shade: a colour a vertex. Ambient and diffuse light (Lambert) and a highlight (Blinn 1977), two-sided.

use crate::abi::{Frame, Object};
use crate::kernel::dice::Grid;
use crate::num::{add, dot3, flush, max, mul, neg, rsqrt, scale3, sub};

/// Smallest squared length that is normalised.
const TINY: f32 = 1.0e-30;

/// Fills `grid.colour` with linear RGB from positions and normals.
#[inline(always)]
pub fn shade<const ROW: usize>(frame: &Frame, object: &Object, grid: &mut Grid<ROW>) {
    for row in 0..=frame.rate as usize {
        let (position, normal) = (&grid.position[row], &grid.normal[row]);
        let colour = &mut grid.colour[row];
        ambient(frame, object, colour);
        for light in 0..frame.light_count as usize {
            add_light(frame, object, light, position, normal, colour);
        }
    }
}

#[inline(always)]
fn ambient<const ROW: usize>(frame: &Frame, object: &Object, colour: &mut [[f32; ROW]; 3]) {
    for k in 0..3 {
        colour[k] = [mul(frame.ambient[k], object.colour[k]); ROW];
    }
}

/// Adds what one light contributes to a row of vertices.
#[inline(always)]
fn add_light<const ROW: usize>(
    frame: &Frame,
    object: &Object,
    light: usize,
    position: &[[f32; ROW]; 3],
    normal: &[[f32; ROW]; 3],
    colour: &mut [[f32; ROW]; 3],
) {
    let intensity = frame.light_colour[light];
    let (mut diffuse, mut highlight) = ([0.0; ROW], [0.0; ROW]);
    for l in 0..ROW {
        let point = [position[0][l], position[1][l], position[2][l]];
        let facing = towards_eye(point, [normal[0][l], normal[1][l], normal[2][l]]);
        let to_light = direction(frame.light_vector[light], point);
        let to_eye = scale3(unit(point), neg(1.0));
        let half = unit([0, 1, 2].map(|k| add(to_light[k], to_eye[k])));
        diffuse[l] = max(dot3(facing, to_light), 0.0);
        highlight[l] = if diffuse[l] > 0.0 { max(dot3(facing, half), 0.0) } else { 0.0 };
    }
    for _ in 0..object.gloss {
        for h in &mut highlight {
            *h = flush(mul(*h, *h));
        }
    }
    for k in 0..3 {
        for l in 0..ROW {
            let reflected = add(mul(object.colour[k], diffuse[l]), mul(object.specular, highlight[l]));
            colour[k][l] = add(colour[k][l], mul(reflected, intensity[k]));
        }
    }
}

/// The unit vector from a point to a light.
#[inline(always)]
fn direction(light: [f32; 4], point: [f32; 3]) -> [f32; 3] {
    unit([0, 1, 2].map(|k| sub(light[k], mul(point[k], light[3]))))
}

/// The normal, turned to the side that the eye sees.
#[inline(always)]
fn towards_eye(point: [f32; 3], normal: [f32; 3]) -> [f32; 3] {
    let flip = if dot3(normal, point) > 0.0 { -1.0 } else { 1.0 };
    scale3(normal, flip)
}

#[inline(always)]
fn unit(a: [f32; 3]) -> [f32; 3] {
    scale3(a, rsqrt(max(dot3(a, a), TINY)))
}
