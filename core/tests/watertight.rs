//! Closed meshes of patches give closed meshes of micropolygons: every edge belongs to two triangles, in opposite
//! directions, whatever the camera.

mod common;

use std::collections::HashMap;

use common::{between, random, view};
use glam::{DVec3, Vec3};
use micropoly_core::abi::{
    Draw, FLAG_FLAT, FLAG_NAIVE, FLAG_WHOLE, Frame, KIND_HALF_SHIFT, Object, PARAM_ONE, Patch,
};
use micropoly_core::adjacency::{find_owners, room_needed};
use micropoly_core::camera::Camera;
use micropoly_core::displacement::Displacement;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::patch::Net;
use micropoly_core::patch::gregory::patch_count;
use micropoly_core::patch::half::SIDE_POINTS;
use micropoly_core::patch::owner::owned_by_half;
use micropoly_core::schedule::for_each_draw;

/// A closed mesh of quads: corners of each face, in the order (0,0), (1,0), (0,1), (1,1) of u and v.
type Quads = Vec<[usize; 4]>;

/// A cube whose faces are cut into n × n quads, on the unit sphere.
fn cube(n: usize) -> (Vec<Vec3>, Quads) {
    let (mut points, mut known, mut faces) = (Vec::new(), HashMap::new(), Vec::new());
    let mut number = |place: [usize; 3]| {
        *known.entry(place).or_insert_with(|| {
            let [x, y, z] = place.map(|c| 2.0 * c as f32 / n as f32 - 1.0);
            points.push(Vec3::new(x, y, z).normalize());
            points.len() - 1
        })
    };
    for axis in 0..3 {
        for end in [0, n] {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut at = |i: usize, j: usize| {
                    let mut place = [end; 3];
                    (place[(axis + 1) % 3], place[(axis + 2) % 3]) = (i, j);
                    number(place)
                };
                let face = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
                // Outwards on both ends of an axis.
                faces.push(if end == 0 { [face[1], face[0], face[3], face[2]] } else { face });
            }
        }
    }
    (points, faces)
}

/// A closed mesh of bicubic patches over these quads: random curves along the edges, random insides; every patch is
/// turned anyhow; some are Gregory patches.
fn closed(random: &mut fastrand::Rng, n: usize, rough: f32, gregory: bool) -> Vec<Patch> {
    let (points, faces) = cube(n);
    let jitter =
        |random: &mut fastrand::Rng| Vec3::from_array([0; 3].map(|_| between(random, -rough, rough)));
    let mut curves: HashMap<(usize, usize), [Vec3; 2]> = HashMap::new();
    let (mut patches, mut records) = (Vec::new(), Vec::new());
    for face in &faces {
        let mut edge = |random: &mut fastrand::Rng, a: usize, b: usize| {
            let (from, to) = (points[a.min(b)], points[a.max(b)]);
            let curve = *curves.entry((a.min(b), a.max(b))).or_insert_with(|| {
                [from.lerp(to, 1.0 / 3.0) + jitter(random), from.lerp(to, 2.0 / 3.0) + jitter(random)]
            });
            if a < b { curve } else { [curve[1], curve[0]] }
        };
        let mut net = [Vec3::ZERO; 16];
        let corners = [0, 12, 3, 15];
        for (at, corner) in corners.into_iter().zip(face) {
            net[at] = points[*corner];
        }
        for (a, b, first, step) in [(0, 1, 0, 4), (2, 3, 3, 4), (0, 2, 0, 1), (1, 3, 12, 1)] {
            let curve = edge(random, face[a], face[b]);
            (net[first + step], net[first + 2 * step]) = (curve[0], curve[1]);
        }
        for (i, j) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
            let (s, t) = (i as f32 / 3.0, j as f32 / 3.0);
            let low = net[0].lerp(net[12], s);
            net[4 * i + j] = low.lerp(net[3].lerp(net[15], s), t) + jitter(random);
        }
        if random.bool() {
            net = std::array::from_fn(|k| net[4 * (k % 4) + 3 - k / 4]); // turned by a right angle
        }
        if random.bool() {
            net.reverse(); // and by two
        }
        let mut patch = put(&net);
        if gregory && random.bool() {
            let inner = [5, 6, 9, 10, 5, 6, 9, 10].map(|k| net[k] + 0.5 * jitter(random));
            let mut all = [Vec3::ZERO; 16];
            all[..8].copy_from_slice(&inner);
            patch.faces = records.len() as u32 + 1;
            records.push(put(&all));
        }
        patches.push(patch);
    }
    let count = patches.len() as u32;
    for patch in patches.iter_mut().filter(|patch| patch.faces > 0) {
        patch.faces += count - 1;
    }
    patches.extend(records);
    patches
}

fn put(net: &[Vec3; 16]) -> Patch {
    Patch { x: net.map(|p| p.x), y: net.map(|p| p.y), z: net.map(|p| p.z), ..Patch::default() }
}

/// All that is drawn of a scene.
fn drawn(frame: &Frame, object: &Object, patches: &[Patch]) -> Vec<Draw> {
    let mut draws = Vec::new();
    for patch in 0..patch_count(patches) as u32 {
        for_each_draw(frame, &[*object], patches, patch, |draw, is_limited| {
            assert!(!is_limited, "more levels are needed");
            draws.push(draw);
        });
    }
    draws
}

/// What a mesh is like.
#[derive(Debug, Default)]
struct Tally {
    triangles: usize,
    collapsed: usize,
    open: usize,
}

fn tally(frame: &Frame, object: &Object, patches: &[Patch]) -> Tally {
    let mut tally = Tally::default();
    let mut edges: HashMap<([u32; 3], [u32; 3]), i32> = HashMap::new();
    let mut grid = Box::new(Grid::default());
    for draw in drawn(frame, object, patches) {
        dice_any(frame, patches, draw.patch_id, object, draw, &mut grid);
        // -0 is 0.
        let point = |at: usize| grid.point(at).map(|c| (c + 0.0).to_bits());
        for (row, column) in (0..grid.rows - 1).flat_map(|row| (0..grid.stride - 1).map(move |c| (row, c))) {
            let a = row * grid.stride + column;
            let corners = [a, a + 1, a + grid.stride + 1, a + grid.stride].map(point);
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| corners[k])) {
                tally.triangles += 1;
                if a == b || b == c || c == a {
                    tally.collapsed += 1;
                    continue;
                }
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let (key, sign) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
                    *edges.entry(key).or_default() += sign;
                }
            }
        }
    }
    tally.open = edges.values().filter(|count| **count != 0).count();
    tally
}

/// A camera near the unit sphere, inside now and then.
fn camera(random: &mut fastrand::Rng) -> Camera {
    let mut axis = || f64::from(between(random, -1.0, 1.0));
    let eye = DVec3::new(axis(), axis(), axis()) * 2.5;
    let target = DVec3::new(axis(), axis(), axis());
    Camera::look_at(eye, target, DVec3::new(0.1, 0.2, 1.0), 50.0, 0.02).expect("a view")
}

#[test]
fn closed_meshes_stay_closed() {
    let mut random = random(1);
    for round in 0..120 {
        let rough = [0.05, 0.3, 1.0][round % 3];
        let n = [1, 2, 3][round / 3 % 3];
        let patches = closed(&mut random, n, rough, round % 2 == 1);
        let (mut frame, object) = view(&camera(&mut random), 160, 120);
        frame.levels = 41;
        frame.flags |= FLAG_WHOLE;
        let tally = tally(&frame, &object, &patches);
        assert!(tally.open == 0, "round {round}: {tally:?}");
        assert!(tally.collapsed * 10 < tally.triangles, "round {round}: {tally:?}");
    }
}

/// Control points of a side that are the same in two patches, whichever way they run: is it the other way?
fn same_side(a: &Patch, side_a: usize, b: &Patch, side_b: usize) -> Option<bool> {
    let points = |p: &Patch, side: usize| SIDE_POINTS[side].map(|l| [p.x[l], p.y[l], p.z[l]]);
    let (there, mut back) = (points(a, side_a), points(b, side_b));
    if there == back {
        return Some(false);
    }
    back.reverse();
    (there == back).then_some(true)
}

/// Halves some Bézier patches along u, where the patches beside them are still whole: their sides are halves of those.
fn halve_some(random: &mut fastrand::Rng, patches: &mut Vec<Patch>) -> usize {
    let (mut count, whole) = (0, patches.len());
    for index in 0..whole {
        let patch = patches[index];
        let beside = |side: usize| {
            (0..whole).filter(|other| *other != index).find_map(|other| {
                let found = (0..4).find_map(|s| same_side(&patch, side, &patches[other], s).map(|r| (s, r)));
                found.map(|(other_side, is_reversed)| (other, other_side, is_reversed))
            })
        };
        let (Some(low), Some(high)) = (beside(0), beside(1)) else { continue };
        // What is halved may have no halves beside it, and neither may its neighbours be halved that way.
        let is_free = |other: usize| patches[other].kind >> KIND_HALF_SHIFT == 0 && patches[other].faces == 0;
        if random.bool() || patch.kind > 0 || !is_free(low.0) || !is_free(high.0) || low.0 == high.0 {
            continue;
        }
        let net = Net::in_object_space(&patch);
        let parts =
            [[0, PARAM_ONE / 2], [PARAM_ONE / 2, PARAM_ONE]].map(|u| net.between([u, [0, PARAM_ONE]]));
        for (k, part) in parts.into_iter().enumerate() {
            let mut half = Patch { x: part.x, y: part.y, z: part.z, ..Patch::default() };
            for (side, (other, other_side, is_reversed)) in [low, high].into_iter().enumerate() {
                half.kind |= 1 << side << KIND_HALF_SHIFT;
                let is_second = (k == 1) != is_reversed;
                half.owners[side] = owned_by_half(other as u32, other_side as u32, is_reversed, is_second);
                patches[other].kind |= 1 << other_side;
            }
            if k == 0 { patches[index] = half } else { patches.push(half) }
        }
        count += 1;
    }
    count
}

#[test]
fn closed_meshes_stay_closed_where_sides_are_halves_of_others() {
    let (mut random, mut halved, mut joined) = (random(5), 0, 0);
    for round in 0..48 {
        let (n, rough) = ([2, 3][round % 2], [0.05, 0.3, 1.0][round % 3]);
        let mut patches = closed(&mut random, n, rough, false);
        halved += halve_some(&mut random, &mut patches);
        let (mut frame, object) = view(&camera(&mut random), 160, 120);
        frame.levels = 41;
        frame.flags |= FLAG_WHOLE;
        if round % 4 == 3 {
            frame.flags |= FLAG_FLAT;
            (frame.bound, frame.rate, frame.density) = (1.0, 1, 1.0);
        }
        let object = if round % 4 == 1 { object.displaced(&bumps(&mut random), 4.0) } else { object };
        if round % 4 == 1 {
            let mut room = vec![0; room_needed(&patches)];
            find_owners(&mut patches, &mut room);
        }
        let tally = tally(&frame, &object, &patches);
        assert!(tally.open == 0, "round {round}: {tally:?}");
        if round < 8 && round % 4 == 0 {
            patches.iter_mut().for_each(|patch| patch.kind = 0);
            joined += self::tally(&frame, &object, &patches).open;
        }
    }
    assert!(halved > 90 && joined > 100, "{halved} halved, {joined} open edges if they were not joined");
}

#[test]
fn closed_meshes_stay_closed_where_surfaces_are_flat() {
    let (mut random, mut triangles) = (random(4), 0);
    for round in 0..48 {
        let (n, rough) = ([1, 2, 3][round / 3 % 3], [0.05, 0.3, 1.0][round % 3]);
        let patches = closed(&mut random, n, rough, round % 2 == 1);
        let (mut frame, object) = view(&camera(&mut random), 160, 120);
        frame.flags |= FLAG_WHOLE | FLAG_FLAT;
        (frame.bound, frame.rate, frame.density) = ([0.5, 1.0, 4.0][random.usize(0..3)], 1, 1.0);
        let tally = tally(&frame, &object, &patches);
        assert!(tally.open == 0, "round {round}: {tally:?}");
        triangles += tally.triangles;
    }
    assert!(triangles > 20_000, "{triangles}");
}

/// Bumps, small and large beside a unit sphere, coarse and fine.
fn bumps(random: &mut fastrand::Rng) -> Displacement {
    let (height, frequency) = ([0.02, 0.3][random.usize(0..2)], between(random, 0.5, 20.0));
    Displacement { height, frequency, octaves: random.u32(1..=4) }
}

#[test]
fn closed_meshes_stay_closed_when_they_are_displaced() {
    let mut random = random(3);
    let mut unowned = 0;
    for round in 0..120 {
        let (n, rough) = ([1, 2, 3][round / 3 % 3], [0.05, 0.3, 1.0][round % 3]);
        let mut patches = closed(&mut random, n, rough, round % 2 == 1);
        let (mut frame, object) = view(&camera(&mut random), 160, 120);
        frame.levels = 41;
        frame.flags |= FLAG_WHOLE;
        let object = object.displaced(&bumps(&mut random), 4.0);
        if round < 6 {
            unowned += tally(&frame, &object, &patches).open;
        }
        let mut room = vec![0; room_needed(&patches)];
        find_owners(&mut patches, &mut room);
        let tally = tally(&frame, &object, &patches);
        assert!(tally.open == 0, "round {round}: {tally:?}");
    }
    assert!(unowned > 10_000, "without owners there must be cracks: {unowned}");
}

#[test]
fn naive_borders_are_open() {
    let mut random = random(2);
    let patches = closed(&mut random, 2, 0.3, false);
    let (mut frame, object) = view(&camera(&mut random), 160, 120);
    frame.levels = 41;
    frame.flags |= FLAG_WHOLE | FLAG_NAIVE;
    assert!(tally(&frame, &object, &patches).open > 1000);
}
