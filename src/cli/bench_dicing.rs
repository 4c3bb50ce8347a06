//! `micropoly bench --dicing`: lengths and number of micropolygons, and what watertight borders cost.

use micropoly::dicing::Dicing;
use micropoly::{Backend, RenderOptions, Result};

use super::args::BenchArguments;
use super::bench::{scenes, short};
use super::render::write_json;

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    say!(
        "{:<12} {:>14} {:>8} {:>9} {:>10} {:>11} {:>6}  sides by length, eighths of the target, % (last: longer than two targets)",
        "scene",
        "micropolygons",
        "of fixed",
        "in range",
        "naive ms",
        "watertight",
        "ratio"
    );
    let mut rows = Vec::new();
    for scene in scenes(&arguments.scenes, false)? {
        let options = RenderOptions { backend: Backend::Cpu, ..arguments.frame.options() };
        let row = Dicing::measure(&scene, &options, arguments.repeat)?;
        say!("{}", line(&row));
        rows.push(row);
    }
    match &arguments.json {
        Some(path) => write_json(path, &rows),
        None => Ok(()),
    }
}

fn line(row: &Dicing) -> String {
    let all = row.lengths.sides.iter().sum::<u64>().max(1) as f64;
    let shares: Vec<String> =
        row.lengths.sides.iter().map(|count| format!("{:.1}", *count as f64 / all * 100.0)).collect();
    format!(
        "{:<12} {:>14} {:>8.3} {:>7.1} % {:>10.2} {:>11.2} {:>6.3}  {}",
        short(&row.scene),
        row.lengths.micropolygons,
        row.lengths.micropolygons as f64 / row.fixed as f64,
        row.in_range * 100.0,
        row.naive_seconds * 1e3,
        row.watertight_seconds * 1e3,
        row.watertight_seconds / row.naive_seconds,
        shares.join(" ")
    )
}
