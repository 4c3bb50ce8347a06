//! Meshes by levels and patterns, as a user of the program meets them.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use micropoly::Backend;
use tempfile::TempDir;

/// A tetrahedron with texture coordinates.
const TETRAHEDRON: &str = "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nvt 0 0\nvt 1 0\nvt 0 1\n\
                           f 1/1 2/2 3/3\nf 1/1 4/2 2/3\nf 1/1 3/2 4/3\nf 2/1 4/2 3/3\n";

fn folder(mesh: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mesh.obj"), mesh).expect("written");
    folder
}

/// A grey picture, as a PNG file.
fn bumps() -> Vec<u8> {
    let mut png = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut png);
    let grey: Vec<u8> = (0..64).map(|k| (k * 37 % 256) as u8).collect();
    image::ImageEncoder::write_image(encoder, &grey, 8, 8, image::ExtendedColorType::L8).expect("encodes");
    png
}

/// Runs the program in a folder, with this on its standard input.
fn micropoly(folder: &Path, arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_micropoly"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("written");
    child.wait_with_output().expect("the program ends")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Tessellates the folder's mesh; what the program says.
fn tessellated(folder: &TempDir, arguments: &[&str]) -> String {
    let all = [&["tessellate", "mesh.obj", "--backend", "cpu"], arguments].concat();
    let output = micropoly(folder.path(), &all, "");
    let said = text(&output.stderr);
    assert!(output.status.success(), "{all:?}: {said}");
    said
}

/// What is said after a word at the start of a line.
fn told(said: &str, word: &str) -> String {
    let line = said.lines().find_map(|line| line.strip_prefix(word));
    line.unwrap_or_else(|| panic!("no `{word}` in: {said}")).trim().to_owned()
}

#[test]
fn levels_make_meshes_in_every_format_and_they_stay_closed() {
    let folder = folder(TETRAHEDRON);
    for (level, spacing, triangles) in [
        ("1", "equal", 4),
        ("4", "equal", 4 * 24),
        ("3.5", "fractional-even", 4 * 24),
        ("2.5", "fractional-odd", 4 * 13),
    ] {
        for output in ["out.obj", "out.ply", "out.glb", "none"] {
            let said = tessellated(
                &folder,
                &["--levels", level, "--spacing", spacing, "--evaluation", "pn", "--check", "-o", output],
            );
            assert_eq!(told(&said, "triangles"), triangles.to_string(), "{level} {spacing} {output}");
            assert_eq!(told(&said, "open edges"), "0", "{level} {spacing} {output}");
            assert!(output == "none" || folder.path().join(output).exists());
        }
    }
    assert!(!folder.path().join("none").exists());
}

#[test]
fn levels_of_detail_are_finer_near_the_eye() {
    let folder = folder(TETRAHEDRON);
    let count = |eye: &str| {
        let said =
            tessellated(&folder, &["--lod", "8", "--eye", eye, "--res", "640x480", "--check", "-o", "none"]);
        assert_eq!(told(&said, "open edges"), "0");
        told(&said, "triangles").parse::<u32>().expect("a number")
    };
    assert!(count("0,0,4") > 4 * count("-4,0,16"));
    let said = tessellated(&folder, &["--distance", "20", "-o", "none"]);
    assert!(told(&said, "triangles").parse::<u32>().expect("a number") > 4);
}

#[test]
fn height_maps_move_points_and_what_was_made_can_be_rendered() {
    let folder = folder(TETRAHEDRON);
    std::fs::write(folder.path().join("bumps.png"), bumps()).expect("written");
    let bumps = ["--heightmap", "bumps.png", "--scale", "0.2"];
    let said = tessellated(&folder, &[&["--levels", "16", "--check", "-o", "out.obj"], &bumps[..]].concat());
    assert_eq!(told(&said, "open edges"), "0");
    let mesh = std::fs::read_to_string(folder.path().join("out.obj")).expect("written");
    assert!(!mesh.contains("vn 0 0 0"), "normals are those of the bumps");
    let output = micropoly(
        folder.path(),
        &["render", "out.obj", "--polygons", "--backend", "cpu", "--res", "64x36", "-o", "out.png"],
        "",
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn what_cannot_be_done_by_levels_is_refused() {
    let folder = folder(TETRAHEDRON);
    std::fs::write(folder.path().join("bad.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n")
        .expect("written");
    std::fs::write(folder.path().join("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    std::fs::write(folder.path().join("scene.toml"), "").expect("written");
    std::fs::write(folder.path().join("text.png"), "no picture").expect("written");
    std::fs::write(folder.path().join("bumps.png"), bumps()).expect("written");
    let cases: [(&[&str], i32, &str); 15] = [
        (&["mesh.obj", "--levels", "0"], 1, "every patch is dropped"),
        (&["mesh.obj", "--levels", "nan"], 1, "every patch is dropped"),
        (&["mesh.obj", "--levels", "-3"], 1, "every patch is dropped"),
        (&["bad.obj", "--levels", "2"], 1, "bad.obj:5"),
        (&["missing.obj", "--levels", "2"], 1, "missing.obj"),
        (&["scene.toml", "--levels", "2"], 1, "scene.toml"),
        (&["mesh.obj", "--levels", "2", "--heightmap", "missing.png"], 1, "missing.png"),
        (&["mesh.obj", "--levels", "2", "--heightmap", "text.png"], 1, "text.png"),
        (&["plain.obj", "--levels", "2", "--heightmap", "bumps.png"], 1, "texture coordinates"),
        (&["mesh.obj", "--levels", "2", "--eye", "0,0,1"], 2, "--lod"),
        (&["mesh.obj", "--levels", "2", "--memory", "1000"], 1, "--memory"),
        (&["mesh.obj", "--levels", "2", "--dice", "4"], 2, "--dice"),
        (&["mesh.obj", "--levels", "2", "--lod", "4"], 2, "--lod"),
        (&["mesh.obj", "--levels", "two"], 2, "two"),
        (&["mesh.obj"], 1, "none"),
    ];
    for (arguments, code, what) in cases {
        let all = [&["tessellate", "-o", "none", "--backend", "cpu"], arguments].concat();
        let output = micropoly(folder.path(), &all, "");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(what) && !said.contains("panicked"), "`{what}` is missing in: {said}");
    }
    // What is too large is clamped, as the specifications have it.
    for level in ["inf", "1e6", "64"] {
        let said = tessellated(&folder, &["--levels", level, "-o", "none"]);
        assert_eq!(told(&said, "triangles"), (4 * 6144).to_string());
    }
}

const QUESTIONS: &str = r#"{"domain":"quads","spacing":"fractional_odd","inner":[3,4.5],"outer":[1,2,3,4]}
{"domain":"triangles","spacing":"equal","inner":[1],"outer":[1,1,1]}

{"domain":"isolines","spacing":"fractional_even","inner":[],"outer":[2,3.5]}
{"domain":"triangles","spacing":"equal","inner":["nan"],"outer":["inf",2,1]}
{"domain":"triangles","spacing":"equal","inner":[5],"outer":[4,"nan",4]}
"#;

#[test]
fn patterns_are_the_same_on_every_backend() {
    let folder = folder(TETRAHEDRON);
    for profile in ["d3d11", "stadlbauer"] {
        let mut wanted: Option<String> = None;
        for backend in Backend::ALL.into_iter().filter(|backend| backend.is_built()) {
            let arguments = ["tess-pattern", "--profile", profile, "--backend", backend.name()];
            let output = micropoly(folder.path(), &arguments, QUESTIONS);
            let said = text(&output.stderr);
            if output.status.code() == Some(2) && std::env::var_os("CI").is_none() {
                println!("skipped: patterns on {}: {said}", backend.name());
                continue;
            }
            assert!(output.status.success(), "{said}");
            let found = text(&output.stdout);
            assert_eq!(found.lines().count(), 5, "{found}");
            assert_eq!(wanted.get_or_insert_with(|| found.clone()), &found, "{}", backend.name());
        }
        let wanted = wanted.expect("a backend");
        let triangle = r#""outer":[1.0,1.0,1.0],"verts":[[0,65536,0],[0,0,65536],[65536,0,0]],"prims":[0,1,2],"points":3}"#;
        assert!(wanted.contains(triangle), "{wanted}");
        let dropped = r#""outer":[4.0,"nan",4.0],"verts":[],"prims":[],"points":0}"#;
        assert!(wanted.contains(dropped), "{wanted}");
    }
}

#[test]
fn questions_that_are_none_are_refused_with_their_line() {
    let folder = folder(TETRAHEDRON);
    let good = QUESTIONS.lines().next().expect("a line");
    for (bad, what) in [
        ("{", "EOF"),
        (r#"{"domain":"circles","spacing":"equal","inner":[],"outer":[1]}"#, "circles"),
        (r#"{"domain":"quads","spacing":"equal","inner":[1],"outer":[1,1,1,1]}"#, "inner levels"),
        (r#"{"domain":"isolines","spacing":"equal","inner":[],"outer":[1,"many"]}"#, "many"),
        (r#"{"domain":"isolines","spacing":"equal","outer":[1,1],"winding":"cw"}"#, "winding"),
    ] {
        let output = micropoly(folder.path(), &["tess-pattern"], &format!("{good}\n{bad}\n"));
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("standard input:2:") && said.contains(what), "`{what}` is missing in: {said}");
    }
}
