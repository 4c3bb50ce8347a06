//! Trees, and what they are asked, have the same bits on every device of the backends built in.

mod common;

use common::{devices, report};
use micropoly::accel::on_device::{Questions, on_device};
use micropoly_backend_cpu::CpuDevice;
use micropoly_core::abi::{Probe, Triangle};
use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::morton::Precision;
use micropoly_core::accel::tree::validate;

/// Triangles, `spread` far from each other.
fn soup(random: &mut fastrand::Rng, count: usize, spread: f32) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let place: [f32; 3] = std::array::from_fn(|_| spread * (random.f32() - 0.5));
            Triangle { corners: std::array::from_fn(|k| place[k % 3] + 0.05 * spread * random.f32()) }
        })
        .collect()
}

fn questions(random: &mut fastrand::Rng) -> Questions {
    let mut any = || 2.0 * random.f32() - 1.0;
    let plane = |any: &mut dyn FnMut() -> f32| [any(), any(), any(), 0.5 + 0.5 * any()];
    let probe = |any: &mut dyn FnMut() -> f32| Probe {
        origin: [any(), any(), any()],
        direction: [any(), any(), any()],
        far: 1.0e30,
    };
    Questions {
        frusta: (0..3).map(|_| (0..4).map(|_| plane(&mut any)).collect()).collect(),
        rays: (0..100).map(|_| probe(&mut any)).collect(),
        points: (0..100).map(|_| probe(&mut any)).collect(),
    }
}

#[test]
fn trees_and_answers_are_the_cpus() {
    let mut random = fastrand::Rng::with_seed(1);
    let same = soup(&mut random, 1, 1.0)[0];
    let flat = Triangle { corners: [0.5; 9] };
    let cases = [
        ("none", Vec::new()),
        ("one", soup(&mut random, 1, 1.0)),
        ("two", soup(&mut random, 2, 1.0)),
        ("a soup", soup(&mut random, 3000, 1.0)),
        ("a block and one", soup(&mut random, 1025, 1.0)),
        ("all in the same place", vec![same; 1500]),
        ("all points", vec![flat; 70]),
        ("tiny", soup(&mut random, 500, 1.0e-40)),
        ("huge", soup(&mut random, 500, 3.0e38)),
    ];
    let questions = questions(&mut random);
    for (entry, _) in devices() {
        for (name, triangles) in &cases {
            let boxes: Vec<Bounds> =
                triangles.iter().map(|triangle| Bounds::of(&triangle.points())).collect();
            for precision in [Precision::Bits30, Precision::Bits63] {
                let tree = CpuDevice::new(0).expect("threads").build_lbvh(&boxes, precision);
                let seen = &mut vec![false; boxes.len()];
                assert_eq!(validate(&tree.nodes, &tree.parents, &boxes, seen), Ok(()), "{name}");
                let times = on_device(&entry, (triangles, &tree), precision, &questions, 1);
                assert!(times.is_ok(), "{name} on {}: {:?}", entry.name, times.err());
            }
            report(&entry, &format!("tree of {} triangles: {name}", triangles.len()), "same bits");
        }
    }
}
