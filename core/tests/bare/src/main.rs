//! Renders one patch into a 16 × 16 image with micropoly-core alone: no std, no allocator, no C library.
//!
//! Exit code 0: some sample is covered; 1: none is; 101: a panic. If core, or anything below it, begins to
//! need std or an allocator, this program no longer links.
#![no_std]
#![no_main]

mod runtime;

use glam::{DAffine3, DVec3, Vec3};
use micropoly_core::abi::{Colour, Control, Draw, Frame, Limits, Object, Patch, Sample, Slot, Surface, Verdict};
use micropoly_core::camera::{Camera, FrameOptions, Light, Material};
use micropoly_core::kernel::dice::{Grid, dice};
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::sample::{Band, sample};
use micropoly_core::kernel::split::{Outcome, split};
use micropoly_core::kernel::{bound::bound, scan::scan, shade::shade, take};
use micropoly_core::memory::stack_exact;
use micropoly_core::patch::Net;

const SIDE: usize = 16;
const LEVELS: u32 = 8;
const BATCH: usize = 4;
/// Room for all surfaces that can ever wait.
const STACK: usize = stack_exact(1, BATCH as u64, LEVELS as u64) as usize;

/// What is drawn.
struct Scene {
    frame: Frame,
    object: Object,
    patch: Patch,
}

/// Surfaces that wait to be bounded, and those that wait to be drawn.
struct Queues {
    control: Control,
    stack: [Surface; STACK],
    draws: [Draw; BATCH],
}

/// The program; its result is the exit code.
fn main() -> i32 {
    match scene().map(|scene| covered_samples(&scene)) {
        Some(count) if count > 0 => 0,
        _ => 1,
    }
}

/// A square, bent upwards at two corners, under one light.
fn scene() -> Option<Scene> {
    let camera = Camera::look_at(DVec3::new(0.5, -2.0, 2.0), DVec3::ZERO, DVec3::Z, 45.0, 0.1)?;
    let light = Light::Directional { to_light: DVec3::new(-1.0, -1.0, 2.0), colour: Vec3::ONE };
    let (width, height) = (SIDE as u32, SIDE as u32);
    let options =
        FrameOptions { width, height, bound: 4.0, rate: 4, levels: LEVELS, ..FrameOptions::default() };
    let material = Material { colour: Vec3::splat(0.6), specular: 0.3, gloss: 5, opacity: 1.0 };
    Some(Scene {
        frame: camera.frame(&options, Vec3::splat(0.1), &[light]),
        object: camera.object(DAffine3::IDENTITY, &material),
        patch: bent_square(),
    })
}

fn bent_square() -> Patch {
    let mut patch = Patch::default();
    for k in 0..16 {
        let (x, y) = ((k / 4) as f32 / 1.5 - 1.0, (k % 4) as f32 / 1.5 - 1.0);
        (patch.x[k], patch.y[k], patch.z[k]) = (x, y, 0.3 * x * y);
    }
    patch
}

/// Renders the scene and counts the samples that something covers; 0 if a queue ran full.
fn covered_samples(scene: &Scene) -> usize {
    let (mut samples, mut colours) = ([Sample::default(); SIDE * SIDE], [Colour::default(); SIDE * SIDE]);
    let mut band = Band::whole(&scene.frame, &mut samples, &mut colours);
    let mut queues = Queues {
        control: Control::default(),
        stack: [Surface::default(); STACK],
        draws: [Draw::default(); BATCH],
    };
    while queues.control.next_root < 1 || queues.control.stack > 0 {
        split_batch(scene, &mut queues);
        if queues.control.overflow > 0 {
            return 0;
        }
        draw(scene, &queues.draws[..queues.control.fresh as usize], &mut band);
        queues.control = take::flush(queues.control);
    }
    colours.iter().filter(|colour| colour.rgba[3] > 0.0).count()
}

/// Takes a batch from the top of the stack, and sends each surface back in halves or on to be drawn.
fn split_batch(scene: &Scene, queues: &mut Queues) {
    let Scene { frame, object, patch } = scene;
    let Queues { control, stack, draws } = queues;
    let (batch, stack_room, levels) = (BATCH as u32, stack.len() as u32, frame.levels);
    let limits = Limits { patches: 1, batch, stack_room, levels, ..Limits::default() };
    *control = take::take(*control, &limits, stack);
    let taken = control.taken as usize;
    let (mut batch, mut verdicts) = ([Surface::default(); BATCH], [Verdict::default(); BATCH]);
    let mut slots = [Slot::default(); BATCH];
    for (item, surface) in (0..).zip(&mut batch[..taken]) {
        *surface = take::member(control, stack, *surface, item);
    }
    for (surface, verdict) in batch[..taken].iter().zip(&mut verdicts) {
        *verdict = bound(frame, patch, object, *surface);
    }
    *control = scan(*control, &verdicts[..taken], &mut slots[..taken], STACK as u32, BATCH as u32);
    if control.overflow > 0 {
        return;
    }
    for ((surface, verdict), slot) in batch[..taken].iter().zip(verdicts).zip(slots) {
        match split(control, *surface, verdict, slot) {
            Outcome::Culled => {}
            Outcome::Drawn(place, draw) => draws[place as usize] = draw,
            Outcome::Split(place, halves) => stack[place as usize..][..2].copy_from_slice(&halves),
        }
    }
}

/// Dices, shades and samples.
fn draw(scene: &Scene, draws: &[Draw], band: &mut Band<'_>) {
    let Scene { frame, object, patch } = scene;
    let mut grid = Grid::default();
    for draw in draws {
        dice(&Net::in_eye_space(patch, object), frame, *draw, &mut grid);
        shade(frame, object, &mut grid);
        sample(frame, &Pattern::new(frame), (*draw, object.opacity), &grid, band);
    }
}
