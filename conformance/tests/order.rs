//! The order of a BSP-grid's pieces is the same on every device of the backends built in.

mod common;

use common::{devices, report};
use micropoly::bsp::Triangle;
use micropoly::devices::{Job, with_device};
use micropoly_backend_cpu::{BspGrid, BspOptions, BspOrder, CpuDevice};
use micropoly_core::accel::bsp::plan::{BspLists, DeviceBsp};
use micropoly_core::backend::Device;

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

/// A grid, eyes, and the order in which each sees all pieces.
struct Case {
    name: &'static str,
    grid: BspGrid,
    views: Vec<([i64; 3], Vec<u32>)>,
}

impl Case {
    fn new(
        random: &mut fastrand::Rng,
        name: &'static str,
        triangles: &[Triangle],
        grid: Option<u32>,
    ) -> Self {
        let cpu = CpuDevice::new(0).expect("threads");
        let options = BspOptions { grid, ..BspOptions::default() };
        let grid = cpu.build_bsp(triangles, &options).expect("pieces");
        let view = |eye| {
            let mut order = BspOrder::default();
            cpu.sort_bsp(&grid, eye, &mut order);
            (eye, order.pieces)
        };
        let views = eyes(random, &grid).into_iter().map(view).collect();
        Self { name, grid, views }
    }
}

/// All cases on one device, which keeps a grid for all eyes.
struct Orders<'a>(&'a [Case]);

impl Job for Orders<'_> {
    type Output = ();

    fn run<D: Device>(self, mut device: D, device_name: String) {
        for Case { name, grid, views } in self.0 {
            let planes = grid.words();
            let sorter = DeviceBsp::new(&mut device, &grid.lists(&planes)).expect("memory");
            assert_eq!(sorter.pieces() as usize, grid.pieces.len());
            for (eye, wanted) in views {
                let mut found = vec![0; wanted.len()];
                sorter.sort(&mut device, *eye).expect("sorts");
                sorter.read(&mut device, &mut found).expect("reads");
                assert!(found == *wanted, "{name} on {device_name} from {eye:?}");
            }
        }
    }
}

#[test]
fn orders_are_the_cpus() {
    let random = &mut fastrand::Rng::with_seed(1);
    let mut cases = Vec::new();
    for (name, triangles, grid) in [
        ("none", Vec::new(), None),
        ("one", soup(random, 1, 1), None),
        ("without area", vec![[[0.5; 3]; 3]; 5], None),
        ("a soup in one cell", soup(random, 120, 6), Some(1)),
        ("a soup in a few", soup(random, 300, 16), Some(3)),
        ("a soup in many", soup(random, 400, 64), Some(21)),
    ] {
        cases.push(Case::new(random, name, &triangles, grid));
    }
    let orders = |case: &Case| case.views.iter().map(|(_, order)| order.clone()).collect::<Vec<_>>();
    assert!(cases[3..].iter().all(|case| orders(case).iter().any(|order| *order != orders(case)[0])));
    for (entry, _) in devices() {
        with_device(&entry, 0, Orders(&cases)).expect("opens");
        for Case { name, grid, views } in &cases {
            let what = format!("order of {} pieces from {} eyes: {name}", grid.pieces.len(), views.len());
            report(&entry, &what, "same bits");
        }
    }
}

/// Lists that do not go together are refused.
#[test]
fn lists_of_other_cells_are_refused() {
    let mut device = CpuDevice::new(1).expect("threads");
    let grid = device.build_bsp(&[], &BspOptions::default()).expect("no pieces");
    let lists = grid.lists(&[]);
    for first_nodes in [&[][..], &[0; 3]] {
        let lists = BspLists { first_nodes, ..lists };
        let error = DeviceBsp::new(&mut device, &lists).expect_err("of one cell");
        assert!(error.to_string().contains("must be 2 to 2"), "{error}");
    }
}
