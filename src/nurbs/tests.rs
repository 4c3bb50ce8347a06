//! Splines against the recursion of Cox and de Boor, bits of shared borders, and what is refused.

use fastrand::Rng;

use super::*;

/// N_{i,p}(t) as Cox and de Boor define it, 0/0 = 0; at the last knot the last span counts.
fn basis_function(knots: &[f64], degree: usize, i: usize, t: f64) -> f64 {
    if degree == 0 {
        let last = knots[knots.len() - 1];
        let is_end = t == last && knots[i + 1] == last && knots[i] < last;
        return f64::from(u8::from(knots[i] <= t && t < knots[i + 1] || is_end));
    }
    let ratio = |a: f64, b: f64| if b == 0.0 { 0.0 } else { a / b };
    let rising = ratio(t - knots[i], knots[i + degree] - knots[i]);
    let falling = ratio(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1]);
    rising * basis_function(knots, degree - 1, i, t) + falling * basis_function(knots, degree - 1, i + 1, t)
}

fn projected([x, y, z, w]: Homogeneous) -> [f64; 3] {
    [x / w, y / w, z / w]
}

fn de_boor(surface: &Nurbs, t: [f64; 2]) -> [f64; 3] {
    let counts = [0, 1].map(|k| surface.knots[k].len() - surface.degree[k] - 1);
    let shares = [0, 1].map(|k| {
        let share = |i| basis_function(&surface.knots[k], surface.degree[k], i, t[k]);
        (0..counts[k]).map(share).collect::<Vec<_>>()
    });
    let mut sum = [0.0; 4];
    for (index, &[x, y, z, w]) in surface.points.iter().enumerate() {
        let share = shares[0][index / counts[1]] * shares[1][index % counts[1]];
        sum = std::array::from_fn(|k| sum[k] + share * [x * w, y * w, z * w, w][k]);
    }
    projected(sum)
}

fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// A point of 16 points and weights, not multiplied.
fn bezier_at(points: impl Fn(usize) -> [f64; 4], [u, v]: [f64; 2]) -> [f64; 3] {
    let (a, b) = (bernstein(u), bernstein(v));
    let mut sum = [0.0; 4];
    for k in 0..16 {
        let ([x, y, z, w], share) = (points(k), a[k / 4] * b[k % 4]);
        sum = std::array::from_fn(|k| sum[k] + share * [x * w, y * w, z * w, w][k]);
    }
    projected(sum)
}

pub(super) fn rounded_at(patch: &RationalPatch, t: [f64; 2]) -> [f64; 3] {
    let point = |k: usize| {
        let [x, y, z] = patch.points[k].map(f64::from);
        [x, y, z, f64::from(patch.weights[k])]
    };
    bezier_at(point, t)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

fn between(random: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.f64()
}

/// Random knots, clamped or not, some of them repeated.
fn random_knots(random: &mut Rng, degree: usize, count: usize) -> Vec<f64> {
    let is_clamped = random.bool();
    let mut knots = vec![between(random, -3.0, 3.0)];
    let mut repeated = 1;
    while knots.len() < count + degree + 1 {
        let last = knots[knots.len() - 1];
        let is_end = knots.len() <= degree || knots.len() > count;
        let most = if is_end { degree + 1 } else { degree };
        let again = if is_clamped && is_end { knots.len() != count } else { random.u8(0..3) == 0 };
        let repeats = again && repeated < most;
        repeated = if repeats { repeated + 1 } else { 1 };
        knots.push(if repeats { last } else { last + between(random, 0.01, 2.0) });
    }
    knots
}

fn random_surface(random: &mut Rng) -> Nurbs {
    loop {
        let degree = [random.usize(1..4), random.usize(1..4)];
        let counts = degree.map(|degree| degree + 1 + random.usize(0..6));
        let knots = [0, 1].map(|k| random_knots(random, degree[k], counts[k]));
        let domain = [0, 1].map(|k| [knots[k][degree[k]], knots[k][counts[k]]]);
        if domain.iter().any(|[low, high]| low >= high) {
            continue;
        }
        let range = domain.map(|[low, high]| {
            if random.bool() {
                return [low, high];
            }
            let (a, b) = (between(random, low, high), between(random, low, high));
            [a.min(b), a.max(b)]
        });
        let is_rational = random.bool();
        let mut point = || {
            let weight = if is_rational { between(random, 0.2, 5.0) } else { 1.0 };
            [between(random, -1.0, 1.0), between(random, -1.0, 1.0), between(random, -1.0, 1.0), weight]
        };
        let points = (0..counts[0] * counts[1]).map(|_| point()).collect();
        return Nurbs { degree, knots, points, range };
    }
}

/// The pieces that a range falls into at the knots, found without the code under test.
fn pieces(knots: &[f64], [start, end]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut ends = vec![start];
    ends.extend(knots.iter().filter(|&&knot| start < knot && knot < end));
    ends.push(end);
    ends.dedup();
    ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

#[test]
fn patches_are_the_surface_that_de_boor_defines() {
    let mut random = Rng::with_seed(1);
    let (mut exact, mut rounded) = (0.0_f64, 0.0_f64);
    for _ in 0..400 {
        let surface = random_surface(&mut random);
        let net = surface.net().and_then(Net::finished).expect("drawable");
        let patches = surface.patches().expect("drawable");
        let pieces = [0, 1].map(|k| pieces(&surface.knots[k], surface.range[k]));
        assert_eq!(patches.len(), pieces[0].len() * pieces[1].len(), "{surface:?}");
        for _ in 0..40 {
            let place = [0, 1].map(|k| random.usize(0..pieces[k].len()));
            let t = [0, 1].map(|_| random.f64());
            let parameter = [0, 1].map(|k| {
                let [a, b] = pieces[k][place[k]];
                a + (b - a) * t[k]
            });
            let wanted = de_boor(&surface, parameter);
            let at = |k: usize| (3 * place[0] + k / 4) * net.counts[1] + 3 * place[1] + k % 4;
            exact = exact.max(distance(wanted, bezier_at(|k| net.points[at(k)], t)));
            let patch = &patches[place[0] * pieces[1].len() + place[1]];
            rounded = rounded.max(distance(wanted, rounded_at(patch, t)));
        }
    }
    println!("largest error {exact:e} before rounding, {rounded:e} after");
    assert!(exact < 1e-13, "{exact:e} before rounding");
    assert!(rounded < 1e-6, "{rounded:e} after rounding");
}

/// Points and weights of a side, as numbered in `micropoly_core::border`.
pub(super) fn side(patch: &RationalPatch, side: usize) -> [[u32; 4]; 4] {
    let at = [[0, 4, 8, 12], [3, 7, 11, 15], [0, 1, 2, 3], [12, 13, 14, 15]][side];
    at.map(|k| {
        let [x, y, z] = patch.points[k].map(f32::to_bits);
        [x, y, z, patch.weights[k].to_bits()]
    })
}

#[test]
fn neighbours_have_the_same_bits_on_their_border() {
    let mut random = Rng::with_seed(2);
    let mut compared = 0;
    for _ in 0..200 {
        let surface = random_surface(&mut random);
        let patches = surface.patches().expect("drawable");
        let columns = pieces(&surface.knots[1], surface.range[1]).len();
        for (index, patch) in patches.iter().enumerate() {
            if index % columns > 0 {
                assert_eq!(side(&patches[index - 1], 1), side(patch, 0));
                compared += 1;
            }
            if index >= columns {
                assert_eq!(side(&patches[index - columns], 3), side(patch, 2));
                compared += 1;
            }
        }
    }
    assert!(compared > 1000);
}

/// A surface that closes along u (its points repeat) and has a pole at v = 0.
fn periodic_with_pole(random: &mut Rng) -> Nurbs {
    let degree = [random.usize(2..4), random.usize(2..4)];
    let (around, along) = (random.usize(3..7), degree[1] + 1 + random.usize(0..3));
    let pole = [between(random, -1.0, 1.0), between(random, -1.0, 1.0), between(random, -1.0, 1.0)];
    let rows: Vec<Vec<[f64; 4]>> = (0..around)
        .map(|_| {
            let mut row: Vec<_> = (0..along).map(|_| [0; 4].map(|_| between(random, 0.1, 1.0))).collect();
            row[0][..3].copy_from_slice(&pole);
            row
        })
        .collect();
    let count = around + degree[0];
    let points = (0..count).flat_map(|i| rows[i % around].clone()).collect();
    // One period is 3.7 long, so that knots a period apart differ by rounding.
    let steps: Vec<f64> = (0..around).map(|_| between(random, 0.1, 1.0)).collect();
    let scale = 3.7 / steps.iter().sum::<f64>();
    let mut knots = vec![between(random, -1.0, 1.0)];
    for i in 0..count + degree[0] {
        knots.push(knots[i] + scale * steps[i % around]);
    }
    let range_u = [knots[degree[0]], knots[count]];
    let mut clamped = vec![0.0; degree[1] + 1];
    clamped.extend((1..along - degree[1]).map(|k| k as f64));
    clamped.resize(along + degree[1] + 1, (along - degree[1]) as f64);
    let range_v = [0.0, (along - degree[1]) as f64];
    Nurbs { degree, knots: [knots, clamped], points, range: [range_u, range_v] }
}

/// In f64: rounding to f32 hides most differences, but not all.
#[test]
fn what_is_closed_closes_in_all_bits_and_poles_are_one_point() {
    let mut random = Rng::with_seed(3);
    for _ in 0..200 {
        let net = periodic_with_pole(&mut random).net().and_then(Net::finished).expect("drawable");
        let [rows, columns] = net.counts;
        let bits = |row: usize, column: usize| net.points[row * columns + column].map(f64::to_bits);
        for column in 0..columns {
            assert_eq!(bits(0, column), bits(rows - 1, column));
        }
        for row in 0..rows {
            assert_eq!(bits(0, 0)[..3], bits(row, 0)[..3]);
        }
    }
}

#[test]
fn bezier_nets_of_mixed_degrees_share_borders_and_pass_through_their_corners() {
    let mut random = Rng::with_seed(4);
    for degree in (1..4).flat_map(|u| (1..4).map(move |v| [u, v])) {
        let counts = degree.map(|degree| 2 * degree + 1);
        let points: Vec<_> =
            (0..counts[0] * counts[1]).map(|_| [0; 4].map(|_| between(&mut random, 0.1, 1.0))).collect();
        let patches = bezier_net(degree, counts, &points).expect("drawable");
        assert_eq!(patches.len(), 4);
        assert_eq!(side(&patches[0], 1), side(&patches[1], 0));
        assert_eq!(side(&patches[0], 3), side(&patches[2], 2));
        for (index, patch) in patches.iter().enumerate() {
            let [i, j] = [index / 2 * degree[0], index % 2 * degree[1]];
            let knots = degree.map(|degree| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat());
            let part =
                (0..=degree[0]).flat_map(|a| (0..=degree[1]).map(move |b| (i + a) * counts[1] + j + b));
            let part = part.map(|k| points[k]).collect();
            let alone = Nurbs { degree, knots, points: part, range: [[0.0, 1.0]; 2] };
            for _ in 0..20 {
                let t = [random.f64(), random.f64()];
                assert!(distance(rounded_at(patch, t), de_boor(&alone, t)) < 1e-6);
            }
        }
    }
}

/// A uniform B-spline of the same points is the same surface, so one is the test of the other.
#[test]
fn b_spline_meshes_are_uniform_nurbs() {
    let mut random = Rng::with_seed(5);
    let counts = [6, 5];
    let positions: Vec<_> = (0..30).map(|_| [0; 3].map(|_| between(&mut random, -1.0, 1.0))).collect();
    let mesh = PatchMesh::with_positions([Basis::BSpline; 2], counts, [false; 2], &positions);
    let patches = mesh.patches().expect("drawable");
    let knots = counts.map(|count| (0..count + 4).map(|k| k as f64).collect::<Vec<_>>());
    let at = |k: usize| positions[k % counts[1] * counts[0] + k / counts[1]];
    let points = (0..30).map(|k| [at(k)[0], at(k)[1], at(k)[2], 1.0]).collect();
    let surface = Nurbs { degree: [3, 3], knots, points, range: [[3.0, 6.0], [3.0, 5.0]] };
    let wanted = surface.patches().expect("drawable");
    assert_eq!(patches.len(), 6);
    for (patch, wanted) in patches.iter().zip(&wanted) {
        for (a, b) in patch.points.iter().zip(&wanted.points) {
            assert!(distance(a.map(f64::from), b.map(f64::from)) < 1e-7);
        }
    }
}

#[test]
fn catmull_rom_meshes_pass_through_their_points() {
    let mut random = Rng::with_seed(6);
    let positions: Vec<_> = (0..20).map(|_| [0; 3].map(|_| between(&mut random, -1.0, 1.0))).collect();
    let mesh = PatchMesh::with_positions([Basis::CatmullRom; 2], [5, 4], [true, false], &positions);
    let patches = mesh.patches().expect("drawable");
    assert_eq!(patches.len(), 5);
    for (i, patch) in patches.iter().enumerate() {
        for (corner, column, row) in [(0, i + 1, 1), (3, i + 1, 2), (12, i + 2, 1), (15, i + 2, 2)] {
            assert_eq!(patch.points[corner], positions[row * 5 + column % 5].map(|c| c as f32));
        }
        assert_eq!(side(patch, 3), side(&patches[(i + 1) % 5], 2));
    }
}

/// z = x³ · y²: points, derivatives and twists.
#[test]
fn hermite_meshes_have_the_points_and_derivatives_they_are_given() {
    let of = |x: f64, y: f64, dx: bool, dy: bool| match (dx, dy) {
        (false, false) => [x, y, x * x * x * y * y],
        (true, false) => [1.0, 0.0, 3.0 * x * x * y * y],
        (false, true) => [0.0, 1.0, 2.0 * x * x * x * y],
        (true, true) => [0.0, 0.0, 6.0 * x * x * y],
    };
    let index = |k: usize| ((k / 2) as f64, k % 2 == 1);
    let positions: Vec<_> = (0..24)
        .map(|k| {
            let ((x, dx), (y, dy)) = (index(k % 6), index(k / 6));
            of(x, y, dx, dy)
        })
        .collect();
    let mesh = PatchMesh::with_positions([Basis::Hermite; 2], [6, 4], [false; 2], &positions);
    let patches = mesh.patches().expect("drawable");
    assert_eq!(patches.len(), 2);
    for (i, patch) in patches.iter().enumerate() {
        assert_eq!(patch.weights, [1.0; 16]);
        for t in [[0.0, 0.0], [0.3, 0.8], [0.9, 0.4], [1.0, 1.0]] {
            let wanted = of(i as f64 + t[0], t[1], false, false);
            assert!(distance(rounded_at(patch, t), wanted) < 1e-6);
        }
    }
}

#[test]
fn bilinear_meshes_are_bilinear_and_close() {
    let positions: Vec<_> = (0..6).map(|k| [f64::from(k % 3), f64::from(k / 3), f64::from(k * k)]).collect();
    let mesh = PatchMesh::with_positions([Basis::Linear; 2], [3, 2], [true, false], &positions);
    let patches = mesh.patches().expect("drawable");
    assert_eq!(patches.len(), 3);
    for (i, patch) in patches.iter().enumerate() {
        let corner = |a: usize, b: usize| positions[b * 3 + (i + a) % 3];
        let mean = std::array::from_fn(|k| {
            [(0, 0), (0, 1), (1, 0), (1, 1)].iter().map(|&(a, b)| corner(a, b)[k]).sum::<f64>() / 4.0
        });
        assert!(distance(rounded_at(patch, [0.5, 0.5]), mean) < 1e-5);
        assert_eq!(side(patch, 3), side(&patches[(i + 1) % 3], 2));
    }
}

#[test]
fn other_steps_make_patches_that_stand_alone() {
    let positions: Vec<_> = (0..32).map(|k| [f64::from(k), f64::from(k * k), 0.0]).collect();
    let mut mesh = PatchMesh::with_positions([Basis::Bezier; 2], [8, 4], [false; 2], &positions);
    assert!(matches!(mesh.patches(), Err(NurbsError::Segments { direction: 'u', count: 8, .. })));
    mesh.steps = [4, 3];
    let patches = mesh.patches().expect("drawable");
    assert_eq!(patches.len(), 2);
    assert_eq!(patches[1].points[0], positions[4].map(|c| c as f32));
    mesh.steps = [0, 3];
    assert!(matches!(mesh.patches(), Err(NurbsError::Segments { .. })));
}

#[test]
fn what_cannot_be_drawn_is_refused_with_its_reason() {
    let good = random_surface(&mut Rng::with_seed(7));
    let refused = |change: &dyn Fn(&mut Nurbs)| {
        let mut surface = good.clone();
        change(&mut surface);
        surface.patches().expect_err("cannot be drawn")
    };
    let first = good.knots[0][0];
    assert!(matches!(refused(&|s| s.degree[1] = 4), NurbsError::Degree { direction: 'v', degree: 4 }));
    assert!(matches!(refused(&|s| s.degree[0] = 0), NurbsError::Degree { direction: 'u', degree: 0 }));
    assert!(matches!(refused(&|s| s.knots[0].clear()), NurbsError::KnotCount { found: 0, .. }));
    assert!(matches!(refused(&|s| s.knots[1][2] = f64::NAN), NurbsError::KnotValue { index: 2, .. }));
    assert!(matches!(refused(&|s| s.knots[0][0] = 1e9), NurbsError::KnotOrder { index: 1, .. }));
    assert!(matches!(refused(&|s| s.knots[0].fill(first)), NurbsError::Multiplicity { .. }));
    assert!(matches!(refused(&|s| s.points.truncate(1)), NurbsError::Count { found: 1, .. }));
    assert!(matches!(refused(&|s| s.points[0][3] = 0.0), NurbsError::Weight { weight: 0.0 }));
    assert!(matches!(refused(&|s| s.points[0][3] = 1e300), NurbsError::Weight { .. }));
    assert!(matches!(refused(&|s| s.points[0][0] = 1e300), NurbsError::Point { .. }));
    assert!(matches!(refused(&|s| s.points[0][0] = f64::NAN), NurbsError::Point { .. }));
    assert!(matches!(refused(&|s| s.range[0] = [s.range[0][0]; 2]), NurbsError::EmptyRange { .. }));
    assert!(matches!(refused(&|s| s.range[0][1] = 1e9), NurbsError::OutsideRange { .. }));
    assert!(matches!(refused(&|s| s.range[0][1] = f64::NAN), NurbsError::OutsideRange { .. }));
    let points = [[0.0, 0.0, 0.0, 1.0]; 6];
    assert!(matches!(bezier_net([2, 1], [4, 2], &points), Err(NurbsError::Segments { count: 4, .. })));
    assert!(matches!(bezier_net([1, 1], [usize::MAX, 4], &points), Err(NurbsError::Count { .. })));
}
