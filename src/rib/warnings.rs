//! Warnings: each once, and no more than a person reads.

use std::collections::BTreeSet;

use super::place::{Place, quoted};
use super::request::Request;

/// Most of them: a damaged file may give rise to any number.
const MAX_WARNINGS: usize = 100;

#[derive(Debug, Default)]
pub(super) struct Warnings {
    /// What was warned about, by a name that does not depend on the line.
    known: BTreeSet<String>,
    list: Vec<String>,
}

impl Warnings {
    /// Warns about something unless it was before.
    pub(super) fn add(&mut self, place: &Place, what: impl Into<String>) {
        let what = what.into();
        if self.known.len() > MAX_WARNINGS || self.known.contains(&what) {
            return;
        }
        self.list.push(match self.known.len() {
            MAX_WARNINGS => "there are more warnings, which are not shown".to_owned(),
            _ => format!("{}:{}: {what}", place.path.display(), place.line),
        });
        self.known.insert(what);
    }

    /// Warns about a request that is left out.
    pub(super) fn ignored(&mut self, request: &Request) {
        self.add(&request.place, format!("{} is not supported and ignored", quoted(&request.name)));
    }

    pub(super) fn into_list(self) -> Vec<String> {
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_given_once_and_not_too_many() {
        let place = Place { path: std::path::Path::new("x.rib").into(), line: 7 };
        let mut warnings = Warnings::default();
        for what in ["a", "b", "a"] {
            warnings.add(&place, what);
        }
        assert_eq!(warnings.list, ["x.rib:7: a", "x.rib:7: b"]);
        (0..1000).for_each(|index| warnings.add(&place, index.to_string()));
        assert_eq!(warnings.into_list().len(), MAX_WARNINGS + 1);
    }
}
