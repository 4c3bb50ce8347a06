//! Numbers of the subdivision matrix around a vertex, and of how Gregory patches follow it (Loop, Schaefer, Ni & Castaño
//! 2009, section 3).

use std::borrow::Cow;

use glam::DVec3;
use libm::{cos, sin};

use super::sector::Sector;

/// What belongs to waves that turn once, or half, around a vertex.
#[derive(Clone, Debug)]
pub(super) struct Wave {
    /// The cosine of the angle from edge to edge.
    pub(super) cosine: f64,
    /// The eigenvalue: how much smaller a level makes it.
    pub(super) eigenvalue: f64,
    /// Weight of a vertex at the end of an edge, for a control point of the patch. Those opposite have `ratio` times as much.
    pub(super) weight: f64,
    /// See `weight`.
    pub(super) ratio: f64,
    /// How far opposite vertices are, if those at the ends of edges are at 1.
    pub(super) reach: f64,
    /// Cosine and sine of each multiple of half the angle, up to a turn.
    turns: Vec<[f64; 2]>,
}

/// Waves of the numbers of faces that are common.
pub(super) struct Waves(Vec<Wave>);

/// How many those are.
const COMMON: usize = 64;

impl Waves {
    pub(super) fn new() -> Self {
        Self((1..COMMON).map(Wave::around).collect())
    }

    /// For `count` faces in a turn.
    pub(super) fn around(&self, count: usize) -> Cow<'_, Wave> {
        match count.checked_sub(1).and_then(|place| self.0.get(place)) {
            Some(wave) => Cow::Borrowed(wave),
            None => Cow::Owned(Wave::around(count)),
        }
    }
}

impl Wave {
    fn around(faces: usize) -> Self {
        let count = faces as f64;
        let angle = std::f64::consts::TAU / count;
        let (cosine, half) = (cos(angle), cos(angle * 0.5));
        let eigenvalue = (5.0 + cosine + half * (18.0 + 2.0 * cosine).sqrt()) / 16.0;
        let sigma = 1.0 / (4.0 + half * half).sqrt();
        let ends = (1.0 + sigma * half) * 0.5;
        let turn = |place: usize| [cos(place as f64 * angle * 0.5), sin(place as f64 * angle * 0.5)];
        Self {
            cosine,
            eigenvalue,
            weight: 4.0 / 3.0 * eigenvalue / count * ends,
            ratio: sigma * 0.5 / ends,
            reach: 2.0 * half / (4.0 * eigenvalue - 1.0),
            turns: (0..=2 * faces).map(turn).collect(),
        }
    }

    /// Cosine and sine at an edge.
    pub(super) fn at(&self, edge: usize) -> [f64; 2] {
        self.turns[2 * edge]
    }

    /// Cosine and sine half-way from an edge to the next.
    pub(super) fn after(&self, edge: usize) -> [f64; 2] {
        self.turns[2 * edge + 1]
    }

    /// The sums of a sector's vertices, each times its cosine, and each times its sine.
    pub(super) fn sums(&self, sector: &Sector) -> [DVec3; 2] {
        let mut sums = [DVec3::ZERO; 2];
        for place in 0..sector.count() {
            for (axis, sum) in sums.iter_mut().enumerate() {
                *sum += sector.ends[place] * self.at(place)[axis];
                *sum += sector.opposite[place] * (self.ratio * self.after(place)[axis]);
            }
        }
        sums.map(|sum| sum * self.weight)
    }
}
