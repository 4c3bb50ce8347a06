//! `micropoly bench --culling`: what culling of whole patches saves.

use micropoly::culling::{Row, measure};
use micropoly::{Result, Scene};

use super::args::BenchArguments;
use super::bench::short;
use super::devices::compared;
use super::render::write_json;

/// Without a scene.
const CITY: &str = "scenes/city.toml";

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    let entries = compared(arguments.backend)?;
    say!(
        "{:<10} {:<8} {:<10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>6}",
        "scene",
        "backend",
        "cull",
        "taken",
        "outside",
        "hidden",
        "drawn",
        "ms",
        "fewer",
        "faster"
    );
    let options = arguments.frame.options();
    let mut rows = Vec::new();
    let city = [CITY.into()];
    for name in if arguments.scenes.is_empty() { &city[..] } else { &arguments.scenes[..] } {
        let scene = Scene::load(name)?;
        rows.extend(measure(&entries, &scene, &options, arguments.repeat, |row| say!("{}", line(row)))?);
    }
    match &arguments.json {
        Some(path) => write_json(path, &rows),
        None => Ok(()),
    }
}

fn line(row: &Row) -> String {
    format!(
        "{:<10} {:<8} {:<10} {:>9} {:>9} {:>9} {:>9} {:>9.1} {:>6.2} {:>6.2}",
        short(&row.scene),
        row.backend,
        row.cull,
        row.taken,
        row.outside,
        row.hidden,
        row.drawn,
        row.milliseconds,
        row.fewer,
        row.faster
    )
}
