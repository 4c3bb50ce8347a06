//! Vertices, texture coordinates and normals, and how faces and surfaces name them.

use super::words::{Words, shown, text};
use crate::error::Result;

/// What an index may name, and the keyword of its lines.
const KINDS: [(&str, &str); 3] = [("vertex", "v"), ("texture coordinate", "vt"), ("normal", "vn")];
/// Remedy for indices that are none.
const FORMS: &str = "write corners as `v`, `v/vt`, `v//vn` or `v/vt/vn`, each an index";

/// All that faces and surfaces can name.
#[derive(Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) texture: Vec<[f32; 2]>,
    /// Weights other than 1, with their vertices, ascending.
    weights: Vec<(u32, f64)>,
    /// Normals are counted only: those of the limit surface are drawn.
    normal_count: usize,
}

/// A corner of a face, or a control point.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) vertex: u32,
    pub(super) texture: Option<u32>,
    pub(super) has_normal: bool,
}

impl Corner {
    /// How it is written.
    fn form(self) -> &'static str {
        match (self.texture.is_some(), self.has_normal) {
            (false, false) => "v",
            (true, false) => "v/vt",
            (false, true) => "v//vn",
            (true, true) => "v/vt/vn",
        }
    }
}

impl Vertices {
    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Reads `v x y z [w]` or `v x y z [w] r g b`; colours are not used.
    pub(super) fn read_position(&mut self, words: &mut Words<'_>) -> Result<()> {
        let ([x, y, z, w, ..], count) = words.numbers::<7>("v")?;
        if !matches!(count, 3 | 4 | 6 | 7) {
            let problem = format!("{count} numbers stand after `v`");
            return Err(words.wrong_statement(problem, "write `v x y z`, perhaps with a weight or a colour"));
        }
        let index = next_index(words, self.positions.len())?;
        if matches!(count, 4 | 7) && w != 1.0 {
            self.weights.push((index, w));
        }
        self.positions.push([x, y, z]);
        Ok(())
    }

    /// Reads `vt u [v [w]]`.
    pub(super) fn read_texture(&mut self, words: &mut Words<'_>) -> Result<()> {
        let ([u, v, _], count) = words.numbers::<3>("vt")?;
        if count == 0 {
            return Err(words.wrong_statement("no number stands after `vt`", "write `vt u v`"));
        }
        next_index(words, self.texture.len())?;
        self.texture.push([u as f32, v as f32]);
        Ok(())
    }

    /// Reads `vn x y z`.
    pub(super) fn read_normal(&mut self, words: &mut Words<'_>) -> Result<()> {
        let (_, count) = words.numbers::<3>("vn")?;
        if count != 3 {
            let problem = format!("{count} numbers stand after `vn`");
            return Err(words.wrong_statement(problem, "write `vn x y z`"));
        }
        self.normal_count += 1;
        Ok(())
    }

    /// Position and weight of a control point.
    pub(super) fn weighted(&self, vertex: u32) -> [f64; 4] {
        let [x, y, z] = self.positions.get(vertex as usize).copied().unwrap_or_default();
        let found = self.weights.binary_search_by_key(&vertex, |&(of, _)| of);
        [x, y, z, found.map_or(1.0, |place| self.weights[place].1)]
    }

    /// Reads all corners that are left in the statement into `corners`; they must be written alike.
    pub(super) fn read_corners(&self, words: &mut Words<'_>, corners: &mut Vec<Corner>) -> Result<()> {
        corners.clear();
        while let Some(word) = words.next() {
            let corner = self.corner(words, word)?;
            let first = *corners.first().unwrap_or(&corner);
            if first.form() != corner.form() {
                let (shown, form, first) = (shown(word), corner.form(), first.form());
                let problem = format!("`{shown}` is written as {form}, the corners before it as {first}");
                return Err(words.wrong(problem, "write all corners of a face in the same way"));
            }
            corners.push(corner);
        }
        Ok(())
    }

    fn corner(&self, words: &Words<'_>, word: &[u8]) -> Result<Corner> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [vertex, texture, normal, more] = std::array::from_fn(|_| parts.next());
        let optional = |part: Option<&[u8]>, kind| match part {
            None => Ok(None),
            Some(part) => self.index(words, word, part, kind).map(Some),
        };
        if more.is_some() {
            return Err(words.wrong(format!("`{}` has too many parts", shown(word)), FORMS));
        }
        // Between two slashes there may be nothing.
        let texture = texture.filter(|part| !part.is_empty() || normal.is_none());
        let vertex = self.index(words, word, vertex.unwrap_or_default(), 0)?;
        let (texture, normal) = (optional(texture, 1)?, optional(normal, 2)?);
        Ok(Corner { vertex, texture, has_normal: normal.is_some() })
    }

    /// The index, counted from 0, that a part of a word stands for.
    fn index(&self, words: &Words<'_>, word: &[u8], part: &[u8], kind: usize) -> Result<u32> {
        let count = [self.positions.len(), self.texture.len(), self.normal_count][kind];
        let Some(number) = text(part).and_then(|text| text.parse::<i64>().ok()) else {
            return Err(words.wrong(format!("`{}` stands where a corner should be", shown(word)), FORMS));
        };
        let index =
            if number < 0 { number.checked_add_unsigned(count as u64) } else { number.checked_sub(1) };
        match index.and_then(|index| u32::try_from(index).ok()) {
            Some(index) if (index as usize) < count => Ok(index),
            _ => Err(outside(words, word, kind, number, count)),
        }
    }
}

/// The error for an index that names nothing.
fn outside(words: &Words<'_>, word: &[u8], kind: usize, number: i64, count: usize) -> crate::Error {
    let ((name, keyword), shown) = (KINDS[kind], shown(word));
    let remedy = format!("put the `{keyword}` lines before the lines that name them, and check the index");
    match number {
        0 => words.wrong(
            format!("`{shown}` names {name} 0"),
            "indices start at 1; negative ones count back from the last one, which is -1",
        ),
        1.. => words.wrong(
            format!("`{shown}` names {name} {number}, but only {count} stand before this line"),
            remedy,
        ),
        _ => words.wrong(
            format!(
                "`{shown}` counts {} back from the last {name}, but only {count} stand before this line",
                { number.unsigned_abs() }
            ),
            remedy,
        ),
    }
}

/// The index of what is added to so many others.
fn next_index(words: &Words<'_>, count: usize) -> Result<u32> {
    let too_many = |_| words.wrong_statement("the file has more than 4294967295 vertices", "divide it");
    u32::try_from(count).map_err(too_many)
}
