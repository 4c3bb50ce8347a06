//! `micropoly diff`.

use micropoly::diff::{Difference, Largest};
use micropoly::{Picture, Result};

use super::args::DiffArguments;
use super::render::write_json;

/// Compares two pictures; do they differ by no more than is allowed?
pub(crate) fn run(arguments: &DiffArguments) -> Result<bool> {
    let (first, second) = (Picture::load(&arguments.first)?, Picture::load(&arguments.second)?);
    let thresholds = arguments.thresholds();
    let found = Difference::of(&first, &second, &thresholds)?;
    if let Some(path) = &arguments.heat {
        found.heat(arguments.white).save_png(path)?;
    }
    match &arguments.json {
        Some(path) => write_json(path, &found)?,
        None => print(&found),
    }
    Ok(found.is_within(&thresholds))
}

fn print(found: &Difference) {
    let Difference { width, height, channels, mean, rms, largest, different, failing, .. } = found;
    say!("pictures      {width}x{height}, channels {}", channels.join(", "));
    say!("mean error    {mean:.9}");
    let psnr = found.psnr.map_or(String::new(), |psnr| format!(", {psnr:.2} dB"));
    say!("rms error     {rms:.9}{psnr}");
    if let Some(Largest { x, y, channel, first, second, difference }) = largest {
        say!("largest       {difference:.9} at column {x}, row {y}, channel {channel}: {first} and {second}");
    }
    say!("different     {different} pixels");
    say!("failing       {failing} pixels, {:.4} %", found.failing_percent());
}
