//! Do the comparisons bite? Kernels with one operator changed must make them fail.

use micropoly_core::backend::Device;
use micropoly_core::stage::Stage;

use crate::corpus::ROUNDS;
use crate::report::check_stage;

/// Pairs of texts of which one is put in the place of the other. Both compile wherever the other does.
const SWAPS: [(&str, &str); 10] = [
    ("add(", "sub("),
    ("sub(", "add("),
    ("mul(", "add("),
    ("max(", "min("),
    ("min(", "max("),
    (" < ", " >= "),
    (" > ", " <= "),
    (" <= ", " > "),
    (" >= ", " < "),
    (" + ", " - "),
];

/// A kernel's source with one operator changed.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// Line, counted from 1, that was changed.
    pub line: usize,
    /// What stood there, and what stands there now.
    pub change: (&'static str, &'static str),
    /// The whole source after the change.
    pub source: String,
}

/// All mutants of a source; definitions of functions, loop heads and comments are left alone.
#[must_use]
pub fn mutants(source: &str) -> Vec<Mutant> {
    let mut found = Vec::new();
    let mut start = 0;
    for (index, line) in source.split_inclusive('\n').enumerate() {
        let code = line.split("//").next().unwrap_or("");
        if !is_left_alone(code) {
            for change in SWAPS {
                if let Some(at) = place(code, change.0) {
                    let mut mutated = source.to_owned();
                    mutated.replace_range(start + at..start + at + change.0.len(), change.1);
                    found.push(Mutant { line: index + 1, change, source: mutated });
                }
            }
        }
        start += line.len();
    }
    found
}

fn is_left_alone(code: &str) -> bool {
    let code = code.trim_start();
    ["fn ", "for", "while", "#", "inline", "static", "float ", "@", "var<", "struct"]
        .iter()
        .any(|start| code.starts_with(start))
}

/// Where a text stands in a line as a whole word.
fn place(code: &str, text: &str) -> Option<usize> {
    code.match_indices(text).map(|(at, _)| at).find(|&at| {
        let before = code[..at].chars().next_back();
        text.starts_with(' ') || !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '.')
    })
}

/// What became of the mutants of one kernel file.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Name of the file.
    pub file: String,
    /// Mutants that were run.
    pub run: usize,
    /// Mutants that a comparison noticed, or that the device or its compiler refused.
    pub killed: usize,
    /// Line and change of those that nothing noticed.
    pub survivors: Vec<(usize, &'static str, &'static str)>,
}

/// Runs up to `most` mutants of a file, spread over it, against the whole corpus of stages.
///
/// `open` opens the device with this source in the place of the file's own; a device that does not open has
/// noticed.
pub fn tally<R: Device, D: Device, E>(
    reference: &mut R,
    file: &str,
    source: &str,
    most: usize,
    mut open: impl FnMut(&str) -> Result<D, E>,
) -> Tally {
    let all = mutants(source);
    let step = all.len().div_ceil(most.max(1)).max(1);
    let mut tally = Tally { file: file.to_owned(), ..Tally::default() };
    for mutant in all.iter().step_by(step) {
        tally.run += 1;
        let noticed = match open(&mutant.source) {
            Err(_) => true,
            Ok(mut device) => Stage::ALL
                .into_iter()
                .any(|stage| !check_stage(reference, &mut device, stage, ROUNDS).agrees()),
        };
        if noticed {
            tally.killed += 1;
        } else {
            tally.survivors.push((mutant.line, mutant.change.0, mutant.change.1));
        }
    }
    tally
}
