//! What is found about few pieces at once, and about cells, is what looking at each alone says.

use micropoly_core::abi::BspFrame;
use micropoly_core::accel::bsp::cells::{far_to_near, place_of, quadrants, slab_end, slab_of};
use micropoly_core::accel::bsp::lattice::{FARTHEST, Point};
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cutter, Knife, side, whole};
use micropoly_core::accel::bsp::table::{FEW, SLOTS, Sides, Table};

type Triangle = [Point; 3];

/// Triangles that have much in common: corners of a coarse lattice, so that many share them, or lie in one plane.
fn soup(random: &mut fastrand::Rng, count: usize, step: i32) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    while triangles.len() < count {
        let triangle = [0; 3].map(|_| [0; 3].map(|_| random.i32(0..(1 << 20) / step) * step));
        if !Plane::of(triangle).is_none() {
            triangles.push(triangle);
        }
    }
    triangles
}

fn sides_one_by_one(triangle: &Triangle, piece: &[Corner], plane: &Plane) -> Vec<i8> {
    let rough = Rough::of(plane);
    (0..piece.len()).map(|k| side(triangle, piece, k, plane, &rough) as i8).collect()
}

/// What of a piece is on one side of a plane: 0 before it, 1 behind it.
fn half(triangle: &Triangle, piece: &[Corner], plane: &Plane, cutter: u32, wanted: usize) -> Vec<Corner> {
    let sides = sides_one_by_one(triangle, piece, plane);
    let way = [1, -1][wanted];
    if !sides.contains(&-way) {
        return if sides.contains(&way) { piece.to_vec() } else { Vec::new() };
    }
    let knife = Knife { triangle, line: plane.values(*triangle), sides: &sides };
    let mut corners = Vec::new();
    knife.split(piece, Cutter::Triangle(cutter), |half, corner, _| {
        if half == wanted {
            corners.push(corner);
        }
    });
    corners
}

#[test]
fn a_table_says_what_each_corner_says_alone() {
    let mut random = fastrand::Rng::with_seed(1);
    let (mut on_planes, mut made) = (0, 0);
    for round in 0..300 {
        let count = [1, 2, 7, 8, 9, 33, FEW][round % 7];
        let triangles = soup(&mut random, count, [1, 1 << 10, 1 << 18][round % 3]);
        let planes: Vec<Plane> = triangles.iter().map(|triangle| Plane::of(*triangle)).collect();
        let mut table = Table::default();
        table.planes.lay(planes.iter().copied(), 0.0);
        let all = table.planes.all();
        assert_eq!(all.count_ones() as usize, count);
        for triangle in &triangles {
            let mut piece = whole(triangle).to_vec();
            for cutter in 0..random.usize(0..4) {
                let plane = &planes[random.usize(0..count)];
                let less = half(triangle, &piece, plane, cutter as u32, random.usize(0..2));
                piece = if less.is_empty() { piece } else { less };
            }
            for k in 0..piece.len() {
                let found = table.planes.sides(triangle, &piece, k, all);
                for (number, plane) in planes.iter().enumerate() {
                    let wanted = side(triangle, &piece, k, plane, &Rough::of(plane)) as i8;
                    assert_eq!(found.of(number), wanted, "round {round}, corner {k}");
                    on_planes += usize::from(wanted == 0);
                    made += usize::from(piece.len() > 3);
                }
            }
        }
    }
    assert!(on_planes > 1000 && made > 1000, "{on_planes} {made}");
}

#[test]
fn a_plane_divides_pieces_as_their_corners_say() {
    let mut random = fastrand::Rng::with_seed(2);
    let triangles = soup(&mut random, FEW, 1 << 17);
    let planes: Vec<Plane> = triangles.iter().map(|triangle| Plane::of(*triangle)).collect();
    let mut table = Table::default();
    table.planes.lay(planes.iter().copied(), 0.0);
    // All slots are used, and some twice.
    let mut rows = [Sides::default(); SLOTS];
    for round in 0..3 * SLOTS {
        let slot = if round < SLOTS { round } else { random.usize(0..SLOTS) };
        let triangle = triangles[random.usize(0..FEW)];
        rows[slot] = triangle
            .iter()
            .map(|corner| table.planes.sides_of_vertex(corner))
            .fold(Sides::default(), Sides::and);
        table.put(slot, rows[slot]);
    }
    let set: u128 = random.u128(..);
    let mut costs = Vec::new();
    for plane in 0..FEW {
        let found = table.divide(set, plane);
        let slots = |wanted: [bool; 2]| {
            let has = |slot: usize| [rows[slot].before, rows[slot].behind].map(|row| row >> plane & 1 == 1);
            let some = (0..SLOTS).filter(|slot| set >> slot & 1 == 1 && has(*slot) == wanted);
            some.fold(0_u128, |set, slot| set | 1 << slot)
        };
        assert_eq!(found.own, slots([false, false]));
        assert_eq!(found.before, slots([true, false]));
        assert_eq!(found.behind, slots([false, true]));
        assert_eq!(found.cut, slots([true, true]));
        let apart = found.before.count_ones().abs_diff(found.behind.count_ones());
        costs.push((found.cut.count_ones(), apart));
    }
    let best = table.best(set, u64::MAX);
    let (cuts, apart) = costs[best];
    assert!(!costs.iter().any(|(fewer, less)| *fewer < cuts && *less < apart));
    assert_eq!(table.best(set, 1 << 17), 17);
}

#[test]
fn quadrants_are_those_in_which_something_is_left() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut seen = [0; 16];
    for round in 0..20_000 {
        let most = [4, 40, 1 << 20][round % 3];
        let triangle: Triangle = [0; 3].map(|_| [0; 3].map(|_| random.i32(0..most)));
        let axes = [[0, 1], [0, 2], [1, 2]][random.usize(0..3)];
        let ends = axes.map(|_| random.i32(0..most - 1));
        let spans = |axis: usize, end: i32| {
            triangle.iter().any(|corner| corner[axis] <= end)
                && triangle.iter().any(|corner| corner[axis] > end)
        };
        if Plane::of(triangle).is_none() || !(0..2).all(|k| spans(axes[k], ends[k])) {
            continue;
        }
        let found = quadrants(&triangle, axes, ends.map(|end| 2 * end + 1));
        let mut wanted = 0;
        for quadrant in 0..4 {
            let mut piece = whole(&triangle).to_vec();
            for k in 0..2 {
                let plane = Plane::across(axes[k], ends[k]);
                let behind = usize::from(quadrant >> k & 1 == 0);
                piece = half(&triangle, &piece, &plane, k as u32, behind);
            }
            wanted |= u32::from(!piece.is_empty()) << quadrant;
        }
        assert_eq!(found, wanted, "round {round}: {triangle:?} {axes:?} {ends:?}");
        seen[found as usize] += 1;
    }
    // Two opposite ones, any three, all four.
    for quadrants in [0b0111, 0b1011, 0b1101, 0b1110, 0b1111] {
        assert!(seen[quadrants] > 100, "{seen:?}");
    }
    assert!(seen[0b0110] + seen[0b1001] > 0, "{seen:?}");
}

#[test]
fn a_coordinate_is_in_the_first_slab_that_ends_beyond_it() {
    let mut random = fastrand::Rng::with_seed(4);
    for round in 0..1000 {
        let (low, slabs) = (random.i32(0..1000), random.u32(1..40));
        let high = low + random.i32(slabs as i32..[50, 1 << 19][round % 2]);
        let ends: Vec<i32> = (0..slabs).map(|slab| slab_end(low, high, slab, slabs)).collect();
        let near = ends.iter().flat_map(|end| [-1, 0, 1].map(|by| i64::from(end + by)));
        for at in near.chain([i64::from(low), i64::from(low) - 100, i64::from(high) + 100, -1 << 40, 1 << 40])
        {
            let wanted = ends.iter().filter(|end| i64::from(**end) < at).count() as u32;
            assert_eq!(slab_of(&ends, at), wanted, "{at} in {ends:?}");
        }
    }
}

#[test]
fn the_nearest_slab_comes_last_and_no_slab_hides_one_that_comes_later() {
    for slabs in 1..12 {
        for eye in 0..=slabs {
            let order: Vec<u32> = (0..slabs).map(|place| far_to_near(slabs, eye, place)).collect();
            let mut wanted: Vec<u32> = (0..slabs).collect();
            // Before the eye's, beyond it, and its own.
            wanted.sort_by_key(|slab| (*slab >= eye, if *slab < eye { *slab } else { slabs - slab }));
            assert_eq!(order, wanted, "{slabs} {eye}");
            assert!((0..slabs).all(|slab| order[far_to_near(slabs, eye, slab) as usize] == slab));
        }
    }
}

#[test]
fn a_cells_place_is_that_of_its_slabs() {
    let ends: [Vec<i32>; 3] = [2, 5, 3].map(|slabs| (1..=slabs).map(|slab| 10 * slab).collect());
    for eye in [[-5, 25, 40], [15, 60, 1], [11, 30, 21], [400, -300, 30]] {
        let frame = BspFrame::new(ends.each_ref().map(Vec::as_slice), 7, eye);
        assert_eq!((frame.cells, frame.slabs, frame.planes), (30, [2, 5, 3], 7));
        let along = |axis: usize| {
            (0..frame.slabs[axis]).map(move |k| far_to_near(frame.slabs[axis], frame.eye_slabs[axis], k))
        };
        let mut place = 0;
        for x in along(0) {
            for y in along(1) {
                for z in along(2) {
                    assert_eq!(place_of(&frame, (x * 5 + y) * 3 + z), place, "{eye:?} {x} {y} {z}");
                    place += 1;
                }
            }
        }
    }
}

/// A number below `most`, or one of the largest and smallest.
fn below(random: &mut fastrand::Rng, most: i64) -> i64 {
    [most - 1, 1 - most, random.i64(1 - most..most), random.i64(-9..9)][random.usize(0..4)]
}

#[test]
fn words_of_a_plane_say_on_which_side_an_eye_is() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut on_plane = 0;
    for _ in 0..100_000 {
        let eye = [0; 3].map(|_| below(&mut random, FARTHEST));
        let normal = [0; 3].map(|_| below(&mut random, 1 << 41));
        let value: i128 = (0..3).map(|k| i128::from(normal[k]) * i128::from(eye[k])).sum();
        let most = 1 << random.u32(1..34);
        let away = i128::from(below(&mut random, most));
        let near = i64::try_from(value - away).ok().filter(|offset| offset.abs() <= 6 << 60);
        let offset = near.unwrap_or_else(|| below(&mut random, 6 << 60));
        let plane = Plane { normal, offset };
        assert_eq!(plane.is_before(eye), value > i128::from(offset), "{plane:?} {eye:?}");
        on_plane += usize::from(value == i128::from(offset));
        let words = plane.words();
        for k in 0..3 {
            assert_eq!((i64::from(words.high[k]) << 32) + i64::from(words.low[k]), normal[k]);
        }
        assert_eq!((i64::from(words.offset_high) << 32) + i64::from(words.offset_low), offset);
    }
    assert!(on_plane > 100, "{on_plane}");
}
