//! `micropoly render`.

use std::io::Write;
use std::ops::RangeInclusive;
use std::path::Path;
use std::time::Instant;

use micropoly::stats::Stats;
use micropoly::{Error, RenderOptions, Result, Scene, Seconds, Shot};

use super::args::RenderArguments;
use super::output::{Kind, numbered};
use super::progress::Progress;
use super::summary;

pub(crate) fn run(arguments: &RenderArguments) -> Result<()> {
    let start = Instant::now();
    let kind = Kind::of(&arguments.output, arguments.bits)?;
    check_folder(&arguments.output)?;
    let scene = arguments.scene.load(arguments.progress)?;
    let blur = Some(arguments.blur(&scene)?);
    let options = RenderOptions { film: kind.needs_film(), blur, ..arguments.options() };
    let load = start.elapsed().as_secs_f64();
    if let Some((first, last)) = arguments.frames {
        return render_path(arguments, &scene, &options, kind, first..=last);
    }

    let mut progress = Progress::new(arguments.progress, 100, "per cent");
    let rendering = micropoly::render(&scene, &options, |now| {
        progress.update((now.share * 100.0) as u64, || format!("{} surfaces", now.counts.processed));
    })?;
    progress.finish();
    tell(&rendering.notes);

    let encoding = Instant::now();
    kind.save(&rendering, &arguments.output)?;
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

/// Renders frames of the camera's path, a file each.
fn render_path(
    arguments: &RenderArguments,
    scene: &Scene,
    options: &RenderOptions,
    kind: Kind,
    frames: RangeInclusive<u32>,
) -> Result<()> {
    let start = Instant::now();
    let first = *frames.start();
    let file = |frame| {
        let only = (frames.start() == frames.end()).then(|| arguments.output.clone());
        numbered(&arguments.output, frame).or(only).ok_or_else(|| {
            let problem = format!("{}: all frames would be written to one file", arguments.output.display());
            Error::scene(problem, "put # into the file's name where the number is to be: out.####.png")
        })
    };
    file(first)?;
    let shots: Vec<Shot> =
        frames.clone().map(|frame| Shot::at(scene, f64::from(frame))).collect::<Result<_>>()?;
    let mut progress = Progress::new(arguments.progress, shots.len() as u64, "frames");
    let mut done = 0;
    let notes = micropoly::render_frames(scene, options, &shots, |number, rendering| {
        let path = file(first + number as u32)?;
        kind.save(&rendering, &path)?;
        done += 1;
        progress.update(done, || path.display().to_string());
        if number == 0 {
            tell(&rendering.notes);
        }
        Ok(())
    })?;
    progress.finish();
    tell(&notes);
    eprintln!("images        {done}, {}", arguments.output.display());
    eprintln!("seconds       {:.3}", start.elapsed().as_secs_f64());
    Ok(())
}

fn tell(notes: &[String]) {
    for note in notes {
        eprintln!("note: {note}");
    }
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
