//! `micropoly bench --tess`: what the tessellator costs.

use micropoly::Result;
use micropoly::tess::{Row, measure};

use super::args::BenchArguments;
use super::devices::compared;
use super::render::write_json;

/// Bytes of a device's memory, unless another number is given.
const MEMORY: u64 = 256 << 20;

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    let entries = compared(arguments.backend)?;
    say!(
        "{:<12} {:>7} {:>5} {:>11} {:>7} {:>11} {:>14} {:>14}",
        "mesh",
        "patches",
        "level",
        "triangles",
        "chunks",
        "control ms",
        "evaluation ms",
        "M triangles/s"
    );
    let (memory, threads) = (arguments.frame.memory.unwrap_or(MEMORY), usize::from(arguments.frame.threads));
    let mut rows = Vec::new();
    for entry in entries {
        say!("{}", entry.name);
        rows.extend(measure(&entry, threads, memory, arguments.repeat, |row| say!("{}", line(row)))?);
    }
    match &arguments.json {
        Some(path) => write_json(path, &rows),
        None => Ok(()),
    }
}

fn line(row: &Row) -> String {
    format!(
        "{:<12} {:>7} {:>5} {:>11} {:>7} {:>11.2} {:>14.2} {:>14.1}",
        row.mesh, row.patches, row.level, row.triangles, row.chunks, row.control, row.evaluation, row.rate
    )
}
