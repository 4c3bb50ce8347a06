//! The linear hierarchy on the CPU: the tree of core, whoever builds it, and what it finds.

use micropoly::accel::mesh::TriangleMesh;
use micropoly::accel::{boxes, frustum, query, sah};
use micropoly::cage::generate::{Layout, torus_cage};
use micropoly::core::accel::bounds::Bounds;
use micropoly::core::accel::morton::{Grid, Precision};
use micropoly::core::accel::tree::{EMPTY, Node, fit, inner, link, validate};
use micropoly_backend_cpu::{CpuDevice, Lbvh};

/// Node by node, as a device would build it.
fn node_by_node(boxes: &[Bounds], precision: Precision) -> Lbvh {
    let all = boxes.iter().fold(Bounds::NONE, |all, bounds| all.union(*bounds));
    let grid = Grid::new(&all, precision);
    let mut keys: Vec<(u64, u32)> = boxes.iter().map(|bounds| grid.code(bounds)).zip(0..).collect();
    keys.sort_unstable();
    let codes: Vec<u64> = keys.iter().map(|(code, _)| *code).collect();
    let above = boxes.len().saturating_sub(1);
    let mut nodes: Vec<Node> = (0..above as u32).map(|index| inner(&codes, index)).collect();
    nodes.extend(keys.iter().map(|&(_, primitive)| Node::leaf(primitive, EMPTY)));
    let mut parents = vec![0; nodes.len()];
    link(&nodes, &mut parents, above);
    fit(&mut nodes, &parents, boxes, &mut vec![0; above]);
    Lbvh { nodes, parents }
}

fn soup(random: &mut fastrand::Rng, count: usize) -> Vec<Bounds> {
    let point = |random: &mut fastrand::Rng, near: [f32; 3]| near.map(|x| x + 0.1 * random.f32());
    // Some are in the same place.
    let places: Vec<[f32; 3]> = (0..1 + count / 2).map(|_| [random.f32(), random.f32(), 0.5]).collect();
    (0..count)
        .map(|_| {
            let near = places[random.usize(0..places.len())];
            Bounds::of(&[near, point(random, near)])
        })
        .collect()
}

#[test]
fn all_threads_build_the_tree_that_one_does_node_by_node() {
    let mut random = fastrand::Rng::with_seed(1);
    for count in [0, 1, 2, 3, 10, 1023, 1024, 5000, 20_000] {
        let boxes = soup(&mut random, count);
        for precision in [Precision::Bits30, Precision::Bits63] {
            let wanted = node_by_node(&boxes, precision);
            for threads in [1, 3] {
                let found = CpuDevice::new(threads).expect("threads").build_lbvh(&boxes, precision);
                assert!(found == wanted, "{count} {precision:?} {threads}");
                let seen = &mut vec![false; count];
                assert_eq!(validate(&found.nodes, &found.parents, &boxes, seen), Ok(()));
            }
        }
    }
}

#[test]
fn a_camera_sees_all_of_a_mesh_that_it_stands_around_and_less_through_a_slit() {
    let mesh = TriangleMesh::of_mesh(&torus_cage(2000, Layout::Triangles)).expect("sound");
    let boxes = boxes(&mesh.triangles);
    let tree = CpuDevice::new(0).expect("threads").build_lbvh(&boxes, Precision::Bits30);
    let camera = mesh.camera().expect("it is near");
    let seen =
        |width| query(&tree.nodes, &boxes, &frustum(&camera, width), 1).expect("as box by box").visible;
    assert_eq!(seen(1.5), boxes.len());
    let few = seen(0.05);
    assert!(few > 0 && few < boxes.len() / 3, "{few}");
}

#[test]
fn a_tree_is_as_good_whatever_its_size() {
    let boxes = soup(&mut fastrand::Rng::with_seed(2), 500);
    let cost = |scale: f32| {
        let scaled = |corner: [f32; 3]| corner.map(|c| c * scale);
        let boxes: Vec<Bounds> =
            boxes.iter().map(|own| Bounds { low: scaled(own.low), high: scaled(own.high) }).collect();
        sah(&CpuDevice::new(0).expect("threads").build_lbvh(&boxes, Precision::Bits63).nodes)
    };
    let wanted = cost(1.0);
    assert!(wanted > 5.0, "{wanted}");
    // Coordinates below 2⁻⁶³ are taken for 0.
    for exponent in [-40, 40, 100] {
        let found = cost(2.0_f32.powi(exponent));
        assert!((found / wanted - 1.0).abs() < 0.05, "2^{exponent}: {found}, not {wanted}");
    }
}
