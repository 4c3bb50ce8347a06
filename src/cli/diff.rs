//! `micropoly diff`.

use micropoly::diff::{ChannelDifference, Difference, Largest};
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
    let Difference { width, height, channels, different, failing, .. } = found;
    say!("pictures      {width}x{height}");
    for ChannelDifference { name, mean, rms, psnr, infinite, largest } in channels {
        let Some(Largest { x, y, first, second, .. }) = largest else {
            say!("{name:<14}no difference");
            continue;
        };
        let psnr = psnr.map_or(String::new(), |psnr| format!(" ({psnr:.2} dB)"));
        let infinite = if *infinite > 0 { format!(", {infinite} infinite") } else { String::new() };
        say!(
            "{name:<14}mean {mean:.9}, rms {rms:.9}{psnr}{infinite}; most at column {x}, row {y}: {first} and {second}"
        );
    }
    say!("different     {different} pixels");
    say!("failing       {failing} pixels, {:.4} %", found.failing_percent());
}
