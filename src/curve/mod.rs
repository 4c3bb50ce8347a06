//! Curves with a width: ribbons of bicubic patches that face the camera.
//!
//! At four places a segment (its ends, and a third of it from either) the ribbon is exactly as wide as it should be,
//! perpendicular to the curve and to the line of sight; between them each edge is the cubic through its four points.
//! The edges of a quarter of a circle in one segment are off by up to 0.6 % of its width where the line of sight is 60° or
//! more from the curve, and by 6 % where it is 30°; those of an eighth by 0.1 % and 1 %.

#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::nurbs::{Basis, cubic_chain};
use crate::shape::BezierPatch;

/// A curve that is drawn as a ribbon.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Control points in object space.
    pub points: Vec<[f64; 3]>,
    /// Width in object space: one for all, or one a segment end, between which it changes evenly. A periodic curve has
    /// as many ends as segments, others one more.
    pub widths: Vec<f64>,
    /// What the control points mean.
    pub basis: Basis,
    /// Does the last segment reach the first one again?
    pub is_periodic: bool,
}

/// Why a curve cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// Segments need another number of control points.
    #[error("{count} control points do not make whole segments of {window} that start every {step}")]
    Count {
        /// How many there are.
        count: usize,
        /// Points of a segment.
        window: usize,
        /// Points from one segment's first to the next one's.
        step: usize,
    },
    /// Neither one width nor one a segment end.
    #[error("{found} widths for a curve with {ends} segment ends; it needs 1 or {ends}")]
    Widths {
        /// How many there are.
        found: usize,
        /// How many there should be.
        ends: usize,
    },
    /// A width that nothing can have.
    #[error(
        "width {index} (counted from 0) is {width}; it must be 0 or more, and no more than single precision has"
    )]
    Width {
        /// Which width.
        index: usize,
        /// Its value.
        width: f64,
    },
    /// A control point that is not finite, or too far away.
    #[error("control point {index} (counted from 0) is not finite, or too large for single precision")]
    Point {
        /// Which point.
        index: usize,
    },
}

/// Sines of angles between curve and line of sight below this say nothing about where the ribbon's edges are.
const NO_ANGLE: f64 = 1.0e-9;

impl Curve {
    /// A ribbon as seen from `eye` in object space: a patch a segment, u along the curve and v across, its front
    /// towards the eye. Segments share their borders.
    ///
    /// Where the curve turns back along the line of sight its ribbon goes on without a twist, and shows its back. Where
    /// it has no direction, or runs straight towards the eye, edges go on from the place before. At a corner they lie on
    /// the line that halves it, so that the ribbon is narrower there.
    ///
    /// # Errors
    /// [`CurveError`], if points or widths are too few, too many or not finite.
    pub fn ribbons(&self, eye: [f64; 3]) -> Result<Vec<BezierPatch>, CurveError> {
        let segments = self.check()?;
        let points: Vec<_> = self.points.iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect();
        let chain: Vec<DVec3> = cubic_chain(self.basis, self.basis.step(), 0..segments, &points)
            .into_iter()
            .map(|[x, y, z, _]| DVec3::new(x, y, z))
            .collect();
        let sides = self.sides(&chain, DVec3::from_array(eye));
        let pairs = chain.windows(4).step_by(3).zip(sides.windows(4).step_by(3));
        Ok(pairs.map(|(curve, sides)| ribbon(curve, sides)).collect())
    }

    /// Number of segments.
    fn check(&self) -> Result<usize, CurveError> {
        let (count, window, step) = (self.points.len(), self.basis.window(), self.basis.step());
        let wrong = CurveError::Count { count, window, step };
        let segments = self.basis.segments(count, step, self.is_periodic).ok_or(wrong)?;
        let (found, ends) = (self.widths.len(), segments + usize::from(!self.is_periodic));
        if found != 1 && found != ends {
            return Err(CurveError::Widths { found, ends });
        }
        self.check_values().map(|()| segments)
    }

    fn check_values(&self) -> Result<(), CurveError> {
        // A part of the largest number, so that points beside the curve are finite too.
        let largest = f64::from(f32::MAX) / 8.0;
        if let Some(index) = self.widths.iter().position(|width| !(0.0..=largest).contains(width)) {
            return Err(CurveError::Width { index, width: self.widths[index] });
        }
        let is_wild = |c: &f64| c.is_nan() || c.abs() > largest;
        match self.points.iter().position(|point| point.iter().any(is_wild)) {
            Some(index) => Err(CurveError::Point { index }),
            None => Ok(()),
        }
    }

    /// From the curve to the ribbon's edge at v = 1, at the ends and thirds of all segments.
    fn sides(&self, chain: &[DVec3], eye: DVec3) -> Vec<DVec3> {
        let mut sides = directions(chain, eye, self.is_periodic);
        for (place, side) in sides.iter_mut().enumerate() {
            *side *= 0.5 * self.width(place);
        }
        sides
    }

    /// The width at a number of thirds of segments.
    fn width(&self, place: usize) -> f64 {
        let at = |end: usize| self.widths[end % self.widths.len()];
        let (before, after) = (at(place / 3), at(place.div_ceil(3)));
        before + (after - before) * (place % 3) as f64 / 3.0
    }
}

/// Unit vectors across the ribbon, at the ends and thirds of all segments: none opposite to the one before.
fn directions(chain: &[DVec3], eye: DVec3, is_periodic: bool) -> Vec<DVec3> {
    let mut found: Vec<Option<DVec3>> =
        (0..chain.len()).map(|place| direction(chain, place, eye, is_periodic)).collect();
    let first = found.iter().flatten().next().copied();
    let mut last = first.unwrap_or_else(|| beside(chain.first().map_or(DVec3::Z, |&point| eye - point)));
    for side in &mut found {
        // Where there is none, the one before goes on.
        let here = side.unwrap_or(last);
        last = if here.dot(last) < 0.0 { -here } else { here };
        *side = Some(last);
    }
    let mut sides: Vec<DVec3> = found.into_iter().flatten().collect();
    if let (true, [first, .., last]) = (is_periodic, &mut sides[..]) {
        // The same line; the ribbon of a curve like that of Möbius arrives the other way round.
        *last = if last.dot(*first) < 0.0 { -*first } else { *first };
    }
    sides
}

/// Across the ribbon at one place, if that can be told; at a corner the mean of before and after it.
fn direction(chain: &[DVec3], place: usize, eye: DVec3, is_periodic: bool) -> Option<DVec3> {
    let (segment, third, last) = (place / 3, place % 3, (chain.len() - 1) / 3);
    let side = |segment: usize, place: usize| across(&chain[3 * segment..3 * segment + 4], place, eye);
    if third != 0 {
        return side(segment, third);
    }
    let before = if is_periodic { Some((segment + last - 1) % last) } else { segment.checked_sub(1) };
    let after = if is_periodic { Some(segment % last) } else { Some(segment).filter(|&after| after < last) };
    let (before, after) = (before.and_then(|s| side(s, 3)), after.and_then(|s| side(s, 0)));
    match (before, after) {
        (Some(a), Some(b)) => (a + if a.dot(b) < 0.0 { -b } else { b }).try_normalize(),
        (a, b) => a.or(b),
    }
}

/// The unit vector perpendicular to a segment and to the line of sight, at 0 to 3 thirds of it.
fn across(curve: &[DVec3], thirds: usize, eye: DVec3) -> Option<DVec3> {
    let tangent = tangent(curve, thirds)?;
    let view = (eye - point(curve, thirds)).try_normalize()?;
    let side = view.cross(tangent);
    if side.length() < NO_ANGLE { None } else { side.try_normalize() }
}

fn point(curve: &[DVec3], thirds: usize) -> DVec3 {
    let t = thirds as f64 / 3.0;
    let s = 1.0 - t;
    curve[0] * (s * s * s)
        + curve[1] * (3.0 * s * s * t)
        + curve[2] * (3.0 * s * t * t)
        + curve[3] * (t * t * t)
}

/// The unit vector along a segment; at its ends towards the next control point that is elsewhere.
fn tangent(curve: &[DVec3], thirds: usize) -> Option<DVec3> {
    let steps = [curve[1] - curve[0], curve[2] - curve[1], curve[3] - curve[2]];
    match thirds {
        0 => [curve[1], curve[2], curve[3]].iter().find_map(|&next| (next - curve[0]).try_normalize()),
        1 => (steps[0] * 4.0 + steps[1] * 4.0 + steps[2]).try_normalize(),
        2 => (steps[0] + steps[1] * 4.0 + steps[2] * 4.0).try_normalize(),
        _ => [curve[2], curve[1], curve[0]].iter().find_map(|&before| (curve[3] - before).try_normalize()),
    }
}

/// Some unit vector perpendicular to the line of sight.
fn beside(view: DVec3) -> DVec3 {
    view.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_vector()
}

/// One segment's patch, from points of the curve and vectors to its edge.
fn ribbon(curve: &[DVec3], sides: &[DVec3]) -> BezierPatch {
    let [a, b, c, d] = [sides[0], sides[1], sides[2], sides[3]];
    // The cubic that is a, b, c, d at 0, 1/3, 2/3 and 1.
    let inner = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| (-5.0 * a + 18.0 * b - 9.0 * c + 2.0 * d) / 6.0;
    let sides = [a, inner(a, b, c, d), inner(d, c, b, a), d];
    let mut patch = BezierPatch { points: [[0.0; 3]; 16] };
    for (k, point) in patch.points.iter_mut().enumerate() {
        let across = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0][k % 4];
        *point = (curve[k / 4] + across * sides[k / 4]).as_vec3().to_array().map(|c| c + 0.0);
    }
    patch
}
