//! Limit positions of vertices (Halstead, Kass & DeRose 1993 for smooth ones): found once, and rounded once.

use glam::DVec3;
use rayon::prelude::*;

use super::dart;
use super::level::Level;
use super::tags::{Fate, Kind, Rule};

/// Fills in the limits of the corners of drawn faces, where they are not known and can be.
pub(super) fn settle(level: &mut Level, kinds: &[Kind], fates: &[Fate]) {
    let mut needed = vec![false; level.points.len()];
    for face in (0..fates.len()).filter(|&face| fates[face] != Fate::Hidden) {
        for &vertex in &level.corners[level.corners_of(face)] {
            needed[vertex as usize] = kinds[vertex as usize].is_settled;
        }
    }
    let mut limits = std::mem::take(&mut level.limits);
    let found: &Level = level;
    limits.par_iter_mut().enumerate().with_min_len(1024).for_each(|(vertex, limit)| {
        if needed[vertex] && limit[0].is_nan() {
            *limit = position(found, vertex, kinds[vertex].rule).as_vec3().to_array();
        }
    });
    level.limits = limits;
}

/// Where a settled vertex ends up.
fn position(level: &Level, vertex: usize, rule: Rule) -> DVec3 {
    match rule {
        Rule::Smooth => smooth(level, vertex),
        Rule::Dart => dart::position(level, vertex),
        Rule::Crease => crease(level, vertex),
        Rule::Corner => level.points[vertex],
    }
}

fn smooth(level: &Level, vertex: usize) -> DVec3 {
    let fan = level.fan(vertex);
    let count = fan.len() as f64;
    let mut around = DVec3::ZERO;
    for &corner in fan {
        let next = level.next(corner as usize);
        around += level.point(next) * 4.0 + level.points[level.end(next)];
    }
    (level.points[vertex] * (count * count) + around) / (count * (count + 5.0))
}

fn crease(level: &Level, vertex: usize) -> DVec3 {
    let mut ends = DVec3::ZERO;
    for (half_edge, starts_here) in level.edges_at(vertex).filter(|&(edge, _)| level.is_crease(edge)) {
        ends += level.points[if starts_here { level.end(half_edge) } else { level.vertex(half_edge) }];
    }
    (level.points[vertex] * 4.0 + ends) / 6.0
}
