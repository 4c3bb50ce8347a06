//! Bézier patch files (`.bpt`): the number of patches, then per patch its degrees along u and v and
//! `(degree_u + 1) × (degree_v + 1)` points, v running fastest. `#` starts a comment.
//!
//! Degrees 1 to 3 are read; lower degrees are raised to 3, which does not change the surface.

use std::path::Path;

use crate::error::{Error, Result, read_text, utf8};
use crate::shape::BezierPatch;

const EXPECTED: &str =
    "a .bpt file is: the number of patches, then for each `3 3` and 16 points of 3 numbers";

/// Reads a patch file.
///
/// # Errors
/// [`Error::Read`], or [`Error::Format`] with the line.
pub fn load(path: &Path) -> Result<Vec<BezierPatch>> {
    parse(path, &read_text(path)?)
}

/// Reads patches from bytes; `path` is for messages only.
///
/// # Errors
/// [`Error::Format`] with the line.
pub fn parse_bytes(path: &Path, bytes: Vec<u8>) -> Result<Vec<BezierPatch>> {
    parse(path, &utf8(path, bytes)?)
}

fn parse(path: &Path, text: &str) -> Result<Vec<BezierPatch>> {
    let mut words = Words::new(path, text);
    let count: usize = words.number("the number of patches")?;
    if count == 0 {
        return Err(words.wrong("the file announces 0 patches"));
    }
    // No more room than the text can fill: the announced number may be anything.
    let mut patches = Vec::with_capacity(count.min(text.len() / 32 + 1));
    for index in 0..count {
        patches.push(read_patch(&mut words, &format!("patch {} of {count}", index + 1))?);
    }
    match words.next() {
        None => Ok(patches),
        Some(word) => Err(words.wrong(&format!("`{}` follows the last of {count} patches", shortened(word)))),
    }
}

fn read_patch(words: &mut Words<'_>, what: &str) -> Result<BezierPatch> {
    let degree_u: usize = words.number(&format!("the u degree of {what}"))?;
    let degree_v: usize = words.number(&format!("the v degree of {what}"))?;
    if !(1..=3).contains(&degree_u) || !(1..=3).contains(&degree_v) {
        let problem = format!("{what} has degrees {degree_u} {degree_v}; only 1 to 3 can be drawn");
        return Err(Error::format(words.path, words.line, problem, "convert the patch to bicubic (3 3)"));
    }
    let mut rows = Vec::with_capacity(4);
    for _ in 0..=degree_u {
        let mut row = Vec::with_capacity(4);
        for _ in 0..=degree_v {
            row.push([words.coordinate(what)?, words.coordinate(what)?, words.coordinate(what)?]);
        }
        rows.push(raised(row));
    }
    let points = raised_rows(&rows);
    Ok(BezierPatch { points })
}

/// A point of a control net while it is converted.
type Point = [f32; 3];

/// Raises a curve to degree 3 (Farin, ch. 5.1). A cubic is left as it is.
fn raised(mut curve: Vec<Point>) -> [Point; 4] {
    while curve.len() < 4 {
        let degree = curve.len();
        let mix = |i: usize, k: usize| {
            let share = i as f64 / degree as f64;
            let before = if i == 0 { 0.0 } else { f64::from(curve[i - 1][k]) };
            let here = if i == degree { 0.0 } else { f64::from(curve[i][k]) };
            (share * before + (1.0 - share) * here) as f32
        };
        curve = (0..=degree).map(|i| [mix(i, 0), mix(i, 1), mix(i, 2)]).collect();
    }
    [curve[0], curve[1], curve[2], curve[3]]
}

fn raised_rows(rows: &[[Point; 4]]) -> [Point; 16] {
    let mut points = [[0.0; 3]; 16];
    for j in 0..4 {
        let column = raised(rows.iter().map(|row| row[j]).collect());
        for (i, point) in column.into_iter().enumerate() {
            points[4 * i + j] = point;
        }
    }
    points
}

/// The beginning of a word that may be of any length.
fn shortened(word: &str) -> String {
    word.chars().take(40).collect()
}

/// The words of a text, with the line each stands in.
struct Words<'a> {
    path: &'a Path,
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    words: std::str::SplitWhitespace<'a>,
    line: usize,
}

impl<'a> Words<'a> {
    fn new(path: &'a Path, text: &'a str) -> Self {
        Self { path, lines: text.lines().enumerate(), words: "".split_whitespace(), line: 1 }
    }

    fn next(&mut self) -> Option<&'a str> {
        loop {
            if let Some(word) = self.words.next() {
                return Some(word);
            }
            let (index, line) = self.lines.next()?;
            self.line = index + 1;
            self.words = line.split('#').next().unwrap_or("").split_whitespace();
        }
    }

    fn wrong(&self, problem: &str) -> Error {
        Error::format(self.path, self.line, problem, EXPECTED)
    }

    fn number<T: std::str::FromStr>(&mut self, what: &str) -> Result<T> {
        let word = self.next().ok_or_else(|| self.wrong(&format!("the file ends before {what}")))?;
        word.parse().map_err(|_| self.wrong(&format!("`{}` stands where {what} should be", shortened(word))))
    }

    fn coordinate(&mut self, what: &str) -> Result<f32> {
        let value: f32 = self.number(&format!("a coordinate of {what}"))?;
        if value.is_finite() {
            return Ok(value);
        }
        let problem = format!("a coordinate of {what} is not finite");
        Err(Error::format(self.path, self.line, problem, "replace NaN, infinities and overlong numbers"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<BezierPatch>> {
        parse(Path::new("x.bpt"), text)
    }

    #[test]
    fn bilinear_patches_become_the_same_bicubic_surface() {
        let patch = read("1\n1 1\n0 0 0  0 3 0\n3 0 0  3 3 6").expect("readable")[0];
        for i in 0..4 {
            for j in 0..4 {
                let [x, y, z] = patch.points[4 * i + j];
                assert_eq!((x, y), (i as f32, j as f32));
                assert!((z - 6.0 * (i as f32 / 3.0) * (j as f32 / 3.0)).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn errors_name_the_line() {
        for (text, line) in [
            ("", 1),
            ("0", 1),
            ("-1", 1),
            ("one", 1),
            ("1\n\n3", 3),
            ("1\n3 4\n", 2),
            ("1\n3 3\n0 0 0\n0 0", 4),
            ("1\n1 1\n0 0 0 0 1 0\n1 0 nan 1 1 0", 4),
            ("1\n1 1\n0 0 0 0 1 0\n1 0 1e99 1 1 0", 4),
            ("1\n1 1\n0 0 0 0 1 0\n1 0 0 1 1 0\n7", 5),
            ("18446744073709551615\n1 1", 2),
        ] {
            match read(text) {
                Err(Error::Format { line: found, .. }) => assert_eq!(found, line, "{text:?}"),
                other => panic!("{text:?} gave {other:?}"),
            }
        }
    }

    #[test]
    fn comments_and_any_line_ending_are_read() {
        let unix = read("1 # one\n1 1 # flat\n0 0 0 0 1 0\n1 0 0 1 1 0\n").expect("readable");
        let dos = read("1\r\n1 1\r\n0 0 0 0 1 0\r\n1 0 0 1 1 0").expect("readable");
        assert_eq!(unix, dos);
    }
}
