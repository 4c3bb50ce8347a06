//! Image and counts depend on nothing but scene and options: not on threads, batches, memory or the run.

use micropoly::core::error::PlanError;
use micropoly::{Batch, Error, FrameOptions, RenderOptions, Rendering, Scene, Scheduler, render};

fn render_with(scene: &Scene, batch: Batch, threads: usize) -> Rendering {
    let frame = FrameOptions { width: 320, height: 180, ..FrameOptions::default() };
    render(scene, &RenderOptions { frame, batch, threads, ..RenderOptions::default() }, |_| {})
        .expect("renders")
}

/// Everything that must not change; the peak of the stack depends on the batch.
/// The image; and, unless it was rendered in parts to fit the memory, the counts.
fn essence(rendering: &Rendering) -> (String, Option<[u64; 5]>) {
    let counts = &rendering.counts;
    let numbers = [counts.processed, counts.drawn, counts.culled, counts.depth_limited, counts.micropolygons];
    (rendering.image.hash(), (rendering.parts == 1).then_some(numbers))
}

#[test]
fn threads_batches_budgets_and_runs_do_not_matter() {
    for name in ["teapot", "eyesplit", "spheres", "still-life", "gregory"] {
        let scene = Scene::load(format!("scenes/{name}.toml")).expect("a scene");
        let expected = essence(&render_with(&scene, Batch::default(), 1));
        for threads in [1, 2, 3, 7] {
            for batch in [1, 2, 3, 7, 32, 100, 1000, 4096, 5000, 100_000] {
                if batch < 7 && threads != 1 {
                    continue; // slow, and there is nothing to share
                }
                let rendering = render_with(&scene, Batch::Surfaces(batch), threads);
                assert_eq!(essence(&rendering), expected, "{name}: batch {batch}, {threads} threads");
                let (peak, bound) = (rendering.counts.max_stack, rendering.sizes.stack_entries());
                assert!(peak <= bound, "{name}: {peak} surfaces on a stack of {bound}");
            }
        }
        let least = render_with(&scene, Batch::Surfaces(1), 1).bytes_allocated;
        for budget in [least, least + 4096, 4 << 20, 64 << 20] {
            let rendering = render_with(&scene, Batch::Memory(budget), 2);
            let found = essence(&rendering);
            assert_eq!(found.0, expected.0, "{name}: {budget} bytes");
            assert!(found.1.is_none_or(|counts| Some(counts) == expected.1), "{name}: {budget} bytes");
            assert!(rendering.bytes_allocated <= budget, "{name}: {budget} bytes");
        }
    }
}

#[test]
fn schedulers_and_their_budgets_do_not_matter() {
    for name in ["teapot", "eyesplit", "gregory"] {
        let scene = Scene::load(format!("scenes/{name}.toml")).expect("a scene");
        let frame = FrameOptions { width: 320, height: 180, ..FrameOptions::default() };
        let with = |scheduler, batch, capacity| {
            let options = RenderOptions { frame, scheduler, batch, capacity, ..RenderOptions::default() };
            render(&scene, &options, |_| {})
        };
        let expected = essence(&with(Scheduler::Adaptive, Batch::default(), 0).expect("renders"));
        for scheduler in Scheduler::ALL {
            let largest = with(scheduler, Batch::default(), 0).expect("renders").bytes_allocated;
            // Buffers of BREADTH grow, and are for a moment there twice.
            let budgets = match scheduler {
                Scheduler::Breadth => vec![2 * largest],
                _ => {
                    let smallest = smallest(&with, scheduler);
                    vec![largest, (largest + smallest) / 2, smallest]
                }
            };
            for budget in budgets {
                let rendering = with(scheduler, Batch::Memory(budget), 0).expect("renders");
                let found = essence(&rendering);
                assert_eq!(found.0, expected.0, "{name}: {scheduler:?} in {budget} bytes");
                assert!(found.1.is_none_or(|counts| Some(counts) == expected.1), "{name}: {scheduler:?}");
                assert!(rendering.bytes_allocated <= budget, "{name}: {scheduler:?} in {budget} bytes");
            }
        }
        // However small the stack is: as many entries as levels, and patches + levels - 1.
        let patches = scene.patch_count() as u32;
        for capacity in [frame.levels, frame.levels + 1, patches + frame.levels - 1] {
            for scheduler in [Scheduler::Adaptive, Scheduler::Local] {
                let rendering = with(scheduler, Batch::default(), capacity).expect("renders");
                assert_eq!(essence(&rendering), expected, "{name}: {scheduler:?} in {capacity} entries");
                assert!(rendering.counts.max_stack <= u64::from(capacity), "{name}: {scheduler:?}");
            }
        }
    }
}

/// The smallest budget of a scheduler: the one that an error names.
fn smallest(
    with: &dyn Fn(Scheduler, Batch, u32) -> micropoly::Result<Rendering>,
    scheduler: Scheduler,
) -> u64 {
    match with(scheduler, Batch::Memory(1), 0) {
        Err(Error::Plan(PlanError::Budget { needed, .. })) => needed,
        other => {
            panic!("one byte was enough, or another error: {:?}", other.map(|rendering| rendering.sizes))
        }
    }
}

#[test]
fn local_groups_have_equal_loads() {
    for (name, batch) in [("eyesplit", 1024), ("eyesplit", 4096), ("city", 4096)] {
        let scene = Scene::load(format!("scenes/{name}.toml")).expect("a scene");
        let frame = FrameOptions { rate: 1, ..FrameOptions::default() };
        let (scheduler, batch) = (Scheduler::Local, Batch::Surfaces(batch));
        let options = RenderOptions { frame, scheduler, batch, ..RenderOptions::default() };
        let rendering = render(&scene, &options, |_| {}).expect("renders");
        let load = rendering.counts.load.expect("groups");
        assert_eq!(load.total, rendering.counts.processed, "{name}");
        assert!(load.groups > 1 && load.imbalance() < 0.1, "{name}: {load:?}");
    }
}

#[test]
fn back_face_culling_does_not_change_closed_objects() {
    let scene = Scene::load("scenes/spheres.toml").expect("a scene");
    let image = |cull_backfaces: bool| {
        let frame = FrameOptions { width: 320, height: 180, cull_backfaces, ..FrameOptions::default() };
        render(&scene, &RenderOptions { frame, ..RenderOptions::default() }, |_| {}).expect("renders").image
    };
    assert!(image(true) == image(false), "the images differ");
}

#[test]
fn scenes_made_in_memory_are_checked_too() {
    let scene = Scene::load("scenes/teapot.toml").expect("a scene");
    for point in [0, 3, 14, 15] {
        for value in [f32::NAN, f32::INFINITY, 1.0e30] {
            let mut broken = scene.clone();
            std::sync::Arc::make_mut(&mut broken.objects[0].shape).bezier[7].points[point][1] = value;
            assert!(broken.for_device(&FrameOptions::default()).is_err(), "point {point} is {value}");
        }
    }
    let mut broken = scene;
    broken.ambient.x = f32::NAN;
    assert!(broken.for_device(&FrameOptions::default()).is_err());
}

#[test]
fn seams_that_reach_beyond_their_surface_are_in_every_band() {
    let scene = Scene::load("scenes/spheres.toml").expect("a scene");
    let image = |threads: usize| {
        let frame = FrameOptions { width: 320, height: 180, rate: 1, levels: 8, ..FrameOptions::default() };
        let options = RenderOptions { frame, threads, ..RenderOptions::default() };
        render(&scene, &options, |_| {}).expect("renders").image
    };
    for threads in [2, 8, 45] {
        assert!(image(threads) == image(1), "{threads} threads");
    }
}
