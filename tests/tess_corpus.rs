//! What a fixed-function tessellator generates, case by case: `../shared/data/tessellation`, where it is there.

use std::path::{Path, PathBuf};

use micropoly::tess::pattern::{Profile, answers, questions};
use micropoly_backend_cpu::CpuDevice;
use serde_json::{Value, json};

const FOLDER: &str = "../shared/data/tessellation";

fn folder(test: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(FOLDER);
    if !folder.is_dir() {
        println!("skipped: {test}, as there is no {FOLDER}");
        return None;
    }
    Some(folder)
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("JSON")
}

/// What the tessellator says of these, as JSON.
fn told(asked: &[Value]) -> Vec<Value> {
    let lines: Vec<String> = asked.iter().map(Value::to_string).collect();
    let asked = questions(&lines.join("\n"), Path::new("asked")).expect("questions");
    let mut device = CpuDevice::new(0).expect("threads");
    let told = answers(&mut device, &asked, Profile::D3d11).expect("answers");
    told.iter().map(|answer| serde_json::to_value(answer).expect("JSON")).collect()
}

#[test]
fn every_case_is_equal_bit_for_bit() {
    let Some(folder) = folder("every_case_is_equal_bit_for_bit") else { return };
    let mut cases = 0;
    for domain in ["triangles", "quads", "isolines"] {
        for spacing in ["equal", "fractional_even", "fractional_odd"] {
            let file = read(&folder.join(format!("{domain}_{spacing}.json")));
            let wanted = file["cases"].as_array().expect("cases");
            let question = |case: &Value| json!({"domain": domain, "spacing": spacing, "inner": case["inner"], "outer": case["outer"]});
            let found = told(&wanted.iter().map(question).collect::<Vec<_>>());
            assert_eq!(found.len(), wanted.len());
            for (found, wanted) in found.iter().zip(wanted) {
                for key in ["verts", "prims", "points"] {
                    assert_eq!(found[key], wanted[key], "{key} of {domain} {spacing} {wanted}");
                }
                cases += 1;
            }
        }
    }
    println!("{cases} cases are equal");
    assert!(cases > 0);
}

#[test]
fn an_edge_is_divided_alike_at_every_level() {
    let Some(folder) = folder("an_edge_is_divided_alike_at_every_level") else { return };
    let sweep = read(&folder.join("edge_sweep.json"));
    for spacing in ["equal", "fractional_even", "fractional_odd"] {
        let wanted = sweep["spacing"][spacing].as_array().expect("levels");
        let question = |case: &Value| json!({"domain": "quads", "spacing": spacing, "inner": [2, 2], "outer": [case["f"], 1, 1, 1]});
        for (found, wanted) in told(&wanted.iter().map(question).collect::<Vec<_>>()).iter().zip(wanted) {
            // Points that coincide are all there.
            let verts = found["verts"].as_array().expect("vertices");
            let points: Vec<usize> = match &found["points"] {
                Value::Array(list) => list.iter().map(|k| k.as_u64().expect("an index") as usize).collect(),
                _ => (0..verts.len()).collect(),
            };
            let on_edge = points.iter().map(|&k| &verts[k]).filter(|v| v[0] == 0);
            let mut edge: Vec<u64> = on_edge.map(|v| v[1].as_u64().expect("an integer")).collect();
            edge.sort_unstable();
            assert_eq!(json!(edge), wanted["v"], "{spacing} {}", wanted["f"]);
        }
    }
}
