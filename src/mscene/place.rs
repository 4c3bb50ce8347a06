//! Where in a file something is: binary files have no lines, so that messages name the element instead.

use std::path::Path;

use crate::error::Error;

/// Longest part of a name that a message shows: a name in a damaged file may be of any length.
const SHOWN: usize = 40;

/// An element of a list in a file.
pub(super) struct Place<'a> {
    pub(super) path: &'a Path,
    pub(super) kind: &'static str,
    /// Counted from 0; messages count from 1.
    pub(super) index: usize,
    pub(super) count: usize,
    /// Empty as long as it is not known.
    pub(super) name: &'a str,
}

impl<'a> Place<'a> {
    pub(super) fn named(&self, name: &'a str) -> Self {
        Self { name, ..*self }
    }

    pub(super) fn wrong(&self, problem: impl std::fmt::Display, remedy: impl Into<String>) -> Error {
        let Self { path, kind, index, count, name } = *self;
        let name = if name.is_empty() { String::new() } else { format!(" ({})", quoted(name)) };
        Error::content(path, format!("{kind} {} of {count}{name}: {problem}", index + 1), remedy)
    }
}

/// The beginning of a name, in quotes; what would disturb a terminal is escaped.
pub(super) fn quoted(name: &str) -> String {
    let shown: String = name.chars().take(SHOWN).collect();
    let rest = if shown.len() < name.len() { "…" } else { "" };
    format!("{shown:?}{rest}")
}
