//! The program as a user meets it: what it writes, and what it says when something is wrong.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use micropoly::Backend;
use tempfile::TempDir;

#[path = "mscene_writer/generated.rs"]
mod mscene;
mod mscene_writer;

use mscene_writer::Sample;

fn micropoly(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_micropoly")).args(arguments).output().expect("the program starts")
}

/// A folder with a scene file of this content and the patch file that it may name.
fn folder(scene: &str, patches: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("scene.toml"), scene).expect("written");
    std::fs::write(folder.path().join("patches.bpt"), patches).expect("written");
    let scene = folder.path().join("scene.toml");
    (folder, scene)
}

/// Renders a scene small, with more arguments; gives exit code, messages and whether an image was written.
fn render(scene: &Path, more: &[&str]) -> (i32, String, bool) {
    let image = scene.with_file_name("out.png");
    let mut arguments = vec!["render", scene.to_str().expect("UTF-8"), "-o", image.to_str().expect("UTF-8")];
    if !more.iter().any(|argument| argument.starts_with("--res")) {
        arguments.push("--res=64x36");
    }
    arguments.extend(more);
    let output = micropoly(&arguments);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code().expect("an exit code"), text, image.exists())
}

/// A scene with these fields of the camera and this object.
fn scene(camera: &str, object: &str) -> String {
    format!("[camera]\n{camera}\n[[light]]\ndirection = [0, 1, -1]\n[[object]]\n{object}\n")
}

const CAMERA: &str = "eye = [0, -5, 1]\ntarget = [0, 0, 0]\nfov = 40\nnear = 0.1";
const OBJECT: &str = "geometry = \"patches.bpt\"";
const FLAT: &str = "1\n1 1\n-1 -1 0  -1 1 0  1 -1 0  1 1 0\n";

/// A camera with keys at these frames, four lines each from line 6 on; it moves away.
fn keys(frames: &[u32]) -> String {
    let key = |&frame: &u32| {
        let far = f64::from(frame + 10) / 10.0;
        format!("[[camera.key]]\nframe = {frame}\neye = [0.5, -{far}, 1]\ntarget = [0, 0, 0]\n")
    };
    format!("{CAMERA}\n{}", frames.iter().map(key).collect::<String>())
}

const HAIR: &str = "generate = { kind = \"hair\", count = 6000000 }";

/// A failure that says what, where and how to mend it.
fn assert_refused((code, text, image): (i32, String, bool), what: &str) {
    assert!(code == 1 || code == 2, "exit code {code}: {text}");
    assert!(!text.contains("panicked"), "{text}");
    assert!(text.contains(what), "`{what}` is missing in: {text}");
    assert!(!image, "no image must be written");
}

#[test]
fn a_good_scene_renders_and_its_statistics_can_be_relied_on() {
    let (folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    let stats = folder.path().join("stats.json");
    let (code, text, image) = render(&scene, &["--stats", stats.to_str().expect("UTF-8"), "--threads", "2"]);
    assert_eq!((code, image), (0, true), "{text}");
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(stats).expect("statistics")).expect("JSON");
    assert_eq!(json["schema"], "micropoly-stats");
    assert_eq!(json["version"], 1);
    assert_eq!(json["backend"], "cpu");
    assert_eq!(json["patches"], 1);
    assert_eq!(json["options"]["profile"], "conservative");
    assert_eq!(json["options"]["width"], 64);
    for name in ["processed", "drawn", "culled", "depth_limited", "max_stack", "stack_bound"] {
        assert!(json["surfaces"][name].is_u64(), "surfaces.{name}");
    }
    for name in ["load", "setup", "bound", "split", "draw", "resolve", "encode", "total"] {
        assert!(json["seconds"][name].is_f64(), "seconds.{name}");
    }
    for name in ["micropolygons", "bytes_allocated"] {
        assert!(json[name].as_u64().is_some_and(|number| number > 0), "{name}");
    }
    assert!(json["image_hash"].as_str().is_some_and(|hash| hash.starts_with("blake3:")));
    assert!(json["scene"].is_string() && json["device"].is_string());
}

#[test]
fn files_that_are_not_there_or_not_right_are_refused() {
    let empty = tempfile::tempdir().expect("a folder");
    for name in ["scene.toml", "scene.mscene", "patches.bpt", "scene"] {
        assert_refused(render(&empty.path().join(name), &[]), "cannot be read");
    }
    for (text, what) in [
        ("", "missing field `camera`"),
        ("[camera", "scene.toml:1"),
        ("\n\n[camera]\neye = 5", "scene.toml:4"),
        ("[camera]\ncolor = 1", "unknown field `color`"),
    ] {
        let (_folder, scene) = folder(text, FLAT);
        assert_refused(render(&scene, &[]), what);
    }
    for (patches, what) in [
        ("", "patches.bpt:1: the file ends before the number of patches"),
        ("2\n3 3\n0 0 0\n", "the file ends before a coordinate of patch 1 of 2"),
        (
            "1\n1 1\n0 0 0\n0 1 0\n1 0 NaN\n1 1 0\n",
            "patches.bpt:5: a coordinate of patch 1 of 1 is not finite",
        ),
        ("1\n1 1\n0 0 0\n0 1 0\n1 0 inf\n1 1 0\n", "patches.bpt:5"),
        ("1\n9 9\n", "only 1 to 3 can be drawn"),
        ("99999999999999999999\n", "stands where the number of patches should be"),
        ("4000000000\n3 3\n", "the file ends before a coordinate of patch 1"),
        ("1\n1 1\n1e30 0 0\n0 1 0\n1 0 0\n1 1 0\n", "1e12 is the limit"),
    ] {
        let (_folder, scene) = folder(&scene(CAMERA, OBJECT), patches);
        let (code, text, image) = render(&scene, &[]);
        assert!(text.contains("help: "), "{text}");
        assert_refused((code, text, image), what);
    }
    let (folder, scene) = folder(&scene(CAMERA, "geometry = \"other.bpt\""), FLAT);
    assert_refused(render(&scene, &[]), "other.bpt");
    std::fs::write(folder.path().join("scene.toml"), [0xff, 0xfe, 0x00]).expect("written");
    assert_refused(render(&scene, &[]), "not text in UTF-8");
}

#[test]
fn cameras_and_objects_that_cannot_be_are_refused_with_their_line() {
    let camera = |change: (&str, &str)| scene(&CAMERA.replace(change.0, change.1), OBJECT);
    let bumps =
        |fields: &str| scene(CAMERA, &format!("geometry = \"patches.bpt\"\ndisplacement = {{ {fields} }}"));
    for (text, what) in [
        (camera(("near = 0.1", "near = 0")), "scene.toml:5: near is 0"),
        (camera(("near = 0.1", "near = -1")), "near is -1"),
        (camera(("near = 0.1", "near = nan")), "near is NaN"),
        (camera(("fov = 40", "fov = 180")), "scene.toml:4: fov is 180"),
        (camera(("fov = 40", "fov = 0")), "fov is 0"),
        (camera(("eye = [0, -5, 1]", "eye = [0, 0, 0]")), "scene.toml:2: the camera looks nowhere"),
        (camera(("eye = [0, -5, 1]", "eye = [inf, 0, 0]")), "not finite"),
        (scene(CAMERA, ""), "exactly one of geometry, patches, gregory and generate"),
        (scene(CAMERA, "patches = [[[0, 0, 0]]]"), "a patch of 1 points"),
        (scene(CAMERA, "gregory = [[[0, 0, 0]]]"), "has 20 points"),
        (scene(CAMERA, "patches = []"), "the list of patches is empty"),
        (scene(CAMERA, "geometry = \"patches.ply\""), "neither an .obj nor a .bpt file"),
        (scene(CAMERA, "geometry = \"patches.bpt\"\ncolour = \"red\""), "this is not a colour"),
        (scene(CAMERA, "geometry = \"patches.bpt\"\nshininess = 3"), "power of two"),
        (scene(CAMERA, "geometry = \"patches.bpt\"\nscale = nan"), "scale"),
        (bumps("height = -1, frequency = 2"), "scene.toml:10: a displacement with numbers"),
        (bumps("height = 1, frequency = 2, octaves = 9"), "octaves 1 to 8"),
        (bumps("height = 1000, frequency = 1e5"), "steeper"),
        (bumps("height = 1, frequency = 1e5, octaves = 8"), "a smaller frequency or fewer octaves"),
        (bumps("height = 1"), "missing field `frequency`"),
        (
            scene(
                CAMERA,
                "generate = { kind = \"spheres\", count = 1 }\nscale = 1e6\ndisplacement = { height = 1e9, frequency = 1e-9 }",
            ),
            "1e12 is the limit",
        ),
        (scene(CAMERA, "generate = { kind = \"hair\", count = 0 }"), "makes no patches"),
        (scene(CAMERA, "generate = { kind = \"hair\", count = 4000000000 }"), "more than"),
        (
            scene(CAMERA, &format!("{HAIR}\n[[object]]\n{HAIR}")),
            "scene.toml:11: with count = 6000000 the scene has more than",
        ),
        (scene(CAMERA, "geometry = \"patches.bpt\"\ncolour = [nan, 1, 1]"), "this is not a colour"),
        (scene(CAMERA, "geometry = \"patches.bpt\"\ncolour = \"#+f+f+f\""), "this is not a colour"),
        (scene(CAMERA, "generate = { kind = \"moss\", count = 1 }"), "unknown variant"),
        (format!("[camera]\n{CAMERA}\n"), "no [[object]]"),
        (scene(&keys(&[0]), OBJECT), "scene.toml:6: a path needs two [[camera.key]] at least"),
        (scene(&keys(&[0, 9, 9]), OBJECT), "scene.toml:15: a key at frame 9 follows one at frame 9"),
        (scene(&keys(&[5, 2]), OBJECT), "scene.toml:11: a key at frame 2 follows one at frame 5"),
        (
            scene(&keys(&[0, 2]).replace("eye = [0.5, -1.2, 1]", "eye = [0, 0, 0]"), OBJECT),
            "scene.toml:12: the camera looks nowhere",
        ),
        (scene(&format!("{}fov = 180", keys(&[0, 2])), OBJECT), "scene.toml:14: fov is 180"),
        (scene(&format!("{}near = 1", keys(&[0, 2])), OBJECT), "unknown field `near`"),
        (scene(&keys(&[0, 2]).replace("frame = 2", "frame = -2"), OBJECT), "scene.toml:11"),
        (camera(("near = 0.1", "near = 0.1\nshutter = -1")), "scene.toml:6: shutter is -1"),
        (camera(("near = 0.1", "near = 0.1\nfstop = 2")), "scene.toml:6: a lens needs both"),
        (camera(("near = 0.1", "near = 0.1\nfocus = 2")), "scene.toml:6: a lens needs both"),
        (camera(("near = 0.1", "near = 0.1\nfocus = 2\nfstop = 0")), "scene.toml:7: fstop is 0"),
        (camera(("near = 0.1", "near = 0.1\nsensor = inf")), "scene.toml:6: sensor is inf"),
        (scene(CAMERA, &format!("{OBJECT}\nopacity = 0")), "opacity is 0"),
        (scene(CAMERA, &format!("{OBJECT}\nopacity = 1.1")), "opacity is 1.1"),
        (scene(CAMERA, &format!("{OBJECT}\nmotion = {{ rotate = [nan, 0, 0] }}")), "not finite"),
        (scene(CAMERA, &format!("{OBJECT}\nmotion = {{ scale = 2 }}")), "unknown field `scale`"),
    ] {
        let (_folder, scene) = folder(&text, FLAT);
        assert_refused(render(&scene, &[]), what);
    }
}

#[test]
fn options_that_cannot_be_are_refused() {
    let (_folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    for (argument, what) in [
        ("--res=0x0", "1 to 16384"),
        ("--res=100000x1", "1 to 16384"),
        ("--res=12", "1280x720"),
        ("--batch=-1", "--batch"),
        ("--batch=0", "--batch"),
        ("--batch=99999999999", "--batch"),
        ("--bound=0", "pixels"),
        ("--bound=nan", "pixels"),
        ("--profile=other", "weber2014"),
        ("--dice=17", "--dice"),
        ("--dice=-8", "--dice"),
        ("--micropolygon-size=0", "pixels"),
        ("--borders=other", "watertight"),
        ("--max-depth=0", "--max-depth"),
        ("--max-depth=42", "--max-depth"),
        ("--memory=-1", "--memory"),
        ("--memory=1KiB", "use --memory"),
        ("--threads=-1", "--threads"),
        ("--backend=metal", "metal"),
        ("--samples=3", "1, 4, 16 or 64"),
        ("--samples=0", "1, 4, 16 or 64"),
        ("--filter=sinc", "mitchell"),
        ("--filter-radius=0.4", "from 0.5 to 4"),
        ("--filter-radius=nan", "from 0.5 to 4"),
        ("--shading=phong", "smooth"),
        ("--rasteriser=other", "sort-last"),
        ("--tile=5", "4, 8, 16 or 32"),
        ("--shutter=-1", "--shutter"),
        ("--shutter=nan", "--shutter"),
        ("--fstop=0", "--fstop"),
        ("--fstop=2", "give both --fstop and --focus"),
        ("--focus=2", "give both --fstop and --focus"),
        ("--crop=1,2,3", "left,top,right,bottom"),
        ("--crop=5,5,5,9", "left,top,right,bottom"),
        ("--crop=0,0,99999,5", "reaches beyond the image"),
        ("--device=no such device", "no device"),
        ("--device=0", "--device"),
        ("--stats=/nowhere/stats.json", "cannot be written"),
    ] {
        let (code, text, image) = render(&scene, &[argument]);
        assert!(code == 1 || code == 2, "{argument} gave exit code {code}: {text}");
        assert!(text.contains(what) && !text.contains("panicked"), "{argument}: {text}");
        assert!(!image || argument.starts_with("--stats"), "{argument}");
    }
    for (scheduler, stack, what) in [
        ("adaptive", "40", "from 41"),
        ("local", "40", "from 41"),
        ("local", "0", "--stack"),
        ("bounded", "500", "leave out --stack"),
        ("breadth", "500", "leave out --stack"),
    ] {
        let (code, text, _) =
            render(&scene, &[&format!("--scheduler={scheduler}"), &format!("--stack={stack}")]);
        assert!(code == 1 || code == 2, "{scheduler} {stack} gave exit code {code}: {text}");
        assert!(text.contains(what) && !text.contains("panicked"), "{scheduler} {stack}: {text}");
    }
    let output = micropoly(&["render", scene.to_str().expect("UTF-8"), "-o", "/nowhere/out.png"]);
    assert_eq!(output.status.code(), Some(1));
    let output = micropoly(&["render", scene.to_str().expect("UTF-8"), "-o", "out.jpg"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn micropolygons_are_as_long_as_they_should_be_and_fewer_than_fixed_ones() {
    let scenes = ["scenes/teapot.toml", "scenes/hair.toml"];
    let output = micropoly(&[&["bench", "--dicing", "--repeat=1", "--json=-"][..], &scenes].concat());
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8_lossy(&output.stdout);
    let json = text.find("[\n").expect("JSON behind the table");
    let rows: serde_json::Value = serde_json::from_str(&text[json..]).expect("JSON");
    for (row, share) in rows.as_array().expect("rows").iter().zip([0.6, 0.2]) {
        let of_fixed = row["lengths"]["micropolygons"].as_f64().zip(row["fixed"].as_f64());
        assert!(row["in_range"].as_f64().is_some_and(|in_range| in_range >= 0.9), "{row}");
        assert!(of_fixed.is_some_and(|(own, fixed)| own > 0.0 && own <= share * fixed), "{row}");
    }
}

#[test]
fn the_smallest_memory_that_is_named_is_enough() {
    let (_folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    let (_, text, _) = render(&scene, &["--memory=1KiB"]);
    let least = memory_named(&text);
    assert_eq!(render(&scene, &[&format!("--memory={least}")]).0, 0);
    let (code, text, _) = render(&scene, &[&format!("--memory={}", least - 1)]);
    assert!(code == 1 && text.contains("too small"), "{text}");
}

/// The number of bytes that a message says to use.
fn memory_named(text: &str) -> u64 {
    let mut words = text.split_whitespace().skip_while(|word| *word != "--memory");
    words.nth(1).and_then(|bytes| bytes.parse().ok()).unwrap_or_else(|| panic!("no --memory BYTES in {text}"))
}

#[test]
fn breadth_keeps_to_its_budget_or_says_what_the_next_level_needs() {
    let (_folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    let path = scene.with_file_name("out.png");
    assert_eq!(render(&scene, &["--bound=4"]).0, 0);
    let expected = std::fs::read(&path).expect("an image");
    let (mut budget, mut levels) = (1024, 0);
    loop {
        std::fs::remove_file(&path).unwrap_or_default();
        let (code, text, written) =
            render(&scene, &["--scheduler=breadth", "--bound=4", &format!("--memory={budget}")]);
        if code == 0 {
            assert!(std::fs::read(&path).expect("an image") == expected, "another image");
            break;
        }
        assert!(code == 1 && !written, "exit code {code}: {text}");
        assert!(text.contains(&format!("memory budget of {budget} bytes is too small")), "{text}");
        let needed = memory_named(&text);
        assert!(needed > budget && text.contains(&format!("needs at least {needed} bytes")), "{text}");
        levels += usize::from(text.contains("a level of"));
        budget = needed;
    }
    assert!(levels > 1, "only {levels} levels were refused");
}

#[test]
fn schedulers_without_a_batch_say_nothing_of_smaller_batches() {
    let (_folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    for scheduler in ["stack", "breadth", "bounded", "adaptive"] {
        let (code, text, _) = render(&scene, &["--scheduler", scheduler, "--backend=cpu"]);
        assert!(code == 0 && !text.contains("instead of"), "{scheduler}: {text}");
    }
}

#[test]
fn odd_but_possible_input_renders() {
    let point = format!("1\n3 3\n{}", "0 0 0\n".repeat(16));
    let line = "1\n1 1\n0 0 0  0 0 0  1 0 0  1 0 0\n";
    let inside = CAMERA
        .replace("eye = [0, -5, 1]", "eye = [0, 0, 0.001]")
        .replace("target = [0, 0, 0]", "target = [1, 0, 0]");
    for (camera, patches) in [(CAMERA, point.as_str()), (CAMERA, line), (inside.as_str(), FLAT)] {
        let (_folder, scene) = folder(&scene(camera, OBJECT), patches);
        for more in [
            &["--dice=1"][..],
            &["--dice=16", "--bound=0.5"],
            &["--max-depth=1"],
            &["--max-depth=41"],
            &["--batch=1"],
        ] {
            let (code, text, image) = render(&scene, more);
            assert_eq!((code, image), (0, true), "{more:?}: {text}");
        }
        for resolution in ["--res=1x1", "--res=16384x1", "--res=1x3000"] {
            let (code, text, image) = render(&scene, &[resolution]);
            assert_eq!((code, image), (0, true), "{resolution}: {text}");
        }
    }
}

#[test]
fn patch_files_render_without_a_scene_file() {
    let image = tempfile::tempdir().expect("a folder");
    let path = image.path().join("teapot.png");
    let path = path.to_str().expect("UTF-8");
    let output = micropoly(&["render", "scenes/teapot.bpt", "-o", path, "--res", "160x90"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A change to a good scene.
type Change = fn(&mut Sample);

#[test]
fn mscene_files_render_and_bad_ones_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.mscene");
    let good = Sample::good().packed();
    for (bytes, what) in [
        (&[][..], "scene.mscene: the file is empty"),
        (&good[..good.len() / 2], "cut short"),
        (b"[camera]\n", "not a .mscene file"),
        (&[0x00, 0xff].repeat(5000), "unpacks to more than"),
    ] {
        std::fs::write(&path, bytes).expect("written");
        let (code, text, image) = render(&path, &[]);
        assert!(text.contains("help: ") && code == 1, "exit code {code}: {text}");
        assert_refused((code, text, image), what);
    }
    let cases: [(Change, &str); 5] = [
        (|s| s.cameras.clear(), "the scene has no camera"),
        (|s| s.objects[0].mesh = "other", "object 1 of 1 (\"an object\"): there is no mesh \"other\""),
        (|s| s.meshes[0].positions.truncate(45), "mesh 1 of 1 (\"flat\"): its list of positions has 45"),
        (|s| s.meshes[0].positions[0] = 1e30, "1e12 is the limit"),
        (|s| s.cameras[0].transform.1 = [0.0; 4], "its rotation is r = 0"),
    ];
    for (change, what) in cases {
        std::fs::write(&path, Sample::with(change).packed()).expect("written");
        assert_refused(render(&path, &[]), what);
    }
    std::fs::write(&path, good).expect("written");
    assert_eq!(render(&path, &[]).0, 0);
    let output = micropoly(&["info", path.to_str().expect("UTF-8")]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("fov 45°, near 0.125"), "{output:?}");
}

#[test]
fn info_says_what_is_in_a_scene() {
    let output = micropoly(&["info", "scenes/teapot.toml"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success());
    for what in ["32 bicubic", "stack bound", "camera"] {
        assert!(text.contains(what), "{text}");
    }
}

/// Renders without any driver for Vulkan or OpenCL; gives the exit code and what was said.
fn without_drivers(scene: &Path, backend: &str) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_micropoly"))
        .args(["render", scene.to_str().expect("UTF-8"), "--res", "32x32", "--backend", backend, "-o"])
        .arg(scene.with_file_name("out.png"))
        .env("VK_DRIVER_FILES", "/nowhere")
        .env("VK_ICD_FILENAMES", "/nowhere")
        .env("OCL_ICD_VENDORS", "/nowhere")
        .output()
        .expect("runs");
    (output.status.code().expect("no signal"), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_backend_without_a_driver_says_what_is_missing() {
    let (_folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    assert_eq!(without_drivers(&scene, "cpu").0, 0);
    for (backend, package) in [(Backend::Wgpu, "mesa-vulkan-drivers"), (Backend::Ocl, "pocl-opencl-icd")] {
        let (code, text) = without_drivers(&scene, backend.name());
        let what = if backend.is_built() { package } else { "--features" };
        assert!(code == 2 && text.contains("is not available") && text.contains(what), "{code}: {text}");
        assert!(text.contains("--backend cpu"), "{text}");
    }
}

#[test]
fn auto_falls_back_to_the_cpu_and_says_so() {
    let (_folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    let (code, text) = without_drivers(&scene, "auto");
    assert_eq!(code, 0, "{text}");
    let built = Backend::Wgpu.is_built() || Backend::Ocl.is_built();
    assert_eq!(text.contains("no GPU was found, so the CPU renders"), built, "{text}");
}

#[test]
fn bench_prints_the_table_and_writes_it() {
    let (folder, scene) = folder(&scene(CAMERA, OBJECT), FLAT);
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (json, csv, svg) = (path("rows.json"), path("rows.csv"), path("plot.svg"));
    let scene = scene.to_str().expect("UTF-8");
    let schedulers = "--schedulers=stack,breadth,bounded,adaptive";
    let arguments =
        ["bench", scene, schedulers, "--batches=1,64", "--repeat=1", "--res=64x36", "--json", &json];
    let output = micropoly(&[&arguments[..], &["--csv", &csv, "--plot", &svg]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rows: Vec<serde_json::Value> =
        serde_json::from_slice(&std::fs::read(json).expect("rows")).expect("JSON");
    assert_eq!(rows.len(), 6);
    assert!(
        rows.iter().all(|row| row["processed"] == rows[0]["processed"] && row["drawn"] == rows[0]["drawn"])
    );
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 7);
    assert_eq!(std::fs::read_to_string(csv).expect("rows").lines().count(), 7);
    assert!(std::fs::read_to_string(svg).expect("a plot").contains("adaptive"));
}

#[test]
fn bench_along_a_path_has_a_row_a_view_and_names_the_spike() {
    let (folder, scene) = folder(&scene(&keys(&[10, 20]), OBJECT), FLAT);
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (json, svg) = (path("rows.json"), path("plot.svg"));
    let scene = scene.to_str().expect("UTF-8");
    let arguments =
        ["bench", scene, "--path", "--views=3", "--repeat=1", "--res=640x360", "--batches=64,256"];
    let output = micropoly(&[&arguments[..], &["--json", &json, "--plot", &svg]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rows: Vec<serde_json::Value> =
        serde_json::from_slice(&std::fs::read(json).expect("rows")).expect("JSON");
    let frames: Vec<f64> = rows.iter().map(|row| row["frame"].as_f64().expect("a frame")).collect();
    assert_eq!(frames, [[10.0; 7], [15.0; 7], [20.0; 7]].concat());

    let breadth = rows.iter().filter(|row| row["scheduler"] == "breadth");
    let spike = breadth.max_by_key(|row| row["memory"].as_u64()).expect("a row");
    assert_eq!(spike["frame"], 10.0, "the camera moves away");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = text.lines().last().expect("a line");
    assert!(said.starts_with("spike view") && said.contains("frame 10,"), "{text}");
    assert_eq!(text.lines().count(), 1 + 21 + 1, "{text}");
    let plot = std::fs::read_to_string(svg).expect("a plot");
    for name in ["breadth", "bounded 64", "bounded 256", "local 64", "adaptive 256", "frame", "memory, MiB"] {
        assert!(plot.contains(name), "{name} is missing");
    }
}

#[test]
fn bench_at_a_frame_measures_what_the_path_has_there() {
    let (folder, scene) = folder(&scene(&keys(&[10, 20]), OBJECT), FLAT);
    let json = folder.path().join("rows.json").to_str().expect("UTF-8").to_owned();
    let scene = scene.to_str().expect("UTF-8");
    let processed = |view: &[&str]| {
        let common = ["bench", scene, "--schedulers=breadth", "--repeat=1", "--res=640x360", "--json", &json];
        let output = micropoly(&[&common, view].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let rows: Vec<serde_json::Value> =
            serde_json::from_slice(&std::fs::read(&json).expect("rows")).expect("JSON");
        rows.iter().map(|row| row["processed"].as_u64().expect("a number")).collect::<Vec<_>>()
    };
    let path = processed(&["--path", "--views=3"]);
    assert_eq!(processed(&["--frame=15"]), [path[1]]);
    assert_eq!(processed(&["--frame=10"]), [path[0]]);
    assert_ne!(path[0], processed(&[])[0], "the path does not begin where the camera is");
}

#[test]
fn bench_refuses_frames_that_no_path_has() {
    let (_with, with_path) = folder(&scene(&keys(&[10, 20]), OBJECT), FLAT);
    let (_without, without) = folder(&scene(CAMERA, OBJECT), FLAT);
    let bench = |scene: &Path, more: &[&str]| {
        let output = micropoly(&[&["bench", scene.to_str().expect("UTF-8"), "--res=640x360"], more].concat());
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for (scene, more, code, what) in [
        (&without, &["--path"][..], 1, "scene.toml: the camera has no path"),
        (&without, &["--frame=3"], 1, "two [[camera.key]] or more"),
        (&with_path, &["--frame=21"], 1, "choose a frame from 10 to 20"),
        (&with_path, &["--frame=nan"], 1, "no frame NaN"),
        (&with_path, &["--frame=12", "--path"], 2, "cannot be used with"),
        (&with_path, &["--views=12"], 2, "--path"),
        (&with_path, &["--path", "--views=0"], 2, "--views"),
    ] {
        let (found, text) = bench(scene, more);
        assert!(found == Some(code) && text.contains(what), "{more:?} gave {found:?}: {text}");
    }
}

#[test]
fn eval_gives_the_limit_of_a_cage_and_names_samples_that_are_nowhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let (samples, out) = (folder.path().join("samples.json"), folder.path().join("out.json"));
    let eval = |text: &str| {
        std::fs::write(&samples, text).expect("written");
        let [samples, out] = [&samples, &out].map(|path| path.to_str().expect("UTF-8"));
        let output = micropoly(&["eval", "scenes/cages/cube.obj", "--at", samples, "-o", out]);
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    // A corner of the cube, of valence 3: its limit is known (0.5 of its own place), its normal too.
    assert_eq!(eval(r#"{"samples": [[0, -1, 0, 0]]}"#).0, Some(0));
    let report = std::fs::read_to_string(&out).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let sample = report["samples"][0].as_array().expect("a sample");
    for k in 4..7 {
        assert!((sample[k].as_f64().expect("a number").abs() - 0.5).abs() < 1.0e-6, "{sample:?}");
        let normal = sample[k + 3].as_f64().expect("a number").abs();
        assert!((normal - 1.0 / 3.0_f64.sqrt()).abs() < 1.0e-3, "{sample:?}");
    }
    for (text, what) in [
        (r#"{"samples": [[0, -1, 0, 0], [6, -1, 0, 0]]}"#, "1"),
        (r#"[[0, -1, 2, 0]]"#, "0"),
        (r#"{"samples": 3}"#, "samples"),
        ("{", "1"),
    ] {
        let (code, text) = eval(text);
        assert!(code == Some(1) && text.contains(what) && text.contains("help:"), "{text}");
    }
}

#[test]
fn meshes_that_have_no_surface_are_refused_with_their_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mesh.obj");
    let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";
    for (faces, line) in [
        ("f 1 2 3 4\nf 1 2 5\nf 2 1 5\n", ":"),
        ("f 1 2 3 9\n", ":6:"),
        ("f 1 2 3 3\n", ":6:"),
        ("f 1 2 3 4\nf 1 2 x\n", ":7:"),
        ("f 1 2\n", ":6:"),
        ("", ":"),
    ] {
        std::fs::write(&file, format!("{vertices}{faces}")).expect("written");
        let text = render(&file, &[]);
        assert_refused(text.clone(), "help:");
        assert!(text.1.contains(&format!("mesh.obj{line}")), "{faces}: {}", text.1);
    }
}

#[test]
fn what_flatness_does_not_know_is_refused() {
    let (code, text, _) = render(Path::new("scenes/displaced.toml"), &["--oracle", "flatness"]);
    assert!(code == 1 && text.contains("--oracle size"), "{text}");
    let weber = ["--oracle", "flatness", "--profile", "weber2014"];
    let (code, text, _) = render(Path::new("scenes/teapot.toml"), &weber);
    assert!(code == 1 && text.contains("--oracle size"), "{text}");
}

#[test]
fn what_webers_program_does_not_know_is_refused() {
    for (scene, what) in [("scenes/displaced.toml", "displaced"), ("scenes/shapes.rib", "rational")] {
        let (code, text, _) = render(Path::new(scene), &["--profile", "weber2014"]);
        assert!(code == 1 && text.contains(what) && text.contains("help:"), "{text}");
    }
}

#[test]
fn transparency_in_order_renders_what_can_be_sorted() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = folder.path().join("out.png").display().to_string();
    let run = |scene: &str, more: &[&str]| {
        let all = [&["render", scene, "-o", &image, "--backend", "cpu", "--res", "64x36"], more].concat();
        let output = micropoly(&all);
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let order = ["--transparency", "order"];
    let (code, said) = run("scenes/crossing.toml", &order);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("360 triangles in ") && said.contains("a grid of 4x4x4"), "{said}");
    let hash = |said: &str| said.lines().find(|line| line.starts_with("image hash")).map(str::to_owned);
    let wanted = hash(&said);
    assert!(wanted.is_some());
    let (_, said) = run("scenes/crossing.toml", &[&order[..], &["--bsp-grid", "9"]].concat());
    assert!(said.contains("a grid of 9x9x9") && hash(&said) == wanted, "{said}");
    let (code, said) = run("scenes/ball.obj", &order);
    assert!(code == Some(1) && said.contains("--polygons"), "{said}");
    let (code, said) = run("scenes/ball.obj", &[&order[..], &["--polygons"]].concat());
    assert_eq!(code, Some(0), "{said}");
    for bad in [["--bsp-grid", "0"], ["--bsp-grid", "5000"], ["--bsp-tolerance", "-1"]] {
        assert_eq!(run("scenes/crossing.toml", &[&order[..], &bad].concat()).0, Some(2));
    }
}

#[test]
fn sorting_a_mesh_says_what_it_takes() {
    let output = micropoly(&["accel", "sort", "scenes/ball.obj", "--bsp-grid", "3", "--repeat", "1"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success() && said.contains("grid          3x3x3, growth "), "{said}");
    for backend in ["cpu", "all"] {
        let output = micropoly(&["accel", "sort", "scenes/ball.obj", "--repeat", "1", "--backend", backend]);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success() && said.contains("\nCPU ("), "{said}");
        assert!(said.ends_with("\nthe order is the CPU's, bit by bit\n"), "{said}");
    }
}

#[test]
fn devices_that_sort_are_those_that_are_meant() {
    let output = micropoly(&["accel", "sort", "scenes/ball.obj", "--device", "0"]);
    assert_eq!(output.status.code(), Some(2), "a device of no backend");
    for what in ["build", "query", "sort"] {
        let output = micropoly(&["accel", what, "scenes/ball.obj", "--backend", "cpu", "--device", "7"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains("no device is meant by `7`"), "{said}");
    }
}

#[test]
fn trees_take_whatever_triangles_there_are_and_nothing_else() {
    let output = micropoly(&["accel", "sort", "scenes/teapot.bpt"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("these are Bézier patches"));
    let folder = tempfile::tempdir().expect("a folder");
    let pieces = folder.path().join("pieces.obj").display().to_string();
    let output = micropoly(&["accel", "sort", "scenes/ball.obj", "--repeat", "1", "-o", &pieces]);
    assert!(output.status.success());
    let written = std::fs::read_to_string(&pieces).expect("written");
    let faces = |text: &str| text.lines().filter(|line| line.starts_with("f ")).count();
    assert!(faces(&written) >= faces(&std::fs::read_to_string("scenes/ball.obj").expect("there")));
    // Triangles without area count, as do places that nothing could be drawn at.
    let odd = folder.path().join("odd.obj").display().to_string();
    let text = "v 0 0 0\nv 1e30 0 0\nv 0 -3e37 0\nv 0 0 1e-40\nv 0 0 0\nf 1 2 3\nf 1 5 2\nf 1 2 4\n";
    std::fs::write(&odd, text).expect("written");
    for what in ["build", "query", "sort"] {
        let output = micropoly(&["accel", what, &odd, "--repeat", "1"]);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success() && said.starts_with("triangles     3"), "{output:?}");
    }
}

#[test]
fn bench_compares_grids_with_one_naive_tree() {
    let folder = tempfile::tempdir().expect("a folder");
    let json = folder.path().join("table.json").display().to_string();
    let output = micropoly(&["bench", "--bsp", "scenes/ball.obj", "--repeat", "1", "--json", &json]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success() && said.contains("35x35x35") && said.contains("one naive tree"),
        "{said}"
    );
    let table: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).expect("written")).expect("JSON");
    assert_eq!(table[0]["rows"].as_array().map(Vec::len), Some(6));
    assert!(table[0]["rows"][0]["cut"]["growth"].as_f64() > Some(1.0), "{table}");
}
