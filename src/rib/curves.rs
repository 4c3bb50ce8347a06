//! Curves and their widths (RenderMan Interface 3.2, section 5.6).

use super::geometry::{Read, check_count, points};
use super::model::{RibBasis, RibCurve, RibCurves, RibGeometry};
use super::parameters::{Class, Declarations, Parameters};
use super::patches::{Bases, check_steps, choice};
use super::request::Request;
use crate::error::Result;

/// `Curves`.
pub(super) fn curves(request: &mut Request, known: &Declarations, bases: &Bases) -> Result<Read> {
    let is_linear = choice(request, "type", ["linear", "cubic"])?;
    let counts = request.indices("numbers of points")?;
    let is_periodic = choice(request, "wrap", ["periodic", "nonperiodic"])?;
    let step = if is_linear { 1 } else { bases.steps[1] };
    let kind = Kind { is_linear, basis: bases.bases[1], step, is_periodic };
    for &count in &counts {
        check_steps(request, is_linear, (count as usize, step, is_periodic))?;
    }
    let mut parameters = Parameters::of(request, known)?;
    let points = points(request, &mut parameters)?;
    let total = counts.iter().try_fold(0_usize, |sum, &count| sum.checked_add(count as usize));
    check_count(request, points.len(), total)?;
    let widths = widths(request, &mut parameters)?;
    let curves = kind.curves(request, &counts, &points, &widths)?;
    let Kind { is_linear, basis, step, is_periodic } = kind;
    Ok((RibGeometry::Curves(RibCurves { is_linear, basis, step, is_periodic, curves }), parameters))
}

/// The widths of all curves, and for what there is one.
struct Widths {
    class: Class,
    list: Vec<f64>,
}

/// `width`, or `constantwidth`, or 1.
fn widths(request: &Request, parameters: &mut Parameters) -> Result<Widths> {
    let constant = parameters.take("constantwidth");
    let found = parameters.take("width").or(constant);
    let Some(parameter) = found else { return Ok(Widths { class: Class::Constant, list: vec![1.0] }) };
    let class = parameter.declaration.class;
    let list = parameter.numbers()?;
    match list.iter().find(|&&width| width < 0.0) {
        Some(width) => Err(request.wrong(format_args!("a width is {width}"), "use widths from 0")),
        None => Ok(Widths { class, list }),
    }
}

/// What all curves have in common.
struct Kind {
    is_linear: bool,
    basis: RibBasis,
    step: usize,
    is_periodic: bool,
}

impl Kind {
    /// Ends of segments of a curve of so many points. The two ends of a closed one are the same.
    fn ends(&self, count: usize) -> usize {
        match (self.is_linear, self.is_periodic) {
            (true, _) => count,
            (false, true) => count / self.step,
            (false, false) => count.saturating_sub(4) / self.step + 2,
        }
    }

    /// How many widths a curve has.
    fn share(&self, class: Class, count: usize) -> usize {
        match class {
            Class::Constant => 0,
            Class::Uniform => 1,
            Class::Varying | Class::FaceVarying => self.ends(count),
            Class::Vertex => count,
        }
    }

    fn curves(
        &self,
        request: &Request,
        counts: &[u32],
        points: &[[f64; 3]],
        widths: &Widths,
    ) -> Result<Vec<RibCurve>> {
        // A single width is that of all, whatever its class.
        let class = if widths.list.len() == 1 { Class::Constant } else { widths.class };
        let expected = match class {
            Class::Constant => 1,
            _ => counts.iter().map(|&count| self.share(class, count as usize)).sum(),
        };
        if widths.list.len() != expected {
            let problem = format_args!("it has {} widths, and should have {expected}", widths.list.len());
            return Err(
                request.wrong(problem, "give one for all curves, for each, or for each end of a segment")
            );
        }
        let (mut first, mut first_width) = (0, 0);
        let each = counts.iter().map(|&count| {
            let own = &points[first..first + count as usize];
            let share = self.share(class, count as usize);
            let own_widths = if class == Class::Constant {
                &widths.list[..]
            } else {
                &widths.list[first_width..first_width + share]
            };
            (first, first_width) = (first + count as usize, first_width + share);
            let widths = if class == Class::Vertex { self.at_ends(own_widths) } else { own_widths.to_vec() };
            RibCurve { points: own.to_vec(), widths }
        });
        Ok(each.collect())
    }

    /// The widths at the ends of segments, where the file has one for each point.
    fn at_ends(&self, widths: &[f64]) -> Vec<f64> {
        if self.is_linear {
            return widths.to_vec();
        }
        let value = |index: usize| widths[index % widths.len()];
        let at = |end: usize| {
            // The last end is that of the last segment.
            let segment = if self.is_periodic { end } else { end.min(self.ends(widths.len()) - 2) };
            let [a, b, c, d] = [0, 1, 2, 3].map(|index| value(segment * self.step + index));
            let [before, here, after] = if end == segment { [a, b, c] } else { [b, c, d] };
            match self.basis {
                RibBasis::Bezier => {
                    if end == segment {
                        a
                    } else {
                        d
                    }
                }
                RibBasis::BSpline => (before + 4.0 * here + after) / 6.0,
                RibBasis::CatmullRom => here,
                RibBasis::Hermite => {
                    if end == segment {
                        a
                    } else {
                        c
                    }
                }
                RibBasis::Power => {
                    if end == segment {
                        d
                    } else {
                        a + b + c + d
                    }
                }
            }
        };
        (0..self.ends(widths.len())).map(at).map(|width| width.max(0.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{geometry, wrong};

    /// So many points along x.
    fn points(count: usize) -> String {
        let numbers: Vec<_> = (0..count).map(|x| format!("{x} 0 0")).collect();
        format!("\"P\" [{}]", numbers.join(" "))
    }

    fn curves(request: &str) -> RibCurves {
        match geometry(request) {
            RibGeometry::Curves(curves) => curves,
            other => panic!("{other:?}"),
        }
    }

    fn widths(request: &str) -> Vec<Vec<f64>> {
        curves(request).curves.into_iter().map(|curve| curve.widths).collect()
    }

    #[test]
    fn points_are_those_of_one_curve_after_the_other() {
        let read = curves(&format!("Curves \"linear\" [2 3] \"nonperiodic\" {}", points(5)));
        assert!(read.is_linear && !read.is_periodic);
        assert_eq!(read.curves[1].points, [[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
        assert_eq!(read.curves[1].widths, [1.0]);
        let cubic = curves(&format!(
            "Basis \"bezier\" 3 \"b-spline\" 1 Curves \"cubic\" [5] \"periodic\" {}",
            points(5)
        ));
        assert_eq!((cubic.basis, cubic.step, cubic.is_periodic), (RibBasis::BSpline, 1, true));
    }

    #[test]
    fn widths_are_constant_or_stand_at_curves_ends_or_points() {
        let two =
            |width: &str| widths(&format!("Curves \"cubic\" [4 7] \"nonperiodic\" {} {width}", points(11)));
        assert_eq!(two("\"constantwidth\" [0.5]"), [[0.5], [0.5]]);
        assert_eq!(two("\"constant float width\" 0.5"), [[0.5], [0.5]]);
        assert_eq!(two("\"uniform float width\" [1 2]"), [[1.0], [2.0]]);
        assert_eq!(two("\"width\" [1 2 3 4 5]"), [vec![1.0, 2.0], vec![3.0, 4.0, 5.0]]);
        assert_eq!(
            two("\"vertex float width\" [1 9 9 2 3 9 9 4 9 9 5]"),
            [vec![1.0, 2.0], vec![3.0, 4.0, 5.0]]
        );
    }

    #[test]
    fn widths_of_points_follow_the_basis() {
        let five = |basis: &str, wrap: &str, width: &str| {
            let request = format!("Basis {basis} {basis} Curves \"cubic\" [5] \"{wrap}\" {}", points(5));
            widths(&format!("{request} \"vertex float width\" [{width}]")).remove(0)
        };
        assert_eq!(five("\"catmull-rom\" 1", "nonperiodic", "9 1 2 3 9"), [1.0, 2.0, 3.0]);
        assert_eq!(five("\"b-spline\" 1", "nonperiodic", "0 6 0 6 12"), [4.0, 2.0, 6.0]);
        assert_eq!(five("\"b-spline\" 1", "periodic", "0 6 0 6 12"), [4.0, 2.0, 6.0, 9.0, 3.0]);
    }

    #[test]
    fn numbers_that_do_not_fit_are_refused() {
        for (request, part) in [
            (format!("Curves \"cubic\" [5] \"nonperiodic\" {}", points(5)), "5 points do not make whole"),
            (format!("Curves \"cubic\" [4] \"nonperiodic\" {}", points(5)), "5 points, and should have 4"),
            (format!("Curves \"linear\" [1] \"nonperiodic\" {}", points(1)), "1 points do not make whole"),
            (
                format!("Curves \"linear\" [2] \"nonperiodic\" {} \"width\" [1 2 3]", points(2)),
                "3 widths, and should have 2",
            ),
            (
                format!("Curves \"linear\" [2] \"nonperiodic\" {} \"width\" [1 -2]", points(2)),
                "a width is -2",
            ),
            (format!("Curves \"round\" [2] \"nonperiodic\" {}", points(2)), "its type is `round`"),
        ] {
            assert!(wrong(&request).contains(part), "{}", wrong(&request));
        }
    }
}
