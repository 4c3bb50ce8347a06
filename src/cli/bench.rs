//! `micropoly bench`: the table of Weber 2014, Table 7.2, and the plot of his Fig. 7.2.

use std::path::Path;

use bytesize::ByteSize;
use micropoly::bench::{Plan, Row, devices};
use micropoly::{Error, Result, Scene, scene_file};
use plotters::prelude::{
    ChartBuilder, Circle, DrawingAreaErrorKind, IntoDrawingArea, IntoLogRange, LineSeries, Palette,
    Palette99, PathElement, SVGBackend, WHITE,
};
use plotters::style::Color;

use super::args::BenchArguments;
use super::render::write_json;

/// Size of a plot in pixels.
const PLOT: (u32, u32) = (800, 500);

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    let plan = Plan {
        devices: devices(arguments.backend.only())?,
        schedulers: arguments.chosen.iter().map(|&choice| choice.into()).collect(),
        batches: arguments.batches.clone(),
        repeat: arguments.repeat,
        options: arguments.frame.options(),
    };
    let mut rows = Vec::new();
    say!("{}", head());
    for scene in scenes(&arguments.scenes)? {
        rows.extend(plan.run(&scene, |row| say!("{}", line(row)))?);
    }
    if let Some(path) = &arguments.json {
        write_json(path, &rows)?;
    }
    if let Some(path) = &arguments.csv {
        write_csv(path, &rows)?;
    }
    if let Some(path) = &arguments.plot {
        plot(path, &rows).map_err(|error| Error::Write { path: path.clone(), why: error.to_string() })?;
    }
    Ok(())
}

/// The scenes that a user names, or the built-in ones.
fn scenes(files: &[std::path::PathBuf]) -> Result<Vec<Scene>> {
    let built_in =
        |(name, text): (&str, &str)| scene_file::parse_bytes(name.as_ref(), text.as_bytes().to_vec());
    if !files.is_empty() {
        return files.iter().map(Scene::load).collect();
    }
    [
        ("hair", include_str!("../../scenes/hair.toml")),
        ("columns", include_str!("../../scenes/columns.toml")),
        ("city", include_str!("../../scenes/city.toml")),
        ("eyesplit", include_str!("../../scenes/eyesplit.toml")),
    ]
    .into_iter()
    .map(built_in)
    .collect()
}

fn head() -> String {
    format!(
        "{:<16} {:<5} {:<9} {:>7} {:>10} {:>11} {:>9} {:>10} {:>9} {:>8} {:>12}",
        "scene",
        "back",
        "scheduler",
        "batch",
        "ms",
        "memory",
        "max",
        "processed",
        "drawn",
        "batches",
        "M surfaces/s"
    )
}

fn line(row: &Row) -> String {
    let name =
        Path::new(&row.scene).file_stem().map_or(row.scene.as_str().into(), |name| name.to_string_lossy());
    let batch = if row.batch == 0 { "-".to_owned() } else { row.batch.to_string() };
    format!(
        "{name:<16} {:<5} {:<9} {batch:>7} {:>10.2} {:>11} {:>9} {:>10} {:>9} {:>8} {:>12.2}",
        row.backend,
        row.scheduler,
        row.seconds * 1e3,
        ByteSize(row.memory).display().iec().to_string(),
        row.max,
        row.processed,
        row.drawn,
        row.batches,
        row.rate
    )
}

fn write_csv(path: &Path, rows: &[Row]) -> Result<()> {
    let failed = |error: csv::Error| Error::Write { path: path.to_owned(), why: error.to_string() };
    let mut writer = csv::Writer::from_path(path).map_err(failed)?;
    for row in rows {
        writer.serialize(row).map_err(failed)?;
    }
    writer.flush().map_err(|error| failed(error.into()))
}

/// Rate over memory of the first scene on its first device, a curve a scheduler.
fn plot(path: &Path, rows: &[Row]) -> std::result::Result<(), DrawingAreaErrorKind<std::io::Error>> {
    let Some(first) = rows.first() else { return Ok(()) };
    let own: Vec<&Row> =
        rows.iter().filter(|row| row.scene == first.scene && row.device == first.device).collect();
    let most = |value: fn(&Row) -> f64| own.iter().map(|row| value(row)).fold(f64::MIN_POSITIVE, f64::max);
    let least = own.iter().map(|row| kib(row)).fold(f64::INFINITY, f64::min);
    let area = SVGBackend::new(path, PLOT).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(format!("{} on {}", first.scene, first.device), ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d((least * 0.8..most(kib) * 1.25).log_scale(), 0.0..most(|row| row.rate) * 1.1)?;
    chart.configure_mesh().x_desc("memory, KiB").y_desc("million surfaces a second").draw()?;
    let mut names: Vec<&str> = own.iter().map(|row| row.scheduler).collect();
    names.dedup();
    for (index, name) in names.into_iter().enumerate() {
        let colour = Palette99::pick(index).to_rgba();
        let points: Vec<(f64, f64)> =
            own.iter().filter(|row| row.scheduler == name).map(|row| (kib(row), row.rate)).collect();
        chart
            .draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(2)));
        chart.draw_series(points.into_iter().map(|point| Circle::new(point, 4, colour.filled())))?;
    }
    chart.configure_series_labels().background_style(WHITE).border_style(plotters::style::BLACK).draw()?;
    area.present()
}

fn kib(row: &Row) -> f64 {
    row.memory as f64 / 1024.0
}
