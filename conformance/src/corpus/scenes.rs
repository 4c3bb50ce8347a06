//! Scenes for stages: patches of every kind, and objects that have them.

use glam::{DAffine3, DVec3, Vec3};
use micropoly_core::abi::{
    FLAG_INSTANCES, Frame, KIND_HALF_SHIFT, KIND_RATIONAL, MAX_OCTAVES, Object, Patch,
};
use micropoly_core::adjacency::{find_owners, room_needed};
use micropoly_core::border::SIDES;
use micropoly_core::camera::{Borders, Camera, FrameOptions, Light, Material, Oracle, Profile};
use micropoly_core::displacement::Displacement;
use micropoly_core::patch::gregory::INNER;
use micropoly_core::patch::owner::owned_by_half;

/// A view from near or inside a unit ball around the origin.
pub(super) fn view(random: &mut fastrand::Rng) -> (Frame, Vec<Object>) {
    let mut axis = || random.f64() * 2.0 - 1.0;
    let eye = DVec3::new(axis(), axis(), axis()) * 3.0 * axis().abs();
    let target = DVec3::new(axis(), axis(), axis());
    let lights = [
        Light::Directional { to_light: DVec3::new(axis(), axis(), 1.0), colour: Vec3::splat(0.7) },
        Light::Point { position: DVec3::new(axis(), axis(), axis()) * 4.0, colour: Vec3::new(0.3, 0.4, 0.5) },
    ];
    let (near, fov) = ([1.0e-4, 0.05, 0.7][random.usize(0..3)], [20.0, 60.0, 120.0][random.usize(0..3)]);
    let camera = Camera::look_at(eye, target, DVec3::new(0.1, 0.2, 1.0), fov, near).unwrap_or(Camera {
        view: DAffine3::IDENTITY,
        fov,
        near,
    });
    let (mut camera, mut size) = (camera, (random.u32(1..200), random.u32(1..150)));
    if random.u8(0..3) == 0 {
        // 32 pixels from a distance of 1: vertices of even patches lie on the centres of pixels.
        camera = Camera { view: DAffine3::from_translation(DVec3::NEG_Z), fov: 90.8882888662, near: 0.05 };
        size = (65, 65);
    }
    let options = FrameOptions {
        width: size.0,
        height: size.1,
        bound: [3.0, 8.0, 40.0][random.usize(0..3)],
        rate: random.u32(1..=16),
        size: [0.3, 1.0, 2.0][random.usize(0..3)],
        borders: [Borders::Watertight, Borders::Watertight, Borders::Naive, Borders::Fixed]
            [random.usize(0..4)],
        levels: random.u32(1..=41),
        cull_backfaces: random.bool(),
        whole: random.u8(0..6) == 0,
        profile: if random.u8(0..4) == 0 { Profile::Weber2014 } else { Profile::Conservative },
        oracle: if random.u8(0..4) == 0 { Oracle::Flatness } else { Oracle::Size },
        tolerance: [0.1, 1.0, 8.0][random.usize(0..3)],
        ..FrameOptions::default()
    };
    let frame = camera.frame(&options, Vec3::splat(0.1), &lights[..random.usize(0..=2)]);
    let object = |gloss: u32, specular: f32| {
        let material = Material { colour: Vec3::new(0.8, 0.5, 0.2), specular, gloss, opacity: 1.0 };
        camera.object(DAffine3::IDENTITY, &material)
    };
    (frame, vec![object(0, 0.0), object(random.u32(0..=10), 0.4)])
}

/// A patch: smooth, rough, even, flat, collapsed along an edge, to a line or to a point, with a control point far
/// away (what rounding can do is then many pixels), or so long that ranges split most often are large.
pub(super) fn patch(random: &mut fastrand::Rng) -> Patch {
    let mut patch = Patch { object: random.u32(0..2), ..Patch::default() };
    let (rough, kind) = ([0.05, 0.4, 2.0][random.usize(0..3)], random.usize(0..12));
    let anywhere = random.usize(0..16);
    // So far that the rest seems flat beside it, or nearly.
    let far = [3.0e5, 2.0e4, 6.0e3][random.usize(0..3)] * if random.bool() { 1.0 } else { -1.0 };
    let point = [0, 15, anywhere][random.usize(0..3)];
    for k in 0..16 {
        let mut jitter = || if kind >= 10 { 0.0 } else { (random.f32() * 2.0 - 1.0) * rough };
        patch.x[k] = (k / 4) as f32 / 1.5 - 1.0 + jitter();
        patch.y[k] = (k % 4) as f32 / 1.5 - 1.0 + jitter();
        patch.z[k] = jitter();
    }
    for k in 0..16 {
        let from = match kind {
            0 if k < 4 => 0,
            1 if k % 4 == 3 => 3,
            2 => k / 4 * 4,
            3 if random.u8(0..4) == 0 => 0,
            _ => k,
        };
        (patch.x[k], patch.y[k], patch.z[k]) = (patch.x[from], patch.y[from], patch.z[from]);
    }
    match kind {
        4 => patch.z = [0.25; 16],
        5 => patch.x[point] = far,
        6 => patch.y[point] = far,
        7 => patch.z[point] = far,
        8 => (0..16).for_each(|k| patch.x[k] = ((k / 4) as f32 / 1.5 - 1.0) * 4.0e6),
        9 => (0..16).for_each(|k| patch.y[k] = ((k % 4) as f32 / 1.5 - 1.0) * 4.0e6),
        11 => patch.x = patch.x.map(|x| -x), // seen from the other side
        _ => (),
    }
    patch
}

/// Number of patches of a scene; every third is a Gregory patch in half of all scenes, or rational in a quarter; half of
/// them are displaced in a third; in a third sides are halves of others'; in a quarter several objects have the same.
pub(super) const PATCHES: u32 = 24;

pub(super) fn scene(random: &mut fastrand::Rng) -> (Frame, Vec<Object>, Vec<Patch>) {
    let (mut frame, mut objects) = view(random);
    let mut patches: Vec<Patch> = (0..PATCHES).map(|_| patch(random)).collect();
    let is_displaced = random.u8(0..3) == 0;
    if is_displaced {
        patches.iter_mut().for_each(|patch| sink(random, patch));
        patches.iter_mut().for_each(|patch| fold(random, patch));
        join(random, &mut patches);
    }
    match random.u8(0..4) {
        0 | 1 => {
            for index in (0..PATCHES as usize).step_by(3) {
                patches[index].faces = patches.len() as u32;
                patches.push(faces(random, &patches[index]));
            }
        }
        2 => (0..PATCHES as usize).step_by(3).for_each(|index| weigh(random, &mut patches, index)),
        _ => (),
    }
    if random.u8(0..3) == 0 {
        (0..PATCHES as usize).for_each(|index| halve(random, &mut patches, index));
    }
    if is_displaced {
        objects[1] = displaced(random, objects[1]);
        let mut room = vec![0; room_needed(&patches)];
        find_owners(&mut patches, &mut room);
    }
    if random.u8(0..4) == 0 {
        frame.flags |= FLAG_INSTANCES;
        objects = instances(random, &objects);
    }
    frame.object_count = objects.len() as u32;
    (frame, objects, patches)
}

/// Makes a patch rational, its weights a little apart, or far.
fn weigh(random: &mut fastrand::Rng, patches: &mut Vec<Patch>, index: usize) {
    let most = [1.0, 2.0, 100.0][random.usize(0..3)];
    let record = Patch { x: std::array::from_fn(|_| 1.0 + (most - 1.0) * random.f32()), ..Patch::default() };
    (patches[index].faces, patches[index].kind) = (patches.len() as u32, KIND_RATIONAL);
    patches.push(record);
}

/// Lets sides of a Bézier patch be halves of another's, or be halved.
fn halve(random: &mut fastrand::Rng, patches: &mut [Patch], index: usize) {
    let others: Vec<u32> = (0..PATCHES)
        .filter(|other| {
            let other = &patches[*other as usize];
            other.faces == 0 && other.object == patches[index].object
        })
        .collect();
    if patches[index].faces > 0 || others.is_empty() {
        return;
    }
    for side in SIDES {
        match random.u8(0..6) {
            0 | 1 => {
                let other = others[random.usize(0..others.len())];
                let word = owned_by_half(other, random.u32(0..4), random.bool(), random.bool());
                patches[index].owners[side] = word;
                patches[index].kind |= 1 << side << KIND_HALF_SHIFT;
            }
            2 => patches[index].kind |= 1 << side,
            _ => (),
        }
    }
}

/// Objects that have some of the records each; one of them none.
fn instances(random: &mut fastrand::Rng, objects: &[Object]) -> Vec<Object> {
    let mut starts = [0, random.u32(0..=PATCHES), random.u32(0..=PATCHES), random.u32(0..=PATCHES), PATCHES];
    starts.sort_unstable();
    starts
        .windows(2)
        .map(|range| Object {
            first_patch: range[0],
            first_record: random.u32(0..=PATCHES - (range[1] - range[0])),
            ..objects[random.usize(0..objects.len())]
        })
        .collect()
}

/// An object with bumps, now and then as coarse and high as the whole scene.
fn displaced(random: &mut fastrand::Rng, object: Object) -> Object {
    let height = [0.01, 0.2, 1.0][random.usize(0..3)];
    let frequency = [0.7, 5.0, 300.0][random.usize(0..3)];
    object.displaced(&Displacement { height, frequency, octaves: random.u32(1..=MAX_OCTAVES) }, 2.0)
}

/// Puts one patch in eight into the plane z = 0, or so near it that devices without denormals might differ.
fn sink(random: &mut fastrand::Rng, patch: &mut Patch) {
    if random.u8(0..8) == 0 {
        let tiny = [0.0, 1.0e-12, 1.0e-19, 1.0e-30][random.usize(0..4)];
        patch.z = patch.z.map(|z| z * tiny);
    }
}

/// Lets a side of one patch in eight run back over its own points.
fn fold(random: &mut fastrand::Rng, patch: &mut Patch) {
    if random.u8(0..8) == 0 {
        let [a, b, c, d] =
            [[0, 4, 8, 12], [3, 7, 11, 15], [0, 1, 2, 3], [12, 13, 14, 15]][random.usize(0..4)];
        for (from, to) in [(a, d), (b, c)] {
            (patch.x[to], patch.y[to], patch.z[to]) = (patch.x[from], patch.y[from], patch.z[from]);
        }
    }
}

/// Lets patches share all edges with the one before them, however turned.
fn join(random: &mut fastrand::Rng, patches: &mut [Patch]) {
    for index in 1..patches.len() {
        let shared = patches[index - 1];
        let (is_turned, is_reversed) = (random.bool(), random.bool());
        let from = |k: usize| {
            let k = if is_turned { 4 * (k % 4) + 3 - k / 4 } else { k };
            if is_reversed { 15 - k } else { k }
        };
        if random.bool() {
            let patch = &mut patches[index];
            patch.object = shared.object;
            for k in (0..16).filter(|k| !INNER.contains(k)) {
                (patch.x[k], patch.y[k], patch.z[k]) =
                    (shared.x[from(k)], shared.y[from(k)], shared.z[from(k)]);
            }
        }
    }
}

/// Face points around the inner points of a patch: far from them, near them, or all there. Now and then one or both of an
/// inner point's are so far away that what rounding can do is many pixels.
pub(super) fn faces(random: &mut fastrand::Rng, patch: &Patch) -> Patch {
    let mut record = Patch { object: patch.object, ..Patch::default() };
    let rough = [0.0, 0.05, 0.6][random.usize(0..3)];
    for l in 0..8 {
        let at = INNER[l % 4];
        let mut jitter = || (random.f32() * 2.0 - 1.0) * rough;
        record.x[l] = patch.x[at] + jitter();
        record.y[l] = patch.y[at] + jitter();
        record.z[l] = patch.z[at] + jitter();
    }
    if random.u8(0..6) == 0 {
        let (m, axis, both) = (random.usize(0..4), random.usize(0..3), random.bool());
        for l in if both { m..m + 5 } else { m..m + 1 }.step_by(4) {
            [&mut record.x, &mut record.y, &mut record.z][axis][l] = 1.0e5;
        }
    }
    record
}

pub(super) const IDENTITY: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// A bent patch some pixels wide that begins before the near plane and ends beyond it: in eye space.
pub(super) fn crossing(random: &mut fastrand::Rng, frame: &Frame) -> Patch {
    let mut patch = Patch::default();
    let pixel = frame.near / frame.focal;
    for k in 0..16 {
        let mut jitter = || random.f32() * 2.0 - 1.0;
        patch.x[k] = ((k / 4) as f32 * 6.0 - 9.0 + 8.0 * jitter()) * pixel;
        patch.y[k] = ((k % 4) as f32 * 3.0 - 5.0 + 8.0 * jitter()) * pixel;
        patch.z[k] = -frame.near * ([0.5, 0.9, 1.4, 1.8][k % 4] + 0.2 * jitter());
    }
    patch
}
