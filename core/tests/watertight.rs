//! Closed meshes of patches give closed meshes of micropolygons: every edge belongs to two triangles, in opposite
//! directions, whatever the camera.

mod common;

use std::collections::HashMap;

use common::{between, random, view};
use glam::{DVec3, Vec3};
use micropoly_core::abi::{Draw, FLAG_FLAT, FLAG_NAIVE, FLAG_WHOLE, Frame, Object, Patch};
use micropoly_core::adjacency::{find_owners, room_needed};
use micropoly_core::camera::Camera;
use micropoly_core::displacement::Displacement;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::patch::gregory::patch_count;
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
