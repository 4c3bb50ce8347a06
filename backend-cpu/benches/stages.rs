//! What each stage costs on one core: surfaces bounded, grid vertices diced and shaded, micropolygons
//! sampled per second. The surfaces are those of a ball that fills most of the image.
#![allow(unsafe_code, missing_docs)] // only what `multiversion` and criterion generate

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DAffine3, DVec3, Vec3};
use micropoly_core::abi::{
    CULL, Colour, DRAW, DRAW_LIMITED, Draw, Frame, Object, Patch, Sample, Surface, Verdict,
};
use micropoly_core::camera::{Camera, FrameOptions, Light, Material};
use micropoly_core::kernel::bound_lanes::{Lanes, bound_lanes};
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::{
    bound::bound, dice::Grid, dice::dice, sample::Band, sample::sample, shade::shade,
};
use micropoly_core::patch::Net;
use micropoly_core::pattern::{Region, Samples};
use multiversion::multiversion;

struct Ball {
    frame: Frame,
    object: Object,
    patches: Vec<Patch>,
    bounded: Vec<Surface>,
    draws: Vec<Draw>,
}

/// Eight octants of a ball, and all their surfaces at the default bound.
fn ball() -> Ball {
    let camera =
        Camera::look_at(DVec3::new(1.0, -3.0, 1.5), DVec3::ZERO, DVec3::Z, 40.0, 0.1).expect("a view");
    let lights = [Light::Directional { to_light: DVec3::new(-1.0, -1.0, 2.0), colour: Vec3::ONE }];
    let frame = camera.frame(&FrameOptions::default(), Vec3::splat(0.1), &lights);
    let material = Material { colour: Vec3::new(0.7, 0.3, 0.2), specular: 0.3, gloss: 5, opacity: 1.0 };
    let object = camera.object(DAffine3::IDENTITY, &material);
    let patches: Vec<Patch> = (0..8).map(octant).collect();
    let mut stack: Vec<Surface> = (0..8).map(Surface::root).collect();
    let (mut bounded, mut draws) = (Vec::new(), Vec::new());
    while let Some(surface) = stack.pop() {
        bounded.push(surface);
        let verdict = bound(&frame, &patches[surface.patch_id as usize], &object, surface);
        match verdict.code {
            CULL => {}
            DRAW | DRAW_LIMITED => draws.push(Draw::new(surface, verdict)),
            _ => stack.extend(surface.halves(verdict)),
        }
    }
    Ball { frame, object, patches, bounded, draws }
}

fn octant(index: u32) -> Patch {
    let arc = [(0.0, 1.0), (0.5523, 1.0), (1.0, 0.5523), (1.0, 0.0)];
    let sign = |bit: u32| if index >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let mut patch = Patch::default();
    for k in 0..16 {
        let ((out, up), (x, y)) = (arc[k / 4], arc[k % 4]);
        patch.x[k] = out * x * sign(0);
        patch.y[k] = out * y * sign(1);
        patch.z[k] = up * sign(2);
    }
    patch
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2", "x86_64+avx2"))]
fn bound_all(ball: &Ball) -> u32 {
    let verdict = |s: &Surface| bound(&ball.frame, &ball.patches[s.patch_id as usize], &ball.object, *s).code;
    ball.bounded.iter().map(verdict).sum()
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2", "x86_64+avx2"))]
fn bound_all_in_lanes(ball: &Ball, verdicts: &mut [Verdict]) {
    let objects = std::slice::from_ref(&ball.object);
    bound_lanes(&ball.frame, objects, &ball.patches, &ball.bounded, verdicts, &mut Lanes::default());
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2", "x86_64+avx2"))]
fn dice_all(ball: &Ball, grids: &mut [Grid]) {
    for (index, draw) in ball.draws.iter().enumerate() {
        let net = Net::in_eye_space(&ball.patches[draw.patch_id as usize], &ball.object);
        let count = grids.len();
        dice(&net, &ball.frame, *draw, &mut grids[index % count]);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2", "x86_64+avx2"))]
fn shade_all(ball: &Ball, grids: &mut [Grid]) {
    for index in 0..ball.draws.len() {
        let count = grids.len();
        shade(&ball.frame, &ball.object, &mut grids[index % count]);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2", "x86_64+avx2"))]
fn sample_all(ball: &Ball, pattern: &Pattern, grids: &[Grid], band: &mut Band<'_>) {
    for (draw, grid) in ball.draws.iter().zip(grids) {
        sample(&ball.frame, pattern, (*draw, 1.0), grid, band);
    }
}

fn stages(criterion: &mut Criterion) {
    let ball = ball();
    let vertices =
        ball.draws.iter().map(|draw| u64::from((draw.rate_u() + 1) * (draw.rate_v() + 1))).sum::<u64>();
    let mut group = criterion.benchmark_group("stages");

    group.throughput(Throughput::Elements(ball.bounded.len() as u64));
    let mut verdicts = vec![Verdict::default(); ball.bounded.len()];
    group.bench_function("bound (surfaces)", |bencher| {
        bencher.iter(|| bound_all_in_lanes(&ball, &mut verdicts));
    });
    group.bench_function("bound one by one (surfaces)", |bencher| bencher.iter(|| bound_all(&ball)));

    let mut hot = vec![Grid::default(); 2];
    group.throughput(Throughput::Elements(vertices));
    group.bench_function("dice (vertices)", |bencher| bencher.iter(|| dice_all(&ball, &mut hot)));
    group.bench_function("shade (vertices)", |bencher| bencher.iter(|| shade_all(&ball, &mut hot)));

    // As many grids as fit a second-level cache; in a frame each is sampled while it is in the first.
    let some = Ball { draws: ball.draws.iter().step_by(ball.draws.len() / 64).copied().collect(), ..ball };
    let micropolygons = some.draws.iter().map(|draw| u64::from(draw.rate_u() * draw.rate_v())).sum();
    let mut grids = vec![Grid::default(); some.draws.len()];
    dice_all(&some, &mut grids);
    shade_all(&some, &mut grids);
    group.throughput(Throughput::Elements(micropolygons));
    for samples in [Samples::One, Samples::Four, Samples::Sixteen] {
        let Frame { width, height, .. } = some.frame;
        let frame = some.frame.with_region(Region::whole(width, height, samples), 0);
        let some = Ball {
            frame,
            draws: some.draws.clone(),
            patches: some.patches.clone(),
            bounded: Vec::new(),
            ..some
        };
        let (pattern, count) = (Pattern::new(&frame), frame.sample_count() as usize);
        let mut colours = vec![Colour::default(); count];
        group.bench_function(format!("sample, {} a pixel (micropolygons)", samples.count()), |bencher| {
            bencher.iter_batched_ref(
                || vec![Sample::default(); count],
                |samples| {
                    let mut band = Band::whole(&frame, samples, &mut colours);
                    sample_all(&some, &pattern, &grids, &mut band);
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, stages);
criterion_main!(benches);
