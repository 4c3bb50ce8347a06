//! Files of images: what is written can be read again, by `diff` too, and frames of a path are those of its cameras.

use std::path::Path;
use std::process::Command;

use micropoly::diff::{Difference, Thresholds};
use micropoly::{Backend, Film, FrameOptions, Picture, Precision, RenderOptions, Scene, render};

fn micropoly(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_micropoly")).args(arguments).output().expect("starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap_or(-1), text(&output.stdout), text(&output.stderr))
}

fn small() -> RenderOptions {
    let frame = FrameOptions { width: 96, height: 54, ..FrameOptions::default() };
    RenderOptions { frame, backend: Backend::Cpu, film: true, ..RenderOptions::default() }
}

fn utf8(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn film() -> Film {
    let scene = Scene::load("scenes/teapot.toml").expect("a scene");
    render(&scene, &small(), |_| {}).expect("renders").film.expect("it was asked for")
}

#[test]
fn exr_files_hold_colour_coverage_depth_and_patch() {
    let (folder, film) = (tempfile::tempdir().expect("a folder"), film());
    let path = folder.path().join("a.exr");
    for (precision, within) in [(Precision::Float, 0.0), (Precision::Half, 1.0 / 2048.0)] {
        film.save_exr(&path, precision).expect("is written");
        let read = Picture::load(&path).expect("is read");
        assert_eq!((read.width, read.height), (96, 54));
        for (k, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            for (pixel, value) in film.pixels.iter().zip(&read.channels[name]) {
                let wanted = f64::from(pixel.rgba[k]);
                assert!((wanted - value).abs() <= within * wanted, "{name}: {value}");
            }
        }
        for (k, pixel) in film.pixels.iter().enumerate() {
            let (depth, patch) = (read.channels["Z"][k], read.channels["patch"][k]);
            let is_there = read.channels["A"][k] > 0.0;
            assert_eq!(is_there, depth.is_finite());
            assert_eq!(patch, f64::from(if is_there { pixel.patch_id } else { u32::MAX }));
            assert_eq!(depth, f64::from(1.0 / f32::from_bits(pixel.depth)));
        }
    }
}

#[test]
fn pngs_of_16_bits_are_what_8_bits_round() {
    let folder = tempfile::tempdir().expect("a folder");
    let (fine, coarse) = (folder.path().join("16.png"), folder.path().join("8.png"));
    let scene = Scene::load("scenes/teapot.toml").expect("a scene");
    let rendering = render(&scene, &small(), |_| {}).expect("renders");
    rendering.film.expect("it was asked for").save_png16(&fine).expect("is written");
    rendering.image.save_png(&coarse).expect("is written");
    let [fine, coarse] = [fine, coarse].map(|path| Picture::load(&path).expect("is read"));
    let found = Difference::of(&fine, &coarse, &Thresholds::default()).expect("the same shape");
    let largest = found.map.iter().fold(0.0, |most: f64, difference| most.max(*difference));
    assert!(largest <= 0.55 / 255.0, "{largest}");
    assert!(found.different > 500, "{}", found.different);
}

#[test]
fn bits_that_a_file_cannot_hold_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bits, what) in
        [("a.png", "32", "8 or 16"), ("a.exr", "8", "16 or 32"), ("a.png", "12", "8, 16 or 32")]
    {
        let path = folder.path().join(name);
        let (code, _, text) = micropoly(&["render", "scenes/teapot.toml", "-o", utf8(&path), "--bits", bits]);
        assert!(code > 0 && text.contains(what), "{text}");
        assert!(!path.exists());
    }
}

#[test]
fn frames_are_those_of_the_path() {
    let folder = tempfile::tempdir().expect("a folder");
    let pattern = folder.path().join("frame.###.png");
    let arguments = ["--res=64x36", "--backend=cpu", "--progress=none"];
    let common = ["render", "scenes/city.toml", "-o", utf8(&pattern)];
    let (code, _, text) = micropoly(&[&common[..], &arguments, &["--frames=298..300"]].concat());
    assert!(code == 0 && text.contains("images        3"), "{text}");
    let mut scene = Scene::load("scenes/city.toml").expect("a scene");
    for frame in 298..=300 {
        scene.camera = scene.camera_at(f64::from(frame)).expect("a camera");
        let mut options = small();
        (options.frame.width, options.frame.height) = (64, 36);
        let expected = folder.path().join("expected.png");
        render(&scene, &options, |_| {}).expect("renders").image.save_png(&expected).expect("is written");
        let found = std::fs::read(folder.path().join(format!("frame.{frame}.png"))).expect("a frame");
        assert!(found == std::fs::read(&expected).expect("a file"), "frame {frame}");
    }
    for (scene, frames, what) in [
        ("scenes/teapot.toml", "0..1", "nothing moves"),
        ("scenes/city.toml", "5..4", "the first no larger than the second"),
        ("scenes/city.toml", "0..100000", "has no frame"),
        ("scenes/city.toml", "0..4294967295", "has no frame"),
    ] {
        let (code, _, text) = micropoly(&["render", scene, "-o", utf8(&pattern), "--frames", frames]);
        assert!(code > 0 && text.contains(what), "{text}");
    }
    let one = folder.path().join("one.png");
    let (code, _, text) = micropoly(&["render", "scenes/city.toml", "-o", utf8(&one), "--frames=1..2"]);
    assert!(code == 1 && text.contains("####"), "{text}");
}

#[test]
fn diff_says_how_much_pictures_differ_and_exits_with_3_if_it_is_too_much() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    let exr = file("a.EXR");
    film().save_exr(&exr, Precision::Half).expect("is written");
    let (code, text, _) = micropoly(&["diff", utf8(&exr), utf8(&exr)]);
    assert!(code == 0 && text.contains("Z             no difference"), "{text}");
    let [first, second, heat, json] = ["a.png", "b.png", "heat.png", "found.json"].map(file);
    for (path, borders) in [(&first, "watertight"), (&second, "naive")] {
        let (code, _, text) = micropoly(&[
            "render",
            "scenes/teapot.toml",
            "-o",
            utf8(path),
            "--res=640x360",
            "--borders",
            borders,
            "--backend=cpu",
        ]);
        assert_eq!(code, 0, "{text}");
    }
    let (code, text, _) = micropoly(&["diff", utf8(&first), utf8(&first)]);
    assert!(code == 0 && text.contains("different     0 pixels"), "{text}");
    let both = ["diff", utf8(&first), utf8(&second)];
    let (code, text, _) = micropoly(&[&both[..], &["--heat", utf8(&heat)]].concat());
    assert!(code == 3 && text.contains("most at column") && heat.exists(), "{text}");
    let (code, _, _) = micropoly(&[&both[..], &["--fail-percent=5", "--json", utf8(&json)]].concat());
    let found: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&json).expect("a file")).expect("JSON");
    assert_eq!((code, found["width"].as_u64()), (0, Some(640)));
    assert!(found["different"].as_u64().expect("a number") > 0, "{found}");
    let (code, _, _) = micropoly(&[&both[..], &["--fail-percent=5", "--hard-fail=0.01"]].concat());
    assert_eq!(code, 3);
    std::fs::write(file("broken.exr"), "no such thing").expect("written");
    // A file that claims a million pixels in each direction.
    let mut claims = std::fs::read(&exr).expect("a file");
    let window = claims.windows(11).position(|name| name == b"dataWindow\0").expect("a window") + 11 + 6 + 4;
    claims[window + 8..window + 16].copy_from_slice(&[0x3f, 0x42, 0x0f, 0, 0x3f, 0x42, 0x0f, 0]);
    std::fs::write(file("claims.exr"), claims).expect("written");
    let (code, _, text) = micropoly(&["diff", utf8(&first), utf8(&file("claims.exr"))]);
    assert!(code == 1 && text.contains("too short for its size"), "{text}");
    for wrong in ["broken.exr", "missing.png"] {
        let (code, _, text) = micropoly(&["diff", utf8(&first), utf8(&file(wrong))]);
        assert!(code == 1 && text.contains(wrong), "{text}");
    }
}
