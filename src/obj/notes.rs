//! Warnings: what of the file is not used, each kind once.

use std::path::Path;

use super::words::{Words, shown};
use crate::error::Result;

/// So many kinds of statements that nobody knows are passed over; with more this is no OBJ file.
const MOST_UNKNOWN: usize = 16;

/// What has not been used so far.
#[derive(Default)]
pub(super) struct Notes {
    notes: Vec<Note>,
}

struct Note {
    name: String,
    text: &'static str,
    /// Where it stands first.
    line: usize,
    times: usize,
}

impl Notes {
    /// Notes that the statement with this keyword, which no other module reads, is not used, if that is worth saying.
    pub(super) fn pass_over(&mut self, keyword: &[u8], words: &Words<'_>) -> Result<()> {
        if makes_no_difference(keyword) {
            return Ok(());
        }
        match not_drawn(keyword) {
            Some(text) => self.add(&shown(keyword), text, words.start()),
            None => {
                return self.add_unknown(
                    shown(keyword),
                    "this statement is not known and is passed over",
                    words,
                );
            }
        }
        Ok(())
    }

    /// Notes a tag that is not used.
    pub(super) fn pass_over_tag(&mut self, name: &[u8], words: &Words<'_>) -> Result<()> {
        self.add_unknown(format!("t {}", shown(name)), "this tag is not used", words)
    }

    fn add_unknown(&mut self, name: String, text: &'static str, words: &Words<'_>) -> Result<()> {
        self.add(&name, text, words.start());
        let known = self.notes.iter().filter(|note| not_drawn(note.name.as_bytes()).is_some()).count();
        if self.notes.len() - known <= MOST_UNKNOWN {
            return Ok(());
        }
        let problem = format!("`{name}` and {MOST_UNKNOWN} other kinds of statements are not known");
        Err(words.wrong_statement(problem, "is this the right file, and an OBJ file in text form?"))
    }

    /// Notes that a kind of thing stands here that is not used.
    pub(super) fn add(&mut self, name: &str, text: &'static str, line: usize) {
        match self.notes.iter_mut().find(|note| note.name == name && note.text == text) {
            Some(note) => note.times += 1,
            None => self.notes.push(Note { name: name.to_owned(), text, line, times: 1 }),
        }
    }

    /// All of them, as a user reads them.
    pub(super) fn warnings(&self, path: &Path) -> Vec<String> {
        let warning = |note: &Note| {
            let Note { name, text, line, times } = note;
            let times = if *times > 1 { format!(" ({times} times)") } else { String::new() };
            format!("{}:{line}: `{name}`: {text}{times}", path.display())
        };
        self.notes.iter().map(warning).collect()
    }
}

/// Names, groups, looks and ways to approximate a surface: the shape is the same without them.
fn makes_no_difference(keyword: &[u8]) -> bool {
    let names: [&[u8]; 8] = [b"o", b"g", b"s", b"mg", b"usemtl", b"mtllib", b"usemap", b"maplib"];
    let looks: [&[u8]; 6] = [b"bevel", b"c_interp", b"d_interp", b"lod", b"shadow_obj", b"trace_obj"];
    // Points of parameter space, steps and bases are told by the curves and surfaces that need them.
    let others: [&[u8]; 5] = [b"ctech", b"stech", b"vp", b"step", b"bmat"];
    names.contains(&keyword) || looks.contains(&keyword) || others.contains(&keyword)
}

/// What is known, but not drawn.
fn not_drawn(keyword: &[u8]) -> Option<&'static str> {
    Some(match keyword {
        b"l" => "lines are not drawn",
        b"p" => "points are not drawn",
        b"curv" | b"curv2" => "curves are not drawn",
        b"trim" | b"hole" => "surfaces are drawn as a whole, not trimmed",
        b"scrv" | b"sp" => "curves and points that a surface should contain are not used",
        b"con" => "surfaces are not joined",
        b"bzp" | b"bsp" | b"cdc" | b"cdp" | b"res" => "patches and curves of OBJ 2.11 are not drawn",
        b"call" | b"csh" => "other files and commands are not carried out",
        _ => return None,
    })
}
