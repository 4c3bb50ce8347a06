//! What turning cages into patches costs: time and memory, by number of faces and how they are laid out.

use std::time::Instant;

use serde::Serialize;

use crate::cage::generate::{Layout, torus_cage};
use crate::cage::{CageError, Options, convert};

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// How the faces are laid out.
    pub layout: &'static str,
    /// Faces of the cage.
    pub faces: usize,
    /// Patches, Gregory patches among them.
    pub patches: usize,
    /// Gregory patches.
    pub gregory: usize,
    /// Seconds, the shortest of all runs.
    pub seconds: f64,
    /// Nanoseconds a face.
    pub nanoseconds_a_face: f64,
    /// The most memory that the program has had, in MiB, cage and patches among it; where the system tells.
    pub peak: Option<f64>,
}

/// Numbers of faces that are measured.
pub const FACES: [u32; 3] = [10_000, 100_000, 1_000_000];

/// Measures cages of all layouts, the shortest of `repeat` runs each; `progress` is given each row as it is done.
///
/// # Errors
/// None, in truth: the cages are sound.
pub fn measure(
    options: &Options,
    repeat: u32,
    mut progress: impl FnMut(&Row),
) -> Result<Vec<Row>, CageError> {
    let mut rows = Vec::new();
    for layout in Layout::ALL {
        for faces in FACES {
            let row = run(faces, layout, options, repeat)?;
            progress(&row);
            rows.push(row);
        }
    }
    Ok(rows)
}

fn run(faces: u32, layout: Layout, options: &Options, repeat: u32) -> Result<Row, CageError> {
    forget_peak();
    let cage = torus_cage(faces, layout);
    let faces = cage.face_sizes.len();
    let (mut seconds, mut counts) = (f64::INFINITY, (0, 0));
    for _ in 0..repeat.max(1) {
        let start = Instant::now();
        let patches = convert(&cage, options, &|_| {})?;
        seconds = start.elapsed().as_secs_f64().min(seconds);
        counts = (patches.bezier.len() + patches.gregory.len(), patches.gregory.len());
    }
    Ok(Row {
        layout: layout.name(),
        faces,
        patches: counts.0,
        gregory: counts.1,
        seconds,
        nanoseconds_a_face: seconds * 1e9 / faces as f64,
        peak: peak(),
    })
}

/// Lets the system count anew, where it can.
fn forget_peak() {
    // What cannot be written leaves the number of an earlier row, which was a smaller cage mostly.
    drop(std::fs::write("/proc/self/clear_refs", "5"));
}

fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse::<f64>().ok().map(|kib| kib / 1024.0)
}
