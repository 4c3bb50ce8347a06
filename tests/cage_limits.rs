//! Patches of cages lie on the limit surface, or near enough.

mod cages;

use cages::*;
use glam::DVec3;
use micropoly::cage::{Cage, Options, Patches, convert};

fn patches(cage: &Cage, levels: u32) -> Patches {
    convert(cage, &Options { levels }, &|_| {}).expect("a surface")
}

/// Samples of a reference file, and the diagonal it names.
fn reference(path: &std::path::Path) -> (Vec<Sample>, f64, String) {
    let text = std::fs::read_to_string(path).expect("a text");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let sample = |row: &serde_json::Value| {
        let x = |k: usize| row[k].as_f64().expect("a number");
        Sample {
            face: x(0) as u32,
            sub: x(1) as i32,
            place: [x(2), x(3)],
            position: DVec3::new(x(4), x(5), x(6)),
            normal: DVec3::new(x(7), x(8), x(9)),
            is_smooth: x(10) == 1.0,
        }
    };
    let samples = json["samples"].as_array().expect("samples").iter().map(sample).collect();
    let text = |name: &str| json[name].as_str().expect("a name").to_owned();
    (samples, json["bbox_diag"].as_f64().expect("a number"), text("boundary"))
}

#[test]
fn published_limit_points_are_met() {
    for (mesh, name) in [
        ("cube", "cube"),
        ("cube_crease_inf", "cube_crease_inf"),
        ("cube_crease_semi", "cube_crease_semi"),
        ("grid", "grid"),
        ("grid", "grid_edgeonly"),
    ] {
        let test = "published_limit_points_are_met";
        let Some(cage) = shared(test, &format!("catmull-clark/{mesh}.obj")) else { continue };
        let Some(path) = shared(test, &format!("catmull-clark/ref_{name}.json")) else { continue };
        let (samples, diagonal, rule) = reference(&path);
        let cage = Cage { boundary: boundary(&rule), ..read_obj(&cage) };
        for levels in 0..6 {
            let errors = compare(&patches(&cage, levels), &samples, diagonal);
            println!("{name} {levels} {errors:?}");
            let (offset, angle) = [(5e-5, 1.5), (5e-5, 1.5), (1e-5, 1.5)][levels.saturating_sub(3) as usize];
            if levels >= 3 {
                assert!(errors.offset <= offset && errors.angle <= angle && errors.regular < 1e-6, "{name} {errors:?}");
            }
        }
    }
}

#[test]
fn survey() {
    let with = |cage: Cage, change: &dyn Fn(&mut Cage)| {
        let mut cage = cage;
        change(&mut cage);
        cage
    };
    let mut list: Vec<(String, Cage)> = vec![
        ("cube".into(), cube()),
        ("tetrahedron".into(), tetrahedron()),
        ("grid".into(), bumpy_grid(5, 4)),
    ];
    for n in 3..=12 {
        list.push((format!("drum {n}"), drum(n)));
        list.push((format!("star {n}"), star(n)));
    }
    list.push(("dart".into(), with(cube(), &|c| c.creases.push(crease(0, 1, 10.0)))));
    list.push(("dart grid".into(), with(bumpy_grid(6, 6), &|c| c.creases = vec![crease(16, 23, 10.0), crease(23, 30, 10.0)])));
    list.push(("dart drum".into(), with(drum(5), &|c| c.creases.push(crease(11, 5, 10.0)))));
    list.push(("corner3".into(), with(cube(), &|c| c.creases = vec![crease(0, 1, 10.0), crease(0, 2, 10.0), crease(0, 4, 10.0)])));
    list.push(("corner4 drum".into(), with(drum(8), &|c| c.creases = vec![crease(17, 8, 10.0), crease(17, 10, 10.0), crease(17, 12, 10.0)])));
    list.push(("cone".into(), with(cube(), &|c| c.sharp_vertices = vec![(0, 10.0)])));
    list.push(("boundary corner".into(), with(bumpy_grid(4, 4), &|c| c.sharp_vertices = vec![(2, 10.0)])));
    list.push(("semi".into(), with(cube(), &|c| c.creases = vec![crease(0, 1, 1.5), crease(1, 3, 2.3), crease(3, 2, 0.4), crease(1, 5, 3.7)])));
    list.push(("semi all".into(), with(drum(5), &|c| c.creases = (0..5).map(|k| crease(k, 5 + k, 0.3 + 0.7 * k as f32)).collect())));
    for (name, cage) in list {
        for levels in [3, 5] {
            let patches = patches(&cage, levels);
            let samples = oracle::samples(&cage, std::env::var("ORACLE").map_or(6, |n| n.parse().expect("n")));
            let e = compare(&patches, &samples, bbox_diagonal(&cage));
            println!("{name:16} {levels} offset {:.1e} angle {:6.3} regular {:.1e} distance {:.1e}  {} + {}", e.offset, e.angle, e.regular, e.distance, patches.bezier.len(), patches.gregory.len());
        }
    }
}
