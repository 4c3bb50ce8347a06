//! The linear bounding volume hierarchy: sound for every soup, and the same whoever builds it.

use micropoly_core::abi::{AccelFrame, Finding, Frustum, Probe, Triangle};
use micropoly_core::accel::bounds::Bounds;
use micropoly_core::accel::hierarchy::span;
use micropoly_core::accel::morton::{Grid, Precision};
use micropoly_core::accel::nearest::Around;
use micropoly_core::accel::query::{Plane, blocks, in_frustum, is_visible, seen};
use micropoly_core::accel::ray::{Ray, Shot};
use micropoly_core::accel::tree::{EMPTY, Fault, Node, fit, inner, link, node_count, validate};
use micropoly_core::accel::walk::{Search, find, find_one};

struct Tree {
    boxes: Vec<Bounds>,
    codes: Vec<u64>,
    nodes: Vec<Node>,
    parents: Vec<u32>,
}

fn built(boxes: Vec<Bounds>, precision: Precision) -> Tree {
    let all = boxes.iter().fold(Bounds::NONE, |all, bounds| all.union(*bounds));
    let grid = Grid::new(&all, precision);
    let mut keys: Vec<(u64, u32)> = boxes.iter().map(|bounds| grid.code(bounds)).zip(0..).collect();
    keys.sort_unstable();
    let codes: Vec<u64> = keys.iter().map(|(code, _)| *code).collect();
    let inner_count = boxes.len().saturating_sub(1) as u32;
    let mut nodes: Vec<Node> = (0..inner_count).map(|index| inner(&codes, index)).collect();
    nodes.extend(keys.iter().map(|&(_, primitive)| Node::leaf(primitive, EMPTY)));
    let mut parents = vec![0; nodes.len()];
    link(&nodes, &mut parents, inner_count as usize);
    let visits = &mut vec![0; inner_count as usize];
    fit(&mut nodes, &parents, &boxes, visits);
    assert!(visits.iter().all(|visit| *visit == 0));
    Tree { boxes, codes, nodes, parents }
}

impl Tree {
    fn validate(&self) -> Result<(), Fault> {
        validate(&self.nodes, &self.parents, &self.boxes, &mut vec![false; self.boxes.len()])
    }
}

/// Boxes of triangles, `spread` far from each other.
fn soup(random: &mut fastrand::Rng, count: usize, spread: f32) -> Vec<Bounds> {
    (0..count)
        .map(|_| {
            let place: [f32; 3] = std::array::from_fn(|_| spread * (random.f32() - 0.5));
            let corner = |random: &mut fastrand::Rng| place.map(|x| x + 0.01 * spread * random.f32());
            Bounds::of(&[corner(random), corner(random), corner(random)])
        })
        .collect()
}

const PRECISIONS: [Precision; 2] = [Precision::Bits30, Precision::Bits63];

#[test]
fn trees_of_random_soups_are_sound() {
    let mut random = fastrand::Rng::with_seed(1);
    for count in (0..20).chain([100, 1000, 3001]) {
        for spread in [1.0, 1.0e-20, 1.0e-44, 1.0e37, 0.0] {
            for precision in PRECISIONS {
                let tree = built(soup(&mut random, count, spread), precision);
                assert_eq!(tree.nodes.len(), node_count(count as u32) as usize);
                assert_eq!(tree.validate(), Ok(()), "{count} {spread}");
            }
        }
    }
}

#[test]
fn trees_of_equal_codes_are_sound_and_shallow() {
    for count in [1, 2, 3, 100, 1025] {
        let same = Bounds { low: [1.0, 2.0, 3.0], high: [2.0, 3.0, 4.0] };
        let tree = built(vec![same; count], Precision::Bits30);
        assert!(tree.codes.iter().all(|code| *code == tree.codes[0]));
        assert_eq!(tree.validate(), Ok(()));
        let deepest = (0..tree.nodes.len() as u32).map(|node| depth(&tree, node)).max();
        assert!(deepest <= Some(usize::BITS - count.leading_zeros() + 1), "{count}: {deepest:?}");
    }
}

fn depth(tree: &Tree, mut node: u32) -> u32 {
    let mut depth = 0;
    while tree.parents[node as usize] != u32::MAX {
        node = tree.parents[node as usize];
        depth += 1;
    }
    depth
}

#[test]
fn every_inner_node_is_cut_where_codes_differ_first() {
    let mut random = fastrand::Rng::with_seed(2);
    for _ in 0..200 {
        let count = random.usize(2..60);
        let mut codes: Vec<u64> = (0..count).map(|_| random.u64(0..40) << random.u32(0..50)).collect();
        codes.sort_unstable();
        for index in 0..count as u32 - 1 {
            let found = span(&codes, index);
            let key = |leaf: u32| u128::from(codes[leaf as usize]) << 32 | u128::from(leaf);
            let top = |a: u32, b: u32| (key(a) ^ key(b)).leading_zeros();
            let shared = top(found.first, found.last);
            assert!(found.first <= found.split && found.split < found.last);
            assert!(top(found.first, found.split) > shared || found.first == found.split);
            assert!(top(found.split + 1, found.last) > shared || found.split + 1 == found.last);
            assert!(index == found.first || index == found.last);
        }
    }
}

#[test]
fn faults_are_found() {
    let mut random = fastrand::Rng::with_seed(3);
    let fresh = || built(soup(&mut fastrand::Rng::with_seed(4), 50, 1.0), Precision::Bits30);
    for _ in 0..200 {
        let mut tree = fresh();
        let node = random.usize(0..tree.nodes.len());
        match random.u32(0..4) {
            0 => tree.nodes[node].low[random.usize(0..3)] -= 1.0,
            1 => tree.nodes[node].first = 1000,
            2 => tree.parents[node] ^= 1,
            _ => {
                let leaves = tree.boxes.len() - 1..tree.nodes.len();
                let (a, b) = (random.usize(leaves.clone()), random.usize(leaves));
                if a == b {
                    continue;
                }
                tree.nodes[a] = tree.nodes[b];
            }
        }
        assert!(tree.validate().is_err());
    }
}

#[test]
fn a_frustum_finds_what_looking_at_every_box_does() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut found_some = 0;
    for _ in 0..100 {
        let count = random.usize(0..400);
        let tree = built(soup(&mut random, count, 10.0), Precision::Bits63);
        let mut any = || 2.0 * random.f32() - 1.0;
        let planes: Vec<Plane> = (0..5).map(|_| [any(), any(), any(), 3.0 + 2.0 * any()]).collect();
        let mut found = Vec::new();
        in_frustum(&tree.nodes, &planes, |primitive| found.push(primitive));
        found.sort_unstable();
        let wanted: Vec<u32> =
            (0..).zip(&tree.boxes).filter(|(_, b)| is_visible(&planes, b)).map(|(k, _)| k).collect();
        assert_eq!(found, wanted);
        found_some += usize::from(!found.is_empty() && found.len() < count);
    }
    assert!(found_some > 50);
}

fn triangles(random: &mut fastrand::Rng, count: usize) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let place: [f32; 3] = std::array::from_fn(|_| 4.0 * random.f32() - 2.0);
            Triangle { corners: std::array::from_fn(|k| place[k % 3] + 0.6 * random.f32()) }
        })
        .collect()
}

/// Triangles, each of them twice, of which the first counts; and the tree over them.
fn doubled(random: &mut fastrand::Rng) -> (Vec<Triangle>, Tree) {
    let count = random.usize(0..300);
    let mut all = triangles(random, count);
    all.extend(all.clone());
    let boxes = all.iter().map(|triangle| Bounds::of(&triangle.points())).collect();
    (all, built(boxes, Precision::Bits30))
}

/// What a search finds, which is the same as by looking at every triangle.
fn found(search: &impl Search, tree: &Tree) -> Finding {
    let found = find(search, &tree.nodes);
    let all = (0..).zip(&tree.boxes);
    let wanted =
        all.fold(Finding::NONE, |wanted, (primitive, bounds)| wanted.or(find_one(search, primitive, bounds)));
    assert_eq!(found, wanted);
    found
}

#[test]
fn a_ray_hits_first_what_looking_at_every_triangle_says() {
    let mut random = fastrand::Rng::with_seed(6);
    let mut hits = 0;
    for _ in 0..40 {
        let (all, tree) = doubled(&mut random);
        for k in 0..50 {
            let mut any = || 6.0 * random.f32() - 3.0;
            // Some along an axis, and some through a corner.
            let direction = match (k % 5, all.first()) {
                (0, _) => [0.0, 1.0, 0.0],
                (1, Some(triangle)) => triangle.points()[0],
                _ => [any(), any(), any()],
            };
            let origin = if k % 5 == 1 { [0.0; 3] } else { [any(), any(), any()] };
            let ray = Ray::new(&Probe { origin, direction, far: 5.0 });
            let found = found(&Shot { ray, triangles: &all }, &tree);
            hits += usize::from(found != Finding::NONE);
            assert!(found == Finding::NONE || found.primitive < all.len() as u32 / 2);
        }
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn what_is_nearest_is_what_looking_at_every_triangle_says() {
    let mut random = fastrand::Rng::with_seed(8);
    let mut none = 0;
    for _ in 0..40 {
        let (all, tree) = doubled(&mut random);
        for k in 0..50 {
            let mut any = || 8.0 * random.f32() - 4.0;
            let mut origin = [any(), any(), any()];
            if let (0, Some(triangle)) = (k % 5, all.first()) {
                origin = triangle.points()[1];
            }
            let probe = Probe { origin, far: 1.0, ..Probe::default() };
            let found = found(&Around { probe, triangles: &all }, &tree);
            none += usize::from(found == Finding::NONE);
            assert!(found == Finding::NONE || found.primitive < all.len() as u32 / 2);
            assert!(k % 5 > 0 || all.is_empty() || found.distance < 1.0e-10);
        }
    }
    assert!((200..1800).contains(&none), "{none}");
}

#[test]
fn hits_lie_on_the_triangle() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut hits = 0;
    for triangle in triangles(&mut random, 3000) {
        // Through a point of the triangle, or beside it.
        let (u, v) = (1.5 * random.f32() - 0.25, 1.5 * random.f32() - 0.25);
        let [a, b, c] = triangle.points();
        let target: [f32; 3] = std::array::from_fn(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]));
        let origin: [f32; 3] = std::array::from_fn(|_| 8.0 * random.f32() - 4.0);
        let direction = std::array::from_fn(|k| target[k] - origin[k]);
        let hit = Ray::new(&Probe { origin, direction, far: 2.0 }).hit([a, b, c]);
        let edge = u.min(v).min(1.0 - u - v);
        if edge.abs() > 1.0e-3 {
            assert!(hit.is_none_or(|t| edge > 0.0 && (t - 1.0).abs() < 1.0e-2), "{hit:?} {u} {v}");
        }
        hits += usize::from(hit.is_some() && edge > 0.0);
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn several_frusta_see_leaf_by_leaf_what_each_sees_by_itself() {
    let mut random = fastrand::Rng::with_seed(9);
    let tree = built(soup(&mut random, 300, 10.0), Precision::Bits63);
    let mut any = || 2.0 * random.f32() - 1.0;
    let planes: Vec<[Plane; 3]> =
        (0..3).map(|_| [(); 3].map(|()| [any(), any(), any(), 1.0 + any()])).collect();
    let frusta: Vec<Frustum> = planes.iter().map(|planes| Frustum::new(planes)).collect();
    let frame = AccelFrame { count: 300, ..AccelFrame::default() };
    for (index, planes) in (0..).zip(&planes) {
        let mut wanted = Vec::new();
        in_frustum(&tree.nodes, planes, |primitive| wanted.push(primitive));
        let blocks = index * blocks(300)..(index + 1) * blocks(300);
        let found: Vec<u32> = blocks.flat_map(|block| seen(&frame, &tree.nodes, &frusta, block)).collect();
        assert_eq!(found, wanted);
        assert!(!found.is_empty() && found.len() < 300);
    }
}
