//! `micropoly render`.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use micropoly::stats::Stats;
use micropoly::{Error, Result, Scene, Seconds};

use super::args::RenderArguments;
use super::progress::Progress;
use super::summary;

pub(crate) fn run(arguments: &RenderArguments) -> Result<()> {
    let start = Instant::now();
    let options = arguments.options();
    check_folder(&arguments.output)?;
    let scene = Scene::load(&arguments.scene)?;
    let load = start.elapsed().as_secs_f64();

    let mut progress = Progress::new(arguments.progress, scene.patch_count() as u64);
    let rendering = micropoly::render(&scene, &options, |counts| progress.update(counts))?;
    progress.finish();
    for note in &rendering.notes {
        eprintln!("note: {note}");
    }

    let encoding = Instant::now();
    rendering.image.save_png(&arguments.output)?;
    let encode = encoding.elapsed().as_secs_f64();
    let total = start.elapsed().as_secs_f64();
    let seconds = Seconds { load, encode, total, ..rendering.seconds };
    let stats = Stats::new(&scene.name, &options, &rendering, seconds);
    if let Some(path) = &arguments.stats {
        write_json(path, &stats)?;
    }
    eprint!("{}", summary::of(&stats, &arguments.output));
    Ok(())
}

/// Finds out before a long rendering that its file could not be written.
pub(super) fn check_folder(output: &Path) -> Result<()> {
    let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => {
            let why = format!("there is no folder {}", folder.display());
            Err(Error::Write { path: output.to_owned(), why })
        }
        _ => Ok(()),
    }
}

/// Writes anything as JSON to a file, or to standard output for `-`.
pub(super) fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<()> {
    let failed = |why: String| Error::Write { path: path.to_owned(), why };
    let mut json = serde_json::to_string_pretty(value).map_err(|error| failed(error.to_string()))?;
    json.push('\n');
    let written = if path == Path::new("-") {
        std::io::stdout().write_all(json.as_bytes())
    } else {
        std::fs::write(path, json)
    };
    written.map_err(|error| failed(error.to_string()))
}
