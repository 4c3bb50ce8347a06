//! Progress on standard error, once a rendering takes long enough to wonder.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle as BarStyle};

use super::args::ProgressStyle;

/// Shorter renderings show nothing.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two plain lines.
const PLAIN_INTERVAL: Duration = Duration::from_secs(2);

pub(crate) struct Progress {
    style: ProgressStyle,
    total: u64,
    unit: &'static str,
    start: Instant,
    last_line: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Of so many patches or frames.
    pub(crate) fn new(style: ProgressStyle, total: u64, unit: &'static str) -> Self {
        let now = Instant::now();
        Self { style, total, unit, start: now, last_line: now, bar: None }
    }

    /// Shows how many have been worked on, if it is time to.
    pub(crate) fn update(&mut self, begun: u64, message: impl Fn() -> String) {
        if self.style == ProgressStyle::None || self.start.elapsed() < PATIENCE {
            return;
        }
        if self.style == ProgressStyle::Auto && std::io::stderr().is_terminal() {
            let bar = self.bar.get_or_insert_with(|| bar(self.total, self.unit));
            bar.set_position(begun);
            bar.set_message(message());
        } else if self.last_line.elapsed() >= PLAIN_INTERVAL {
            self.last_line = Instant::now();
            eprintln!("{begun} of {} {}: {}", self.total, self.unit, message());
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: u64, unit: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    let template = format!("{{bar:32}} {{pos}}/{{len}} {unit}  {{msg}}  {{elapsed}}, {{eta}} left");
    if let Ok(style) = BarStyle::with_template(&template) {
        bar.set_style(style);
    }
    bar
}
