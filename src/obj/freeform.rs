//! Free-form surfaces: `cstype`, `deg`, then `surf`, `parm u`, `parm v` and `end` for each.

use super::parameters::{MAX_DEGREE, first_descent, knots_of_pieces, point_count};
use super::vertices::{Corner, Vertices};
use super::words::{Words, shown, text};
use crate::error::{Error, Result};

/// Remedy for a surface of a type that cannot be drawn.
const CONVERT: &str = "convert the surface to `bezier` or `bspline`, with `rat` if it has weights";
/// Names of the two directions.
const DIRECTIONS: [&str; 2] = ["u", "v"];

/// A free-form surface as the file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeForm {
    /// Degrees along u and v, 1 to 3.
    pub degree: [usize; 2],
    /// B-spline: knots along u and v. Bézier: where its pieces start and end.
    pub knots: [Vec<f64>; 2],
    /// Control points x, y, z and weight, not multiplied by it; index `i · count_v + j` with `i` along u.
    pub points: Vec<[f64; 4]>,
    /// Do the weights count? If not, all are 1.
    pub is_rational: bool,
    /// Piecewise Bézier? If not, it is a B-spline.
    pub is_bezier: bool,
    /// From where to where it is drawn, along u and v.
    pub range: [[f64; 2]; 2],
    /// The line on which it starts.
    pub line: usize,
}

impl FreeForm {
    /// Number of control points along u and v.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        [0, 1].map(|k| point_count(self.is_bezier, self.degree[k], self.knots[k].len()).unwrap_or(0))
    }

    /// The knots along u and v with which it is a B-spline: those of a piecewise Bézier surface have as many of each as
    /// its degree says.
    #[must_use]
    pub fn spline_knots(&self) -> [Vec<f64>; 2] {
        if !self.is_bezier {
            return self.knots.clone();
        }
        [0, 1].map(|k| knots_of_pieces(self.degree[k], &self.knots[k]))
    }
}

/// Types of curves and surfaces that can be drawn.
#[derive(Clone, Copy, PartialEq)]
enum Type {
    Bezier,
    BSpline,
    /// Known, but cannot be drawn.
    Other(&'static str),
}

/// The free-form elements that have been read, and what holds for the next.
#[derive(Default)]
pub(super) struct Elements {
    surfaces: Vec<FreeForm>,
    /// Type, and whether it is rational.
    kind: Option<(Type, bool)>,
    degree: Vec<usize>,
    open: Option<Open>,
    corners: Vec<Corner>,
}

/// An element between its first line and `end`.
struct Open {
    line: usize,
    surface: Option<FreeForm>,
    vertices: Vec<u32>,
}

impl Elements {
    /// Reads `cstype [rat] TYPE`.
    pub(super) fn read_type(&mut self, words: &mut Words<'_>) -> Result<()> {
        let mut word = words.next().unwrap_or_default();
        let is_rational = word == b"rat";
        if is_rational {
            word = words.next().unwrap_or_default();
        }
        let kind = match word {
            b"bezier" => Type::Bezier,
            b"bspline" => Type::BSpline,
            b"bmatrix" => Type::Other("bmatrix"),
            b"cardinal" => Type::Other("cardinal"),
            b"taylor" => Type::Other("taylor"),
            _ => {
                let problem = format!("`{}` is no type of curve or surface", shown(word));
                return Err(words.wrong(problem, "write `cstype bezier`, `cstype rat bspline` or the like"));
            }
        };
        self.kind = Some((kind, is_rational));
        Ok(())
    }

    /// Reads `deg U [V]`.
    pub(super) fn read_degree(&mut self, words: &mut Words<'_>) -> Result<()> {
        self.degree.clear();
        while let Some(word) = words.next() {
            let degree = text(word).and_then(|text| text.parse().ok()).filter(|_| self.degree.len() < 2);
            let problem = || format!("`{}` stands where a degree should be", shown(word));
            self.degree
                .push(degree.ok_or_else(|| words.wrong(problem(), "write `deg U V`, such as `deg 3 3`"))?);
        }
        Ok(())
    }

    /// Begins an element that is passed over.
    pub(super) fn begin_curve(&mut self, words: &Words<'_>) -> Result<()> {
        self.begin(words, None)
    }

    fn begin(&mut self, words: &Words<'_>, surface: Option<FreeForm>) -> Result<()> {
        if let Some(open) = &self.open {
            return Err(open.unended(words));
        }
        let vertices = self.corners.drain(..).map(|corner| corner.vertex).collect();
        self.open = Some(Open { line: words.start(), surface, vertices });
        Ok(())
    }

    /// Reads `surf s0 s1 t0 t1 v1 v2 ...`.
    pub(super) fn begin_surface(&mut self, words: &mut Words<'_>, vertices: &Vertices) -> Result<()> {
        let (is_bezier, is_rational) = self.drawable(words)?;
        let degree = self.degrees(words)?;
        let range = [range(words)?, range(words)?];
        vertices.read_corners(words, &mut self.corners)?;
        let (knots, points, line) = (Default::default(), Vec::new(), words.start());
        self.begin(words, Some(FreeForm { degree, knots, points, is_rational, is_bezier, range, line }))
    }

    /// Is the surface Bézier, and rational?
    fn drawable(&self, words: &Words<'_>) -> Result<(bool, bool)> {
        match self.kind {
            Some((Type::Other(name), _)) => {
                Err(words.wrong_statement(format!("surfaces of type `{name}` cannot be drawn"), CONVERT))
            }
            Some((kind, is_rational)) => Ok((kind == Type::Bezier, is_rational)),
            None => Err(words.wrong_statement(
                "no `cstype` stands before the surface",
                "put `cstype bezier`, `cstype rat bspline` or the like before it",
            )),
        }
    }

    fn degrees(&self, words: &Words<'_>) -> Result<[usize; 2]> {
        let Ok(degree) = <[usize; 2]>::try_from(self.degree.as_slice()) else {
            let problem = "no `deg` with two degrees stands before the surface";
            return Err(words.wrong_statement(problem, "put `deg U V`, such as `deg 3 3`, before it"));
        };
        if degree.iter().all(|degree| (1..=MAX_DEGREE).contains(degree)) {
            return Ok(degree);
        }
        let problem =
            format!("the surface has degrees {} and {}; only 1 to 3 can be drawn", degree[0], degree[1]);
        Err(words.wrong_statement(problem, "convert it to degree 3"))
    }

    /// Reads `parm u ...` or `parm v ...`.
    pub(super) fn read_parameters(&mut self, words: &mut Words<'_>) -> Result<()> {
        let open = self.open.as_mut().ok_or_else(|| outside(words, "parm"))?;
        let Some(surface) = &mut open.surface else { return Ok(()) };
        let word = words.next().unwrap_or_default();
        let Some(direction) = DIRECTIONS.iter().position(|name| name.as_bytes() == word) else {
            let problem = format!("`{}` stands where `u` or `v` should be", shown(word));
            return Err(words.wrong(problem, "write `parm u ...` and `parm v ...`"));
        };
        let parameters = &mut surface.knots[direction];
        parameters.clear();
        while let Some(word) = words.next() {
            parameters.push(words.number(word)?);
        }
        check_parameters(words, surface, direction)
    }

    /// Ends the element; now the number of its control points can be checked.
    pub(super) fn end(&mut self, words: &Words<'_>, vertices: &Vertices) -> Result<()> {
        let open = self.open.take().ok_or_else(|| outside(words, "end"))?;
        let Some(mut surface) = open.surface else { return Ok(()) };
        let counts = check_counts(words, &surface, open.vertices.len())?;
        surface.points = control_points(&surface, counts, &open.vertices, vertices);
        if let Some(at) = surface.points.iter().position(|point| point[3] <= 0.0) {
            let problem = format!("a control point of the surface has weight {}", surface.points[at][3]);
            return Err(wrong(words, &surface, problem, "give its vertices weights above 0: `v x y z w`"));
        }
        self.surfaces.push(surface);
        Ok(())
    }

    pub(super) fn finish(&mut self, words: &Words<'_>) -> Result<Vec<FreeForm>> {
        match &self.open {
            Some(open) => Err(open.unended(words)),
            None => Ok(std::mem::take(&mut self.surfaces)),
        }
    }
}

impl Open {
    fn unended(&self, words: &Words<'_>) -> Error {
        let problem = "the curve or surface that starts here has no `end`";
        Error::format(
            words.path(),
            self.line,
            problem,
            "put `end` on a line of its own behind its last `parm`",
        )
    }
}

/// An error of a surface that has been read, on the line where it starts.
fn wrong(words: &Words<'_>, surface: &FreeForm, problem: String, remedy: &str) -> Error {
    Error::format(words.path(), surface.line, problem, remedy)
}

fn outside(words: &Words<'_>, keyword: &str) -> Error {
    let problem = format!("`{keyword}` stands outside a curve or surface");
    words.wrong_statement(problem, "put it between `surf` and `end`, or remove it")
}

fn range(words: &mut Words<'_>) -> Result<[f64; 2]> {
    let mut ends = [0.0; 2];
    for end in &mut ends {
        let Some(word) = words.next() else {
            let problem = "fewer than four numbers stand after `surf`";
            return Err(words.wrong_statement(problem, "write `surf s0 s1 t0 t1`, then the control points"));
        };
        *end = words.number(word)?;
    }
    if ends[0] < ends[1] {
        return Ok(ends);
    }
    let problem = format!("the surface runs from parameter {} to {}", ends[0], ends[1]);
    Err(words.wrong_statement(problem, "write the smaller one first; they must differ"))
}

fn check_parameters(words: &Words<'_>, surface: &FreeForm, direction: usize) -> Result<()> {
    let parameters = &surface.knots[direction];
    let Some(at) = first_descent(surface.is_bezier, parameters) else { return Ok(()) };
    let (name, value, before) = (DIRECTIONS[direction], parameters[at], parameters[at - 1]);
    let must =
        if surface.is_bezier { "each must be larger than the one before" } else { "they must not descend" };
    let problem = format!("parameter {} of `parm {name}` is {value}, after {before}: {must}", at + 1);
    Err(words.wrong_statement(problem, "put the parameters in order"))
}

/// Numbers of control points along u and v, if the surface has as many.
fn check_counts(words: &Words<'_>, surface: &FreeForm, found: usize) -> Result<[usize; 2]> {
    let mut counts = [0; 2];
    for (k, name) in DIRECTIONS.iter().enumerate() {
        let (degree, given) = (surface.degree[k], surface.knots[k].len());
        let Some(count) = point_count(surface.is_bezier, degree, given) else {
            let least = if surface.is_bezier { 2 } else { 2 * degree + 2 };
            let problem =
                format!("the surface has {given} parameters along {name}, and needs {least} or more");
            return Err(wrong(
                words,
                surface,
                problem,
                &format!("put `parm {name} ...` between `surf` and `end`"),
            ));
        };
        counts[k] = count;
    }
    let [u, v] = counts;
    if u.checked_mul(v) == Some(found) {
        return Ok(counts);
    }
    let problem =
        format!("the surface has {found} control points; its degrees and parameters ask for {u} times {v}");
    Err(wrong(
        words,
        surface,
        problem,
        "check `surf`, `deg` and `parm`: one of them does not go with the others",
    ))
}

/// The points in our order, v running fastest; in the file it is u.
fn control_points(
    surface: &FreeForm,
    counts: [usize; 2],
    named: &[u32],
    vertices: &Vertices,
) -> Vec<[f64; 4]> {
    let [count_u, count_v] = counts;
    let places = (0..count_u).flat_map(|i| (0..count_v).map(move |j| j * count_u + i));
    let point = |place: usize| {
        let [x, y, z, w] = vertices.weighted(named[place]);
        [x, y, z, if surface.is_rational { w } else { 1.0 }]
    };
    places.map(point).collect()
}
