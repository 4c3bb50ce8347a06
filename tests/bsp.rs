//! The BSP-grid: along every ray its order is that of exact distances, whatever triangles do to each other.

use std::cmp::Ordering;
use std::path::Path;

use glam::DVec3;
use micropoly::accel::mesh::TriangleMesh;
use micropoly::bsp::pieces;
use micropoly::cage::generate::{Layout, torus_cage};
use micropoly::core::accel::bsp::lattice::Point;
use micropoly::core::accel::bsp::sight::{Sight, View};
use micropoly_backend_cpu::{BspError, BspGrid, BspOptions, BspOrder, CpuDevice};
use num_bigint::{BigInt, Sign};

type Triangle = [[f32; 3]; 3];

fn device() -> CpuDevice {
    CpuDevice::new(0).expect("threads")
}

fn exact(grid: u32) -> BspOptions {
    BspOptions { grid: Some(grid), ..BspOptions::default() }
}

/// Some numbers in integers without limits.
fn big<const N: usize>(numbers: [i64; N]) -> [BigInt; N] {
    numbers.map(BigInt::from)
}

fn cross(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn dot(a: &[BigInt; 3], b: &[BigInt; 3]) -> BigInt {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn minus(a: [i64; 3], b: [i64; 3]) -> [BigInt; 3] {
    big([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// What a ray does to a triangle.
enum Reference {
    Misses,
    /// At this numerator and positive denominator of a distance.
    Hits(BigInt, BigInt),
    /// It meets an edge.
    Undecided,
}

/// Told from the triangle's plane and the sides of its edges, not from what the eye sees of it.
fn reference(eye: [i64; 3], ray: &[BigInt; 3], triangle: &[Point; 3]) -> Reference {
    let corners = triangle.map(|corner| corner.map(i64::from));
    let [a, b, c] = corners;
    let normal = cross(&minus(b, a), &minus(c, a));
    let (mut over, mut under) = (dot(&normal, &minus(a, eye)), dot(&normal, ray));
    if under.sign() == Sign::NoSign {
        return Reference::Misses;
    }
    if under.sign() == Sign::Minus {
        (over, under) = (-over, -under);
    }
    if over.sign() != Sign::Plus {
        return Reference::Misses;
    }
    // The hit, times the denominator.
    let hit: [BigInt; 3] = std::array::from_fn(|k| BigInt::from(eye[k]) * &under + &ray[k] * &over);
    let mut is_on_edge = false;
    for [from, to] in [[a, b], [b, c], [c, a]] {
        let away: [BigInt; 3] = std::array::from_fn(|k| &hit[k] - BigInt::from(from[k]) * &under);
        match dot(&cross(&minus(to, from), &away), &normal).sign() {
            Sign::Minus => return Reference::Misses,
            Sign::NoSign => is_on_edge = true,
            Sign::Plus => {}
        }
    }
    if is_on_edge { Reference::Undecided } else { Reference::Hits(over, under) }
}

/// Does a ray pass near a triangle, as floats see it from afar?
fn passes(eye: [i64; 3], ray: &[BigInt; 3], triangle: &[Point; 3]) -> bool {
    let ray = ray.each_ref().map(|c| i64::try_from(c).expect("a word") as f64);
    let length = ray.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [a, b, c] = triangle.map(|corner| DVec3::from(corner.map(f64::from)));
    let (middle, ray) = ((a + b + c) / 3.0, DVec3::from(ray) / length);
    let radius = (a - middle).length().max((b - middle).length()).max((c - middle).length());
    let away = middle - DVec3::from(eye.map(|c| c as f64));
    away.cross(ray).length() <= radius + 1.0 + away.length() * 1.0e-9
}

/// Triangles along a ray, far to near, of those in one plane the highest first; `None` if it meets an edge.
fn sorted_hits(
    view: &View,
    [x, y]: [i32; 2],
    triangles: &[[Point; 3]],
) -> Option<Vec<(u32, BigInt, BigInt)>> {
    let [x, y] = [i64::from(x), i64::from(y)];
    let ray = big([0, 1, 2].map(|k| view.ahead[k] + x * view.right[k] + y * view.down[k]));
    let mut hits = Vec::new();
    let passing = (0..).zip(triangles).filter(|(_, triangle)| passes(view.eye, &ray, triangle));
    for (number, triangle) in passing {
        match reference(view.eye, &ray, triangle) {
            Reference::Misses => {}
            Reference::Hits(over, under) => hits.push((number, over, under)),
            Reference::Undecided => return None,
        }
    }
    hits.sort_by(|(k, a, b), (l, c, d)| (c * b).cmp(&(a * d)).then(l.cmp(k)));
    Some(hits)
}

/// Triangles along a ray in the order of the grid.
fn ordered_hits(grid: &BspGrid, order: &[u32], view: &View, [x, y]: [i32; 2]) -> Vec<u32> {
    let sights: Vec<Option<Sight>> =
        grid.triangles.iter().map(|triangle| Sight::new(view, triangle)).collect();
    let hits: Vec<_> = sights.iter().map(|sight| sight.as_ref().and_then(|sight| sight.hit(x, y))).collect();
    let is_seen = |piece: u32| {
        let triangle = grid.pieces[piece as usize].triangle as usize;
        let (Some(hit), Some(sight)) = (hits[triangle], &sights[triangle]) else { return false };
        grid.cuts_of(piece).iter().all(|cut| sight.is_within(hit, grid.line(triangle, *cut)))
    };
    let seen = order.iter().filter(|piece| is_seen(**piece));
    seen.map(|piece| grid.pieces[*piece as usize].triangle).collect()
}

/// A view from an eye in some direction.
fn view(random: &mut fastrand::Rng, eye: [i64; 3]) -> View {
    let mut any = |most: i64| [0; 3].map(|_| random.i64(-most..most));
    View { eye, ahead: any(1 << 47), right: any(1 << 40), down: any(1 << 40) }
}

/// Compares rays from 100 eyes; gives how many rays there were and how many hits.
fn check(name: &str, triangles: &[Triangle], options: &BspOptions, rays: usize) -> (usize, usize) {
    let device = device();
    let grid = device.build_bsp(triangles, options).expect("it fits");
    let mut random = fastrand::Rng::with_seed(7);
    let (mut order, mut compared, mut met) = (BspOrder::default(), 0, 0);
    for eye in 0..100 {
        // Inside, around, far away, and at a corner's height.
        let reach = [1 << 20, 1 << 21, 1 << 28, 1 << 19][eye % 4];
        let mut at = [0; 3].map(|_| (1 << 19) + random.i64(-reach / 2..reach / 2));
        if let (3, Some(triangle)) = (eye % 4, grid.triangles.first()) {
            at[1] = i64::from(triangle[0][1]);
        }
        let view = view(&mut random, at);
        device.sort_bsp(&grid, at, &mut order);
        for _ in 0..rays {
            let place = [random.i32(-64..64), random.i32(-64..64)];
            let view = towards(&mut random, &grid, view, place);
            let Some(wanted) = sorted_hits(&view, place, &grid.triangles) else { continue };
            let found = ordered_hits(&grid, &order.pieces, &view, place);
            assert_is_order(name, &wanted, &found);
            compared += 1;
            met += found.len();
        }
    }
    (compared, met)
}

/// The same view; or half of all times so turned that the ray through a place goes towards a triangle.
fn towards(random: &mut fastrand::Rng, grid: &BspGrid, view: View, [x, y]: [i32; 2]) -> View {
    if grid.triangles.is_empty() || random.bool() {
        return view;
    }
    let corners = grid.triangles[random.usize(0..grid.triangles.len())];
    let shares = [random.i64(1..100), random.i64(1..100), random.i64(1..100)];
    let all: i64 = shares.iter().sum();
    let ahead = std::array::from_fn(|k| {
        let target = (0..3).map(|c| i64::from(corners[c][k]) * shares[c]).sum::<i64>() / all;
        ((target - view.eye[k]) << 18) - i64::from(x) * view.right[k] - i64::from(y) * view.down[k]
    });
    View { ahead, ..view }
}

/// Every hit once, and none before one that is farther away. Where different planes meet on the ray, either may be first.
fn assert_is_order(name: &str, wanted: &[(u32, BigInt, BigInt)], found: &[u32]) {
    let names: Vec<u32> = wanted.iter().map(|hit| hit.0).collect();
    if names == found {
        return;
    }
    let mut set = found.to_vec();
    let mut all = names.clone();
    set.sort_unstable();
    all.sort_unstable();
    assert_eq!(set, all, "{name}: not every hit once");
    let distance = |number: u32| wanted.iter().find(|hit| hit.0 == number).expect("it is a hit");
    for pair in found.windows(2) {
        let ((_, a, b), (_, c, d)) = (distance(pair[0]), distance(pair[1]));
        assert_ne!((a * d).cmp(&(c * b)), Ordering::Less, "{name}: {names:?} {found:?}");
    }
}

fn soup(random: &mut fastrand::Rng, count: usize, size: f32) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let place = [0; 3].map(|_| random.f32());
            [0; 3].map(|_| place.map(|c| c + size * (random.f32() - 0.5)))
        })
        .collect()
}

#[test]
fn soups_that_cut_each_other_are_in_order() {
    let mut random = fastrand::Rng::with_seed(1);
    for (count, size, grid) in
        [(1, 1.0, 1), (2, 1.0, 1), (30, 1.5, 1), (30, 1.5, 4), (150, 0.3, 5), (60, 0.6, 2), (64, 1.0, 1)]
    {
        let (compared, met) = check("soup", &soup(&mut random, count, size), &exact(grid), 12);
        assert!(compared > 1000 && met > compared / 3, "{compared} {met}");
    }
}

#[test]
fn three_that_overlap_in_a_ring_are_in_order() {
    // Each lies before the next one.
    let beam = |turn: f32| -> [Triangle; 2] {
        let (sine, cosine) = libm::sincosf(turn);
        let at = |x: f32, y: f32, z: f32| [x * cosine - y * sine, x * sine + y * cosine, z];
        let corners = [at(-1.0, 0.4, 0.2), at(1.0, 0.4, -0.2), at(1.0, 0.7, -0.2), at(-1.0, 0.7, 0.2)];
        [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
    };
    let ring: Vec<Triangle> = [0.0, 2.094_395, 4.188_79].into_iter().flat_map(beam).collect();
    let (compared, met) = check("ring", &ring, &exact(1), 30);
    assert!(compared > 1000 && met > compared / 3, "{compared} {met}");
    let grid = device().build_bsp(&ring, &exact(1)).expect("it fits");
    assert!(grid.pieces.len() > ring.len(), "a ring has no order unless something is cut");
}

#[test]
fn what_lies_in_one_plane_is_in_order_of_its_numbers() {
    let mut random = fastrand::Rng::with_seed(3);
    // In planes of the lattice, aslant, and twice the same.
    for aslant in [0.0, 0.5, 0.25] {
        let mut all: Vec<Triangle> = (0..25)
            .map(|_| {
                let level = random.u32(0..3) as f32;
                [0; 3].map(|_| {
                    let [x, y] = [random.u32(0..64) as f32 / 8.0, random.u32(0..64) as f32 / 8.0];
                    [x, y, level + aslant * x]
                })
            })
            .collect();
        all.extend(all.clone());
        let (compared, met) = check("planes", &all, &exact(3), 12);
        assert!(compared > 500 && met > compared, "{compared} {met}");
    }
}

#[test]
fn closed_meshes_are_in_order() {
    let mesh = TriangleMesh::of_mesh(&torus_cage(600, Layout::Triangles)).expect("sound");
    for grid in [1, 6] {
        let (compared, met) = check("torus", &mesh.triangles, &exact(grid), 6);
        assert!(compared > 500 && met > compared, "{compared} {met}");
    }
}

/// The real thing: 69,451 triangles.
#[test]
fn the_bunny_is_in_order() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/models/stanford-bunny.obj");
    if !path.exists() {
        eprintln!("skipped: the_bunny_is_in_order, as there is no shared/data/models/stanford-bunny.obj");
        return;
    }
    let mesh = TriangleMesh::load(&path).expect("it can be read");
    let (compared, met) = check("bunny", &mesh.triangles, &BspOptions::default(), 2);
    assert!(compared > 150 && met > compared, "{compared} {met}");
}

#[test]
fn what_has_no_area_and_what_is_huge_or_tiny() {
    let mut random = fastrand::Rng::with_seed(4);
    for scale in [1.0e-38, 1.0, 1.0e37] {
        let mut all = soup(&mut random, 20, 1.0);
        all.push([[0.5; 3]; 3]);
        all.push([[0.1; 3], [0.5; 3], [0.9; 3]]);
        let all: Vec<Triangle> = all.iter().map(|t| t.map(|p| p.map(|c| c * scale))).collect();
        let grid = device().build_bsp(&all, &exact(2)).expect("it fits");
        assert_eq!(grid.degenerate, 2);
        check("scaled", &all, &exact(2), 3);
    }
    let none = device().build_bsp(&[], &exact(5)).expect("nothing fits");
    assert!(none.pieces.is_empty());
    let lost = [[[0.0, f32::NAN, 0.0]; 3]];
    assert_eq!(device().build_bsp(&lost, &exact(1)), Err(BspError::Corner { triangle: 0 }));
}

#[test]
fn too_many_pieces_are_an_error() {
    let all = soup(&mut fastrand::Rng::with_seed(5), 100, 2.0);
    let options = BspOptions { most_pieces: 200, ..exact(1) };
    assert_eq!(device().build_bsp(&all, &options), Err(BspError::Pieces { most: 200 }));
}

#[test]
fn threads_make_no_difference() {
    let all = soup(&mut fastrand::Rng::with_seed(6), 3000, 0.1);
    let [one, many] = [1, 3].map(|threads| {
        let device = CpuDevice::new(threads).expect("threads");
        let grid = device.build_bsp(&all, &BspOptions::default()).expect("it fits");
        let mut order = BspOrder::default();
        device.sort_bsp(&grid, [1000, 2000, 3000], &mut order);
        (grid, order.pieces)
    });
    assert!(one == many);
}

/// With a tolerance the order is not exact, but everything is still there once.
#[test]
fn a_tolerance_loses_nothing() {
    let all = soup(&mut fastrand::Rng::with_seed(8), 200, 0.4);
    let options = BspOptions { tolerance: 1.0e-2, ..exact(4) };
    let grid = device().build_bsp(&all, &options).expect("it fits");
    let less = device().build_bsp(&all, &exact(4)).expect("it fits");
    assert!(grid.pieces.len() < less.pieces.len());
    let mut random = fastrand::Rng::with_seed(9);
    let mut order = BspOrder::default();
    for _ in 0..100 {
        let at = [0; 3].map(|_| random.i64(0..1 << 20));
        device().sort_bsp(&grid, at, &mut order);
        let view = view(&mut random, at);
        let Some(wanted) = sorted_hits(&view, [0, 0], &grid.triangles) else { continue };
        let mut found = ordered_hits(&grid, &order.pieces, &view, [0, 0]);
        let mut wanted: Vec<u32> = wanted.iter().map(|hit| hit.0).collect();
        found.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(found, wanted);
    }
}

/// Nothing of a triangle is missing or there twice, little is outside of its cell, and weights say where in it a corner is.
#[test]
fn pieces_share_out_their_triangles() {
    let mut random = fastrand::Rng::with_seed(10);
    for (count, size, slabs, tolerance) in [
        (120, 0.7, 1, 0.0),
        (120, 0.7, 2, 0.0),
        (120, 0.7, 6, 0.0),
        (120, 0.7, 2, 1.0e-2),
        (120, 0.7, 6, 1.0e-2),
        // Trees outgrow their tables.
        (700, 0.2, 2, 0.0),
        (1500, 0.12, 3, 0.0),
        (1500, 0.12, 3, 1.0e-3),
    ] {
        let all = soup(&mut random, count, size);
        let options = BspOptions { tolerance, ..exact(slabs) };
        let grid = device().build_bsp(&all, &options).expect("it fits");
        let (mut order, mut corners) = (BspOrder::default(), Vec::new());
        device().sort_bsp(&grid, [1 << 19; 3], &mut order);
        let is_empty = |piece: &&u32| {
            grid.corners_of(**piece, &mut corners);
            corners.is_empty()
        };
        let empty = order.pieces.iter().filter(is_empty).count();
        assert!(empty < order.pieces.len() / 20, "{slabs}: {empty} of {} are empty", order.pieces.len());
        let mesh = pieces::mesh(&grid, &order.pieces);
        let mut told = Vec::new();
        for piece in &order.pieces {
            grid.corners_of(*piece, &mut corners);
            told.extend(corners.iter().map(|_| grid.pieces[*piece as usize].triangle));
        }
        assert_eq!(mesh.patches, told, "{slabs}: far to near");
        let mut areas = vec![0.0; all.len()];
        for fan in &mesh.triangles {
            let own = fan.map(|corner| DVec3::from(mesh.positions[corner as usize].map(f64::from)));
            areas[mesh.patches[fan[0] as usize] as usize] += area(own);
        }
        let wholes = all.iter().map(|triangle| triangle.map(|corner| DVec3::from(corner.map(f64::from))));
        for (k, whole) in wholes.clone().enumerate() {
            assert!((areas[k] - area(whole)).abs() < 2.0e-5 * (1.0 + areas[k]), "{slabs}: triangle {k}");
        }
        let wholes: Vec<_> = wholes.collect();
        for (k, [u, v]) in mesh.uvs.iter().enumerate() {
            let [a, b, c] = wholes[mesh.patches[k] as usize];
            let there = a + f64::from(*u) * (b - a) + f64::from(*v) * (c - a);
            let here = DVec3::from(mesh.positions[k].map(f64::from));
            assert!((there - here).length() < 1.0e-5, "{slabs}: {there} {here}");
        }
    }
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}
