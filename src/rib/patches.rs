//! Patches: single ones, meshes of them, and surfaces of non-uniform B-splines (RenderMan Interface 3.2, section 5.2).

use super::geometry::{Read, check_count, weighted_points};
use super::model::{RibBasis, RibGeometry, RibNuPatch, RibPatches};
use super::parameters::{Declarations, Parameters};
use super::place::quoted;
use super::request::{Request, Value};
use crate::error::Result;

/// What `Basis` has set, along u and v.
pub(super) struct Bases {
    pub(super) bases: [RibBasis; 2],
    pub(super) steps: [usize; 2],
}

/// The matrices of the bases, by which coefficients of u³, u², u and 1 come from four points; row by row, times 6.
const MATRICES: [(RibBasis, [i32; 16]); 5] = [
    (RibBasis::Bezier, [-6, 18, -18, 6, 18, -36, 18, 0, -18, 18, 0, 0, 6, 0, 0, 0]),
    (RibBasis::BSpline, [-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0]),
    (RibBasis::CatmullRom, [-3, 9, -9, 3, 6, -15, 12, -3, -3, 0, 3, 0, 0, 6, 0, 0]),
    (RibBasis::Hermite, [12, 6, -12, 6, -18, -12, 18, -6, 0, 6, 0, 0, 6, 0, 0, 0]),
    (RibBasis::Power, [6, 0, 0, 0, 0, 6, 0, 0, 0, 0, 6, 0, 0, 0, 0, 6]),
];

/// `Basis`: a basis and a step along u, the same along v.
pub(super) fn basis(request: &mut Request) -> Result<([RibBasis; 2], [usize; 2])> {
    let (basis_u, step_u) = (one_basis(request)?, step(request)?);
    let (basis_v, step_v) = (one_basis(request)?, step(request)?);
    request.end()?;
    Ok(([basis_u, basis_v], [step_u, step_v]))
}

fn step(request: &mut Request) -> Result<usize> {
    match request.count("step")? {
        step @ 1..=4 => Ok(step),
        step => Err(request.wrong(format_args!("its step is {step}"), "choose a step from 1 to 4")),
    }
}

/// A name, or a matrix that has one.
fn one_basis(request: &mut Request) -> Result<RibBasis> {
    let basis = match request.take().map(|argument| argument.value) {
        Some(Value::Text(name)) => Some(named(request, &name)?),
        Some(Value::Numbers(matrix)) if matrix.len() == 16 => {
            let is_same = |(_, other): &&(RibBasis, [i32; 16])| {
                matrix.iter().zip(other).all(|(a, &b)| (6.0 * a - f64::from(b)).abs() < 1.0e-4)
            };
            MATRICES.iter().find(is_same).map(|&(basis, _)| basis)
        }
        _ => None,
    };
    basis.ok_or_else(|| request.wrong("a basis is missing, or a matrix of its own", REMEDY))
}

const REMEDY: &str = "use \"bezier\", \"b-spline\", \"catmull-rom\", \"hermite\" or \"power\"";

fn named(request: &Request, name: &str) -> Result<RibBasis> {
    Ok(match name {
        "bezier" => RibBasis::Bezier,
        "b-spline" => RibBasis::BSpline,
        "catmull-rom" => RibBasis::CatmullRom,
        "hermite" => RibBasis::Hermite,
        "power" => RibBasis::Power,
        _ => return Err(request.wrong(format_args!("there is no basis {}", quoted(name)), REMEDY)),
    })
}

/// Is the patch bilinear, or bicubic?
fn is_linear(request: &mut Request) -> Result<bool> {
    choice(request, "type", ["bilinear", "bicubic"])
}

/// Is it closed?
fn is_periodic(request: &mut Request) -> Result<bool> {
    choice(request, "wrap", ["periodic", "nonperiodic"])
}

/// Is the next argument the first of two strings, or the second?
pub(super) fn choice(request: &mut Request, what: &str, [first, second]: [&str; 2]) -> Result<bool> {
    let text = request.text(what)?;
    if text != first && text != second {
        let remedy = format!("use \"{first}\" or \"{second}\"");
        return Err(request.wrong(format_args!("its {what} is {}", quoted(&text)), remedy));
    }
    Ok(text == first)
}

/// `Patch`: a mesh of one.
pub(super) fn patch(request: &mut Request, known: &Declarations, bases: &Bases) -> Result<Read> {
    let is_linear = is_linear(request)?;
    let counts = if is_linear { [2; 2] } else { [4; 2] };
    patches(request, known, bases, (is_linear, counts, [false; 2]))
}

/// `PatchMesh`.
pub(super) fn patch_mesh(request: &mut Request, known: &Declarations, bases: &Bases) -> Result<Read> {
    let is_linear = is_linear(request)?;
    let (count_u, wrap_u) = (request.count("number of points along u")?, is_periodic(request)?);
    let (count_v, wrap_v) = (request.count("number of points along v")?, is_periodic(request)?);
    patches(request, known, bases, (is_linear, [count_u, count_v], [wrap_u, wrap_v]))
}

fn patches(
    request: &mut Request,
    known: &Declarations,
    bases: &Bases,
    (is_linear, counts, is_periodic): (bool, [usize; 2], [bool; 2]),
) -> Result<Read> {
    let steps = if is_linear { [1; 2] } else { bases.steps };
    for axis in [0, 1] {
        check_steps(request, is_linear, (counts[axis], steps[axis], is_periodic[axis]))?;
    }
    let mut parameters = Parameters::of(request, known)?;
    let points = weighted_points(request, &mut parameters)?;
    check_count(request, points.len(), counts[0].checked_mul(counts[1]))?;
    let bases = bases.bases;
    let patches = RibPatches { is_linear, bases, steps, counts, is_periodic, points };
    Ok((RibGeometry::Patches(patches), parameters))
}

/// Refuses a number of points that is not enough for a patch, or leaves some over.
pub(super) fn check_steps(
    request: &Request,
    is_linear: bool,
    (count, step, is_periodic): (usize, usize, bool),
) -> Result<()> {
    let span = if is_linear { 2 } else { 4 };
    let is_whole = if is_periodic {
        count.is_multiple_of(step)
    } else {
        count >= span && (count - span).is_multiple_of(step)
    };
    if count >= 2 && is_whole {
        return Ok(());
    }
    let remedy = match is_periodic {
        true => format!("use a multiple of {step}: the step from a segment to the next"),
        false => format!(
            "use {span} points, or any number of times {step} more: the step from a segment to the next"
        ),
    };
    Err(request.wrong(format_args!("{count} points do not make whole segments"), remedy))
}

/// `NuPatch`.
pub(super) fn nu_patch(request: &mut Request, known: &Declarations) -> Result<Read> {
    let (count_u, order_u, knots_u, range_u) = nu_axis(request)?;
    let (count_v, order_v, knots_v, range_v) = nu_axis(request)?;
    let mut parameters = Parameters::of(request, known)?;
    let points = weighted_points(request, &mut parameters)?;
    check_count(request, points.len(), count_u.checked_mul(count_v))?;
    let patch = RibNuPatch {
        counts: [count_u, count_v],
        orders: [order_u, order_v],
        knots: [knots_u, knots_v],
        ranges: [range_u, range_v],
        points,
    };
    Ok((RibGeometry::NuPatch(patch), parameters))
}

/// Number of points, order, knots and range.
fn nu_axis(request: &mut Request) -> Result<(usize, usize, Vec<f64>, [f64; 2])> {
    let (count, order) = (request.count("number of points")?, request.count("order")?);
    let knots = request.numbers("knots")?;
    let range = [request.number("first parameter")?, request.number("last parameter")?];
    if order < 1 || count < order || count.checked_add(order) != Some(knots.len()) {
        let problem = format_args!("it has {} knots for {count} points and order {order}", knots.len());
        return Err(request.wrong(
            problem,
            "give as many knots as points and order together, and no fewer points than the order",
        ));
    }
    Ok((count, order, knots, range))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{geometry, read, wrong};

    fn points(count: usize) -> String {
        let numbers: Vec<_> = (0..3 * count).map(|number| number.to_string()).collect();
        format!("\"P\" [{}]", numbers.join(" "))
    }

    #[test]
    fn a_patch_is_a_mesh_of_one() {
        let RibGeometry::Patches(patch) = geometry(&format!("Patch \"bicubic\" {}", points(16))) else {
            panic!("patches");
        };
        assert_eq!((patch.is_linear, patch.counts, patch.steps), (false, [4, 4], [3, 3]));
        assert_eq!((patch.points.len(), patch.points[1]), (16, [3.0, 4.0, 5.0, 1.0]));
        assert!(
            wrong(&format!("Patch \"bicubic\" {}", points(15))).contains("15 points, and should have 16")
        );
        assert!(wrong(&format!("Patch \"cubic\" {}", points(16))).contains("its type is `cubic`"));
        assert!(wrong("Patch \"bilinear\"").contains("no points"));
    }

    #[test]
    fn weights_are_taken_out_of_points() {
        let request = "Patch \"bilinear\" \"Pw\" [2 4 6 2  0 0 0 1  0 0 0 1  0 0 0 1]";
        let RibGeometry::Patches(patch) = geometry(request) else { panic!("patches") };
        assert_eq!(patch.points[0], [1.0, 2.0, 3.0, 2.0]);
        assert!(wrong("Patch \"bilinear\" \"Pw\" [2 4 6 0  0 0 0 1  0 0 0 1  0 0 0 1]").contains("weight 0"));
        assert!(wrong("Patch \"bilinear\" \"Pw\" [2 4 6]").contains("`Pw` has 3 numbers"));
    }

    #[test]
    fn bases_are_names_or_their_matrices() {
        let bases = |basis: &str| {
            let scene = read(&format!("{basis} Patch \"bicubic\" {}", points(16)));
            let RibGeometry::Patches(patch) = &*scene.objects[0].geometry else { panic!("patches") };
            (patch.bases, patch.steps)
        };
        assert_eq!(bases(""), ([RibBasis::Bezier; 2], [3; 2]));
        assert_eq!(
            bases("Basis \"b-spline\" 1 \"catmull-rom\" 2"),
            ([RibBasis::BSpline, RibBasis::CatmullRom], [1, 2])
        );
        let spline = "[-.16667 .5 -.5 .16667 .5 -1 .5 0 -.5 0 .5 0 .16667 .66667 .16667 0]";
        let hermite = "[2 1 -2 1 -3 -2 3 -1 0 1 0 0 1 0 0 0]";
        assert_eq!(bases(&format!("Basis {spline} 1 {hermite} 2")).0, [RibBasis::BSpline, RibBasis::Hermite]);
        assert!(wrong("Basis \"nurbs\" 1 \"bezier\" 3").contains("no basis `nurbs`"));
        assert!(wrong("Basis \"bezier\" 0 \"bezier\" 3").contains("step is 0"));
        assert!(wrong("Basis [1 2 3] 1 \"bezier\" 3").contains("matrix of its own"));
    }

    #[test]
    fn meshes_have_points_for_whole_patches() {
        let mesh =
            |u: &str, v: &str, count: usize| format!("PatchMesh \"bicubic\" {u} {v} {}", points(count));
        let RibGeometry::Patches(patch) = geometry(&mesh("7 \"nonperiodic\"", "6 \"periodic\"", 42)) else {
            panic!("patches");
        };
        assert_eq!((patch.counts, patch.is_periodic), ([7, 6], [false, true]));
        for (request, part) in [
            (mesh("8 \"nonperiodic\"", "6 \"periodic\"", 48), "8 points do not make whole"),
            (mesh("7 \"nonperiodic\"", "7 \"periodic\"", 49), "7 points do not make whole"),
            (mesh("3 \"nonperiodic\"", "6 \"periodic\"", 18), "3 points do not make whole"),
            (mesh("7 \"open\"", "6 \"periodic\"", 42), "its wrap is `open`"),
            (mesh("-7 \"periodic\"", "6 \"periodic\"", 42), "is -7"),
            (mesh("4294967293 \"periodic\"", "4294967292 \"periodic\"", 4), "points do not make"),
            (
                mesh("4294967292 \"periodic\"", "4294967292 \"periodic\"", 4),
                "should have 18446744039349813264",
            ),
        ] {
            assert!(wrong(&request).contains(part), "{}", wrong(&request));
        }
    }

    #[test]
    fn splines_have_as_many_knots_as_points_and_order() {
        let patch = |knots: &str| format!("NuPatch 3 3 [{knots}] 0 1 2 2 [0 0 2 2] 0 2 {}", points(6));
        let RibGeometry::NuPatch(read) = geometry(&patch("0 0 0 1 1 1")) else { panic!("splines") };
        assert_eq!((read.counts, read.orders), ([3, 2], [3, 2]));
        assert_eq!(read.ranges, [[0.0, 1.0], [0.0, 2.0]]);
        assert_eq!(read.knots[1], [0.0, 0.0, 2.0, 2.0]);
        assert!(wrong(&patch("0 0 0 1 1")).contains("5 knots for 3 points and order 3"));
        assert!(wrong("NuPatch 1 2 [0 0 0] 0 1").contains("3 knots for 1 points and order 2"));
    }

    #[test]
    fn trimmed_surfaces_are_warned_about() {
        let scene = read("TrimCurve [1] [2] [0 1] [0] [1] [2] [0 1] [0 1] [1 1]\nDisk 0 1 360");
        assert_eq!(scene.warnings.len(), 1);
        assert!(scene.warnings[0].contains("without being trimmed"));
    }
}
