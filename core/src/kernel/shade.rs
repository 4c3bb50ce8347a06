//! shade: a colour a vertex. Ambient and diffuse light (Lambert) and a highlight (Blinn 1977), two-sided.

use crate::abi::{Frame, Object, SHADE_TINY};
use crate::kernel::dice::{Grid, LANES, load3, store};
use crate::num::{add, add3, dot3, flush, max, mul, neg, rsqrt, scale3, sub};

/// Fills `grid.colour` with linear RGB from positions and normals.
#[inline(always)]
pub fn shade(frame: &Frame, object: &Object, grid: &mut Grid) {
    for block in grid.blocks() {
        let colour = colours(frame, object, load3(&grid.position, block), load3(&grid.normal, block));
        for (all, lanes) in grid.colour.iter_mut().zip(&colour) {
            store(all, block, lanes);
        }
    }
}

/// Linear RGB of [`LANES`] points in eye space, given unit normals.
#[inline(always)]
#[must_use]
pub fn colours(
    frame: &Frame,
    object: &Object,
    point: [[f32; LANES]; 3],
    mut normal: [[f32; LANES]; 3],
) -> [[f32; LANES]; 3] {
    let mut to_eye = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let away = unit([point[0][l], point[1][l], point[2][l]]);
        [to_eye[0][l], to_eye[1][l], to_eye[2][l]] = scale3(away, neg(1.0));
        let facing = towards_eye(away, [normal[0][l], normal[1][l], normal[2][l]]);
        [normal[0][l], normal[1][l], normal[2][l]] = facing;
    }
    let mut colour = [[0.0; LANES]; 3];
    for k in 0..3 {
        colour[k] = [mul(frame.ambient[k], object.colour[k]); LANES];
    }
    for light in 0..frame.light_count as usize {
        add_light(frame, object, light, [&point, &to_eye, &normal], &mut colour);
    }
    colour
}

/// Adds what one light contributes to [`LANES`] vertices, given their positions, the unit directions to the
/// eye and the unit normals on its side.
#[inline(always)]
fn add_light(
    frame: &Frame,
    object: &Object,
    light: usize,
    [point, to_eye, normal]: [&[[f32; LANES]; 3]; 3],
    colour: &mut [[f32; LANES]; 3],
) {
    let (mut diffuse, mut highlight) = ([0.0; LANES], [0.0; LANES]);
    for l in 0..LANES {
        let point = [point[0][l], point[1][l], point[2][l]];
        let normal = [normal[0][l], normal[1][l], normal[2][l]];
        let to_light = direction(frame.light_vector[light], point);
        let half = unit(add3(to_light, [to_eye[0][l], to_eye[1][l], to_eye[2][l]]));
        diffuse[l] = max(dot3(normal, to_light), 0.0);
        highlight[l] = if diffuse[l] > 0.0 { max(dot3(normal, half), 0.0) } else { 0.0 };
    }
    for _ in 0..object.gloss {
        for h in &mut highlight {
            *h = flush(mul(*h, *h));
        }
    }
    for k in 0..3 {
        for l in 0..LANES {
            let reflected = add(mul(object.colour[k], diffuse[l]), mul(object.specular, highlight[l]));
            colour[k][l] = add(colour[k][l], mul(reflected, frame.light_colour[light][k]));
        }
    }
}

/// The unit vector from a point to a light.
#[inline(always)]
fn direction(light: [f32; 4], point: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = scale3(point, light[3]);
    unit([sub(light[0], x), sub(light[1], y), sub(light[2], z)])
}

/// The normal, turned to the side that the eye sees.
#[inline(always)]
fn towards_eye(away: [f32; 3], normal: [f32; 3]) -> [f32; 3] {
    let flip = if dot3(normal, away) > 0.0 { -1.0 } else { 1.0 };
    scale3(normal, flip)
}

#[inline(always)]
fn unit(a: [f32; 3]) -> [f32; 3] {
    scale3(a, rsqrt(max(dot3(a, a), SHADE_TINY)))
}
