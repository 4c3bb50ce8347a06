//! Culling on every device: the image is the same as without, and what is culled the same as on the CPU, whatever works the
//! stack off.
#![allow(missing_docs)]

mod common;

use micropoly::cull::{Cull, Roots};
use micropoly::devices::{Job, with_device};
use micropoly::generate::{Generator, generate};
use micropoly::{
    Batch, FrameOptions, Rasteriser, RenderOptions, Rendering, Result, Scene, Scheduler, Shape, render_on,
};
use micropoly_core::backend::Device;

use common::{devices, report};

/// Patches a wave.
const WAVE: u32 = 50;

fn options(cull: Cull) -> RenderOptions {
    let frame = FrameOptions { width: 96, height: 64, ..FrameOptions::default() };
    RenderOptions { frame, cull, wave: WAVE, ..RenderOptions::default() }
}

/// Every scheduler, with large and small batches, and the other rasteriser.
fn ways(cull: Cull) -> Vec<RenderOptions> {
    let own = |scheduler, batch| RenderOptions { scheduler, batch: Batch::Surfaces(batch), ..options(cull) };
    let mut all: Vec<RenderOptions> =
        Scheduler::ALL.iter().flat_map(|&scheduler| [own(scheduler, 30), own(scheduler, 4096)]).collect();
    let mut last = options(cull);
    last.frame.rasteriser = Rasteriser::SortLast;
    all.push(last);
    all
}

struct Render<'a>(&'a Scene, &'a RenderOptions);

impl Job for Render<'_> {
    type Output = Result<Rendering>;

    fn run<D: Device>(self, mut device: D, name: String) -> Result<Rendering> {
        render_on(&mut device, name, self.0, self.1, |_| {})
    }
}

/// What must be the same everywhere.
fn essence(rendering: &Rendering) -> (String, Roots, [u64; 5]) {
    let counts = &rendering.counts;
    let numbers = [counts.processed, counts.drawn, counts.culled, counts.depth_limited, counts.micropolygons];
    (rendering.image.hash(), rendering.roots, numbers)
}

/// Scenes in which much is hidden; how patches of all kinds lie, the host alone works out (`tests/cull.rs`).
fn scenes() -> [Scene; 2] {
    [(Generator::City, 150), (Generator::Columns, 20)].map(|(kind, count)| {
        let shape = Shape::of_bezier(generate(kind, count, 5));
        Scene::around(format!("{kind:?}"), shape).expect("a scene")
    })
}

#[test]
fn images_and_counts_are_the_same_everywhere() {
    let scenes = scenes();
    let cpu = devices().into_iter().next().expect("the CPU");
    let on = |(entry, threads): &(_, usize), scene: &Scene, options: &RenderOptions| {
        let rendering = with_device(entry, *threads, Render(scene, options)).expect("opens");
        essence(&rendering.unwrap_or_else(|error| panic!("{}: {error}", scene.name)))
    };
    for scene in &scenes {
        let without = on(&cpu, scene, &options(Cull::None));
        for cull in [Cull::Frustum, Cull::Occlusion] {
            let expected = on(&cpu, scene, &options(cull));
            assert_eq!(expected.0, without.0, "{}, {cull:?}: another image", scene.name);
            for device in devices() {
                for options in ways(cull) {
                    let found = on(&device, scene, &options);
                    assert_eq!(found, expected, "{}, {options:?} on {}", scene.name, device.0.name);
                }
                report(&device.0, &format!("{}, {}", scene.name, cull.name()), "the same bits and counts");
            }
        }
    }
    let hidden = |scene| on(&cpu, scene, &options(Cull::Occlusion)).1.hidden;
    assert!(hidden(&scenes[0]) > 100 && hidden(&scenes[1]) > 0, "nothing is hidden");
}
