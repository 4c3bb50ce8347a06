//! `micropoly bench --raster`: the table of Eisenacher & Loop 2010, Table 1.

use micropoly::rasterising::{Row, measure};
use micropoly::{Result, Scene, scene_file};

use super::args::BenchArguments;
use super::bench::short;
use super::conform::teapot;
use super::devices::compared;
use super::render::write_json;

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    let entries = compared(arguments.backend)?;
    say!("milliseconds; setup is part of sampling, and steps are those of all threads together");
    say!("{}", head());
    let options = arguments.frame.options();
    let mut rows = Vec::new();
    for scene in scenes(arguments)? {
        rows.extend(measure(&entries, &scene, &options, arguments.repeat, |row| say!("{}", line(row)))?);
    }
    match &arguments.json {
        Some(path) => write_json(path, &rows),
        None => Ok(()),
    }
}

/// The scenes that a user names, or the teapot as `scenes/teapot.toml` shows it.
fn scenes(arguments: &BenchArguments) -> Result<Vec<Scene>> {
    if !arguments.scenes.is_empty() {
        return arguments.scenes.iter().map(Scene::load).collect();
    }
    let mut scene = teapot("teapot")?;
    let view = include_str!("../../scenes/teapot.toml")
        .replace("geometry = \"teapot.bpt\"", "generate = { kind = \"spheres\", count = 1 }");
    let view = scene_file::parse_bytes("teapot.toml".as_ref(), view.into_bytes())?;
    (scene.camera, scene.lights, scene.ambient) = (view.camera, view.lights, view.ambient);
    Ok(vec![scene])
}

fn head() -> String {
    format!(
        "{:<10} {:<8} {:<11} {:>4} {:>5} {:>7} {:>11} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>8} {:>11}",
        "scene",
        "backend",
        "rasteriser",
        "tile",
        "bound",
        "samples",
        "bound+split",
        "count",
        "sort",
        "dice",
        "shade",
        "sampling",
        "filter",
        "total",
        "of 1 sample"
    )
}

fn line(row: &Row) -> String {
    let tile = if row.tile == 0 { "-".to_owned() } else { row.tile.to_string() };
    let known = |value: f64| if value > 0.0 { format!("{value:.2}") } else { "-".to_owned() };
    let step = |name: &str| row.step(name).map_or("-".to_owned(), known);
    format!(
        "{:<10} {:<8} {:<11} {:>4} {:>5} {:>7} {:>11} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>8.2} {:>11.2}",
        short(&row.scene),
        row.backend,
        row.rasteriser,
        tile,
        row.bound,
        row.samples,
        known(row.subdivide),
        step("count"),
        step("sort"),
        step("dice"),
        step("shade"),
        step("sample"),
        known(row.filter),
        row.total,
        row.of_one_sample
    )
}
