//! Quadrics against their equations, their borders, and which way they face.

use fastrand::Rng;

use super::*;

const RADIUS: f64 = 3.0;

/// Position, and the derivatives along u and v, each in f64 of points in f32.
fn at(patch: &RationalPatch, [u, v]: [f64; 2]) -> [[f64; 3]; 3] {
    let basis = |t: f64| {
        let s = 1.0 - t;
        let values = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let slopes = [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t];
        [values, slopes]
    };
    let (a, b) = (basis(u), basis(v));
    let sum = |i: usize, j: usize| {
        let mut sum = [0.0; 4];
        for k in 0..16 {
            let share = a[i][k / 4] * b[j][k % 4] * f64::from(patch.weights[k]);
            let [x, y, z] = patch.points[k].map(f64::from);
            sum = std::array::from_fn(|c| sum[c] + share * [x, y, z, 1.0][c]);
        }
        sum
    };
    let (point, along_u, along_v) = (sum(0, 0), sum(1, 0), sum(0, 1));
    let place = [0, 1, 2].map(|c| point[c] / point[3]);
    let slope = |d: [f64; 4]| [0, 1, 2].map(|c| (d[c] - place[c] * d[3]) / point[3]);
    [place, slope(along_u), slope(along_v)]
}

fn normal(along_u: [f64; 3], along_v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        along_u[a] * along_v[b] - along_u[b] * along_v[a]
    })
}

/// One of each kind, with the function that is 0 on it and grows outwards, as a length near the surface.
type Case = (Quadric, fn([f64; 3]) -> f64);

fn out([x, y, _]: [f64; 3]) -> f64 {
    (x * x + y * y).sqrt()
}

fn cases(theta_max: f64) -> Vec<Case> {
    let one = [2.0, -1.0, -1.0];
    let two = [2.0, 1.0, 3.0];
    vec![
        (Quadric::Sphere { radius: RADIUS, z_min: -3.0, z_max: 3.0, theta_max }, |p| {
            out(p).hypot(p[2]) - RADIUS
        }),
        (Quadric::Sphere { radius: -RADIUS, z_min: 2.9, z_max: -1.2, theta_max }, |p| {
            out(p).hypot(p[2]) - RADIUS
        }),
        (Quadric::Cylinder { radius: RADIUS, z_min: 2.0, z_max: -1.0, theta_max }, |p| out(p) - RADIUS),
        (Quadric::Cone { height: 2.0, radius: RADIUS, theta_max }, |p| out(p) - RADIUS * (1.0 - p[2] / 2.0)),
        (Quadric::Cone { height: -2.0, radius: RADIUS, theta_max }, |p| out(p) - RADIUS * (1.0 + p[2] / 2.0)),
        (
            Quadric::Torus {
                major_radius: RADIUS,
                minor_radius: 1.0,
                phi_min: 0.0,
                phi_max: 360.0,
                theta_max,
            },
            |p| (out(p) - RADIUS).hypot(p[2]) - 1.0,
        ),
        (
            Quadric::Torus {
                major_radius: RADIUS,
                minor_radius: 1.0,
                phi_min: 250.0,
                phi_max: 190.0,
                theta_max,
            },
            |p| (out(p) - RADIUS).hypot(p[2]) - 1.0,
        ),
        (Quadric::Disk { height: 0.7, radius: RADIUS, theta_max }, |p| p[2] - 0.7),
        // x² + y² = 4 + (z − 1)² / 4
        (Quadric::Hyperboloid { point1: one, point2: two, theta_max }, |p| {
            out(p) - (4.0 + (p[2] - 1.0) * (p[2] - 1.0) / 4.0).sqrt()
        }),
        (Quadric::Hyperboloid { point1: two, point2: one, theta_max }, |p| {
            out(p) - (4.0 + (p[2] - 1.0) * (p[2] - 1.0) / 4.0).sqrt()
        }),
        (Quadric::Hyperboloid { point1: [1.0, 0.0, 0.5], point2: [3.0, 1.0, 0.5], theta_max }, |p| {
            p[2] - 0.5
        }),
        (Quadric::Paraboloid { r_max: RADIUS, z_min: 0.0, z_max: 2.0, theta_max }, |p| {
            out(p) - RADIUS * (p[2] / 2.0).max(0.0).sqrt()
        }),
        (Quadric::Paraboloid { r_max: RADIUS, z_min: -3.0, z_max: -2.0, theta_max }, |p| {
            out(p) - RADIUS * (p[2] / -2.0).max(0.0).sqrt()
        }),
    ]
}

#[test]
fn every_point_is_on_the_surface_and_its_front_is_outside() {
    let mut random = Rng::with_seed(1);
    let mut largest = 0.0_f64;
    for theta_max in [360.0, -360.0, 270.0, 100.0, -33.0, 1000.0] {
        for (quadric, outside) in cases(theta_max) {
            for patch in quadric.patches().expect("drawable") {
                for _ in 0..100 {
                    let inner = [0.05 + 0.9 * random.f64(), 0.05 + 0.9 * random.f64()];
                    let [place, along_u, along_v] = at(&patch, inner);
                    largest = largest.max(outside(place).abs());
                    assert!(outside(place).abs() < 1e-6 * RADIUS, "{quadric:?} at {place:?}");
                    let n = normal(along_u, along_v);
                    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
                    let further = [0, 1, 2].map(|k| place[k] + 1e-3 * n[k] / length);
                    assert!(outside(further) > 1e-4, "{quadric:?} at {place:?} faces {n:?}");
                }
            }
        }
    }
    println!("largest distance from a surface {:e} of the radius", largest / RADIUS);
}

/// Angles and z of what is drawn, by the corners of its patches.
#[test]
fn parts_end_where_they_should() {
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-5, "{a} is not {b}");
    let patches = Quadric::Sphere { radius: RADIUS, z_min: -1.5, z_max: 2.0, theta_max: 100.0 }.patches();
    let patches = patches.expect("drawable");
    assert_eq!(patches.len(), 2, "41.8° + 30° upwards are one piece, 100° around two");
    let (first, last) = (patches[0].points[0].map(f64::from), patches[1].points[15].map(f64::from));
    close(first[2], -1.5);
    close(last[2], 2.0);
    close(libm::atan2(first[1], first[0]), 0.0);
    close(libm::atan2(last[1], last[0]).to_degrees(), 100.0);
    let ring = Quadric::Torus {
        major_radius: 3.0,
        minor_radius: 1.0,
        phi_min: 90.0,
        phi_max: 180.0,
        theta_max: 90.0,
    };
    let points = ring.patches().expect("drawable")[0].points;
    assert_eq!([points[0], points[3]], [[3.0, 0.0, 1.0], [2.0, 0.0, 0.0]]);
    assert_eq!([points[12], points[15]], [[0.0, 3.0, 1.0], [0.0, 2.0, 0.0]]);
}

type Border = [[u32; 4]; 4];

/// The sides of a patch, all counter-clockwise seen from the front; those that are points are left out.
fn borders(patch: &RationalPatch) -> Vec<Border> {
    let bits = |k: usize| {
        let [x, y, z] = patch.points[k].map(f32::to_bits);
        [x, y, z, patch.weights[k].to_bits()]
    };
    let sides = [[0, 4, 8, 12], [12, 13, 14, 15], [15, 11, 7, 3], [3, 2, 1, 0]].map(|side| side.map(bits));
    sides.into_iter().filter(|side| side.iter().any(|point| point[..3] != side[0][..3])).collect()
}

/// Borders that no other one runs back along.
fn open_borders(quadric: Quadric) -> usize {
    let mut all: Vec<Border> = quadric.patches().expect("drawable").iter().flat_map(borders).collect();
    all.sort_unstable();
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]), "{quadric:?}: a border is there twice");
    let backwards = |[a, b, c, d]: Border| [d, c, b, a];
    all.iter().filter(|&&border| all.binary_search(&backwards(border)).is_err()).count()
}

#[test]
fn closed_quadrics_are_watertight_and_others_open_at_their_rims_only() {
    // Those of cases(), turned fully: quarters of rims.
    let open = [0, 8, 8, 4, 4, 0, 8, 4, 8, 8, 8, 4, 8];
    for theta_max in [360.0, -360.0, 720.0] {
        for ((quadric, _), open) in cases(theta_max).into_iter().zip(open) {
            assert_eq!(open_borders(quadric), open, "{quadric:?}");
        }
    }
    let odd = Quadric::Sphere { radius: 0.1, z_min: -0.1, z_max: 0.1, theta_max: 360.0 };
    assert_eq!(open_borders(odd), 0);
    let half = Quadric::Sphere { radius: 0.1, z_min: -0.1, z_max: 0.1, theta_max: 180.0 };
    assert_eq!(open_borders(half), 4);
}

#[test]
fn poles_and_tips_are_one_point() {
    for (quadric, _) in cases(360.0) {
        let tips: Vec<[u32; 3]> = quadric
            .patches()
            .expect("drawable")
            .iter()
            .flat_map(|patch| patch.points)
            .filter(|point| point[0].abs() < 1e-6 && point[1].abs() < 1e-6)
            .map(|point| point.map(f32::to_bits))
            .collect();
        assert!(tips.iter().all(|tip| tip[..2] == [0, 0]), "{quadric:?}");
    }
    let sphere = cases(360.0)[0].0.patches().expect("drawable");
    assert_eq!([sphere[0].points[0], sphere[1].points[3]], [[0.0, 0.0, -3.0], [0.0, 0.0, 3.0]]);
    let at_poles =
        sphere.iter().flat_map(|patch| patch.points).filter(|p| p[0] == 0.0 && p[1] == 0.0).count();
    assert_eq!(at_poles, 8 * 4);
}

#[test]
fn what_leaves_nothing_is_refused_with_its_reason() {
    let sphere =
        |radius, z_min, z_max, theta_max| Quadric::Sphere { radius, z_min, z_max, theta_max }.patches();
    assert_eq!(sphere(0.0, -1.0, 1.0, 360.0), Err(QuadricError::Zero { name: "radius" }));
    assert_eq!(sphere(1.0, -1.0, 1.0, 0.0), Err(QuadricError::Zero { name: "theta_max" }));
    assert!(matches!(sphere(1.0, 0.5, 0.5, 360.0), Err(QuadricError::Empty { .. })));
    assert!(matches!(sphere(1.0, 1.5, 2.5, 360.0), Err(QuadricError::Empty { from: 1.5, to: 2.5, .. })));
    assert!(matches!(
        sphere(f64::NAN, -1.0, 1.0, 360.0),
        Err(QuadricError::NotFinite { name: "radius", .. })
    ));
    assert!(matches!(sphere(1.0, -1.0, 1e99, 360.0), Err(QuadricError::NotFinite { name: "z_max", .. })));
    let bowl = |z_min, z_max| Quadric::Paraboloid { r_max: 1.0, z_min, z_max, theta_max: 360.0 }.patches();
    assert_eq!(bowl(-1.0, 1.0), Err(QuadricError::Apex { z_min: -1.0, z_max: 1.0 }));
    assert_eq!(bowl(0.0, 0.0), Err(QuadricError::Zero { name: "z_max" }));
    assert!(matches!(bowl(1.0, 1.0), Err(QuadricError::Empty { .. })));
    let line = Quadric::Hyperboloid { point1: [1.0; 3], point2: [1.0; 3], theta_max: 360.0 };
    assert!(matches!(line.patches(), Err(QuadricError::Zero { .. })));
}
