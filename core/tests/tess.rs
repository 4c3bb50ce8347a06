//! What the specifications say of tessellated patches (OpenGL 4.6 sec. 11.2.2, Direct3D 11.3 sec. 12), for both profiles.

use std::collections::{BTreeMap, BTreeSet};

use micropoly_core::abi::{
    PIECE_PRIMITIVES, PIECE_VERTICES, TESS_CLOCKWISE, TESS_COORDINATES, TESS_EQUAL, TESS_EVEN, TESS_ISOLINES,
    TESS_ODD, TESS_POINTS, TESS_QUADS, TESS_STADLBAUER, TESS_TRIANGLES, TESS_UNIT, TessFrame, TessLevels,
    TessPatch, TessRecord, TessTotals, TessVertex,
};
use micropoly_core::kernel::tess_control::record;
use micropoly_core::kernel::tess_evaluate::{Span, built_in, corners, indices, patch_of, spans};
use micropoly_core::kernel::tess_places::{pieces, places};
use micropoly_core::tess::division::Division;
use micropoly_core::tess::level::{convert, level_counts};
use micropoly_core::tess::topology::Topology;

type Coordinates = [u32; 3];

/// A tessellated patch.
struct Mesh {
    record: TessRecord,
    vertices: Vec<Coordinates>,
    triangles: Vec<[u32; 3]>,
}

fn frame(domain: u32, spacing: u32, flags: u32) -> TessFrame {
    TessFrame { patch_count: 1, domain, spacing, flags, evaluation: TESS_COORDINATES, ..TessFrame::default() }
}

fn levels(outer: [f32; 4], inner: [f32; 2]) -> TessLevels {
    TessLevels { outer, inner }
}

/// Every kind of frame that makes triangles.
fn frames() -> impl Iterator<Item = TessFrame> {
    let domains = [TESS_TRIANGLES, TESS_QUADS].into_iter();
    domains.flat_map(|domain| {
        let spacings = [TESS_EQUAL, TESS_EVEN, TESS_ODD].into_iter();
        spacings.flat_map(move |spacing| [0, TESS_STADLBAUER].map(|flags| frame(domain, spacing, flags)))
    })
}

fn coordinates(vertex: &TessVertex) -> Coordinates {
    vertex.position.map(|x| (x * TESS_UNIT as f32) as u32)
}

/// Vertices and indices of a part of a patch.
fn part(frame: &TessFrame, record: &TessRecord, [own, laid]: [Span; 2]) -> (Vec<Coordinates>, Vec<u32>) {
    let topology = record.topology(frame);
    let mut vertices = vec![TessVertex::default(); (own.end - own.first) as usize];
    built_in(frame, &TessPatch::default(), &[], &topology, own, &mut vertices);
    let mut laid_out = vec![0; (corners(frame) * (laid.end - laid.first)) as usize];
    indices(frame, &topology, 0, laid, &mut laid_out);
    (vertices.iter().map(coordinates).collect(), laid_out)
}

fn whole(record: &TessRecord) -> [Span; 2] {
    [Span { first: 0, end: record.vertices }, Span { first: 0, end: record.primitives }]
}

fn mesh(frame: &TessFrame, levels: &TessLevels) -> Mesh {
    let record = record(frame, levels);
    let (vertices, indices) = part(frame, &record, whole(&record));
    Mesh { record, vertices, triangles: indices.as_chunks::<3>().0.to_vec() }
}

/// Levels that are whole, nearly whole, and in between; few enough that all combinations can be tried.
fn some_levels(random: &mut fastrand::Rng) -> f32 {
    match random.u32(0..6) {
        0 => random.u32(1..=64) as f32,
        1 => random.u32(1..=64) as f32 * (1.0 + f32::EPSILON * random.u32(0..200) as f32),
        2 => 1.0 + random.f32(),
        _ => 1.0 + 63.0 * random.f32() * random.f32(),
    }
}

fn random_levels(random: &mut fastrand::Rng) -> TessLevels {
    let mut any = || some_levels(random);
    levels([any(), any(), any(), any()], [any(), any()])
}

/// Meshes of every kind of frame, of levels in steps and of random ones.
fn each_mesh(mut check: impl FnMut(&TessFrame, &TessLevels, &Mesh)) {
    let mut random = fastrand::Rng::with_seed(1);
    for frame in frames() {
        let steps = [1.0, 1.0 + f32::EPSILON, 1.0 + 1.0 / 262144.0, 1.5, 2.0, 2.75, 3.0, 4.0, 5.1, 7.0, 16.0];
        for outer in steps {
            for inner in steps {
                let all = levels([outer, inner, outer, 1.0], [inner, outer]);
                check(&frame, &all, &mesh(&frame, &all));
            }
        }
        for _ in 0..60 {
            let all = random_levels(&mut random);
            check(&frame, &all, &mesh(&frame, &all));
        }
    }
}

fn twice_area(mesh: &Mesh, triangle: [u32; 3]) -> i64 {
    let [a, b, c] = triangle.map(|k| mesh.vertices[k as usize].map(i64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn triangles_fill_the_domain_exactly_and_none_is_turned_over() {
    each_mesh(|frame, levels, mesh| {
        let areas = mesh.triangles.iter().map(|triangle| twice_area(mesh, *triangle));
        let one = i64::from(TESS_UNIT) * i64::from(TESS_UNIT);
        let domain = if frame.domain == TESS_QUADS { 2 * one } else { one };
        assert_eq!(areas.sum::<i64>(), domain, "{frame:?} {levels:?}");
        if frame.flags & TESS_STADLBAUER == 0 {
            return; // its points are not quite in order about the middle
        }
        let least = mesh.triangles.iter().map(|triangle| twice_area(mesh, *triangle)).min();
        assert!(least >= Some(-i64::from(TESS_UNIT)), "{frame:?} {levels:?} {least:?}");
    });
}

#[test]
fn every_mesh_is_a_disc() {
    each_mesh(|frame, levels, mesh| {
        let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for &[a, b, c] in &mesh.triangles {
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(edge).or_default() += 1;
            }
        }
        assert!(edges.values().all(|&times| times == 1), "an edge twice the same way: {frame:?} {levels:?}");
        let border: Vec<_> = edges.keys().filter(|[a, b]| !edges.contains_key(&[*b, *a])).collect();
        let sides = 3 + usize::from(frame.domain == TESS_QUADS);
        let segments: u32 = (0..sides).map(|k| Division::new(mesh.record.levels[k]).segments()).sum();
        assert_eq!(border.len(), segments as usize, "{frame:?} {levels:?}");
        let undirected = (edges.len() + border.len()) / 2;
        let used: BTreeSet<u32> = mesh.triangles.iter().flatten().copied().collect();
        assert_eq!(used.len(), mesh.vertices.len(), "a vertex that no triangle has: {frame:?} {levels:?}");
        assert_eq!(used.len() + mesh.triangles.len(), undirected + 1, "{frame:?} {levels:?}");
    });
}

#[test]
fn coordinates_are_in_the_domain_and_add_up() {
    each_mesh(|frame, levels, mesh| {
        for &[u, v, w] in &mesh.vertices {
            assert!(u <= TESS_UNIT && v <= TESS_UNIT, "{frame:?} {levels:?}");
            let sum = if frame.domain == TESS_TRIANGLES { u + v + w } else { TESS_UNIT };
            assert_eq!(sum, TESS_UNIT, "{frame:?} {levels:?}");
        }
    });
}

/// Levels in steps of 1/16, and beside them.
fn sweep() -> impl Iterator<Item = f32> {
    (4..66 * 16).flat_map(|step| [-1.0e-4, 0.0, 1.0e-4].map(|off| step as f32 / 16.0 + off))
}

#[test]
fn an_edge_is_symmetric_and_in_order() {
    for frame in frames() {
        for level in sweep() {
            let words = convert(&frame, &levels([level; 4], [level; 2]));
            let edge = Division::new(words[0]);
            let count = edge.segments();
            let places: Vec<u32> = (0..=count).map(|point| edge.place(point)).collect();
            assert_eq!((places[0], places[count as usize]), (0, TESS_UNIT), "{level}");
            // Direct3D's reciprocals, rounded, add up to a little more than a half.
            let slack = if frame.flags & TESS_STADLBAUER > 0 { 0 } else { 9 };
            let in_order = places.windows(2).all(|pair| pair[0] <= pair[1] + slack);
            assert!(in_order, "{frame:?} {level}: {places:?}");
            let turned: Vec<u32> = places.iter().rev().map(|place| TESS_UNIT - place).collect();
            assert_eq!(places, turned, "{frame:?} {level}");
        }
    }
}

#[test]
fn segments_are_as_many_as_the_level_says_and_only_two_are_of_another_length() {
    for frame in frames() {
        for level in sweep() {
            let words = convert(&frame, &levels([level; 4], [level; 2]));
            let edge = Division::new(words[0]);
            let wanted = match frame.spacing {
                TESS_EVEN => 2.0 * (level.clamp(2.0, 64.0) / 2.0 - 1.0e-6).ceil(),
                TESS_ODD => 2.0 * ((level.clamp(1.0, 63.0) + 1.0) / 2.0 - 1.0e-6).ceil() - 1.0,
                _ => level.clamp(1.0, 64.0).ceil(),
            };
            // Levels are rounded to 2⁻¹⁶, which may be across a whole number.
            assert!((edge.segments() as f32 - wanted).abs() < 0.5, "{frame:?} {level}: {}", edge.segments());
            let length = |k| edge.place(k + 1).saturating_sub(edge.place(k));
            let lengths: Vec<u32> = (0..edge.segments()).map(length).collect();
            let long = lengths.iter().max().expect("a segment");
            let short = lengths.iter().filter(|length| **length + 140 < *long).count();
            assert!(short <= 2, "{frame:?} {level}: {lengths:?}");
        }
    }
}

/// Numbers of the vertices of an outer edge, from its first end to its last.
fn edge_of(frame: &TessFrame, mesh: &Mesh, edge: usize) -> Vec<u32> {
    let count = |k: usize| Division::new(mesh.record.levels[k]).segments();
    let start: u32 = (0..edge).map(count).sum();
    (start..=start + count(edge)).map(|k| k % ring_of(frame, mesh)).collect()
}

/// How many vertices are on outer edges.
fn ring_of(frame: &TessFrame, mesh: &Mesh) -> u32 {
    let sides = level_counts(frame.domain)[0] as usize;
    (0..sides).map(|k| Division::new(mesh.record.levels[k]).segments()).sum()
}

#[test]
fn an_outer_edge_depends_on_its_level_alone() {
    let mut random = fastrand::Rng::with_seed(2);
    for frame in frames() {
        for _ in 0..40 {
            let level = 1.01 + 62.0 * random.f32();
            let mut wanted: Option<Vec<u32>> = None;
            for edge in 0..level_counts(frame.domain)[0] as usize {
                let mut all = random_levels(&mut random);
                all.outer[edge] = level;
                let mesh = mesh(&frame, &all);
                let along = if frame.domain == TESS_QUADS { [1, 0, 1, 0] } else { [1, 0, 0, 0] }[edge];
                let places = edge_of(&frame, &mesh, edge);
                let mut found: Vec<u32> =
                    places.into_iter().map(|k| mesh.vertices[k as usize][along]).collect();
                found.sort_unstable();
                assert_eq!(wanted.get_or_insert_with(|| found.clone()), &found, "{frame:?} {all:?} {edge}");
            }
        }
    }
}

/// Triangles by coordinates, each from its smallest corner on, in order.
fn by_place(mesh: &Mesh, is_wanted: impl Fn(&[u32; 3]) -> bool) -> Vec<[Coordinates; 3]> {
    let wanted = mesh.triangles.iter().filter(|triangle| is_wanted(triangle));
    let mut placed: Vec<_> = wanted
        .map(|triangle| {
            let mut placed = triangle.map(|k| mesh.vertices[k as usize]);
            while placed[0] != *placed.iter().min().expect("three") {
                placed.rotate_left(1);
            }
            placed
        })
        .collect();
    placed.sort_unstable();
    placed
}

/// Rule 6: triangles inside depend on inner levels alone. Rule 7: those that touch an outer edge on its level besides.
#[test]
fn triangles_depend_on_no_level_that_is_not_theirs() {
    let mut random = fastrand::Rng::with_seed(3);
    for frame in frames() {
        for _ in 0..30 {
            // With inner levels up to 2 the inside has no border of its own; 3 and more have.
            let inner = [3.0 + 20.0 * random.f32(), 3.0 + 20.0 * random.f32()];
            let outer: [f32; 4] = std::array::from_fn(|_| some_levels(&mut random));
            let one = levels(outer, inner);
            let edge = random.usize(0..level_counts(frame.domain)[0] as usize);
            let mut other = levels(std::array::from_fn(|_| some_levels(&mut random)), inner);
            other.outer[edge] = one.outer[edge];
            let all = |mesh: &Mesh| {
                let (ring, own) = (ring_of(&frame, mesh), edge_of(&frame, mesh, edge));
                let inside = by_place(mesh, |triangle| triangle.iter().all(|k| *k >= ring));
                // Those that have a segment of the edge, not only a corner that two edges have.
                let on_edge =
                    by_place(mesh, |triangle| triangle.iter().filter(|k| own.contains(k)).count() == 2);
                (inside, on_edge)
            };
            let (one_mesh, other_mesh) = (mesh(&frame, &one), mesh(&frame, &other));
            assert_eq!(all(&one_mesh), all(&other_mesh), "{frame:?} {one:?} {other:?}");
        }
    }
}

#[test]
fn clockwise_patches_are_the_same_triangles_turned() {
    let all = levels([3.0, 4.5, 6.0, 7.0], [5.0, 4.0]);
    for frame in frames() {
        let turned = TessFrame { flags: frame.flags | TESS_CLOCKWISE, ..frame };
        let (straight, turned) = (mesh(&frame, &all), mesh(&turned, &all));
        assert_eq!(straight.vertices, turned.vertices);
        let swapped: Vec<_> = straight.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert_eq!(swapped, turned.triangles);
    }
}

#[test]
fn points_are_the_vertices_and_lay_no_triangles() {
    let all = levels([3.0, 4.5, 6.0, 7.0], [5.0, 4.0]);
    for frame in frames() {
        let points = TessFrame { flags: frame.flags | TESS_POINTS, ..frame };
        let (filled, points) = (mesh(&frame, &all), mesh(&points, &all));
        assert_eq!(filled.vertices, points.vertices);
        assert!(points.triangles.is_empty() && !filled.triangles.is_empty());
    }
}

/// Stadlbauer's completeness test: whatever the levels, the pieces of a patch have each of its vertices and triangles once.
#[test]
fn pieces_have_everything_once_for_every_pair_of_levels() {
    for domain in [TESS_TRIANGLES, TESS_QUADS, TESS_ISOLINES] {
        let frame = frame(domain, TESS_EQUAL, 0);
        for a in 1..=64 {
            for b in 1..=64 {
                let (outer, inner) = (a as f32, b as f32);
                let record = record(&frame, &levels([outer, inner, outer, inner], [inner, outer]));
                let everything = part(&frame, &record, whole(&record));
                let mut found = (Vec::new(), Vec::new());
                for piece in 0..pieces(&record) {
                    let spans = spans(&record, piece);
                    assert!(spans[0].end - spans[0].first <= PIECE_VERTICES);
                    assert!(spans[1].end - spans[1].first <= PIECE_PRIMITIVES);
                    let (vertices, indices) = part(&frame, &record, spans);
                    found.0.extend(vertices);
                    found.1.extend(indices);
                }
                assert!(found == everything, "{domain} {a} {b}");
            }
        }
    }
}

/// Any vertex and any triangle is what it is, whoever asks.
#[test]
fn everything_is_known_by_its_index_alone() {
    let mut random = fastrand::Rng::with_seed(4);
    for frame in frames() {
        for _ in 0..20 {
            let all = random_levels(&mut random);
            let mesh = mesh(&frame, &all);
            let topology = Topology::new(&frame, &mesh.record.levels);
            assert_eq!(topology.vertices() as usize, mesh.vertices.len());
            assert_eq!(topology.primitives() as usize, mesh.triangles.len());
            for (k, vertex) in (0..).zip(&mesh.vertices) {
                let side = topology.side_of(k);
                assert_eq!(topology.row(side).coordinates(k - side.first), *vertex, "{frame:?} {all:?} {k}");
            }
            for (k, triangle) in (0..).zip(&mesh.triangles) {
                let strip = topology.strip_of(k);
                assert_eq!(strip.triangle(k - strip.first), *triangle, "{frame:?} {all:?} {k}");
            }
        }
    }
}

#[test]
fn levels_that_are_none_drop_the_patch_and_others_are_clamped() {
    for domain in [TESS_TRIANGLES, TESS_QUADS, TESS_ISOLINES] {
        let [outer, _] = level_counts(domain);
        for spacing in [TESS_EQUAL, TESS_EVEN, TESS_ODD] {
            let frame = frame(domain, spacing, 0);
            let count = |levels: &TessLevels| record(&frame, levels).vertices;
            for wrong in [f32::NAN, 0.0, -0.0, -1.0, f32::NEG_INFINITY] {
                for edge in 0..outer as usize {
                    let mut all = levels([4.0; 4], [4.0; 2]);
                    all.outer[edge] = wrong;
                    assert_eq!(count(&all), 0, "{domain} {wrong} {edge}");
                }
                // Inner levels are the least that there are.
                let least = count(&levels([4.0; 4], [0.5; 2]));
                assert_eq!(count(&levels([4.0; 4], [wrong; 2])), least, "{domain} {wrong}");
            }
            let most = count(&levels([64.0; 4], [64.0; 2]));
            assert_eq!(count(&levels([f32::INFINITY; 4], [1.0e6; 2])), most);
            assert_eq!(count(&levels([1.0e-20; 4], [1.0; 2])), count(&levels([1.0; 4], [1.0; 2])));
        }
    }
}

#[test]
fn places_are_given_as_long_as_there_is_room() {
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..300 {
        let count = random.u32(1..40);
        let frame = TessFrame { patch_count: count, ..frame(TESS_TRIANGLES, TESS_EQUAL, 0) };
        let mut records: Vec<TessRecord> = (0..count)
            .map(|k| {
                record(&frame, &levels([if k % 7 == 3 { 0.0 } else { 5.0 }; 4], [random.f32() * 9.0; 2]))
            })
            .collect();
        let rooms = [random.u32(0..2000), random.u32(0..4000)];
        let first = random.u32(0..count);
        let totals =
            TessTotals { first, vertex_room: rooms[0], primitive_room: rooms[1], ..TessTotals::default() };
        let totals = places(&frame, &mut records, totals);
        let placed = &records[first as usize..totals.end as usize];
        let sum = |of: fn(&TessRecord) -> u32| placed.iter().map(of).sum::<u32>();
        assert_eq!((totals.vertices, totals.primitives), (sum(|r| r.vertices), sum(|r| r.primitives)));
        assert!(totals.vertices <= rooms[0] && totals.primitives <= rooms[1]);
        assert_eq!(totals.pieces, sum(pieces));
        if let Some(next) = records.get(totals.end as usize) {
            let fits = totals.vertices + next.vertices <= rooms[0]
                && totals.primitives + next.primitives <= rooms[1];
            assert!(!fits, "there was room for another patch");
        }
        for piece in 0..totals.pieces {
            let patch = patch_of(&records, first, totals.end, piece);
            let own = piece - records[patch as usize].first_piece;
            assert!(own < pieces(&records[patch as usize]), "piece {piece} is of patch {patch}");
        }
    }
}
