//! One naive tree over a whole mesh, to compare with: planes in random order, polygons as lists of points in floats, corners
//! within a tolerance of a plane taken to be in it (Fuchs, Kedem & Naylor 1980; de Berg et al. 2008, ch. 12).

use glam::DVec3;

use super::Triangle;

/// Corners nearer to a plane than this share of the longest side are in it.
const TOLERANCE: f64 = 1.0e-9;

struct Polygon {
    normal: DVec3,
    offset: f64,
    corners: Vec<DVec3>,
}

/// A node and what is before and behind it.
#[derive(Default)]
struct Node {
    own: Vec<Polygon>,
    front: Option<Box<Node>>,
    back: Option<Box<Node>>,
}

/// A tree, and how many pieces it has.
pub(super) struct Tree {
    root: Option<Box<Node>>,
    pub(super) pieces: usize,
}

/// A deep tree would overflow the stack if each node dropped its own.
impl Drop for Tree {
    fn drop(&mut self) {
        let mut waiting: Vec<Box<Node>> = self.root.take().into_iter().collect();
        while let Some(mut node) = waiting.pop() {
            waiting.extend(node.front.take());
            waiting.extend(node.back.take());
            std::hint::black_box(&node.own);
        }
    }
}

/// Builds it.
pub(super) fn build(triangles: &[Triangle]) -> Tree {
    let mut polygons: Vec<Polygon> = triangles.iter().filter_map(polygon).collect();
    shuffle(&mut polygons);
    let longest = longest_side(&polygons);
    let mut pieces = 0;
    let root = grow(polygons, TOLERANCE * longest, &mut pieces);
    Tree { root, pieces }
}

fn polygon(triangle: &Triangle) -> Option<Polygon> {
    let corners = triangle.map(|corner| DVec3::from(corner.map(f64::from)));
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize()?;
    Some(Polygon { normal, offset: normal.dot(corners[0]), corners: corners.to_vec() })
}

/// Always the same order.
fn shuffle(polygons: &mut [Polygon]) {
    let mut state = 1_u64;
    for k in (1..polygons.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        polygons.swap(k, ((state >> 33) % (k as u64 + 1)) as usize);
    }
}

fn longest_side(polygons: &[Polygon]) -> f64 {
    let corners = || polygons.iter().flat_map(|polygon| &polygon.corners);
    let low = corners().fold(DVec3::INFINITY, |low, corner| low.min(*corner));
    let high = corners().fold(DVec3::NEG_INFINITY, |high, corner| high.max(*corner));
    (high - low).max_element().max(0.0)
}

/// A place in the tree where some polygons go.
type Task<'a> = (&'a mut Option<Box<Node>>, Vec<Polygon>);

fn grow(polygons: Vec<Polygon>, tolerance: f64, pieces: &mut usize) -> Option<Box<Node>> {
    let mut root = None;
    let mut tasks: Vec<Task<'_>> = vec![(&mut root, polygons)];
    while let Some((place, polygons)) = tasks.pop() {
        let mut polygons = polygons.into_iter();
        let Some(first) = polygons.next() else { continue };
        let (normal, offset) = (first.normal, first.offset);
        let (mut own, mut front, mut back) = (vec![first], Vec::new(), Vec::new());
        for polygon in polygons {
            let values: Vec<f64> =
                polygon.corners.iter().map(|corner| normal.dot(*corner) - offset).collect();
            let before = values.iter().any(|value| *value > tolerance);
            let behind = values.iter().any(|value| *value < -tolerance);
            match (before, behind) {
                (false, false) => own.push(polygon),
                (true, false) => front.push(polygon),
                (false, true) => back.push(polygon),
                (true, true) => {
                    back.push(half(&polygon, &values, -1.0));
                    front.push(half(&polygon, &values, 1.0));
                }
            }
        }
        *pieces += own.len();
        let node = place.insert(Box::new(Node { own, front: None, back: None }));
        tasks.push((&mut node.front, front));
        tasks.push((&mut node.back, back));
    }
    root
}

/// What of a polygon is on one side of a plane, given its corners' values.
fn half(polygon: &Polygon, values: &[f64], way: f64) -> Polygon {
    let mut corners = Vec::with_capacity(values.len() + 1);
    for (k, corner) in polygon.corners.iter().enumerate() {
        let next = (k + 1) % values.len();
        let (here, there) = (values[k] * way, values[next] * way);
        if here >= 0.0 {
            corners.push(*corner);
        }
        if (here < 0.0) != (there < 0.0) {
            corners.push(*corner + (polygon.corners[next] - *corner) * (here / (here - there)));
        }
    }
    Polygon { corners, ..*polygon }
}
