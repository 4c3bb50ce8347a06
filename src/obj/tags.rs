//! Tags, as OpenSubdiv's shapes have them: `t NAME I/N/S`, then I integers, N numbers and S strings.
//!
//! Vertices and faces are counted from 0 in them. They may stand before what they name, so that is checked last.

use super::notes::Notes;
use super::words::{Words, shown, text};
use crate::cage::{Boundary, Cage, Crease};
use crate::error::{Error, Result};

/// The tags that have been read; those that name something have their lines.
#[derive(Default)]
pub(super) struct Tags {
    creases: Vec<(usize, Crease)>,
    corners: Vec<(usize, (u32, f32))>,
    holes: Vec<(usize, u32)>,
    boundary: Boundary,
}

/// What stands behind the name of a tag.
struct Arguments {
    integers: Vec<u32>,
    numbers: Vec<f32>,
}

impl Tags {
    pub(super) fn read(&mut self, words: &mut Words<'_>, notes: &mut Notes) -> Result<()> {
        match words.next() {
            Some(b"crease") => self.read_crease(words),
            Some(b"corner") => self.read_corner(words),
            Some(b"hole") => self.read_hole(words),
            Some(b"interpolateboundary") => self.read_boundary(words),
            Some(name) => notes.pass_over_tag(name, words),
            None => {
                Err(words.wrong_statement("a tag without a name", "write `t crease 2/1/0 A B SHARPNESS`"))
            }
        }
    }

    /// `t crease 2/1/0 A B SHARPNESS`, or any number of edges with one sharpness or with one each.
    fn read_crease(&mut self, words: &mut Words<'_>) -> Result<()> {
        const FORM: &str = "write `t crease 2/1/0 A B SHARPNESS`; more edges have one sharpness or one each";
        let Arguments { integers, numbers } = arguments(words, FORM)?;
        let (edges, odd) = integers.as_chunks::<2>();
        if !odd.is_empty() || !fits(edges.len(), numbers.len()) {
            return Err(mismatch(words, "crease", "edges", integers.len() / 2, numbers.len(), FORM));
        }
        for (edge, &[a, b]) in edges.iter().enumerate() {
            if a == b {
                let problem = format!("a crease from vertex {a} to itself");
                return Err(words.wrong_statement(problem, "name the two ends of an edge, counted from 0"));
            }
            let sharpness = numbers[edge % numbers.len()];
            self.creases.push((words.start(), Crease { vertices: [a, b], sharpness }));
        }
        Ok(())
    }

    /// `t corner 1/1/0 V SHARPNESS`, or any number of vertices with one sharpness or with one each.
    fn read_corner(&mut self, words: &mut Words<'_>) -> Result<()> {
        const FORM: &str = "write `t corner 1/1/0 V SHARPNESS`; more vertices have one sharpness or one each";
        let Arguments { integers, numbers } = arguments(words, FORM)?;
        if !fits(integers.len(), numbers.len()) {
            return Err(mismatch(words, "corner", "vertices", integers.len(), numbers.len(), FORM));
        }
        let sharp = integers.iter().enumerate().map(|(at, &vertex)| (vertex, numbers[at % numbers.len()]));
        self.corners.extend(sharp.map(|corner| (words.start(), corner)));
        Ok(())
    }

    fn read_hole(&mut self, words: &mut Words<'_>) -> Result<()> {
        const FORM: &str = "write `t hole 1/0/0 FACE`, with any number of faces";
        let Arguments { integers, numbers } = arguments(words, FORM)?;
        if integers.is_empty() || !numbers.is_empty() {
            return Err(mismatch(words, "hole", "faces", integers.len(), numbers.len(), FORM));
        }
        self.holes.extend(integers.into_iter().map(|face| (words.start(), face)));
        Ok(())
    }

    /// `t interpolateboundary 1/0/0 RULE`; the numbering is RenderMan's, which OpenSubdiv's shapes keep.
    fn read_boundary(&mut self, words: &mut Words<'_>) -> Result<()> {
        const FORM: &str =
            "write `t interpolateboundary 1/0/0 RULE`: 0 = none, 1 = edge and corner, 2 = edge only";
        let Arguments { integers, numbers } = arguments(words, FORM)?;
        self.boundary = match (integers.as_slice(), numbers.is_empty()) {
            ([0], true) => Boundary::None,
            ([1], true) => Boundary::EdgeAndCorner,
            ([2], true) => Boundary::EdgeOnly,
            ([rule], true) => {
                return Err(words.wrong_statement(format!("there is no boundary rule {rule}"), FORM));
            }
            _ => {
                return Err(mismatch(
                    words,
                    "interpolateboundary",
                    "rules",
                    integers.len(),
                    numbers.len(),
                    FORM,
                ));
            }
        };
        Ok(())
    }

    /// Do all vertices and faces exist that are named?
    pub(super) fn check(&self, words: &Words<'_>, vertices: usize, faces: usize) -> Result<()> {
        let creases =
            self.creases.iter().flat_map(|&(line, crease)| crease.vertices.map(|vertex| (line, vertex)));
        let corners = self.corners.iter().map(|&(line, (vertex, _))| (line, vertex));
        check_indices(words, "crease", "vertex", creases, vertices)?;
        check_indices(words, "corner", "vertex", corners, vertices)?;
        check_indices(words, "hole", "face", self.holes.iter().copied(), faces)
    }

    /// The cage with these tags.
    pub(super) fn put_into(self, cage: Cage) -> Cage {
        Cage {
            creases: self.creases.into_iter().map(|(_, crease)| crease).collect(),
            sharp_vertices: self.corners.into_iter().map(|(_, corner)| corner).collect(),
            holes: self.holes.into_iter().map(|(_, face)| face).collect(),
            boundary: self.boundary,
            ..cage
        }
    }
}

/// Is there one number for all, or one for each?
fn fits(things: usize, numbers: usize) -> bool {
    things > 0 && (numbers == 1 || numbers == things)
}

fn mismatch(words: &Words<'_>, tag: &str, things: &str, count: usize, numbers: usize, form: &str) -> Error {
    words.wrong_statement(format!("the tag `{tag}` has {count} {things} and {numbers} numbers"), form)
}

fn check_indices(
    words: &Words<'_>,
    tag: &str,
    kind: &str,
    mut named: impl Iterator<Item = (usize, u32)>,
    count: usize,
) -> Result<()> {
    match named.find(|&(_, index)| index as usize >= count) {
        None => Ok(()),
        Some((line, index)) => {
            let problem = format!("the tag `{tag}` names {kind} {index}, but the file has {count}");
            Err(Error::format(
                words.path(),
                line,
                problem,
                "check the index: in tags they are counted from 0",
            ))
        }
    }
}

/// Reads `I/N/S`, I integers and N numbers. No tag that is read has strings.
fn arguments(words: &mut Words<'_>, form: &str) -> Result<Arguments> {
    let [integers, numbers] = counts(words, form)?;
    let missing = |words: &Words<'_>| {
        words.wrong_statement("the tag has fewer values than the counts before them say", form)
    };
    // Room grows with what is read: the counts may be anything.
    let mut read = Arguments { integers: Vec::new(), numbers: Vec::new() };
    for _ in 0..integers {
        let word = words.next().ok_or_else(|| missing(words))?;
        read.integers.push(integer(words, word)?);
    }
    for _ in 0..numbers {
        let word = words.next().ok_or_else(|| missing(words))?;
        read.numbers.push(sharpness(words, word)?);
    }
    match words.next() {
        None => Ok(read),
        Some(word) => {
            let problem =
                format!("`{}` stands behind the values that the tag's counts announce", shown(word));
            Err(words.wrong_statement(problem, form))
        }
    }
}

/// The first two of the three counts; the third must be 0.
fn counts(words: &mut Words<'_>, form: &str) -> Result<[u32; 2]> {
    let word = words.next().unwrap_or_default();
    let mut parts = word.split(|&byte| byte == b'/').map(|part| text(part)?.parse::<u32>().ok());
    match std::array::from_fn(|_| parts.next().flatten()) {
        [Some(integers), Some(numbers), Some(0)] if parts.next().is_none() => Ok([integers, numbers]),
        _ => Err(words.wrong(format!("`{}` stands where a tag's counts should be", shown(word)), form)),
    }
}

fn integer(words: &Words<'_>, word: &[u8]) -> Result<u32> {
    text(word).and_then(|text| text.parse().ok()).ok_or_else(|| {
        let problem = format!("`{}` stands where an index should be", shown(word));
        words.wrong(problem, "in tags, vertices and faces are counted from 0")
    })
}

fn sharpness(words: &Words<'_>, word: &[u8]) -> Result<f32> {
    let value = words.number(word)?;
    if value < 0.0 {
        let problem = format!("`{}` stands where a sharpness should be", shown(word));
        return Err(words.wrong(problem, "write 0 (smooth) or more; 10 is sharp for ever"));
    }
    Ok(value as f32)
}
