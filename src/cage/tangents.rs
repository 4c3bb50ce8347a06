//! Control points beside irregular vertices, found once for all patches that share them.

use glam::DVec3;
use rayon::prelude::*;

use super::dart;
use super::eigen::{Wave, Waves};
use super::fan::Fan;
use super::level::{Level, NONE};
use super::sector::Sector;
use super::tags::{Fate, Kind, Rule};

/// Control points beside vertices, along their edges.
pub(super) struct Tangents {
    /// Where those of each corner begin: the one along the edge to the next corner, then the one along that to the corner
    /// before. `NONE` at regular vertices.
    slots: Vec<u32>,
    spokes: Vec<Spoke>,
}

/// One of them.
#[derive(Clone, Copy)]
struct Spoke {
    point: DVec3,
    /// See [`Beside::cosine`].
    cosine: f64,
}

/// What a patch needs to know of a corner.
#[derive(Clone, Copy)]
pub(super) struct Beside {
    /// The control point along the edge to the next corner.
    pub(super) next: DVec3,
    /// The one along the edge to the corner before.
    pub(super) previous: DVec3,
    /// Twice this times the way to any point is the sum of the ways to its two neighbours around the vertex.
    pub(super) cosine: f64,
}

impl Tangents {
    /// Those that the Gregory patches of a level need.
    pub(super) fn of(level: &Level, kinds: &[Kind], fates: &[Fate]) -> Self {
        let vertices = irregular(level, kinds, fates);
        let mut tangents = Self { slots: Vec::new(), spokes: Vec::new() };
        if vertices.is_empty() {
            return tangents;
        }
        tangents.slots = vec![NONE; level.corners.len()];
        let waves = &Waves::new();
        for some in vertices.chunks(1 << 16) {
            let found: Vec<_> = some
                .par_iter()
                .flat_map_iter(|&vertex| {
                    let (limit, rule) =
                        (DVec3::from(level.limits[vertex].map(f64::from)), kinds[vertex].rule);
                    let with = move |sector: Sector| (spokes(&sector, limit, rule, waves), sector.corners);
                    Sector::all(level, vertex).into_iter().map(with)
                })
                .collect();
            for (spokes, corners) in found {
                for (place, corner) in corners.into_iter().enumerate() {
                    tangents.slots[corner] = (tangents.spokes.len() + place) as u32;
                }
                tangents.spokes.extend(spokes);
            }
        }
        tangents
    }

    /// At a corner of an irregular vertex.
    pub(super) fn at(&self, corner: usize) -> Option<Beside> {
        let slot = *self.slots.get(corner).filter(|&&slot| slot != NONE)? as usize;
        let (next, previous) = (self.spokes[slot], self.spokes[slot + 1]);
        Some(Beside { next: next.point, previous: previous.point, cosine: next.cosine })
    }
}

/// Irregular vertices of Gregory patches, in order.
fn irregular(level: &Level, kinds: &[Kind], fates: &[Fate]) -> Vec<usize> {
    let mut needed = vec![false; level.points.len()];
    for face in (0..fates.len()).filter(|&face| fates[face] == Fate::Irregular) {
        for &vertex in &level.corners[level.corners_of(face)] {
            needed[vertex as usize] = !kinds[vertex as usize].is_regular;
        }
    }
    (0..needed.len()).filter(|&vertex| needed[vertex]).collect()
}

/// Control points along the edges of a sector, one more than it has faces.
fn spokes(sector: &Sector, limit: DVec3, rule: Rule, waves: &Waves) -> Vec<Spoke> {
    let count = sector.count();
    match rule {
        Rule::Smooth => {
            let wave = waves.around(count);
            turned(limit, &wave, wave.sums(sector), count, 1.0)
        }
        Rule::Dart => {
            let wave = waves.around(count);
            turned(limit, &wave, dart::tangents(sector, &wave), count, 1.0)
        }
        Rule::Crease => {
            let wave = waves.around(2 * count);
            turned(limit, &wave, crease(sector, &wave), count, -1.0)
        }
        Rule::Corner => corner(sector, limit),
    }
}

/// Along ellipses: the sum of two neighbours is the same multiple of what is between them everywhere. The last point is
/// the first one's `last` times: the same bits as from the other side of the edge.
fn turned(limit: DVec3, wave: &Wave, [along, across]: [DVec3; 2], count: usize, last: f64) -> Vec<Spoke> {
    let at = |place: usize| {
        let [cosine, sine] = wave.at(place);
        match place {
            0 => along,
            _ if place == count => along * last,
            _ => along * cosine + across * sine,
        }
    };
    (0..=count).map(|place| Spoke { point: limit + at(place), cosine: wave.cosine }).collect()
}

/// Along the crease, and away from it: the left eigenvector whose part inside the sector is half a wave.
fn crease(sector: &Sector, wave: &Wave) -> [DVec3; 2] {
    let count = sector.count();
    let along = (sector.ends[0] - sector.ends[count]) / 6.0;
    if count == 1 {
        return [along, DVec3::ZERO];
    }
    let sum: f64 = (0..count).map(|place| wave.at(place)[1] + wave.ratio * wave.after(place)[1]).sum();
    let beside = wave.at(1)[1] / 16.0 + wave.ratio * wave.after(0)[1] * 0.25;
    let on_crease = (beside - sum * 0.125) / (wave.eigenvalue - 0.25);
    let ends = (sector.ends[0] + sector.ends[count]) * (on_crease * wave.weight);
    [along, (wave.sums(sector)[1] + ends) * 2.0]
}

/// Where the vertex does not move: in the plane of the two creases, if they span one, so that no edge between them is a bend;
/// else straight to the neighbours. (Nothing is smooth at such a vertex, whatever is done: see section 4 of Biermann, Levin
/// & Zorin 2000.)
fn corner(sector: &Sector, limit: DVec3) -> Vec<Spoke> {
    let count = sector.count();
    let straight = |place: usize| sector.ends[place] / 3.0;
    if sector.is_closed {
        // All edges leave it the same way: what differs from their mean shrinks faster.
        let way = (0..count).map(straight).sum::<DVec3>() / count as f64;
        return vec![Spoke { point: limit + way, cosine: 1.0 }; count + 1];
    }
    let (first, last) = (straight(0), straight(count));
    let fan = if count > 1 { Fan::between(first, last, (1..count).map(straight), count) } else { None };
    let spoke = |place: usize| match fan {
        Some(fan) if place > 0 && place < count => {
            let way = first * fan.share(count - place) + last * fan.share(place);
            Spoke { point: limit + way, cosine: fan.cosine }
        }
        _ => Spoke { point: limit + straight(place), cosine: fan.map_or(0.0, |fan| fan.cosine) },
    };
    (0..=count).map(spoke).collect()
}
