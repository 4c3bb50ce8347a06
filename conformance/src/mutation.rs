//! Do the comparisons bite? Kernels with one operator changed, that must make them fail.

/// What is put in the place of what. Most mutants compile wherever the original does.
const SWAPS: [(&str, &str); 36] = [
    ("add(", "sub("),
    ("sub(", "add("),
    ("mul(", "add("),
    ("max(", "min("),
    ("min(", "max("),
    ("imax(", "imin("),
    ("imin(", "imax("),
    ("greater(", "lesser("),
    ("lesser(", "greater("),
    ("fold_max(", "fold_min("),
    ("fold_min(", "fold_max("),
    (" < ", " >= "),
    (" > ", " <= "),
    (" <= ", " > "),
    (" >= ", " < "),
    (" == ", " != "),
    (" != ", " == "),
    (" && ", " || "),
    (" || ", " && "),
    (" + ", " - "),
    (" - ", " + "),
    (" * ", " + "),
    (" / ", " * "),
    (" % ", " / "),
    (" & ", " | "),
    (" | ", " & "),
    (" ^ ", " & "),
    (" << ", " >> "),
    (" >> ", " << "),
    (" += ", " -= "),
    (" *= ", " += "),
    (" /= ", " -= "),
    (" = 0u;", " = 1u;"),
    (" = 0.0;", " = 1.0;"),
    (" = 0.0f;", " = 1.0f;"),
    ("!", " "),
];

/// A kernel file with one operator changed.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// Line, counted from 1, that was changed.
    pub line: usize,
    /// The line before the change, without the blanks around it.
    pub text: String,
    /// What stood there, and what stands there now.
    pub change: (&'static str, &'static str),
    /// The whole file after the change.
    pub source: String,
}

/// All mutants of a file, in order; heads of functions, declarations and comments are left alone.
#[must_use]
pub fn mutants(source: &str) -> Vec<Mutant> {
    let mut found = Vec::new();
    let mut start = 0;
    for (index, line) in source.split_inclusive('\n').enumerate() {
        let code = line.split("//").next().unwrap_or("");
        for (at, change) in places(code) {
            let mut mutated = source.to_owned();
            mutated.replace_range(start + at..start + at + change.0.len(), change.1);
            found.push(Mutant { line: index + 1, text: line.trim().to_owned(), change, source: mutated });
        }
        start += line.len();
    }
    found
}

/// At most `most` of them, spread evenly; the same ones every time.
#[must_use]
pub fn sample<T>(all: Vec<T>, most: usize) -> Vec<T> {
    let count = all.len();
    let chosen = |index: &usize| most >= count || index * most / count != (index + 1) * most / count;
    (0..count).zip(all).filter(|(index, _)| chosen(index)).map(|(_, one)| one).collect()
}

/// Where a line can be changed, and how.
fn places(code: &str) -> Vec<(usize, (&'static str, &'static str))> {
    if is_left_alone(code) {
        return Vec::new();
    }
    let mut found: Vec<_> = SWAPS
        .into_iter()
        .flat_map(|change| code.match_indices(change.0).map(move |(at, _)| (at, change)))
        .filter(|&(at, (from, _))| is_whole(code, at, from))
        .collect();
    found.sort_by_key(|&(at, _)| at);
    found
}

fn is_left_alone(code: &str) -> bool {
    let code = code.trim_start();
    ["fn ", "static ", "struct ", "#", "@", "var<"].iter().any(|start| code.starts_with(start))
}

/// Is what stands there a word or operator of its own, not the end or start of a longer one?
fn is_whole(code: &str, at: usize, text: &str) -> bool {
    let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    match text.chars().next() {
        Some(first) if is_name(first) => !code[..at].ends_with(is_name),
        Some('!') => !code[at + 1..].starts_with('='),
        _ => true,
    }
}
