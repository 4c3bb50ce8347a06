//! Welding: control points that differ by rounding only become the same bits.

use super::net::Net;

/// How far apart such points may be, as a part of the largest coordinate; and their weights, as a part of these.
const TOLERANCE: f64 = 1.0e-12;

/// Makes opposite sides of a net of bicubics equal where they meet, and borders of its patches that are points one point.
pub(super) fn weld(net: &mut Net) {
    let tolerance = TOLERANCE * largest_coordinate(net);
    let (mut places, mut weights) = (Groups::new(net.points.len()), Groups::new(net.points.len()));
    for curve in borders(net) {
        if curve.iter().all(|&k| is_near(net, curve[0], k, tolerance)) {
            curve.iter().for_each(|&k| places.join(curve[0], k));
        }
    }
    for pair in opposites(net) {
        if pair.iter().all(|&[a, b]| is_near(net, a, b, tolerance) && weigh_the_same(net, a, b)) {
            pair.iter().for_each(|&[a, b]| places.join(a, b));
            pair.iter().for_each(|&[a, b]| weights.join(a, b));
        }
    }
    for k in 0..net.points.len() {
        let [x, y, z, _] = net.points[places.first(k)];
        net.points[k] = [x, y, z, net.points[weights.first(k)][3]];
    }
}

fn largest_coordinate(net: &Net) -> f64 {
    net.points.iter().flat_map(|point| &point[..3]).fold(0.0, |most, c| most.max(c.abs()))
}

fn is_near(net: &Net, a: usize, b: usize, tolerance: f64) -> bool {
    (0..3).all(|axis| (net.points[a][axis] - net.points[b][axis]).abs() <= tolerance)
}

fn weigh_the_same(net: &Net, a: usize, b: usize) -> bool {
    let [a, b] = [net.points[a][3], net.points[b][3]];
    (a - b).abs() <= TOLERANCE * a.max(b)
}

/// The borders of all patches, those along v first.
fn borders(net: &Net) -> impl Iterator<Item = [usize; 4]> + use<> {
    let [rows, columns] = net.counts;
    let along_v = starts(rows, columns).map(move |(i, j)| [0, 1, 2, 3].map(|k| i * columns + j + k));
    let along_u = starts(columns, rows).map(move |(j, i)| [0, 1, 2, 3].map(|k| (i + k) * columns + j));
    along_v.chain(along_u)
}

/// Lines between patches, and where along them a border starts.
fn starts(lines: usize, length: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..lines).step_by(3).flat_map(move |line| (3..length).step_by(3).map(move |end| (line, end - 3)))
}

/// Points that face each other: of borders on the first and the last row, and on the first and the last column.
fn opposites(net: &Net) -> impl Iterator<Item = [[usize; 2]; 4]> + use<> {
    let [rows, columns] = net.counts;
    let (last_row, last_column) = (rows.saturating_sub(1) * columns, columns.saturating_sub(1));
    let along_v = starts(1, columns).map(move |(_, j)| [0, 1, 2, 3].map(|k| [j + k, last_row + j + k]));
    let along_u = starts(1, rows)
        .map(move |(_, i)| [0, 1, 2, 3].map(|k| (i + k) * columns).map(|k| [k, k + last_column]));
    along_v.chain(along_u)
}

/// Disjoint sets of points (Tarjan 1975, without ranks: sets are small); each is known by its first.
struct Groups {
    earlier: Vec<usize>,
}

impl Groups {
    fn new(count: usize) -> Self {
        Self { earlier: (0..count).collect() }
    }

    fn first(&mut self, mut k: usize) -> usize {
        while self.earlier[k] != k {
            self.earlier[k] = self.earlier[self.earlier[k]];
            k = self.earlier[k];
        }
        k
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.earlier[a.max(b)] = a.min(b);
    }
}
