//! Where in a file something is: archives are files of their own, so that a line alone would not tell.

use std::path::Path;
use std::sync::Arc;

use crate::error::Error;

/// Longest part of a word that a message shows: words in a damaged file may be of any length.
const SHOWN: usize = 40;

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub path: Arc<Path>,
    /// The line, counted from 1.
    pub line: usize,
}

impl Place {
    /// An error here.
    #[must_use]
    pub fn wrong(&self, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::format(&self.path, self.line, problem, remedy)
    }
}

/// The beginning of a word, in backquotes; what would disturb a terminal is escaped.
pub(super) fn quoted(word: &str) -> String {
    let shown: String = word.chars().take(SHOWN).flat_map(char::escape_debug).collect();
    let rest = if word.chars().nth(SHOWN).is_some() { "…" } else { "" };
    format!("`{shown}{rest}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_and_odd_words_are_shown_shortened_and_escaped() {
        assert_eq!(quoted("Sphere"), "`Sphere`");
        assert_eq!(quoted("a\nb\u{1b}"), "`a\\nb\\u{1b}`");
        assert_eq!(quoted(&"x".repeat(41)), format!("`{}…`", "x".repeat(40)));
    }
}
