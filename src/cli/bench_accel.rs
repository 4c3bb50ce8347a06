//! `micropoly bench --accel`: what building trees costs.

use std::path::Path;

use micropoly::Result;
use micropoly::accel::bench::{Row, measure};
use micropoly::accel::boxes;

use super::accel::load;
use super::args::BenchArguments;
use super::render::write_json;

pub(crate) fn run(mesh: &Path, arguments: &BenchArguments) -> Result<()> {
    let boxes = boxes(&load(mesh)?.triangles);
    say!(
        "{} triangles; medians of {} runs; SAH: areas of all boxes over the root's",
        boxes.len(),
        arguments.repeat
    );
    say!("{:<16} {:>8} {:>8} {:>8} {:>8}", "builder", "ms", "of obvhs", "SAH", "of obvhs");
    let rows = measure(&boxes, arguments.repeat)?;
    rows.iter().for_each(|row| say!("{}", line(row)));
    match &arguments.json {
        Some(path) => write_json(path, &rows),
        None => Ok(()),
    }
}

fn line(row: &Row) -> String {
    let Row { builder, milliseconds, time_ratio, sah, sah_ratio, .. } = row;
    format!("{builder:<16} {milliseconds:>8.2} {time_ratio:>8.3} {sah:>8.2} {sah_ratio:>8.3}")
}
