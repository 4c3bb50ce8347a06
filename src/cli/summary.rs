//! What a rendering took, on one screen.

use std::fmt::Write;
use std::path::Path;

use bytesize::ByteSize;
use micropoly::stats::{LoadStats, RootStats, Stats, Surfaces};

fn stack(surfaces: &Surfaces) -> String {
    let most = match surfaces.stack_bound {
        Some(bound) => format!("{} surfaces at most, proven bound {bound}", surfaces.max_stack),
        None => format!("{} surfaces at most, without a bound", surfaces.max_stack),
    };
    match surfaces.load {
        Some(LoadStats { groups, least, most: busiest, .. }) => {
            let groups = if groups == 1 { "1 group".to_owned() } else { format!("{groups} groups") };
            format!("{most}; {groups}, {least} to {busiest} bounded by each")
        }
        None => most,
    }
}

fn patches(stats: &Stats) -> String {
    let RootStats { taken, outside, hidden, waves } = stats.roots;
    if waves == 0 {
        return stats.patches.to_string();
    }
    format!("{}: {taken} taken in {waves} waves, {outside} outside, {hidden} hidden", stats.patches)
}

/// The summary as text.
pub(crate) fn of(stats: &Stats, output: &Path) -> String {
    let surfaces = &stats.surfaces;
    let seconds = &stats.seconds;
    let ms = |seconds: f64| format!("{:.1}", seconds * 1e3);
    let rows = [
        ("image", format!("{} ({}x{})", output.display(), stats.options.width, stats.options.height)),
        ("device", stats.device.clone()),
        ("patches", patches(stats)),
        (
            "surfaces",
            format!(
                "{} processed, {} drawn, {} culled, {} depth-limited",
                surfaces.processed, surfaces.drawn, surfaces.culled, surfaces.depth_limited
            ),
        ),
        ("micropolygons", stats.micropolygons.to_string()),
        ("stack", stack(surfaces)),
        ("memory", ByteSize(stats.bytes_allocated).display().iec().to_string()),
        (
            "milliseconds",
            format!(
                "load {}, setup {}, cull {}, bound {}, split {}, draw {}, resolve {}, encode {}, total {}",
                ms(seconds.load),
                ms(seconds.setup),
                ms(seconds.cull),
                ms(seconds.bound),
                ms(seconds.split),
                ms(seconds.draw),
                ms(seconds.resolve),
                ms(seconds.encode),
                ms(seconds.total)
            ),
        ),
        ("image hash", stats.image_hash.clone()),
    ];
    rows.iter().fold(String::new(), |mut text, (name, value)| {
        let _ = writeln!(text, "{name:<14}{value}");
        text
    })
}
