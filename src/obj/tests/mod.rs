//! What OBJ files may hold, and what is said of those that are wrong.

mod cages;
mod hostile;
mod polygons;
mod published;
mod surfaces;
mod tags;

use std::path::Path;

use super::{Obj, parse_bytes};
use crate::cage::Cage;
use crate::error::Error;

/// Four vertices of a square.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read(bytes: impl AsRef<[u8]>) -> Obj {
    parse_bytes(Path::new("x.obj"), bytes.as_ref()).expect("readable")
}

fn cage(bytes: impl AsRef<[u8]>) -> Cage {
    read(bytes).cage.expect("faces")
}

/// Line, problem and remedy of the error for what cannot be read.
fn refusal(bytes: impl AsRef<[u8]>) -> (usize, String, String) {
    match parse_bytes(Path::new("x.obj"), bytes.as_ref()) {
        Err(Error::Format { line, problem, remedy, .. }) => (line, problem, remedy),
        other => panic!("{:?} gave {other:?}", String::from_utf8_lossy(bytes.as_ref())),
    }
}

/// Each text is refused on this line, with this in the problem, and a remedy.
fn assert_refused<'a>(cases: impl IntoIterator<Item = (&'a str, usize, &'a str)>) {
    for (text, line, part) in cases {
        let (found, problem, remedy) = refusal(text);
        assert_eq!(found, line, "{text:?}: {problem}");
        assert!(problem.contains(part), "{text:?}: {problem:?} is not about {part:?}");
        assert!(!remedy.is_empty(), "{text:?}");
    }
}
