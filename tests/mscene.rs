//! `.mscene` files are read as they should, and bad ones are refused: with an error, never a panic.

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use micropoly::mscene::{Mesh, MeshPatches, Mscene, parse_bytes, read_contents};
use micropoly::{Error, FrameOptions, Light, RenderOptions, Scene, render};

#[path = "mscene_writer/generated.rs"]
mod mscene;
mod mscene_writer;

use mscene::mscene_capnp::{light_source, mesh};
use mscene_writer::{MeshSample, ObjectSample, Sample, UNTURNED, pack};

fn place() -> &'static Path {
    Path::new("test.mscene")
}

fn read(sample: &Sample) -> Scene {
    parse_bytes(place(), &sample.packed()).expect("a scene")
}

/// The message of a refusal.
fn refusal(bytes: &[u8]) -> String {
    match parse_bytes(place(), bytes) {
        Err(error @ Error::Content { .. }) => error.to_string(),
        other => panic!("not refused as it should: {other:?}"),
    }
}

#[test]
fn a_scene_is_read_as_it_was_written() {
    let sample = Sample::with(|s| s.objects[0].transform.0 = [7.0, 0.0, -1.0]);
    let scene = read(&sample);
    assert_eq!(scene.name, "test.mscene");
    assert_eq!((scene.camera.near, scene.camera.fov), (0.125, 45.0));
    assert_eq!(scene.camera.view.transform_point3(DVec3::new(1.5, 1.5, 5.0)), DVec3::ZERO);
    assert_eq!(scene.camera.view.transform_point3(DVec3::ZERO), DVec3::new(-1.5, -1.5, -5.0));
    assert_eq!(scene.lights, [Light::Directional { to_light: DVec3::Z, colour: Vec3::new(2.0, 1.0, 0.5) }]);
    let [object] = &scene.objects[..] else { panic!("one object") };
    assert_eq!(object.to_world.transform_point3(DVec3::ZERO), DVec3::new(7.0, 0.0, -1.0));
    assert_eq!(object.material.colour, Vec3::new(0.5, 0.6, 0.7));
    assert_eq!(object.shape.bezier.len(), 1);
    assert_eq!(object.shape.bezier[0].points[6], [1.0, 2.0, 0.0]);
}

#[test]
fn things_are_turned_first_and_moved_then_and_the_camera_looks_along_its_minus_z() {
    // A quarter turn about x, not of unit length: -z goes to y.
    let turned = [0.5, 0.5, 0.0, 0.0];
    let scene = read(&Sample::with(|s| {
        s.objects[0].transform = ([1.0, 2.0, 3.0], turned);
        s.cameras[0].transform = ([0.0, -4.0, 0.0], turned);
        s.lights[0].transform.1 = turned;
    }));
    let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} is not {b}");
    near(scene.objects[0].to_world.transform_point3(DVec3::Z), DVec3::new(1.0, 1.0, 3.0));
    near(scene.camera.view.transform_point3(DVec3::ZERO), DVec3::new(0.0, 0.0, -4.0));
    near(scene.camera.view.transform_vector3(DVec3::Z), DVec3::Y);
    let [Light::Directional { to_light, .. }] = scene.lights[..] else { panic!("one light") };
    near(to_light, -DVec3::Y);
}

#[test]
fn each_type_of_light_becomes_what_is_like_it() {
    let light = |kind| {
        let scene = read(&Sample::with(|s| {
            s.lights[0].kind = kind;
            s.lights[0].transform.0 = [1.0, 2.0, 3.0];
        }));
        (scene.ambient, scene.lights[0])
    };
    let (ambient, colour) = (Vec3::splat(0.1), Vec3::new(2.0, 1.0, 0.5));
    let point = Light::Point { position: DVec3::new(1.0, 2.0, 3.0), colour };
    assert_eq!(light(light_source::Type::Point), (ambient, point));
    let directional = Light::Directional { to_light: DVec3::Z, colour };
    assert_eq!(light(light_source::Type::Directional), (ambient, directional));
    let half = colour * 0.5;
    let sky = Light::Directional { to_light: DVec3::Z, colour: half };
    assert_eq!(light(light_source::Type::Hemi), (ambient + half, sky));
}

#[test]
fn gregory_patches_are_read_and_drawn() {
    let gregory = MeshSample {
        name: "round",
        kind: mesh::Type::Gregory,
        positions: (0..60).map(|i| i as f32).collect(),
    };
    let mut sample = Sample::with(|s| s.meshes.push(gregory));
    let Mscene { meshes, .. } = read_contents(place(), &sample.packed()).expect("contents");
    let MeshPatches::Gregory(patches) = &meshes[1].patches else { panic!("Gregory patches") };
    assert_eq!(patches.len(), 1);
    assert_eq!(patches[0].points[19], [57.0, 58.0, 59.0]);
    assert_eq!(read(&sample).patch_count(), 1);
    sample.objects[0].mesh = "round";
    let scene = read(&sample);
    assert_eq!((scene.patch_count(), scene.gregory_count()), (1, 1));
    assert_eq!(scene.objects[0].shape.gregory, *patches);
    let device = scene.for_device(&FrameOptions::default()).expect("a drawable scene");
    assert_eq!((device.patches.len(), device.patches[0].faces, device.patches[1].faces), (2, 1, 0));
}

#[test]
fn scenes_that_make_no_sense_are_refused() {
    type Change = fn(&mut Sample);
    let cases: [(Change, &str); 27] = [
        (|s| s.cameras.clear(), "test.mscene: the scene has no camera"),
        (|s| s.objects.clear(), "the scene has no objects"),
        (|s| s.meshes.clear(), "object 1 of 1 (\"an object\"): there is no mesh \"flat\""),
        (|s| s.objects[0].mesh = "", "there is no mesh \"\""),
        (|s| s.objects[0].mesh = "other\u{1b}[31m", "there is no mesh \"other\\u{1b}[31m\""),
        (|s| s.meshes[0].name = "", "mesh 1 of 1: it has no name"),
        (|s| s.meshes.push(s.meshes[0].clone()), "mesh 2 of 2 (\"flat\"): an earlier mesh has the same name"),
        (|s| s.meshes[0].positions.clear(), "mesh 1 of 1 (\"flat\"): its list of positions has 0 numbers"),
        (|s| s.meshes[0].positions.truncate(47), "has 47 numbers"),
        (|s| s.meshes[0].positions.extend([0.0; 12]), "has 60 numbers"),
        (|s| s.meshes[0].kind = mesh::Type::Gregory, "has 48 numbers"),
        (|s| s.meshes[0].positions[5] = f32::NAN, "a coordinate of patch 1 of 1 is not finite"),
        (|s| s.meshes[0].positions[47] = f32::INFINITY, "a coordinate of patch 1 of 1 is not finite"),
        (|s| s.objects[0].transform.0[1] = f32::NAN, "its translation is not finite"),
        (|s| s.objects[0].transform.1 = [0.0; 4], "object 1 of 1 (\"an object\"): its rotation is r = 0"),
        (|s| s.lights[0].transform.1[2] = f32::NAN, "light 1 of 1 (\"a light\"): its rotation is r = 1"),
        (|s| s.cameras[0].transform.1[2] = f32::INFINITY, "camera 1 of 1 (\"a camera\"): its rotation is"),
        (|s| s.cameras[0].transform.0[0] = 1e30, "beyond 1e12"),
        (|s| s.objects[0].colour[0] = -1.0, "its colour is -1 0.6 0.7"),
        (|s| s.lights[0].colour[2] = f32::NAN, "its colour is 1 0.5 NaN"),
        (|s| s.lights[0].intensity = -1.0, "its intensity is -1"),
        (|s| s.lights[0].intensity = f32::NAN, "its intensity is NaN"),
        (|s| s.lights = vec![s.lights[0].clone(); 9], "the scene has 9 lights"),
        (|s| s.cameras[0].near = 0.0, "camera 1 of 1 (\"a camera\"): its near is 0"),
        (|s| s.cameras[0].near = f32::NAN, "its near is NaN"),
        (|s| s.cameras[0].fovy = 180.0, "its fovy is 180"),
        (|s| s.cameras[0].fovy = f32::NAN, "its fovy is NaN"),
    ];
    for (change, what) in cases {
        let text = refusal(&Sample::with(change).packed());
        assert!(text.contains(what) && text.contains("help: "), "`{what}` is missing in: {text}");
    }
}

/// Offset of the only place where these bytes stand in a message.
fn find(message: &[u8], bytes: &[u8]) -> usize {
    let mut places = message.windows(bytes.len()).enumerate().filter(|(_, window)| *window == bytes);
    let (at, _) = places.next().expect("it is there");
    assert!(places.next().is_none(), "{bytes:?} stands there twice");
    at
}

/// The upper half of a pointer to so many floats.
fn list_of_floats(count: u32) -> [u8; 4] {
    (count << 3 | 4).to_le_bytes()
}

#[test]
fn unknown_types_and_names_that_are_no_text_are_refused() {
    let sample = Sample::with(|s| s.lights[0].intensity = 1.25);
    let good = sample.unpacked();
    // A light's type follows its intensity.
    let mut message = good.clone();
    let at = find(&message, &1.25_f32.to_le_bytes());
    message[at + 4] = 3;
    assert!(refusal(&pack(&message)).contains("light 1 of 1 (\"a light\"): its type is neither point"));
    // A mesh is a word with its type and the pointers to its name and its positions.
    let mut message = good.clone();
    let at = find(&message, &list_of_floats(48));
    message[at - 20] = 2;
    assert!(refusal(&pack(&message)).contains("mesh 1 of 1 (\"flat\"): its type is neither bezier"));
    let mut message = good.clone();
    let at = find(&message, b"an object");
    message[at] = 0xff;
    assert!(refusal(&pack(&message)).contains("object 1 of 1: its name is damaged"));
}

#[test]
fn files_that_are_no_message_are_refused() {
    let packed = Sample::good().packed();
    let mut longer = packed.clone();
    longer.extend([0x01, 0x07]);
    let mut random = fastrand::Rng::with_seed(1);
    let noise: Vec<u8> = (0..1000).map(|_| random.u8(..)).collect();
    for (bytes, what) in [
        (&[][..], "test.mscene: the file is empty"),
        (&longer, "8 bytes follow the message"),
        (&packed[..packed.len() - 1], "help: "),
        (&[0x00, 0xff].repeat(10_000), "the message unpacks to more than"),
        // Four billion segments; a segment of 32 GiB.
        (&[0x0f, 0xff, 0xff, 0xff, 0xff], "the message is damaged"),
        (&[0xf0, 0xff, 0xff, 0xff, 0xff], "the message is damaged"),
        (b"[camera]\neye = [0, 0, 0]\n", "help: "),
        (&noise, "help: "),
        (&Sample::good().unpacked(), "help: "),
    ] {
        let text = refusal(bytes);
        assert!(text.starts_with("test.mscene: ") && text.contains(what), "`{what}` is missing in: {text}");
    }
}

/// A message's word for a pointer to a list of structs whose tag stands `offset` words after it.
fn composite(offset: u64, words: u64) -> u64 {
    1 | offset << 2 | 7 << 32 | words << 35
}

/// A message in which each of so many meshes has the same list of positions.
fn shared_positions(meshes: u64, floats: u64) -> Vec<u8> {
    let mut words = vec![0, 4 << 48, composite(3, 3 * meshes), 0, 0, 0];
    words.push(meshes << 2 | 1 << 32 | 2 << 48);
    for mesh in 0..meshes {
        let to_end = 3 * (meshes - mesh - 1);
        words.extend([0, 0, 1 | to_end << 2 | 4 << 32 | floats << 35]);
    }
    words.resize(words.len() + floats as usize / 2, 0x3f80_0000_3f80_0000);
    words[0] = (words.len() as u64 - 1) << 32;
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

#[test]
fn pointers_that_share_a_list_do_not_fill_the_memory() {
    let one = read_contents(place(), &pack(&shared_positions(1, 96))).expect("a single mesh may");
    assert!(
        matches!(&one.meshes[0], Mesh { patches: MeshPatches::Bezier(patches), .. } if patches.len() == 2)
    );
    let text = refusal(&pack(&shared_positions(10_000, 48_000)));
    assert!(text.contains("its list of positions is damaged"), "{text}");
}

#[test]
fn lists_that_claim_to_be_huge_are_refused() {
    // Half a billion structs of no size, half a billion structs of some, half a billion floats.
    let claim = |pointer: u64, tag: u64| {
        let words = [6 << 32, 4 << 48, pointer, 0, 0, 0, tag];
        pack(&words.iter().flat_map(|word: &u64| word.to_le_bytes()).collect::<Vec<u8>>())
    };
    let many = (1 << 29) - 1;
    for bytes in [claim(composite(3, 0), many << 2), claim(composite(3, many), many << 2 | 1 << 48)] {
        let text = refusal(&bytes);
        assert!(text.contains("the list of meshes is damaged"), "{text}");
    }
    let mut message = Sample::good().unpacked();
    let at = find(&message, &list_of_floats(48));
    message[at..at + 4].copy_from_slice(&list_of_floats(many as u32));
    assert!(refusal(&pack(&message)).contains("its list of positions is damaged"));
}

#[test]
fn a_mesh_that_is_used_too_often_is_refused_before_it_fills_the_memory() {
    let points = Sample::good().meshes[0].positions.clone();
    let sample = Sample::with(|s| {
        s.meshes[0].positions = points.repeat(4_000);
        s.objects =
            vec![ObjectSample { mesh: "flat", transform: ([0.0; 3], UNTURNED), colour: [1.0; 3] }; 2501];
    });
    let text = refusal(&sample.packed());
    assert!(text.contains("object 2501 of 2501 (\"an object\"): with it the scene has more than"), "{text}");
}

/// Reads the bytes and makes what was read ready for a device; only that it returns matters, and what it holds.
fn survives(bytes: &[u8]) {
    let Ok(scene) = parse_bytes(place(), bytes) else { return };
    if let Ok(device) = scene.for_device(&FrameOptions::default()) {
        let points = device.patches.iter().flat_map(|patch| patch.x.iter().chain(&patch.y).chain(&patch.z));
        assert!(points.chain(device.objects.iter().flat_map(|object| &object.to_eye)).all(|x| x.is_finite()));
    }
}

/// Two of everything, Gregory patches among them.
fn rich() -> Sample {
    Sample::with(|s| {
        let gregory = mesh::Type::Gregory;
        s.meshes.push(MeshSample { name: "round", kind: gregory, positions: vec![0.5; 60] });
        s.lights.push(s.lights[0].clone());
        s.objects.push(s.objects[0].clone());
        s.cameras.push(s.cameras[0].clone());
    })
}

#[test]
fn every_truncation_is_refused() {
    let (packed, plain) = (rich().packed(), rich().unpacked());
    parse_bytes(place(), &packed).expect("the whole is good");
    for length in 0..packed.len() {
        refusal(&packed[..length]);
    }
    for length in (0..plain.len()).step_by(8) {
        refusal(&pack(&plain[..length]));
    }
}

#[test]
fn no_flipped_bit_causes_a_panic() {
    let (packed, plain) = (rich().packed(), rich().unpacked());
    let flipped = |bytes: &[u8], at: usize, mask: u8| {
        let mut bytes = bytes.to_vec();
        bytes[at] ^= mask;
        bytes
    };
    let masks = (0..8).map(|bit| 1 << bit).chain([0xff]);
    for mask in masks {
        (0..packed.len()).for_each(|at| survives(&flipped(&packed, at, mask)));
        (0..plain.len()).for_each(|at| survives(&pack(&flipped(&plain, at, mask))));
    }
}

#[test]
fn no_random_damage_causes_a_panic() {
    let mut random = fastrand::Rng::with_seed(2014);
    let plain = rich().unpacked();
    for _ in 0..20_000 {
        let mut bytes = plain.clone();
        for _ in 0..random.usize(1..6) {
            // Pointers and their tags are whole words: one takes the place of another.
            let (from, to) = (random.usize(..plain.len() / 8) * 8, random.usize(..plain.len() / 8) * 8);
            bytes.copy_within(from..from + 8, to);
            bytes[random.usize(..plain.len())] = random.u8(..);
        }
        survives(&pack(&bytes));
    }
}

/// A file of Weber's, if it is there.
fn original(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/micropolis").join(name);
    if !path.is_file() {
        println!("skipped {test}: no {}", path.display());
        return None;
    }
    Some(path)
}

#[test]
fn the_originals_have_as_many_patches_as_they_should() {
    for (name, count) in [("teapot.mscene", 32), ("spheres.mscene", 200), ("hair.mscene", 10_000)] {
        let Some(path) = original("the_originals_have_as_many_patches_as_they_should", name) else {
            continue;
        };
        let scene = Scene::load(&path).expect(name);
        assert_eq!(scene.patch_count(), count, "{name}");
        assert_eq!((scene.camera.fov, scene.lights.len()), (60.0, 1), "{name}");
        scene.for_device(&FrameOptions::default()).expect(name);
    }
}

#[test]
fn the_originals_of_gregory_patches_are_read() {
    for (name, count) in [
        ("eye_split.mscene", 1),
        ("teapot_greg.mscene", 32),
        ("depth_complexity.mscene", 1024),
        ("columns.mscene", 13_242),
    ] {
        let Some(path) = original("the_originals_of_gregory_patches_are_read", name) else {
            continue;
        };
        let bytes = std::fs::read(&path).expect(name);
        let contents = read_contents(&path, &bytes).expect(name);
        let [Mesh { patches: MeshPatches::Gregory(patches), .. }] = &contents.meshes[..] else {
            panic!("{name}: one mesh of Gregory patches")
        };
        assert_eq!(patches.len(), count, "{name}");
        let scene = Scene::load(&path).expect(name);
        assert_eq!((scene.patch_count(), scene.gregory_count()), (count, count), "{name}");
    }
}

#[test]
fn the_original_teapot_stands_upright_and_lit() {
    let Some(path) = original("the_original_teapot_stands_upright_and_lit", "teapot.mscene") else { return };
    let scene = Scene::load(&path).expect("a scene");
    let frame = FrameOptions { width: 320, height: 180, ..FrameOptions::default() };
    let image =
        render(&scene, &RenderOptions { frame, ..RenderOptions::default() }, |_| {}).expect("renders").image;
    let row = |row: usize| &image.rgb[row * 320 * 3..(row + 1) * 320 * 3];
    let covered = |y: usize| row(y).chunks_exact(3).filter(|rgb| *rgb != [0, 0, 0]).count();
    let rows: Vec<usize> = (0..180).filter(|&y| covered(y) > 0).collect();
    let (top, bottom) = (rows[0], rows[rows.len() - 1]);
    let (knob, belly) = (covered(top + 2), covered(top + (bottom - top) * 2 / 3));
    assert!(knob > 0 && belly > 4 * knob, "the knob ({knob} pixels wide) is above the belly ({belly})");
    let middle = row((top + bottom) / 2)[160 * 3];
    assert!(middle > 200, "the light comes from where the camera is");
}
