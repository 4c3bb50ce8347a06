//! Random patches, surfaces and views, and exact evaluation, shared by the tests.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test uses its part

use glam::{DAffine3, DVec3, Vec3};
use micropoly_core::abi::{
    DRAW, Draw, Frame, MAX_RATE, Object, PARAM_BITS, Patch, SPLIT_U, SPLIT_V, Surface, Verdict,
};
use micropoly_core::border::{SIDES, Side};
use micropoly_core::camera::{Camera, FrameOptions, Light, Material};
use micropoly_core::patch::Net;
use micropoly_core::patch::gregory::INNER;

/// A number generator whose seed stands in every failure message.
pub fn random(seed: u64) -> fastrand::Rng {
    fastrand::Rng::with_seed(seed)
}

pub fn between(random: &mut fastrand::Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * random.f32()
}

/// Control points scattered around a flat square of side 2.
pub fn random_patch(random: &mut fastrand::Rng, roughness: f32) -> Patch {
    let mut patch = Patch::default();
    for k in 0..16 {
        patch.x[k] = (k / 4) as f32 / 1.5 - 1.0 + between(random, -roughness, roughness);
        patch.y[k] = (k % 4) as f32 / 1.5 - 1.0 + between(random, -roughness, roughness);
        patch.z[k] = between(random, -roughness, roughness);
    }
    patch
}

/// A patch and the record of its face points, which lie around its inner points.
pub fn random_gregory(random: &mut fastrand::Rng, roughness: f32, apart: f32) -> [Patch; 2] {
    let mut patch = random_patch(random, roughness);
    let mut record = Patch::default();
    for (m, at) in INNER.into_iter().enumerate() {
        let mut place = |c: &mut [f32; 16], faces: &mut [f32; 16]| {
            faces[m] = c[at] + between(random, -apart, apart);
            faces[4 + m] = c[at] + between(random, -apart, apart);
            c[at] = 0.5 * (faces[m] + faces[4 + m]);
        };
        place(&mut patch.x, &mut record.x);
        place(&mut patch.y, &mut record.y);
        place(&mut patch.z, &mut record.z);
    }
    patch.faces = 1;
    [patch, record]
}

/// A view of 640×360 pixels from anywhere around the origin, inside the patch now and then.
pub fn random_view(random: &mut fastrand::Rng, near: f64) -> (Frame, Object) {
    let axis = |random: &mut fastrand::Rng| f64::from(between(random, -1.0, 1.0));
    let direction = DVec3::new(axis(random), axis(random), axis(random) + 1.0e-3);
    let eye = direction * 4.0 * f64::from(random.f32());
    let target = DVec3::new(axis(random), axis(random), axis(random));
    let camera = Camera::look_at(eye, target, DVec3::new(0.1, 0.2, 1.0), 50.0, near).expect("a view");
    view(&camera, 640, 360)
}

pub fn view(camera: &Camera, width: u32, height: u32) -> (Frame, Object) {
    let options = FrameOptions { width, height, ..FrameOptions::default() };
    let light = Light::Directional { to_light: DVec3::new(1.0, 2.0, 3.0), colour: Vec3::ONE };
    let material = Material { colour: Vec3::splat(0.5), specular: 0.2, gloss: 4, opacity: 1.0 };
    (camera.frame(&options, Vec3::splat(0.1), &[light]), camera.object(DAffine3::IDENTITY, &material))
}

/// A surface somewhere in the first patch; often its sides were divided somehow on the way there.
pub fn random_surface(random: &mut fastrand::Rng, deepest: u32) -> Surface {
    let (mut surface, seldom) = (Surface::root(0), [2, 8, u32::MAX][random.usize(0..3)]);
    for _ in 0..random.u32(0..=deepest) {
        let code = if random.bool() { SPLIT_U } else { SPLIT_V };
        let verdict = divided(random, surface, code, seldom);
        surface = surface.halves(verdict)[usize::from(random.bool())];
    }
    surface
}

/// A verdict on a surface that divides one in `seldom` of its live sides.
pub fn divided(random: &mut fastrand::Rng, surface: Surface, code: u32, seldom: u32) -> Verdict {
    let sides = SIDES.map(|side| {
        let (known, level) = (surface.side(side), [surface.u_level(), surface.v_level()][side / 2]);
        let steps = random.u32(1..=MAX_RATE);
        if known.steps > 0 || random.u32(0..seldom) > 0 {
            known
        } else {
            Side { steps, bits: PARAM_BITS - level }
        }
    });
    Verdict { code, ..Verdict::default() }.with_sides(sides, [0; 2])
}

/// A surface to be diced so finely, or finer if its sides need it.
pub fn draw_at(surface: Surface, rates: [u32; 2]) -> Draw {
    let least = |first: usize| surface.steps_needed(first).max(surface.steps_needed(first + 1));
    let rates = [rates[0].max(least(0)), rates[1].max(least(2))];
    let sides = SIDES.map(|side| surface.side(side));
    Draw::new(surface, Verdict { code: DRAW, ..Verdict::default() }.with_sides(sides, rates))
}

/// Rates from 1 to the largest.
pub fn random_rates(random: &mut fastrand::Rng) -> [u32; 2] {
    [0; 2].map(|_| random.u32(1..=MAX_RATE))
}

/// The point at (u, v) by de Casteljau's algorithm in f64.
pub fn exact_point(net: &Net, u: f64, v: f64) -> [f64; 3] {
    let curve = |c: [f64; 4], t: f64| {
        let mix = |a: f64, b: f64| a + (b - a) * t;
        let (a, b, c) = (mix(c[0], c[1]), mix(c[1], c[2]), mix(c[2], c[3]));
        mix(mix(a, b), mix(b, c))
    };
    [&net.x, &net.y, &net.z].map(|c| {
        let row = |i: usize| curve([0, 1, 2, 3].map(|j| f64::from(c[4 * i + j])), v);
        curve([row(0), row(1), row(2), row(3)], u)
    })
}
