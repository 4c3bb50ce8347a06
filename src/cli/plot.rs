//! The plots of `micropoly bench`, as SVG: Weber 2014, Fig. 7.1 and Fig. 7.2.

use std::ops::Range;
use std::path::Path;

use micropoly::bench::Row;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::{
    ChartBuilder, Circle, DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, IntoLogRange, LineSeries,
    Palette, Palette99, PathElement, SVGBackend, Text, WHITE,
};
use plotters::style::{Color, RGBAColor, TRANSPARENT};

use super::bench::short;

/// Size of a plot in pixels.
const SIZE: (u32, u32) = (800, 500);
/// Space for the numbers and the name of the vertical axis, in pixels.
const LEFT: i32 = 64;
/// Height of a line of the legend in pixels.
const LEGEND_LINE: i32 = 20;
/// Length of a curve's sample in the legend in pixels.
const SAMPLE: i32 = 24;
/// Room for a character of a name in the legend, in pixels: more than any takes at that size.
const CHARACTER: i32 = 8;
/// Size of the letters of the legend.
const LETTERS: i32 = 14;

type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A curve, and what it is called.
struct Curve {
    name: String,
    points: Vec<(f64, f64)>,
}

/// What stands around the curves.
struct Texts<'a> {
    caption: String,
    x: &'a str,
    y: &'a str,
}

/// Fig. 7.2: rate over memory of the first scene on its first device, a curve a scheduler.
pub(super) fn rate_over_memory(path: &Path, rows: &[Row]) -> Drawn {
    let Some((caption, own)) = first(rows) else { return Ok(()) };
    let curves = curves(&own, |row| row.scheduler.to_owned(), |row| (row.memory as f64 / 1024.0, row.rate));
    let (memory, rates) = ranges(&curves);
    let texts = Texts { caption, x: "memory, KiB", y: "million surfaces a second" };
    draw(
        path,
        &texts,
        (memory.start * 0.8..memory.end * 1.25).log_scale().base(2.0),
        0.0..rates.end * 1.1,
        &curves,
    )
}

/// Fig. 7.1: memory over frames of the first scene on its first device, a curve a scheduler and batch.
pub(super) fn memory_over_frames(path: &Path, rows: &[Row]) -> Drawn {
    let Some((caption, own)) = first(rows) else { return Ok(()) };
    let has_batches = own.iter().any(|row| {
        row.batch > 0 && own.iter().any(|other| other.scheduler == row.scheduler && other.batch != row.batch)
    });
    let name = |row: &Row| match row.batch {
        batch if batch > 0 && has_batches => format!("{} {batch}", row.scheduler),
        _ => row.scheduler.to_owned(),
    };
    let mebibytes = |row: &Row| row.memory as f64 / f64::from(1 << 20);
    let curves = curves(&own, name, |row| (row.frame.unwrap_or_default(), mebibytes(row)));
    let (frames, memory) = ranges(&curves);
    let texts = Texts { caption, x: "frame", y: "memory, MiB" };
    draw(path, &texts, frames.start..frames.end.max(frames.start + 1.0), 0.0..memory.end * 1.1, &curves)
}

/// The rows of the first scene on its first device, and what to call them.
fn first(rows: &[Row]) -> Option<(String, Vec<&Row>)> {
    let first = rows.first()?;
    let own = rows.iter().filter(|row| row.scene == first.scene && row.device == first.device).collect();
    let view = match rows.iter().all(|row| row.frame == first.frame).then_some(first.frame).flatten() {
        Some(frame) => format!(" at frame {frame}"),
        None => String::new(),
    };
    Some((format!("{}{view} on {}", short(&first.scene), first.device), own))
}

/// A curve for each name, in the order in which the names come.
fn curves(rows: &[&Row], name: impl Fn(&Row) -> String, point: impl Fn(&Row) -> (f64, f64)) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in rows {
        let name = name(row);
        match curves.iter_mut().find(|curve| curve.name == name) {
            Some(curve) => curve.points.push(point(row)),
            None => curves.push(Curve { name, points: vec![point(row)] }),
        }
    }
    curves
}

/// The ranges of all points.
fn ranges(curves: &[Curve]) -> (Range<f64>, Range<f64>) {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold(f64::INFINITY..f64::MIN_POSITIVE, |range, value| {
            range.start.min(value)..range.end.max(value)
        })
    };
    (range(&mut points().map(|point| point.0)), range(&mut points().map(|point| point.1)))
}

/// Colours of the palette but its yellow, which is hard to see on white.
fn colour(index: usize) -> RGBAColor {
    const YELLOW: usize = 2;
    Palette99::pick(index + usize::from(index >= YELLOW)).to_rgba()
}

/// A number at an axis, without the digits that only rounding makes.
fn number(value: f64) -> String {
    ((value * 1000.0).round() / 1000.0).to_string()
}

fn draw<X>(path: &Path, texts: &Texts<'_>, x: X, y: Range<f64>, curves: &[Curve]) -> Drawn
where
    X: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
{
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let below = legend(&area.titled(&texts.caption, ("sans-serif", 18))?, curves)?;
    let mut chart = ChartBuilder::on(&below)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(LEFT)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(texts.x)
        .y_desc(texts.y)
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|value| number(*value))
        .y_label_formatter(&|value| number(*value))
        .draw()?;
    for (index, curve) in curves.iter().enumerate() {
        let points = || curve.points.iter().copied();
        chart.draw_series(LineSeries::new(points(), colour(index).stroke_width(2)))?;
        chart.draw_series(points().map(|point| Circle::new(point, 3, colour(index).filled())))?;
    }
    area.present()
}

/// Names the curves in lines of their own, where they hide nothing; gives the area below.
fn legend<'a>(area: &Area<'a>, curves: &[Curve]) -> Result<Area<'a>, DrawingAreaErrorKind<std::io::Error>> {
    let longest = curves.iter().map(|curve| curve.name.len()).max().unwrap_or(0) as i32;
    let slot = SAMPLE + 8 + CHARACTER * longest + 16;
    let a_line = ((SIZE.0 as i32 - 2 * LEFT) / slot).max(1);
    let lines = (curves.len() as i32 + a_line - 1) / a_line;
    let (legend, below) = area.split_vertically(8 + lines * LEGEND_LINE);
    for (index, curve) in curves.iter().enumerate() {
        let (column, line) = (index as i32 % a_line, index as i32 / a_line);
        let (left, middle) = (LEFT + column * slot, 8 + line * LEGEND_LINE + LEGEND_LINE / 2);
        let sample = [(left, middle), (left + SAMPLE, middle)];
        legend.draw(&PathElement::new(sample, colour(index).stroke_width(2)))?;
        legend.draw(&Circle::new((left + SAMPLE / 2, middle), 3, colour(index).filled()))?;
        let place = (left + SAMPLE + 8, middle - LETTERS / 2);
        legend.draw(&Text::new(curve.name.as_str(), place, ("sans-serif", LETTERS)))?;
    }
    Ok(below)
}
