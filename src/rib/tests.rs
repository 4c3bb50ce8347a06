//! Files as a whole.

use std::path::Path;

use super::lower::lower;
use super::{RibGeometry, RibScene, parse_bytes};

/// Reads a text that can be read.
pub(super) fn read(text: &str) -> RibScene {
    parse_bytes(Path::new("x.rib"), text.as_bytes()).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// Why a text cannot be read.
pub(super) fn wrong(text: &str) -> String {
    match parse_bytes(Path::new("x.rib"), text.as_bytes()) {
        Err(error @ crate::Error::Format { .. }) => error.to_string(),
        other => panic!("{text}\n{other:?}"),
    }
}

/// The geometry that a text draws.
pub(super) fn geometry(text: &str) -> RibGeometry {
    (*read(text).objects[0].geometry).clone()
}

#[test]
fn objects_are_drawn_where_they_are_used() {
    let scene = read(
        "ObjectBegin 1 Translate 1 0 0 Sphere 1 -1 1 360 Color 0 1 0 Disk 0 1 360 ObjectEnd\n\
         Color 1 0 0 Translate 0 2 0 ObjectInstance 1 ReverseOrientation ObjectInstance 1",
    );
    assert_eq!(scene.objects.len(), 4);
    let [ball, disk, other_ball, _] = &scene.objects[..] else { panic!("four") };
    assert_eq!(ball.to_world.translation, glam::DVec3::new(1.0, 2.0, 0.0));
    assert_eq!((ball.colour, disk.colour), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert!(std::sync::Arc::ptr_eq(&ball.geometry, &other_ball.geometry));
    assert!(!ball.is_reversed && other_ball.is_reversed);
    assert!(wrong("ObjectInstance \"x\"").contains("no object `x`"));
    assert!(wrong("ObjectBegin 1 ObjectBegin 2").contains("another object"));
}

#[test]
fn objects_of_objects_are_not_drawn_without_limit() {
    let mut text = "ObjectBegin 0 Disk 0 1 360 ObjectEnd\n".to_owned();
    for level in 1..40 {
        let last = level - 1;
        text += &format!("ObjectBegin {level} ObjectInstance {last} ObjectInstance {last} ObjectEnd\n");
    }
    assert!(wrong(&text).contains("more than 2000000 objects"));
}

#[test]
fn blocks_restore_what_was_before() {
    let scene = read(
        "AttributeBegin Translate 1 0 0 Color 1 0 0 AttributeEnd TransformBegin Translate 2 0 0 TransformEnd\n\
         SolidBegin \"union\" Sphere 1 -1 1 360 SolidEnd",
    );
    assert_eq!(scene.objects[0].to_world, glam::DAffine3::IDENTITY);
    assert_eq!(scene.objects[0].colour, [1.0; 3]);
    assert_eq!(scene.warnings.len(), 1);
}

#[test]
fn blocks_end_in_the_order_in_which_they_begin() {
    assert!(wrong("AttributeBegin\nTransformBegin AttributeEnd").contains("`TransformBegin` of line 2"));
    assert!(wrong("WorldEnd").contains("no such block"));
    assert!(wrong("\nWorldBegin Disk 0 1 360").starts_with("x.rib:2: the block that `WorldBegin` begins"));
    assert!(wrong("WorldBegin WorldBegin").contains("another world"));
}

#[test]
fn of_motions_the_first_place_counts() {
    let scene = read("MotionBegin [0 1] Translate 1 0 0 Translate 2 0 0 MotionEnd Sphere 1 -1 1 360");
    assert_eq!(scene.objects[0].to_world.translation, glam::DVec3::X);
    assert!(scene.warnings[0].contains("motion"));
}

#[test]
fn of_frames_the_first_one_is_read() {
    let frame = "FrameBegin 1 Projection \"perspective\" WorldBegin Disk 0 1 360 WorldEnd FrameEnd\n";
    let scene = read(&format!("{frame}{frame}"));
    assert_eq!((scene.objects.len(), scene.warnings.len()), (1, 1));
    assert!(scene.camera.is_some());
}

#[test]
fn requests_that_are_unknown_are_warned_about_once() {
    let scene = read("Foo 1 [2] \"x\"\nBar\nFoo \"P\" [1 2\n3]\nDisk 0 1 360");
    let expected = ["Foo", "Bar"].iter().zip(1..);
    let expected: Vec<_> =
        expected.map(|(name, line)| format!("x.rib:{line}: `{name}` is not supported and ignored")).collect();
    assert_eq!(scene.warnings, expected);
}

#[test]
fn what_is_no_scene_is_refused() {
    for (text, start) in [
        ("", "x.rib:1: the file draws nothing"),
        ("# nothing\n", "x.rib:1: the file draws nothing"),
        ("dear reader", "x.rib:1: `dear`: this is no request"),
        ("1\n3 3", "x.rib:1: something other"),
        ("Disk 0 1 360\n{", "x.rib:2: `{` is neither"),
    ] {
        assert!(wrong(text).starts_with(start), "{}", wrong(text));
    }
}

/// Seeds of the fuzz target.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds/rib");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("seeds").map(|entry| entry.expect("a seed").path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("a seed")).collect()
}

/// Bytes that mean something, or should not be there.
const ODD: &[u8] = b"0123456789-.e []\"\n#AZ\0\xff\\";

/// One to four changes: digits that are others, bytes that are taken out, or put in from elsewhere in some seed.
fn mutate(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], random: &mut fastrand::Rng) {
    for _ in 0..random.usize(1..=4) {
        if random.bool() {
            change_digit(bytes, random);
            continue;
        }
        let at = random.usize(0..=bytes.len());
        let length = random.usize(0..=24).min(bytes.len() - at);
        let other = &seeds[random.usize(0..seeds.len())];
        let from = random.usize(0..=other.len());
        let piece = &other[from..(from + random.usize(0..=24)).min(other.len())];
        match random.u8(0..4) {
            0 => drop(bytes.splice(at..at + length, piece.iter().copied())),
            1 => drop(bytes.drain(at..at + length)),
            2 => bytes.insert(at, ODD[random.usize(0..ODD.len())]),
            _ => drop(bytes.splice(at..at, piece.iter().copied())),
        }
    }
}

/// Puts another digit in the place of one.
fn change_digit(bytes: &mut [u8], random: &mut fastrand::Rng) {
    let digits: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
    if let Some(&at) = random.choice(&digits) {
        bytes[at] = random.u8(b'0'..=b'9');
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    let (seeds, mut random) = (seeds(), fastrand::Rng::with_seed(7));
    let (mut read, mut made_ready) = (0, 0);
    for _ in 0..20_000 {
        let mut bytes = seeds[random.usize(0..seeds.len())].clone();
        mutate(&mut bytes, &seeds, &mut random);
        if let Ok(scene) = parse_bytes(Path::new("no such folder/x.rib"), &bytes) {
            read += 1;
            if let Ok(made) = lower(&scene, 1) {
                made_ready += 1;
                assert_eq!(made.shapes.len(), scene.objects.len());
                let mut points = made.shapes.iter().flat_map(|shape| shape.points()).flatten();
                assert!(points.all(f32::is_finite), "{}", String::from_utf8_lossy(&bytes));
            }
        }
    }
    assert!(read > 1000 && made_ready > 500, "{read}, {made_ready}: the changes are too many");
}
