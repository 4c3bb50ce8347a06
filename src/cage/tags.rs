//! What kind of patch each face becomes, and why (Nießner, Loop, Meyer & DeRose 2012, section 3).

use rayon::prelude::*;

use super::INFINITELY_SHARP;
use super::level::Level;

/// How the surface passes a vertex, once no sharpness decays there any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// It is smooth.
    Smooth,
    /// A crease ends there, in a smooth surface.
    Dart,
    /// A crease, or the boundary, passes through.
    Crease,
    /// The surface has a corner, or several.
    Corner,
}

/// What is known of a vertex whose faces are all there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    /// How the surface passes.
    pub(super) rule: Rule,
    /// Will refinement change no rule any more, and are all faces around quads?
    pub(super) is_settled: bool,
    /// Is the surface a bicubic B-spline around it, on all sides of all creases? A vertex that is so for one side only
    /// does not count: then neighbours across a crease are never more than one level apart.
    pub(super) is_regular: bool,
}

/// What becomes of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It only shapes others.
    Hidden,
    /// It is a Bézier patch.
    Regular,
    /// It is a Gregory patch.
    Irregular,
    /// It is refined.
    Refined,
}

/// Kinds of all vertices; of no meaning where faces are missing around.
pub(super) fn kinds(level: &Level) -> Vec<Kind> {
    (0..level.points.len()).into_par_iter().with_min_len(1024).map(|vertex| kind(level, vertex)).collect()
}

fn kind(level: &Level, vertex: usize) -> Kind {
    let (mut creases, mut is_settled) = (0, true);
    let edges = (!level.is_plain(vertex)).then(|| level.edges_at(vertex));
    for (half_edge, _) in edges.into_iter().flatten() {
        let sharpness = level.edge_sharpness(half_edge);
        creases += u32::from(sharpness >= INFINITELY_SHARP);
        is_settled &= sharpness == 0.0 || sharpness >= INFINITELY_SHARP;
    }
    let own = level.vertex_sharpness(vertex);
    is_settled &= own == 0.0 || own >= INFINITELY_SHARP;
    is_settled &= level.fan(vertex).iter().all(|&corner| level.is_quad(level.face_of(corner as usize)));
    let rule = match creases {
        _ if own > 0.0 => Rule::Corner,
        0 => Rule::Smooth,
        1 => Rule::Dart,
        2 => Rule::Crease,
        _ => Rule::Corner,
    };
    Kind { rule, is_settled, is_regular: is_settled && is_regular(level, vertex, rule) }
}

/// Are there as many quads as a B-spline has, between creases or all around?
fn is_regular(level: &Level, vertex: usize, rule: Rule) -> bool {
    let fan = level.fan(vertex);
    let creases_of_each = match rule {
        Rule::Dart => return false,
        Rule::Smooth => return fan.len() == 4,
        Rule::Crease => 1,
        Rule::Corner => 2,
    };
    fan.iter().all(|&corner| {
        let edges = [corner as usize, level.previous(corner as usize)];
        edges.into_iter().filter(|&edge| level.is_crease(edge)).count() == creases_of_each
    })
}

/// Fates of all faces, if whatever may be a Gregory patch becomes one.
pub(super) fn fates(level: &Level, kinds: &[Kind]) -> Vec<Fate> {
    let mut fates: Vec<Fate> = (0..level.face_count())
        .into_par_iter()
        .with_min_len(1024)
        .map(|face| fate(level, kinds, face))
        .collect();
    spread(level, &mut fates);
    fates
}

fn fate(level: &Level, kinds: &[Kind], face: usize) -> Fate {
    let corners = &level.corners[level.corners_of(face)];
    let all = |holds: fn(&Kind) -> bool| corners.iter().all(|&vertex| holds(&kinds[vertex as usize]));
    if level.origins[face].is_none() {
        Fate::Hidden
    } else if all(|kind| kind.is_regular) {
        Fate::Regular
    } else if all(|kind| kind.is_settled) {
        Fate::Irregular
    } else {
        Fate::Refined
    }
}

/// Refines what would be a Gregory patch beside smaller ones: only Bézier patches may have such neighbours.
pub(super) fn spread(level: &Level, fates: &mut [Fate]) {
    let mut waiting: Vec<usize> = (0..fates.len()).filter(|&face| fates[face] == Fate::Refined).collect();
    while let Some(face) = waiting.pop() {
        for twin in level.corners_of(face).filter_map(|half_edge| level.twin(half_edge)) {
            let beside = level.face_of(twin);
            if fates[beside] == Fate::Irregular {
                fates[beside] = Fate::Refined;
                waiting.push(beside);
            }
        }
    }
}
