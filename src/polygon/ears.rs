//! Dividing a polygon into triangles, each of its edges whole.
//!
//! Libraries for this leave out corners that lie on a line between their neighbours. That would divide the edge on the
//! other side only, so it is done here.

/// A point of a plane.
type Point = [f64; 2];

/// The coordinate plane that a polygon is seen in best, from its front.
pub(super) struct Flat {
    axes: [usize; 2],
}

impl Flat {
    /// Across the largest part of the polygon's normal (Newell's, in Sutherland, Sproull & Schumacker 1974).
    pub(super) fn new(corners: &[[f64; 3]]) -> Self {
        let normal = normal(corners);
        let mut most = 2;
        for axis in [0, 1] {
            if normal[axis].abs() > normal[most].abs() {
                most = axis;
            }
        }
        let (a, b) = ((most + 1) % 3, (most + 2) % 3);
        Self { axes: if normal[most] < 0.0 { [b, a] } else { [a, b] } }
    }

    pub(super) fn point(&self, place: [f64; 3]) -> Point {
        self.axes.map(|axis| place[axis])
    }

    pub(super) fn of(&self, corners: &[[f64; 3]]) -> Vec<Point> {
        corners.iter().map(|&corner| self.point(corner)).collect()
    }
}

/// Twice the polygon's area along each axis, from its first corner, so that it may be far from the origin.
fn normal(corners: &[[f64; 3]]) -> [f64; 3] {
    let Some(&origin) = corners.first() else { return [0.0; 3] };
    corners.windows(2).fold([0.0; 3], |sum, pair| {
        let [a, b] = [0, 1].map(|k| [0, 1, 2].map(|axis| pair[k][axis] - origin[axis]));
        [0, 1, 2].map(|k| {
            let (l, m) = ((k + 1) % 3, (k + 2) % 3);
            sum[k] + a[l] * b[m] - a[m] * b[l]
        })
    })
}

/// Twice the area of a triangle; above 0 if it is counter-clockwise.
fn area(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn square(a: Point, b: Point) -> f64 {
    (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])
}

/// Does a quadrilateral turn left at all corners, or nearly run straight on?
pub(super) fn is_convex(corners: [Point; 4]) -> bool {
    const NEARLY: f64 = -1.0e-9;
    (0..4).all(|k| {
        let [a, b, c] = [k, k + 1, k + 2].map(|k| corners[k % 4]);
        area(a, b, c) >= NEARLY * square(a, b).max(square(b, c))
    })
}

/// Do all edges run counter-clockwise around a point, well away from it, and once in all?
pub(super) fn sees_all(centre: Point, corners: &[Point]) -> bool {
    /// Least distance from an edge's line, in lengths of that edge.
    const AWAY: f64 = 0.01;
    let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
    let rises = edges().filter(|(a, b)| a[1] <= centre[1] && centre[1] < b[1]).count();
    rises == 1 && edges().all(|(&a, &b)| area(centre, a, b) > AWAY * square(a, b))
}

/// A polygon as triangles, by cutting off ears (Meisters 1975), the best-shaped first: two fewer than it has corners.
/// What intersects itself has no right answer, but gets triangles that have each of its edges once too.
pub(super) fn triangulated(corners: &[Point]) -> Vec<[usize; 3]> {
    let mut ring: Vec<usize> = (0..corners.len()).collect();
    let mut shapes: Vec<f64> = (0..ring.len()).map(|at| shape(corners, &ring, at)).collect();
    let mut triangles = Vec::with_capacity(corners.len());
    while ring.len() > 2 {
        let best = (1..ring.len()).fold(0, |best, at| if shapes[at] > shapes[best] { at } else { best });
        triangles.push(ear(&ring, best));
        ring.remove(best);
        shapes.remove(best);
        for at in [best + ring.len() - 1, best].map(|at| at % ring.len()) {
            shapes[at] = shape(corners, &ring, at);
        }
    }
    triangles
}

/// A corner of what is left of a polygon, between its neighbours.
fn ear(ring: &[usize], at: usize) -> [usize; 3] {
    let count = ring.len();
    [ring[(at + count - 1) % count], ring[at], ring[(at + 1) % count]]
}

/// How well-shaped an ear is: its height by its longest side. Below 0 if it is none.
fn shape(corners: &[Point], ring: &[usize], at: usize) -> f64 {
    let [a, b, c] = ear(ring, at).map(|k| corners[k]);
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    let shape = if longest > 0.0 { area(a, b, c) / longest } else { 0.0 };
    let is_inside = |p: Point| {
        let is_corner = p == a || p == b || p == c;
        !is_corner && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0
    };
    // No ear at all is worse than one without an area, and better than one that covers what is not there.
    if shape > 0.0 && ring.iter().any(|&k| is_inside(corners[k])) { -1.0 - shape } else { shape }
}
