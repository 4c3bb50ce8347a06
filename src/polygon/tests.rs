//! Polygons: what they cover, that edges are whole and the same from both sides, and what is refused.

use fastrand::Rng;

use super::*;

type Edge = [[u32; 3]; 4];

/// The sides of a patch, counter-clockwise seen from the front; those that are points are left out.
fn edges(patch: &BezierPatch) -> Vec<Edge> {
    let sides = [[0, 4, 8, 12], [12, 13, 14, 15], [15, 11, 7, 3], [3, 2, 1, 0]];
    let bits = sides.map(|side| side.map(|k| patch.points[k].map(f32::to_bits)));
    bits.into_iter().filter(|side| side.iter().any(|point| *point != side[0])).collect()
}

fn backwards([a, b, c, d]: Edge) -> Edge {
    [d, c, b, a]
}

/// Edges that no other patch has in the other direction.
fn open_edges(patches: &[BezierPatch]) -> Vec<Edge> {
    let mut all: Vec<Edge> = patches.iter().flat_map(edges).collect();
    all.sort_unstable();
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]), "an edge is there twice");
    all.iter().copied().filter(|&edge| all.binary_search(&backwards(edge)).is_err()).collect()
}

/// Twice the area that a patch covers along z; below 0 where its back is up.
fn covered(patch: &BezierPatch) -> f64 {
    let [a, b, c, d] = [0, 12, 15, 3].map(|k| patch.points[k].map(f64::from));
    let cross = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
    cross(a, b) + cross(b, c) + cross(c, d) + cross(d, a)
}

fn one_face(positions: Vec<[f64; 3]>) -> Cage {
    let count = positions.len() as u32;
    Cage { positions, face_sizes: vec![count], corners: (0..count).collect(), ..Cage::default() }
}

fn flat(corners: &[[f64; 2]]) -> Vec<[f64; 3]> {
    corners.iter().map(|&[x, y]| [x, y, 0.1 * x + 0.2 * y]).collect()
}

fn check_cover(corners: &[[f64; 2]], patches: &[BezierPatch]) {
    let next = corners.iter().cycle().skip(1);
    let area: f64 = corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
    let sum: f64 = patches.iter().map(covered).sum();
    assert!((area - sum).abs() < 1e-5 * area.abs(), "{sum} of {area} is covered: {corners:?}");
    assert!(patches.iter().all(|patch| covered(patch) * area >= -1e-6), "something folds over: {corners:?}");
    let open = open_edges(patches);
    assert_eq!(open.len(), corners.len(), "edges are not whole: {corners:?}");
    let wanted = flat(corners);
    for (k, &a) in wanted.iter().enumerate() {
        let edge = straight(a, wanted[(k + 1) % wanted.len()]);
        assert!(open.contains(&edge.map(|point| point.map(|c| (c as f32 + 0.0).to_bits()))));
    }
}

/// An L, a comb, a U with corners on its edges, and a polygon with a hole that a slit leads to.
fn concave() -> Vec<Vec<[f64; 2]>> {
    let comb = (0..10).flat_map(|k| {
        let x = f64::from(k);
        [[x, 0.0], [x + 0.4, 0.0], [x + 0.5, 3.0], [x + 0.9, 3.0]]
    });
    let comb: Vec<_> = [[10.0, 4.0], [0.0, 4.0]].into_iter().chain(comb).collect();
    let slit = vec![
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [0.0, 3.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [2.0, 2.0],
        [2.0, 1.0],
        [1.0, 1.0],
    ];
    vec![
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]],
        vec![[0.0, 0.0], [3.0, 0.0], [0.5, 0.5], [0.0, 3.0]],
        comb,
        vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ],
        slit,
    ]
}

#[test]
fn faces_cover_their_polygon_once_and_keep_its_edges_whole() {
    let mut random = Rng::with_seed(1);
    for mut corners in concave().into_iter().take(4) {
        for _ in 0..corners.len() {
            corners.rotate_left(1);
            check_cover(&corners, &polygons(&one_face(flat(&corners))).expect("drawable"));
            let clockwise: Vec<_> = corners.iter().rev().copied().collect();
            check_cover(&clockwise, &polygons(&one_face(flat(&clockwise))).expect("drawable"));
        }
    }
    for _ in 0..2000 {
        // Stars about a point that need not be their mean.
        let count = random.usize(3..30);
        let mut angles: Vec<f64> = (0..count).map(|_| random.f64() * std::f64::consts::TAU).collect();
        angles.sort_by(f64::total_cmp);
        let gap = |k: usize| (angles[(k + 1) % count] - angles[k]).rem_euclid(std::f64::consts::TAU);
        if (0..count).any(|k| gap(k) > 3.0 || gap(k) < 1e-3) {
            continue;
        }
        let corner = |&angle: &f64| {
            let (sine, cosine) = libm::sincos(angle);
            let radius = 0.1 + 3.0 * random.f64();
            [radius * cosine, radius * sine]
        };
        let corners: Vec<_> = angles.iter().map(corner).collect();
        check_cover(&corners, &polygons(&one_face(flat(&corners))).expect("drawable"));
    }
}

#[test]
fn a_hole_with_a_slit_is_left_open() {
    let corners = concave().swap_remove(4);
    let patches = polygons(&one_face(flat(&corners))).expect("drawable");
    assert!((patches.iter().map(covered).sum::<f64>() - 16.0).abs() < 1e-5);
    assert!(patches.iter().all(|patch| covered(patch) > 0.0));
    assert_eq!(open_edges(&patches).len(), 8);
}

/// A cube whose sides are a quadrilateral, triangles, and polygons with a corner in the middle of edges.
#[test]
fn neighbours_of_all_sizes_share_their_edges() {
    let mut positions: Vec<_> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
    positions.extend([[0.3, 0.0, 1.0], [0.1, 1.0, 1.0], [0.7, 1.0, 1.0]]);
    for position in &mut positions {
        *position = [0.1 + position[0] / 3.0, position[1] / 7.0 - 0.3, 0.9 * position[2]];
    }
    let faces: [&[u32]; 8] = [
        &[0, 2, 3, 1],
        &[4, 8, 5, 7, 10, 9, 6],
        &[0, 1, 5, 8, 4],
        &[2, 6, 9, 10, 7, 3],
        &[0, 4, 6],
        &[0, 6, 2],
        &[1, 3, 7],
        &[1, 7, 5],
    ];
    let face_sizes = faces.iter().map(|face| face.len() as u32).collect();
    let mut cage = Cage { positions, face_sizes, corners: faces.concat(), ..Cage::default() };
    assert_eq!(open_edges(&polygons(&cage).expect("drawable")), [] as [Edge; 0]);
    cage.holes = vec![0];
    assert_eq!(open_edges(&polygons(&cage).expect("drawable")).len(), 4);
}

#[test]
fn edges_are_the_same_bits_from_both_ends() {
    let mut random = Rng::with_seed(2);
    for _ in 0..10_000 {
        let [a, b] = [0; 2].map(|_| [0; 3].map(|_| (random.f64() - 0.5) * 100.0));
        let [p, q, r, s] = straight(a, b);
        assert_eq!([s, r, q, p], straight(b, a));
        assert_eq!(straight(a, a), [a; 4]);
    }
}

#[test]
fn quadrilaterals_are_bilinear_with_their_front_counter_clockwise() {
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 4.0], [0.0, 2.0, 0.0]];
    let patches = polygons(&one_face(corners.to_vec())).expect("drawable");
    assert_eq!(patches, [bilinear(corners)]);
    let at = |i: usize, j: usize| patches[0].points[4 * i + j];
    assert_eq!([at(0, 0), at(3, 0), at(3, 3), at(0, 3)], corners.map(|corner| corner.map(|c| c as f32)));
    let third = at(1, 1)[2];
    assert!((third - 4.0 / 9.0).abs() < 1e-6);
}

#[test]
fn degenerate_faces_have_whole_edges_too() {
    let line: Vec<_> = (0..6).map(|k| [f64::from(k), 0.0, 0.0]).collect();
    let star: Vec<_> = (0..5)
        .map(|k| libm::sincos(f64::from(k) * 0.8 * std::f64::consts::PI))
        .map(|(sine, cosine)| [cosine, sine, 0.0])
        .collect();
    for corners in [line, star] {
        let patches = polygons(&one_face(corners.clone())).expect("drawable");
        assert_eq!(open_edges(&patches).len(), corners.len());
    }
    let point = polygons(&one_face(vec![[1.0; 3]; 7])).expect("drawable");
    assert!(point.iter().flat_map(|patch| patch.points).all(|point| point == [1.0; 3]));
}

#[test]
fn what_cannot_be_drawn_is_refused_with_its_reason() {
    let good = one_face(flat(&concave()[0]));
    let refused = |change: &dyn Fn(&mut Cage)| {
        let mut cage = good.clone();
        change(&mut cage);
        polygons(&cage).expect_err("cannot be drawn")
    };
    let most = u32::MAX;
    assert_eq!(
        refused(&|cage| cage.face_sizes.push(most)),
        PolygonError::Corners { claimed: u64::from(most) + 6, corners: 6 }
    );
    assert_eq!(refused(&|cage| cage.face_sizes = vec![4, 2]), PolygonError::Size { face: 1, size: 2 });
    assert_eq!(
        refused(&|cage| cage.corners[2] = 6),
        PolygonError::Vertex { face: 0, vertex: 6, vertices: 6 }
    );
    assert_eq!(refused(&|cage| cage.positions[4][1] = f64::NAN), PolygonError::Position { vertex: 4 });
    assert_eq!(refused(&|cage| cage.holes.push(1)), PolygonError::Hole { face: 1, faces: 1 });
    let comb: Vec<_> = (0..=MOST_CORNERS).map(|k| [k as f64, (k % 2) as f64, 0.0]).collect();
    let size = MOST_CORNERS + 1;
    assert_eq!(polygons(&one_face(comb)), Err(PolygonError::Concave { face: 0, size }));
}
