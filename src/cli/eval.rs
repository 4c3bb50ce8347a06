//! `micropoly eval`: where the surface of a cage is, and how it faces, at places that a file lists.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum, value_parser};
use micropoly::cage::{Boundary, Cage, Evaluator, MOST_LEVELS, Options, convert};
use micropoly::{Error, Result};
use serde_json::{Value, json};

use super::render::write_json;

#[derive(Debug, Args)]
pub(crate) struct EvalArguments {
    /// Mesh file (.obj).
    mesh: PathBuf,
    /// JSON file with the places: `samples`, or a bare array, of [face, sub-face, u, v, …]. Faces are counted from 0; the
    /// sub-face is -1 in quads, elsewhere the corner it is at.
    #[arg(long, value_name = "FILE")]
    at: PathBuf,
    /// JSON file to write; - writes to standard output.
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Levels of refinement around what is not regular.
    #[arg(long, value_name = "N", default_value_t = Options::default().levels,
          value_parser = value_parser!(u32).range(0..=i64::from(MOST_LEVELS)))]
    cc_levels: u32,
    /// How the surface ends. [default: as the samples' file says, else as the mesh says, else edge_and_corner]
    #[arg(long, value_enum)]
    boundary: Option<BoundaryChoice>,
}

/// OpenSubdiv's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub(crate) enum BoundaryChoice {
    /// Faces with a vertex on the boundary are not drawn.
    None,
    /// In a smooth curve.
    EdgeOnly,
    /// In a smooth curve, with corners at vertices that have one face only.
    EdgeAndCorner,
}

impl From<BoundaryChoice> for Boundary {
    fn from(choice: BoundaryChoice) -> Self {
        match choice {
            BoundaryChoice::None => Self::None,
            BoundaryChoice::EdgeOnly => Self::EdgeOnly,
            BoundaryChoice::EdgeAndCorner => Self::EdgeAndCorner,
        }
    }
}

const fn name(boundary: Boundary) -> &'static str {
    match boundary {
        Boundary::None => "none",
        Boundary::EdgeOnly => "edge_only",
        Boundary::EdgeAndCorner => "edge_and_corner",
    }
}

pub(crate) fn run(arguments: &EvalArguments) -> Result<()> {
    let samples = Samples::read(&arguments.at)?;
    let mut cage = cage_of(&arguments.mesh)?;
    if let Some(boundary) = arguments.boundary.map(Boundary::from).or(samples.boundary) {
        cage.boundary = boundary;
    }
    let levels = arguments.cc_levels;
    let patches = convert(&cage, &Options { levels }, &|_| {})
        .map_err(|error| error.in_file(&arguments.mesh, &cage))?;
    let found = samples.evaluate(&cage, &Evaluator::new(&patches))?;
    let mesh = arguments.mesh.file_name().map(|name| name.to_string_lossy().into_owned());
    let report = json!({
        "source": format!("micropoly {}, {levels} levels", env!("CARGO_PKG_VERSION")),
        "mesh": mesh,
        "boundary": name(cage.boundary),
        "bbox_diag": diagonal(&cage),
        "faces": cage.face_sizes.len(),
        "fields": ["face", "sub", "u", "v", "px", "py", "pz", "nx", "ny", "nz", "smooth"],
        "samples": found,
    });
    write_json(&arguments.output, &report)
}

/// The cage in a mesh file.
fn cage_of(path: &Path) -> Result<Cage> {
    let file = micropoly::obj::load(path)?;
    for warning in &file.warnings {
        eprintln!("note: {warning}");
    }
    file.cage.ok_or_else(|| {
        Error::scene(
            format!("{}: there is no face in it", path.display()),
            "choose a file with a polygon mesh",
        )
    })
}

fn diagonal(cage: &Cage) -> f64 {
    let extent = |axis: usize| {
        let along = || cage.positions.iter().map(|point| point[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    if cage.positions.is_empty() {
        0.0
    } else {
        [0, 1, 2].map(|axis| extent(axis) * extent(axis)).iter().sum::<f64>().sqrt()
    }
}

/// Places to evaluate, and the file they are from.
struct Samples<'a> {
    path: &'a Path,
    rows: Vec<Value>,
    boundary: Option<Boundary>,
}

/// One of them.
struct Place {
    face: u32,
    sub: i32,
    u: f64,
    v: f64,
}

impl<'a> Samples<'a> {
    fn read(path: &'a Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let mut value: Value = serde_json::from_slice(&text).map_err(|error| Error::Format {
            path: path.to_owned(),
            line: error.line(),
            problem: format!("this is not JSON: {error}"),
            remedy: "is this the right file?".to_owned(),
        })?;
        let boundary = value.get("boundary").and_then(Value::as_str);
        let boundary =
            boundary.and_then(|name| BoundaryChoice::from_str(name, false).ok()).map(Boundary::from);
        let rows = if value.is_array() {
            value.take()
        } else {
            value.get_mut("samples").map(Value::take).unwrap_or_default()
        };
        match rows {
            Value::Array(rows) => Ok(Self { path, rows, boundary }),
            _ => Err(wrong(path, "it lists no samples".to_owned())),
        }
    }

    /// Rows as they are written.
    fn evaluate(&self, cage: &Cage, evaluator: &Evaluator<'_>) -> Result<Vec<Value>> {
        let at = |(index, row): (usize, &Value)| {
            let failed = |why: String| wrong(self.path, format!("sample {index} (counted from 0): {why}"));
            let place = place(row, cage).map_err(failed)?;
            let Place { face, sub, u, v } = place;
            let found = evaluator
                .at(face, sub, u, v)
                .ok_or_else(|| failed(format!("nothing is drawn of face {face}: it is a hole")))?;
            let ([x, y, z], [nx, ny, nz]) = (found.position.to_array(), found.normal.to_array());
            Ok(json!([face, sub, u, v, x, y, z, nx, ny, nz, u8::from(found.is_smooth)]))
        };
        self.rows.iter().enumerate().map(at).collect()
    }
}

/// A place, or what is wrong with it.
fn place(row: &Value, cage: &Cage) -> std::result::Result<Place, String> {
    let number = |k: usize| row.get(k).and_then(Value::as_f64);
    let [Some(face), Some(sub), Some(u), Some(v)] = [0, 1, 2, 3].map(number) else {
        return Err("it is not a list that begins with four numbers".to_owned());
    };
    let faces = cage.face_sizes.len();
    if !(face >= 0.0 && face < faces as f64 && face.fract() == 0.0) {
        return Err(format!("there is no face {face}: there are {faces}, counted from 0"));
    }
    let size = cage.face_sizes[face as usize];
    let is_there =
        if size == 4 { sub == -1.0 } else { sub >= 0.0 && sub < f64::from(size) && sub.fract() == 0.0 };
    if !is_there {
        let known = if size == 4 { "-1".to_owned() } else { format!("0 to {}", size - 1) };
        return Err(format!("face {face} has no sub-face {sub}, with {size} corners it has {known}"));
    }
    if !((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)) {
        return Err(format!("u and v are {u} and {v}; they run from 0 to 1"));
    }
    Ok(Place { face: face as u32, sub: sub as i32, u, v })
}

fn wrong(path: &Path, problem: String) -> Error {
    let remedy =
        "give [face, sub-face, u, v] for each sample: `micropoly eval --help` explains them".to_owned();
    Error::Content { path: path.to_owned(), problem, remedy }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cage() -> Cage {
        Cage {
            positions: vec![
                [0.0, 0.0, 0.0],
                [3.0, 0.0, 0.0],
                [3.0, 4.0, 0.0],
                [0.0, 4.0, 0.0],
                [5.0, 2.0, 0.0],
            ],
            face_sizes: vec![4, 3],
            corners: vec![0, 1, 2, 3, 1, 4, 2],
            ..Cage::default()
        }
    }

    #[test]
    fn samples_that_are_nowhere_are_refused() {
        for row in [
            json!([0, -1, 0.5]),
            json!("0 -1 0.5 0.5"),
            json!([2, -1, 0.5, 0.5]),
            json!([-1, -1, 0.5, 0.5]),
            json!([0.5, -1, 0.5, 0.5]),
            json!([0, 0, 0.5, 0.5]),
            json!([1, -1, 0.5, 0.5]),
            json!([1, 3, 0.5, 0.5]),
            json!([0, -1, 1.5, 0.5]),
            json!([0, -1, 0.5, -0.1]),
        ] {
            assert!(place(&row, &cage()).is_err(), "{row}");
        }
    }

    #[test]
    fn errors_name_the_sample_and_good_ones_have_eleven_columns() {
        let cage = cage();
        let patches = convert(&cage, &Options::default(), &|_| {}).expect("a surface");
        let rows = vec![json!([0, -1, 0, 0, "more"]), json!([1, 2, 0.25, 1])];
        let mut samples = Samples { path: "x.json".as_ref(), rows, boundary: None };
        let found = samples.evaluate(&cage, &Evaluator::new(&patches)).expect("places");
        assert!(found.iter().all(|row| row.as_array().is_some_and(|row| row.len() == 11)));
        assert_eq!(found[0][4], 0.0);
        samples.rows.push(json!([7, -1, 0, 0]));
        let error = samples.evaluate(&cage, &Evaluator::new(&patches)).expect_err("no such face").to_string();
        assert!(error.contains("sample 2") && error.contains("face 7"), "{error}");
    }
}
