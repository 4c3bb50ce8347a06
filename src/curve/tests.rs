//! Ribbons: how wide, where, which way round, and what is refused.

use fastrand::Rng;

use super::*;

fn between(random: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.f64()
}

fn random_points(random: &mut Rng, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| [0; 3].map(|_| between(random, -1.0, 1.0))).collect()
}

const HANDLE: f64 = 0.552_284_749_831;

fn quarter() -> Vec<[f64; 3]> {
    vec![[1.0, 0.0, 0.0], [1.0, HANDLE, 0.0], [HANDLE, 1.0, 0.0], [0.0, 1.0, 0.0]]
}

fn cubic(points: impl Fn(usize) -> DVec3, t: f64) -> [DVec3; 2] {
    let (p, s) = ([0, 1, 2, 3].map(points), 1.0 - t);
    let place = p[0] * (s * s * s) + p[1] * (3.0 * s * s * t) + p[2] * (3.0 * s * t * t) + p[3] * (t * t * t);
    let slope = (p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2.0 * s * t) + (p[3] - p[2]) * (t * t);
    [place, slope]
}

fn edge(patch: &BezierPatch, j: usize, t: f64) -> DVec3 {
    cubic(|i| DVec3::from_array(patch.points[4 * i + j].map(f64::from)), t)[0]
}

/// How far an edge is from where it should be, in widths, seen from where the line of sight is at least so many
/// degrees from the curve.
fn largest_error(points: &[[f64; 3]], angle: f64) -> f64 {
    let mut random = Rng::with_seed(1);
    let mut largest = 0.0_f64;
    let width = 0.1;
    for _ in 0..2000 {
        let eye = DVec3::from_array([0; 3].map(|_| between(&mut random, -4.0, 4.0)));
        let samples = (0..=50).map(|k| {
            let t = f64::from(k) / 50.0;
            let [place, slope] = cubic(|i| DVec3::from_array(points[i]), t);
            (t, place, (eye - place).normalize(), slope.normalize())
        });
        let samples: Vec<_> = samples.collect();
        let least = samples.iter().map(|&(_, _, view, slope)| view.cross(slope).length()).fold(1.0, f64::min);
        if least < libm::sin(angle.to_radians()) {
            continue;
        }
        let curve =
            Curve { points: points.to_vec(), widths: vec![width], basis: Basis::Bezier, is_periodic: false };
        let patch = curve.ribbons(eye.to_array()).expect("drawable")[0];
        for (t, place, view, slope) in samples {
            let wanted = view.cross(slope).normalize() * (0.5 * width);
            largest = largest.max((edge(&patch, 3, t) - place - wanted).length());
            largest = largest.max((edge(&patch, 0, t) - place + wanted).length());
        }
    }
    largest / width
}

#[test]
fn a_ribbon_is_as_wide_as_it_should_be_and_across_the_line_of_sight() {
    let eighth = halved(&quarter());
    for (points, angle, most) in
        [(quarter(), 60.0, 6e-3), (eighth.clone(), 60.0, 1e-3), (quarter(), 30.0, 6e-2), (eighth, 30.0, 1e-2)]
    {
        let error = largest_error(&points, angle);
        println!("{angle}° or more from the curve: off by {error:e} widths");
        assert!(error < most, "{angle}°: {error:e}");
    }
}

/// The first half of a segment (de Casteljau).
fn halved(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut rest: Vec<DVec3> = points.iter().map(|&point| point.into()).collect();
    let mut half = Vec::new();
    while let Some(&first) = rest.first() {
        half.push(first.to_array());
        rest = rest.windows(2).map(|pair| pair[0].midpoint(pair[1])).collect();
    }
    half
}

/// Bits of a border across the curve, the same for both directions.
fn border(patch: &BezierPatch, row: usize) -> [[u32; 3]; 4] {
    let points: [_; 4] = std::array::from_fn(|k| patch.points[4 * row + k].map(f32::to_bits));
    let [a, b, c, d] = points;
    points.min([d, c, b, a])
}

const ALL: [Basis; 5] = [Basis::Bezier, Basis::BSpline, Basis::CatmullRom, Basis::Hermite, Basis::Linear];

#[test]
fn segments_share_their_borders() {
    let mut random = Rng::with_seed(2);
    for (basis, is_periodic) in ALL.into_iter().flat_map(|basis| [(basis, false), (basis, true)]) {
        for _ in 0..100 {
            let count = if is_periodic { 6 * basis.step() } else { basis.window() + 5 * basis.step() };
            let points = random_points(&mut random, count);
            let ends = if is_periodic { 6 } else { 7 };
            let widths = (0..ends).map(|_| between(&mut random, 0.0, 0.1)).collect();
            let curve = Curve { points, widths, basis, is_periodic };
            let patches = curve.ribbons([3.0, 1.0, 2.0]).expect("drawable");
            assert_eq!(patches.len(), 6);
            for k in 0..if is_periodic { 6 } else { 5 } {
                assert_eq!(border(&patches[k], 3), border(&patches[(k + 1) % 6], 0), "{basis:?} {k}");
            }
        }
    }
}

#[test]
fn widths_are_those_of_the_segment_ends() {
    let points = (0..4).map(|k| [f64::from(k), 0.0, 0.0]).collect();
    let curve = Curve { points, widths: vec![0.1, 0.4, 0.0, 0.2], basis: Basis::Linear, is_periodic: false };
    let patches = curve.ribbons([1.5, 0.0, 9.0]).expect("drawable");
    for (patch, widths) in patches.iter().zip(curve.widths.windows(2)) {
        for t in [0.0, 0.25, 0.7, 1.0] {
            let width = (edge(patch, 3, t) - edge(patch, 0, t)).y;
            assert!((width - widths[0] - (widths[1] - widths[0]) * t).abs() < 1e-6);
        }
    }
}

#[test]
fn the_front_is_towards_the_eye() {
    let curve = Curve { points: quarter(), widths: vec![0.1], basis: Basis::Bezier, is_periodic: false };
    for eye in [[0.0, 0.0, 5.0], [0.0, 0.0, -5.0], [4.0, 1.0, 1.0]] {
        let patch = curve.ribbons(eye).expect("drawable")[0];
        let (u, v) =
            (edge(&patch, 0, 0.6) - edge(&patch, 0, 0.5), edge(&patch, 3, 0.5) - edge(&patch, 0, 0.5));
        assert!(u.cross(v).dot(DVec3::from_array(eye) - edge(&patch, 0, 0.5)) > 0.0);
    }
}

#[test]
fn curves_without_a_direction_have_ribbons_of_their_width_nevertheless() {
    let along_sight = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 3.0]];
    let hairpin = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]];
    let twice = [[0.0; 3], [0.0; 3], [1.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let through_the_eye = [[0.0, 0.0, 4.0], [0.0, 0.0, 5.0], [0.0, 0.0, 6.0], [0.0, 0.0, 7.0]];
    for points in [along_sight, [[1.0, 2.0, 3.0]; 4], hairpin, twice, through_the_eye] {
        for (basis, is_periodic) in ALL.into_iter().map(|basis| (basis, basis == Basis::Linear)) {
            let curve = Curve { points: points.to_vec(), widths: vec![0.1], basis, is_periodic };
            for patch in curve.ribbons([0.0, 0.0, 5.0]).expect("drawable") {
                assert!(patch.points.as_flattened().iter().all(|c| c.is_finite()));
                for end in [0.0, 1.0] {
                    let width = (edge(&patch, 3, end) - edge(&patch, 0, end)).length();
                    assert!((width - 0.1).abs() < 1e-6, "{basis:?} {points:?}: {width}");
                }
            }
        }
    }
}

/// A loop towards the eye: on screen the curve turns back in a cusp.
#[test]
fn where_a_curve_turns_back_along_the_line_of_sight_its_ribbon_does_not_cross_itself() {
    let points = vec![[-1.0, 0.0, 0.0], [0.5, 0.0, 1.0], [0.5, 0.01, 2.0], [-1.0, 0.02, 3.0]];
    let curve = Curve { points, widths: vec![0.2], basis: Basis::Bezier, is_periodic: false };
    let patch = curve.ribbons([0.0, 0.0, 9.0]).expect("drawable")[0];
    for k in 0..=20 {
        let t = f64::from(k) / 20.0;
        let width = (edge(&patch, 3, t) - edge(&patch, 0, t)).length();
        assert!((0.17..0.23).contains(&width), "{width} at {t}");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused_with_its_reason() {
    let refused = |count: usize, widths: &[f64], basis, is_periodic| {
        let mut points = random_points(&mut Rng::with_seed(3), count);
        if widths == [7.0] {
            points[1][2] = f64::NAN;
        }
        let curve = Curve { points, widths: widths.to_vec(), basis, is_periodic };
        curve.ribbons([0.0; 3]).expect_err("cannot be drawn")
    };
    assert_eq!(refused(5, &[1.0], Basis::Bezier, false), CurveError::Count { count: 5, window: 4, step: 3 });
    assert!(matches!(refused(0, &[1.0], Basis::Linear, true), CurveError::Count { .. }));
    assert!(matches!(refused(1, &[1.0], Basis::Linear, false), CurveError::Count { .. }));
    assert_eq!(refused(7, &[1.0; 2], Basis::Bezier, false), CurveError::Widths { found: 2, ends: 3 });
    assert_eq!(refused(6, &[], Basis::Bezier, true), CurveError::Widths { found: 0, ends: 2 });
    assert!(matches!(refused(4, &[-1.0], Basis::BSpline, false), CurveError::Width { index: 0, .. }));
    assert!(matches!(refused(4, &[f64::NAN], Basis::BSpline, false), CurveError::Width { index: 0, .. }));
    assert_eq!(refused(4, &[7.0], Basis::BSpline, false), CurveError::Point { index: 1 });
}
