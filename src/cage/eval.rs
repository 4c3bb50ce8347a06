//! The surface that is drawn, at any place of its cage.

use glam::DVec3;
use micropoly_core::patch::gregory::INNER;

use super::convert::Patches;
use super::origin::Origin;
use crate::gregory::GregoryPatch;
use crate::shape::BezierPatch;

/// A place on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// The position.
    pub position: DVec3,
    /// The unit normal; 0 where there is none.
    pub normal: DVec3,
    /// Has the surface one normal there? Not on creases, boundaries and corners.
    pub is_smooth: bool,
}

impl Evaluation {
    /// Of a Bézier patch alone, as if it were smooth everywhere.
    #[must_use]
    pub fn of_bezier(patch: &BezierPatch, u: f64, v: f64) -> Self {
        let net = patch.points.map(|point| DVec3::from(point.map(f64::from)));
        evaluate(&[net, [DVec3::ZERO; 16], [DVec3::ZERO; 16]], [u, v])
    }

    /// Of a Gregory patch alone, as if it were smooth everywhere.
    #[must_use]
    pub fn of_gregory(patch: &GregoryPatch, u: f64, v: f64) -> Self {
        evaluate(&gregory_nets(patch, [u, v]), [u, v])
    }
}

/// Finds patches by where they lie, and evaluates them.
#[derive(Clone, Debug)]
pub struct Evaluator<'a> {
    patches: &'a Patches,
    /// Patches in order of where they lie.
    order: Vec<Entry>,
    deepest: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    origin: Origin,
    is_gregory: bool,
    index: u32,
}

impl<'a> Evaluator<'a> {
    /// Of these patches.
    #[must_use]
    pub fn new(patches: &'a Patches) -> Self {
        let entries = |origins: &'a [Origin], is_gregory| {
            origins.iter().zip(0..).map(move |(&origin, index)| Entry { origin, is_gregory, index })
        };
        let mut order: Vec<Entry> = entries(&patches.bezier_origins, false).collect();
        order.extend(entries(&patches.gregory_origins, true));
        order.sort_unstable();
        let deepest = order.iter().map(|entry| entry.origin.level).max().unwrap_or(0);
        Self { patches, order, deepest }
    }

    /// Position and normal at (u, v) of a face, or of a sub-face (-1 in quads: see [`Origin`]); `None` if nothing is drawn
    /// there.
    #[must_use]
    pub fn at(&self, face: u32, sub: i32, u: f64, v: f64) -> Option<Evaluation> {
        let (entry, [u, v]) = (0..=self.deepest).find_map(|level| self.find(face, sub, level, [u, v]))?;
        let index = entry.index as usize;
        let found = if entry.is_gregory {
            Evaluation::of_gregory(self.patches.gregory.get(index)?, u, v)
        } else {
            Evaluation::of_bezier(self.patches.bezier.get(index)?, u, v)
        };
        Some(Evaluation { is_smooth: is_smooth(entry.origin.sharp, [u, v]), ..found })
    }

    /// The patch of one level, and where in it the place is.
    fn find(&self, face: u32, sub: i32, level: u8, place: [f64; 2]) -> Option<(Entry, [f64; 2])> {
        let squares = f64::from(1_u32 << level);
        let [x, y] = place.map(|t| ((t * squares).floor().max(0.0) as u16).min((squares - 1.0) as u16));
        let wanted = (face, sub, level, x, y);
        let key = |entry: &Entry| {
            let Origin { face, sub, level, x, y, .. } = entry.origin;
            (face, sub, level, x, y)
        };
        let entry = self.order[self.order.binary_search_by_key(&wanted, key).ok()?];
        Some((entry, [place[0] * squares - f64::from(x), place[1] * squares - f64::from(y)]))
    }
}

/// The net at a place, and how it changes along u and along v.
type Nets = [[DVec3; 16]; 3];

/// A Gregory patch's nets: its inner points are blends of two face points each, by the distances from the two borders
/// beside them.
fn gregory_nets(patch: &GregoryPatch, [u, v]: [f64; 2]) -> Nets {
    let mut nets =
        [patch.net().map(|point| DVec3::from(point.map(f64::from))), [DVec3::ZERO; 16], [DVec3::ZERO; 16]];
    let faces = patch.faces(0);
    let face = |l: usize| DVec3::new(faces.x[l].into(), faces.y[l].into(), faces.z[l].into());
    for (m, at) in INNER.into_iter().enumerate() {
        let (of_u, of_v) = (face(m), face(4 + m));
        let (a, u_sign) = if m / 2 == 0 { (u, 1.0) } else { (1.0 - u, -1.0) };
        let (b, v_sign) = if m % 2 == 0 { (v, 1.0) } else { (1.0 - v, -1.0) };
        let sum = if a + b > 0.0 { a + b } else { 1.0 };
        nets[0][at] = of_v + (of_u - of_v) * (b / sum);
        nets[1][at] = (of_u - of_v) * (-u_sign * b / (sum * sum));
        nets[2][at] = (of_u - of_v) * (v_sign * a / (sum * sum));
    }
    nets
}

fn evaluate(nets: &Nets, [u, v]: [f64; 2]) -> Evaluation {
    let ((along_u, slope_u), (along_v, slope_v)) = (weights(u), weights(v));
    let sum = |net: &[DVec3; 16], u: &[f64; 4], v: &[f64; 4]| -> DVec3 {
        (0..16).map(|l| net[l] * (u[l / 4] * v[l % 4])).sum()
    };
    let du = sum(&nets[0], &slope_u, &along_v) + sum(&nets[1], &along_u, &along_v);
    let dv = sum(&nets[0], &along_u, &slope_v) + sum(&nets[2], &along_u, &along_v);
    let normal = du.cross(dv).normalize_or_zero();
    Evaluation { position: sum(&nets[0], &along_u, &along_v), normal, is_smooth: true }
}

/// Bernstein weights of degree 3 and their derivatives.
fn weights(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    let [a, b, c] = [s * s, 2.0 * s * t, t * t];
    ([a * s, 1.5 * b * s, 1.5 * b * t, c * t], [-3.0 * a, 3.0 * (a - b), 3.0 * (b - c), 3.0 * c])
}

/// Is a place in a patch on none of its sharp sides and corners?
fn is_smooth(sharp: u8, [u, v]: [f64; 2]) -> bool {
    let at = [[v == 0.0, v == 1.0], [u == 0.0, u == 1.0]];
    let side = |side: usize| sharp >> side & 1 == 1 && at[side / 2][side % 2];
    let corner = |corner: usize| sharp >> (4 + corner) & 1 == 1 && at[0][corner / 2] && at[1][corner % 2];
    !(0..4).any(|k| side(k) || corner(k))
}
