//! The order of a BSP-grid's pieces is the same on every device of the backends built in.

mod common;

use common::{devices, report};
use micropoly::bsp::Triangle;
use micropoly::bsp::on_device::on_device;
use micropoly_backend_cpu::{BspGrid, BspOptions, BspOrder, CpuDevice};

/// Triangles, `spread` far from each other, on a coarse lattice: some of them are in one plane.
fn soup(random: &mut fastrand::Rng, count: usize, spread: i32) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let place = [0; 3].map(|_| random.i32(-spread..=spread));
            [0; 3].map(|_| place.map(|c| (c + random.i32(-6..=6)) as f32 / 16.0))
        })
        .collect()
}

/// Eyes in the grid, on planes of triangles, about a corner of the grid, before, beyond, and as far away as they may be.
fn eyes(random: &mut fastrand::Rng, grid: &BspGrid) -> Vec<[i64; 3]> {
    let ends = grid.slabs.each_ref().map(|ends| i64::from(ends[ends.len() / 2]));
    let last = grid.slabs.each_ref().map(|ends| i64::from(ends[ends.len() - 1]));
    let far = (1 << 29) - 1;
    let mut eyes = vec![ends, ends.map(|end| end + 1), last.map(|end| end + 1)];
    eyes.extend([[-1; 3], [far; 3], [-far; 3], [far, -far, ends[2]]]);
    if let Some(triangle) = grid.triangles.get(random.usize(0..=grid.triangles.len() / 2)) {
        let [a, b, c] = triangle.map(|corner| corner.map(i64::from));
        let at = |k: usize| a[k] + 3 * (b[k] - a[k]) - 2 * (c[k] - a[k]);
        eyes.extend([a, [at(0), at(1), at(2)], [at(0), at(1) + 1, at(2)]]);
    }
    eyes
}

#[test]
fn orders_are_the_cpus() {
    let mut random = fastrand::Rng::with_seed(1);
    let flat = [[0.5; 3]; 3];
    let cases = [
        ("none", Vec::new(), None),
        ("one", soup(&mut random, 1, 1), None),
        ("without area", vec![flat; 5], None),
        ("a soup in one cell", soup(&mut random, 120, 6), Some(1)),
        ("a soup in a few", soup(&mut random, 300, 16), Some(3)),
        ("a soup in many", soup(&mut random, 400, 64), Some(21)),
    ];
    let cpu = CpuDevice::new(0).expect("threads");
    for (name, triangles, cells) in &cases {
        let options = BspOptions { grid: *cells, ..BspOptions::default() };
        let grid = cpu.build_bsp(triangles, &options).expect("pieces");
        let mut order = BspOrder::default();
        for eye in eyes(&mut random, &grid) {
            cpu.sort_bsp(&grid, eye, &mut order);
            for (entry, _) in devices() {
                let times = on_device(&entry, &grid, (eye, &order.pieces), 1);
                assert!(times.is_ok(), "{name} on {} from {eye:?}: {:?}", entry.name, times.err());
            }
        }
        for (entry, _) in devices() {
            report(&entry, &format!("order of {} pieces: {name}", grid.pieces.len()), "same bits");
        }
    }
}
