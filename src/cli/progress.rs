//! Progress on standard error, once a rendering takes long enough to wonder.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle as BarStyle};
use micropoly::Counts;

use super::args::ProgressStyle;

/// Shorter renderings show nothing.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two plain lines.
const PLAIN_INTERVAL: Duration = Duration::from_secs(2);

pub(crate) struct Progress {
    style: ProgressStyle,
    patches: u64,
    start: Instant,
    last_line: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(style: ProgressStyle, patches: u64) -> Self {
        let now = Instant::now();
        Self { style, patches, start: now, last_line: now, bar: None }
    }

    /// Shows how many patches have been worked on, if it is time to.
    pub(crate) fn update(&mut self, counts: &Counts) {
        if self.style == ProgressStyle::None || self.start.elapsed() < PATIENCE {
            return;
        }
        let begun = counts.roots_taken;
        if self.style == ProgressStyle::Auto && std::io::stderr().is_terminal() {
            let bar = self.bar.get_or_insert_with(|| bar(self.patches));
            bar.set_position(begun);
            bar.set_message(format!("{} surfaces", counts.processed));
        } else if self.last_line.elapsed() >= PLAIN_INTERVAL {
            self.last_line = Instant::now();
            eprintln!("{begun} of {} patches begun, {} surfaces", self.patches, counts.processed);
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

fn bar(patches: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(patches), ProgressDrawTarget::stderr());
    if let Ok(style) = BarStyle::with_template("{bar:32} {pos}/{len} patches  {msg}  {elapsed}, {eta} left") {
        bar.set_style(style);
    }
    bar
}
