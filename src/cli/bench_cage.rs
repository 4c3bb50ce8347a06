//! `micropoly bench --cage`: what turning cages into patches costs.

use micropoly::cage::Options;
use micropoly::cage_bench::{Row, measure};
use micropoly::{Error, Result};

use super::args::BenchArguments;
use super::render::write_json;

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    say!(
        "{:<10} {:>9} {:>9} {:>9} {:>9} {:>8} {:>9}",
        "cage",
        "faces",
        "patches",
        "Gregory",
        "seconds",
        "ns/face",
        "MiB peak"
    );
    let rows = measure(&Options::default(), arguments.repeat, |row| say!("{}", line(row)))
        .map_err(|error| Error::scene(error.problem(), error.remedy()))?;
    match &arguments.json {
        Some(path) => write_json(path, &rows),
        None => Ok(()),
    }
}

fn line(row: &Row) -> String {
    let peak = row.peak.map_or("-".to_owned(), |mib| format!("{mib:.0}"));
    format!(
        "{:<10} {:>9} {:>9} {:>9} {:>9.3} {:>8.0} {peak:>9}",
        row.layout, row.faces, row.patches, row.gregory, row.seconds, row.nanoseconds_a_face
    )
}
