//! Where a crease ends in a smooth surface. Only the vertex on the crease moves by another rule than around a smooth vertex,
//! to the middle of its edge; so weights are the left eigenvectors of another matrix (section 4 of Biermann, Levin & Zorin
//! 2000 explains how limits follow from them).

use glam::DVec3;
use libm::cos;

use super::eigen::Wave;
use super::level::Level;
use super::sector::Sector;

/// Steps in which the eigenvector is found: others are left behind by a fifth or more each time.
const STEPS: usize = 160;

/// Weights of the vertices around; those of a sector that begins at the crease.
struct Weights {
    ends: Vec<f64>,
    opposite: Vec<f64>,
    here: f64,
}

/// Where the vertex ends up.
pub(super) fn position(level: &Level, vertex: usize) -> DVec3 {
    let here = level.points[vertex];
    Sector::all(level, vertex)
        .first()
        .map_or(here, |sector| here + Weights::limit(sector.count()).apply(sector))
}

/// Two tangents: along the crease, and a quarter turn on.
pub(super) fn tangents(sector: &Sector, wave: &Wave) -> [DVec3; 2] {
    let weights = Weights::tangent(sector.count());
    let (mut found, mut wanted) = (0.0, 0.0);
    for place in 0..sector.count() {
        let (end, opposite) = (wave.at(place)[0], wave.after(place)[0]);
        found += weights.ends[place] * end + weights.opposite[place] * wave.reach * opposite;
        wanted += wave.weight * (end * end + wave.ratio * wave.reach * opposite * opposite);
    }
    [weights.apply(sector) * (wanted / found), wave.sums(sector)[1]]
}

impl Weights {
    /// Of the limit position: they change no more. Those of the edges' ends obey 7 x(j) - x(j-1) - x(j+1) = 20 / n², and are
    /// 0 on the crease as far as others see it.
    fn limit(count: usize) -> Self {
        let n = count as f64;
        let root = (7.0 - 45.0_f64.sqrt()) * 0.5;
        let power = |place: usize| libm::pow(root, place as f64);
        let across = |place: usize| {
            if place.is_multiple_of(count) {
                return 0.0;
            }
            4.0 / (n * n) * (1.0 - (power(place) + power(count - place)) / (1.0 + power(count)))
        };
        let mut ends: Vec<f64> = (0..count).map(across).collect();
        let between = |place: usize| (across(place) + across(place + 1)) / 12.0 + 1.0 / (3.0 * n * n);
        let opposite: Vec<f64> = (0..count).map(between).collect();
        let beside = across(1) + across(count - 1);
        ends[0] = beside / 8.0 + (opposite[count - 1] + opposite[0]) * 0.5 + 3.0 / (n * n);
        let sum = 1.0 + ends.iter().chain(&opposite).sum::<f64>();
        Self { ends, opposite, here: 1.0 }.scaled(1.0 / sum)
    }

    /// Of the tangent along the crease: of all that are the same on both sides of the crease they decay least.
    fn tangent(count: usize) -> Self {
        let limit = Self::limit(count);
        let angle = std::f64::consts::TAU / count as f64;
        let ends = (0..count).map(|place| cos(place as f64 * angle)).collect();
        let mut weights = Self { ends, opposite: vec![0.0; count], here: 0.0 };
        for _ in 0..STEPS {
            weights = weights.without(&limit).step();
            let largest = weights.all().fold(f64::MIN_POSITIVE, |most, x| x.abs().max(most));
            weights = weights.scaled(1.0 / largest);
        }
        weights.without(&limit)
    }

    fn all(&self) -> impl Iterator<Item = f64> {
        self.ends.iter().chain(&self.opposite).copied().chain([self.here])
    }

    /// The weights times the matrix.
    fn step(&self) -> Self {
        let count = self.ends.len();
        let n = count as f64;
        // As others see it the vertex on the crease is not there.
        let end = |place: usize| if place.is_multiple_of(count) { 0.0 } else { self.ends[place % count] };
        let opposite = |place: usize| {
            (end(place) + end(place + 1)) / 16.0 + self.opposite[place] * 0.25 + self.here / (4.0 * n * n)
        };
        let along = |place: usize| {
            let own = self.ends[place] * if place == 0 { 0.5 } else { 0.375 };
            let faces = self.opposite[(place + count - 1) % count] + self.opposite[place];
            own + (end(place + count - 1) + end(place + 1)) / 16.0 + faces * 0.25 + self.here * 1.5 / (n * n)
        };
        let here = self.ends[0] * 0.125 + self.ends.iter().sum::<f64>() * 0.375;
        Self {
            ends: (0..count).map(along).collect(),
            opposite: (0..count).map(opposite).collect(),
            here: here + self.opposite.iter().sum::<f64>() * 0.25 + self.here * (1.0 - 1.75 / n),
        }
    }

    /// Less as much of the limit's weights as they contain.
    fn without(mut self, limit: &Self) -> Self {
        let sum: f64 = self.all().sum();
        let pairs =
            self.ends.iter_mut().zip(&limit.ends).chain(self.opposite.iter_mut().zip(&limit.opposite));
        pairs.for_each(|(weight, part)| *weight -= sum * part);
        self.here -= sum * limit.here;
        self
    }

    fn scaled(mut self, factor: f64) -> Self {
        self.ends
            .iter_mut()
            .chain(&mut self.opposite)
            .chain([&mut self.here])
            .for_each(|weight| *weight *= factor);
        self
    }

    /// The weighted sum of a sector's vertices, which are counted from the vertex itself.
    fn apply(&self, sector: &Sector) -> DVec3 {
        let ends: DVec3 = self.ends.iter().zip(&sector.ends).map(|(&weight, &end)| end * weight).sum();
        ends + self.opposite.iter().zip(&sector.opposite).map(|(&weight, &far)| far * weight).sum::<DVec3>()
    }
}
