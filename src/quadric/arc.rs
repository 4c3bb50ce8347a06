//! Arcs as rational cubics, and surfaces of revolution.

use crate::nurbs::{Homogeneous, Net, joined, raised};

/// Sine and cosine of degrees; exact for quarter turns, and the same after whole turns.
fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let quarters = (degrees / 90.0).round();
    let (sine, cosine) = libm::sincos((degrees - 90.0 * quarters).to_radians());
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// An arc of the unit circle in cubic pieces of at most 90°: x·w, y·w and w of their control points, in a row.
pub(super) fn arc(start: f64, sweep: f64) -> Vec<[f64; 3]> {
    let pieces = (sweep.abs() / 90.0).ceil().max(1.0);
    let on_circle = |place: f64| {
        let (sine, cosine) = sine_and_cosine(start + sweep * place / pieces);
        [cosine, sine, 0.0, 1.0]
    };
    // The middle point of a quadratic arc: times its weight, it is on the circle.
    let (_, weight) = sine_and_cosine(0.5 * sweep / pieces);
    let middle = |place: f64| {
        let [x, y, z, _] = on_circle(place);
        [x, y, z, weight]
    };
    let piece = |k: f64| raised(&[on_circle(k), middle(k + 0.5), on_circle(k + 1.0)]);
    let chain = joined((0..pieces as u32).map(|k| piece(f64::from(k))));
    chain.into_iter().map(|[x, y, _, w]| [x, y, w]).collect()
}

/// A profile turned about z.
pub(super) fn revolved(profile: &[Homogeneous], sweep: f64) -> Net {
    let around = arc(0.0, sweep);
    let points = around.iter().flat_map(|&[c, s, turned]| {
        profile.iter().map(move |&[x, y, z, w]| [x * c - y * s, x * s + y * c, z * turned, w * turned])
    });
    Net { counts: [around.len(), profile.len()], points: points.collect() }
}
