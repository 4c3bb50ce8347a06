//! Numbers of the subdivision matrix around a vertex, and of how Gregory patches follow it (Loop, Schaefer, Ni & Castaño
//! 2009, section 3).

use glam::DVec3;
use libm::cos;

use super::sector::Sector;

/// What belongs to waves that turn by `angle` from edge to edge around a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    /// The angle from edge to edge.
    pub(super) angle: f64,
    /// Its cosine.
    pub(super) cosine: f64,
    /// The eigenvalue: how much smaller a level makes it.
    pub(super) eigenvalue: f64,
    /// Weight of a vertex at the end of an edge, for a control point of the patch. Those opposite have `ratio` times as much.
    pub(super) weight: f64,
    /// See `weight`.
    pub(super) ratio: f64,
    /// How far opposite vertices are, if those at the ends of edges are at 1.
    pub(super) reach: f64,
}

impl Wave {
    /// For `count` faces in a turn.
    pub(super) fn around(count: f64) -> Self {
        let angle = std::f64::consts::TAU / count;
        let (cosine, half) = (cos(angle), cos(angle * 0.5));
        let eigenvalue = (5.0 + cosine + half * (18.0 + 2.0 * cosine).sqrt()) / 16.0;
        let sigma = 1.0 / (4.0 + half * half).sqrt();
        let ends = (1.0 + sigma * half) * 0.5;
        Self {
            angle,
            cosine,
            eigenvalue,
            weight: 4.0 / 3.0 * eigenvalue / count * ends,
            ratio: sigma * 0.5 / ends,
            reach: 2.0 * half / (4.0 * eigenvalue - 1.0),
        }
    }

    /// The sum of a sector's vertices, the one at the end of edge `j` times `shape(j · angle)`, opposite ones between.
    pub(super) fn sum(&self, sector: &Sector, shape: impl Fn(f64) -> f64) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for place in 0..sector.count() {
            let angle = place as f64 * self.angle;
            sum += sector.ends[place] * shape(angle);
            sum += sector.opposite[place] * (self.ratio * shape(angle + 0.5 * self.angle));
        }
        sum * self.weight
    }
}
