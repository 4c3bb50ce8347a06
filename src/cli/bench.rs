//! `micropoly bench`: the table of Weber 2014, Table 7.2, at one view or along a camera's path.

use std::borrow::Cow;
use std::path::Path;

use bytesize::ByteSize;
use micropoly::bench::{Plan, Row, Views, spike};
use micropoly::{Error, Result, Scene, scene_file};

use super::args::BenchArguments;
use super::devices::compared;
use super::plot;
use super::render::write_json;

pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    let plan = Plan {
        devices: compared(arguments.backend)?,
        schedulers: arguments.chosen.iter().map(|&choice| choice.into()).collect(),
        batches: arguments.batches(),
        views: arguments.views(),
        repeat: arguments.repeat,
        options: arguments.frame.options_as_published(),
    };
    let (mut rows, framed) = (Vec::new(), plan.views != Views::Camera);
    say!("{}{}", if framed { "frame    " } else { "" }, head());
    for scene in scenes(&arguments.scenes, framed)? {
        let measured = plan.run(&scene, |row| say!("{}", line(row)))?;
        if arguments.path {
            say_spikes(&measured);
        }
        rows.extend(measured);
    }
    if let Some(path) = &arguments.json {
        write_json(path, &rows)?;
    }
    if let Some(path) = &arguments.csv {
        write_csv(path, &rows)?;
    }
    if let Some(path) = &arguments.plot {
        let draw = if arguments.path { plot::memory_over_frames } else { plot::rate_over_memory };
        draw(path, &rows).map_err(|error| Error::Write { path: path.clone(), why: error.to_string() })?;
    }
    Ok(())
}

/// Says for each device at which frame BREADTH needs most memory.
fn say_spikes(rows: &[Row]) {
    for on_device in rows.chunk_by(|row, next| row.device == next.device) {
        let Some(Row { frame: Some(frame), memory, max, device, .. }) = spike(on_device) else { continue };
        let memory = ByteSize(*memory).display().iec();
        say!(
            "spike view on {device}: frame {frame}, where breadth needs {memory} for {max} surfaces at once"
        );
    }
}

/// The scenes that a user names, or the built-in ones; of these, those with a path if one is needed.
pub(super) fn scenes(files: &[std::path::PathBuf], with_path: bool) -> Result<Vec<Scene>> {
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
    .filter(|scene| !with_path || scene.as_ref().is_ok_and(|scene| scene.path.is_some()))
    .collect()
}

fn head() -> String {
    format!(
        "{:<16} {:<5} {:<9} {:>7} {:>10} {:>11} {:>9} {:>10} {:>9} {:>8} {:>12} {:>14}",
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
        "M surfaces/s",
        "groups' load"
    )
}

fn line(row: &Row) -> String {
    let name = short(&row.scene);
    let batch = if row.batch == 0 { "-".to_owned() } else { row.batch.to_string() };
    let load = row.imbalance.map_or_else(String::new, |share| format!("mean ± {:.1} %", share * 100.0));
    let frame = row.frame.map_or_else(String::new, |frame| format!("{:<8} ", format!("{frame:.2}")));
    let text = format!(
        "{frame}{name:<16} {:<5} {:<9} {batch:>7} {:>10.2} {:>11} {:>9} {:>10} {:>9} {:>8} {:>12.2} {load:>14}",
        row.backend,
        row.scheduler,
        row.seconds * 1e3,
        ByteSize(row.memory).display().iec().to_string(),
        row.max,
        row.processed,
        row.drawn,
        row.batches,
        row.rate
    );
    text.trim_end().to_owned()
}

/// A scene's name without folders and extension.
pub(super) fn short(scene: &str) -> Cow<'_, str> {
    Path::new(scene).file_stem().map_or(scene.into(), |name| name.to_string_lossy())
}

fn write_csv(path: &Path, rows: &[Row]) -> Result<()> {
    let failed = |error: csv::Error| Error::Write { path: path.to_owned(), why: error.to_string() };
    let mut writer = csv::Writer::from_path(path).map_err(failed)?;
    for row in rows {
        writer.serialize(row).map_err(failed)?;
    }
    writer.flush().map_err(|error| failed(error.into()))
}
