//! What the flatness oracle draws is as near to the surface on screen as the tolerance says.

mod common;

use common::{exact_point, random, random_gregory, random_patch, random_view};
use micropoly_core::abi::{Draw, FLAG_FLAT, Frame, Object, Patch};
use micropoly_core::kernel::dice_gregory::evaluate_gregory;
use micropoly_core::patch::{Faces, Net};
use micropoly_core::schedule::for_each_draw;

/// In pixels.
const TOLERANCE: f32 = 0.5;

/// A view of a patch that is to be flat.
struct Case {
    frame: Frame,
    object: Object,
    patches: Vec<Patch>,
    net: Net,
}

impl Case {
    fn new(random: &mut fastrand::Rng, is_gregory: bool) -> Self {
        let rough = [0.05, 0.4, 1.5][random.usize(0..3)];
        let patches = if is_gregory {
            random_gregory(random, rough, 0.1).to_vec()
        } else {
            vec![random_patch(random, rough)]
        };
        let (mut frame, object) = random_view(random, 0.05);
        frame.flags |= FLAG_FLAT;
        (frame.bound, frame.rate, frame.density) = (TOLERANCE, 1, 1.0);
        Self { net: Net::in_eye_space(&patches[0], &object), frame, object, patches }
    }

    fn draws(&self) -> Vec<Draw> {
        let mut draws = Vec::new();
        for_each_draw(&self.frame, &[self.object], &self.patches, 0, |draw, is_limited| {
            assert!(!is_limited, "more levels are needed");
            draws.push(draw);
        });
        draws
    }

    /// The surface at a parameter, in units of 2⁻²⁴.
    fn point(&self, u: f64, v: f64) -> [f64; 3] {
        if self.patches[0].faces == 0 {
            return exact_point(&self.net, u / f64::from(1 << 24), v / f64::from(1 << 24));
        }
        let faces = Faces::in_eye_space(&self.patches[1], &self.object);
        evaluate_gregory(&self.net, &faces, &self.frame, u as u32, v as u32).point.map(f64::from)
    }

    /// In pixels; none of what is nearer than the near plane, or out of the image.
    fn on_screen(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let scale = f64::from(self.frame.focal) / -point[2];
        let at = [point[0] * scale, point[1] * scale];
        let is_seen = at[0].abs() <= 320.0 && at[1].abs() <= 180.0;
        (-point[2] > f64::from(self.frame.near) && is_seen).then_some(at)
    }
}

/// The largest distance on screen between random points of what is drawn and the same points of the surface, and how many
/// there were.
fn largest_error(random: &mut fastrand::Rng, case: &Case, points: usize) -> (f64, usize) {
    let (mut most, mut count) = (0.0_f64, 0);
    let draws = case.draws();
    for _ in 0..if draws.is_empty() { 0 } else { points } {
        let draw = draws[random.usize(0..draws.len())];
        let [a, b, d, c] = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[row, column]| draw.vertex(row, column));
        let corners =
            if random.bool() { [a, b, c] } else { [a, c, d] }.map(|[u, v]| [f64::from(u), f64::from(v)]);
        let (mut s, mut t) = (random.f64(), random.f64());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let mix = |x: [f64; 3]| x[0] * (1.0 - s - t) + x[1] * s + x[2] * t;
        let ends = corners.map(|[u, v]| case.point(u, v));
        let flat = [0, 1, 2].map(|k| mix([ends[0][k], ends[1][k], ends[2][k]]));
        let curved = case.point(mix(corners.map(|c| c[0])), mix(corners.map(|c| c[1])));
        if let (Some(flat), Some(curved)) = (case.on_screen(flat), case.on_screen(curved)) {
            most = most.max((flat[0] - curved[0]).hypot(flat[1] - curved[1]));
            count += 1;
        }
    }
    (most, count)
}

#[test]
fn nothing_is_farther_from_the_surface_than_the_tolerance() {
    for is_gregory in [false, true] {
        let mut random = random(61);
        let (mut most, mut count) = (0.0_f64, 0);
        for round in 0..150 {
            let case = Case::new(&mut random, is_gregory);
            let (error, points) = largest_error(&mut random, &case, 2000);
            assert!(error <= f64::from(TOLERANCE), "round {round}, Gregory {is_gregory}: {error}");
            (most, count) = (most.max(error), count + points);
        }
        assert!(count >= 100_000 && most > 0.1, "{count} points, {most}");
    }
}

#[test]
fn a_plane_is_one_micropolygon_however_it_is_seen() {
    let (mut random, mut drawn) = (random(62), 0);
    for round in 0..100 {
        let mut case = Case::new(&mut random, false);
        let mut patch = random_patch(&mut random, 0.0);
        patch.z = [0.0; 16];
        case.patches = vec![patch];
        let count = case.draws().len();
        assert!(count <= 1, "round {round}: {count}");
        drawn += count;
    }
    assert!(drawn > 30, "{drawn}");
}
