//! BREADTH counts to the byte what it holds while it grows, and holds no more than its budget.

use std::cell::Cell;
use std::rc::Rc;

use micropoly::core::abi::{Layout, Shared};
use micropoly::core::backend::Device;
use micropoly::core::error::PlanError;
use micropoly::core::stage::{Extent, Items, Stage};
use micropoly::devices::{Job, devices_of, with_device};
use micropoly::{
    Backend, Batch, Error, FrameOptions, RenderOptions, Rendering, Result, Scene, Scheduler, render_on,
};

/// Bytes that the watched device says it needs for itself.
const OWN: u64 = 12_345;

/// A device that keeps the most bytes that were ever allocated.
struct Watched<D> {
    device: D,
    most: Rc<Cell<u64>>,
}

impl<D: Device> Device for Watched<D> {
    type Buffer = D::Buffer;
    type Error = D::Error;

    fn allocate(
        &mut self,
        name: &'static str,
        layout: Layout,
        entries: u64,
    ) -> std::result::Result<D::Buffer, D::Error> {
        let buffer = self.device.allocate(name, layout, entries)?;
        self.most.set(self.most.get().max(self.device.bytes_allocated()));
        Ok(buffer)
    }

    fn bytes_allocated(&self) -> u64 {
        self.device.bytes_allocated()
    }

    fn own_bytes(&self, extent: Extent) -> u64 {
        OWN + self.device.own_bytes(extent)
    }

    fn write<T: Shared>(&mut self, buffer: &D::Buffer, data: &[T]) -> std::result::Result<(), D::Error> {
        self.device.write(buffer, data)
    }

    fn read<T: Shared>(
        &mut self,
        buffer: &D::Buffer,
        first: u64,
        out: &mut [T],
    ) -> std::result::Result<(), D::Error> {
        self.device.read(buffer, first, out)
    }

    fn copy(&mut self, from: &D::Buffer, to: &D::Buffer, entries: u64) -> std::result::Result<(), D::Error> {
        self.device.copy(from, to, entries)
    }

    fn clear(&mut self, buffer: &D::Buffer) -> std::result::Result<(), D::Error> {
        self.device.clear(buffer)
    }

    fn dispatch(
        &mut self,
        stage: Stage,
        items: Items,
        buffers: &[&D::Buffer],
    ) -> std::result::Result<(), D::Error> {
        self.device.dispatch(stage, items, buffers)
    }
}

/// Renders a scene; gives the most bytes that were held on the way, too.
struct Render<'a>(&'a Scene, Batch);

impl Job for Render<'_> {
    type Output = (Result<Rendering>, u64);

    fn run<D: Device>(self, device: D, name: String) -> Self::Output {
        // So small that it is never cut into parts.
        let frame = FrameOptions { width: 40, height: 25, bound: 0.5, size: 0.1, ..FrameOptions::default() };
        let options =
            RenderOptions { frame, batch: self.1, scheduler: Scheduler::Breadth, ..RenderOptions::default() };
        let most = Rc::new(Cell::new(0));
        let mut device = Watched { device, most: Rc::clone(&most) };
        let outcome = render_on(&mut device, name, self.0, &options, |_| {});
        (outcome, most.get() + OWN)
    }
}

fn render(scene: &Scene, batch: Batch) -> (Result<Rendering>, u64) {
    let cpu = devices_of(Backend::Cpu).expect("a CPU").remove(0);
    with_device(&cpu, 1, Render(scene, batch)).expect("opens")
}

#[test]
fn the_memory_that_is_named_is_what_the_level_takes_to_the_byte() {
    for name in ["teapot", "eyesplit", "spheres", "gregory"] {
        let scene = Scene::load(format!("scenes/{name}.toml")).expect("a scene");
        let (expected, most) = render(&scene, Batch::default());
        let expected = expected.expect("renders");
        let (mut budget, mut refused) = (1024, 0);
        let last = loop {
            match render(&scene, Batch::Memory(budget)) {
                (Ok(rendering), held) => {
                    assert_eq!(held, budget, "{name}: the budget is not what was held");
                    break rendering;
                }
                (Err(Error::Plan(PlanError::Budget { have, needed })), 0..=OWN) => {
                    assert!(have == budget && needed > budget, "{name}: {have} of {budget}, {needed}");
                    budget = needed;
                }
                (Err(Error::Plan(PlanError::Level { have, needed, .. })), held) => {
                    assert_eq!((have, held <= have), (budget, true), "{name}: {held} bytes were held");
                    assert!(needed > budget, "{name}: {needed} bytes instead of {budget}");
                    (budget, refused) = (needed, refused + 1);
                }
                (outcome, held) => panic!("{name}: {held} bytes held, {outcome:?}"),
            }
        };
        assert!(refused > 0, "{name}: no level was refused");
        assert_eq!(budget, most, "{name}");
        assert!(last.image == expected.image && last.counts == expected.counts, "{name}: another image");
    }
}
