//! The words of an OBJ file, statement by statement, and the numbers that they stand for.
//!
//! The file is read as bytes: names and comments may be in any encoding. Nothing is copied.

use std::path::Path;

use crate::error::{Error, Result};

/// Remedy for numbers that are none.
const NUMBERS: &str = "replace it by a number, such as -1.5e3";
/// Remedy for numbers that are too large.
const FINITE: &str = "replace NaN, infinities and overlong numbers";

/// A place in the file, before the next word.
pub(super) struct Words<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
    line: usize,
    /// Line on which the statement started.
    start: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Self { path, bytes, at: 0, line: 1, start: 1 }
    }

    pub(super) fn path(&self) -> &'a Path {
        self.path
    }

    /// The line on which the statement started.
    pub(super) fn start(&self) -> usize {
        self.start
    }

    /// Goes on to the next statement, whatever is left of this one, and gives its first word.
    pub(super) fn statement(&mut self) -> Option<&'a [u8]> {
        while self.at > 0 && self.next().is_some() {}
        loop {
            self.start = self.line;
            if let Some(word) = self.next() {
                return Some(word);
            }
            self.at = end_of_line(self.bytes, self.at)?;
            self.line += 1;
        }
    }

    /// The next word of the statement.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        match rest.first()? {
            b'\n' | b'\r' => None,
            b'#' => {
                self.at += rest.iter().position(|&byte| is_end(byte)).unwrap_or(rest.len());
                None
            }
            _ => {
                let ends = |at: usize| is_after_word(rest[at]) || is_continued(rest, at);
                let length = (0..rest.len()).find(|&at| ends(at)).unwrap_or(rest.len());
                self.at += length;
                Some(&rest[..length])
            }
        }
    }

    /// Goes on to what is no blank, on the next line if a backslash ends this one.
    fn skip_blanks(&mut self) {
        loop {
            self.at = after_blanks(self.bytes, self.at);
            if !is_continued(self.bytes, self.at) {
                return;
            }
            let end = after_blanks(self.bytes, self.at + 1);
            self.at = end_of_line(self.bytes, end).unwrap_or(end);
            self.line += 1;
        }
    }

    /// An error on the line of the last word.
    pub(super) fn wrong(&self, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::format(self.path, self.line, problem, remedy)
    }

    /// An error of the statement, on the line where it started.
    pub(super) fn wrong_statement(&self, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::format(self.path, self.start, problem, remedy)
    }

    /// The number in a word: finite, and in the range of single precision, in which patches are kept.
    pub(super) fn number(&self, word: &[u8]) -> Result<f64> {
        match text(word).and_then(|text| text.parse::<f64>().ok()) {
            Some(value) if value.abs() <= f64::from(f32::MAX) => Ok(value),
            Some(_) => Err(self.wrong(format!("`{}` is not finite, or beyond 3.4e38", shown(word)), FINITE)),
            None => Err(self.wrong(format!("`{}` stands where a number should be", shown(word)), NUMBERS)),
        }
    }

    /// All numbers of the statement, and how many they are; none or more than there is room for is an error.
    pub(super) fn numbers<const ROOM: usize>(&mut self, keyword: &str) -> Result<([f64; ROOM], usize)> {
        let (mut numbers, mut count) = ([0.0; ROOM], 0);
        while let Some(word) = self.next() {
            let value = self.number(word)?;
            let Some(place) = numbers.get_mut(count) else {
                return Err(self.wrong_statement(
                    format!("more than {ROOM} numbers stand after `{keyword}`"),
                    "remove those that are too many",
                ));
            };
            *place = value;
            count += 1;
        }
        Ok((numbers, count))
    }
}

/// The text in a word, if it is one.
pub(super) fn text(word: &[u8]) -> Option<&str> {
    std::str::from_utf8(word).ok()
}

/// The beginning of a word, for messages: words may be of any length, and hold any bytes.
pub(super) fn shown(word: &[u8]) -> String {
    let start = String::from_utf8_lossy(&word[..word.len().min(160)]);
    start.chars().take(40).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

fn is_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

fn is_after_word(byte: u8) -> bool {
    is_blank(byte) || is_end(byte) || byte == b'#'
}

/// The first place from `at` on that is no blank.
fn after_blanks(bytes: &[u8], at: usize) -> usize {
    let rest = &bytes[at..];
    at + rest.iter().position(|&byte| !is_blank(byte)).unwrap_or(rest.len())
}

/// Does a backslash stand here that ends the line, or the file? Editors may have left blanks behind it.
fn is_continued(bytes: &[u8], at: usize) -> bool {
    bytes.get(at) == Some(&b'\\') && bytes.get(after_blanks(bytes, at + 1)).is_none_or(|&byte| is_end(byte))
}

/// The start of the next line, if a line ends here.
fn end_of_line(bytes: &[u8], at: usize) -> Option<usize> {
    match bytes[at..] {
        [b'\r', b'\n', ..] => Some(at + 2),
        [b'\r' | b'\n', ..] => Some(at + 1),
        _ => None,
    }
}
