//! From geometry to patches.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::cage::{self, Cage};
use crate::curve::Curve;
use crate::error::Result;
use crate::nurbs::{Basis, Nurbs, PatchMesh};
use crate::polygon::polygons;
use crate::quadric::Quadric;
use crate::rib::model::{RibBasis, RibCurves, RibGeometry, RibNuPatch, RibObject, RibPatches, RibQuadric};
use crate::shape::Shape;

/// What is wrong with geometry, and what to do about it.
struct Unfit {
    problem: String,
    remedy: &'static str,
}

fn unfit<E: std::fmt::Display>(remedy: &'static str) -> impl Fn(E) -> Unfit {
    move |error| Unfit { problem: error.to_string(), remedy }
}

type Made = std::result::Result<Shape, Unfit>;

/// The shape of an object, in its own space, its front as the file has it. Curves face an eye in world space.
///
/// # Errors
/// [`Error::Format`](crate::Error::Format) that names the request.
pub fn shape_of(object: &RibObject, eye: DVec3, levels: u32) -> Result<Shape> {
    let made = match &*object.geometry {
        RibGeometry::Patches(patches) => patches_of(patches),
        RibGeometry::NuPatch(patch) => nu_patch(patch),
        RibGeometry::Subdivision(cage) => subdivided(cage, levels),
        RibGeometry::Polygons(cage) => {
            polygons(cage).map(Shape::of_polygons).map_err(unfit("correct the polygon, or leave it out"))
        }
        RibGeometry::Quadric(quadric) => quadric_of(*quadric)
            .patches()
            .map(Shape::of_rational)
            .map_err(unfit("choose parameters that leave something to be drawn")),
        RibGeometry::Curves(curves) => ribbons(curves, seen_from(object, eye)),
    };
    let name = object.geometry.request();
    let mut shape =
        made.map_err(|Unfit { problem, remedy }| object.place.wrong(format!("{name}: {problem}"), remedy))?;
    if is_reversed(object) {
        shape.reverse();
    }
    Ok(shape)
}

/// Does v have to run the other way, so that the front is where u runs to the right and v upwards in world space?
pub(super) fn is_reversed(object: &RibObject) -> bool {
    object.is_reversed != (object.to_world.matrix3.determinant() < 0.0)
}

/// Where the eye is in an object's space.
fn seen_from(object: &RibObject, eye: DVec3) -> [f64; 3] {
    let seen = object.to_world.inverse().transform_point3(eye);
    // Where an object is flattened, its curves have no more than an edge.
    if seen.is_finite() { seen.into() } else { eye.into() }
}

/// Calls a function with points around an object, in its own space.
pub(super) fn for_each_point(object: &RibObject, shape: &Shape, mut call: impl FnMut(DVec3)) {
    if let RibGeometry::Curves(curves) = &*object.geometry {
        curves.curves.iter().flat_map(|curve| &curve.points).for_each(|&point| call(point.into()));
    }
    shape.points().for_each(|point| call(Vec3::from(point).as_dvec3()));
}

impl RibGeometry {
    /// The request that draws it, for messages.
    const fn request(&self) -> &'static str {
        match self {
            Self::Patches(_) => "this mesh of patches",
            Self::NuPatch(_) => "`NuPatch`",
            Self::Subdivision(_) => "`SubdivisionMesh`",
            Self::Polygons(_) => "these polygons",
            Self::Quadric(_) => "this quadric",
            Self::Curves(_) => "`Curves`",
        }
    }
}

fn basis_of(basis: RibBasis) -> std::result::Result<Basis, Unfit> {
    Ok(match basis {
        RibBasis::Bezier => Basis::Bezier,
        RibBasis::BSpline => Basis::BSpline,
        RibBasis::CatmullRom => Basis::CatmullRom,
        RibBasis::Hermite => Basis::Hermite,
        RibBasis::Power => {
            let problem = "the basis \"power\" is not supported".to_owned();
            return Err(Unfit { problem, remedy: "convert the points to \"bezier\"" });
        }
    })
}

fn patches_of(patches: &RibPatches) -> Made {
    let RibPatches { is_linear, steps, counts, is_periodic, ref points, .. } = *patches;
    let bases = match is_linear {
        true => [Basis::Linear; 2],
        false => [basis_of(patches.bases[0])?, basis_of(patches.bases[1])?],
    };
    let is_rational = points.iter().any(|point| point[3] != 1.0);
    let mesh = if is_rational {
        let points = points.iter().map(|&[x, y, z, w]| [x * w, y * w, z * w, w]).collect();
        PatchMesh { bases, steps, counts, is_periodic, points }
    } else {
        let positions: Vec<_> = points.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
        PatchMesh { steps, ..PatchMesh::with_positions(bases, counts, is_periodic, &positions) }
    };
    mesh.patches().map(Shape::of_rational).map_err(unfit("give it points for whole patches"))
}

fn nu_patch(patch: &RibNuPatch) -> Made {
    let [count_u, count_v] = patch.counts;
    let column = |i: usize| (0..count_v).map(move |j| patch.points[j * count_u + i]);
    let nurbs = Nurbs {
        degree: patch.orders.map(|order| order.saturating_sub(1)),
        knots: patch.knots.clone(),
        points: (0..count_u).flat_map(column).collect(),
        range: patch.ranges,
    };
    nurbs
        .patches()
        .map(Shape::of_rational)
        .map_err(unfit("use orders 2 to 4, knots that ascend, and parameters within them"))
}

fn quadric_of(quadric: RibQuadric) -> Quadric {
    match quadric {
        RibQuadric::Sphere { radius, z_min, z_max, theta_max } => {
            Quadric::Sphere { radius, z_min, z_max, theta_max }
        }
        RibQuadric::Cone { height, radius, theta_max } => Quadric::Cone { height, radius, theta_max },
        RibQuadric::Cylinder { radius, z_min, z_max, theta_max } => {
            Quadric::Cylinder { radius, z_min, z_max, theta_max }
        }
        RibQuadric::Hyperboloid { point1, point2, theta_max } => {
            Quadric::Hyperboloid { point1, point2, theta_max }
        }
        RibQuadric::Paraboloid { r_max, z_min, z_max, theta_max } => {
            Quadric::Paraboloid { r_max, z_min, z_max, theta_max }
        }
        RibQuadric::Disk { height, radius, theta_max } => Quadric::Disk { height, radius, theta_max },
        RibQuadric::Torus { major, minor, phi_min, phi_max, theta_max } => {
            Quadric::Torus { major_radius: major, minor_radius: minor, phi_min, phi_max, theta_max }
        }
    }
}

fn ribbons(curves: &RibCurves, eye: [f64; 3]) -> Made {
    let basis = if curves.is_linear { Basis::Linear } else { basis_of(curves.basis)? };
    if curves.step != basis.step() {
        let problem = format!("curves of this basis with a step of {} are not supported", curves.step);
        let remedy =
            "use `Basis` with the step of its basis: bezier 3, b-spline and catmull-rom 1, hermite 2";
        return Err(Unfit { problem, remedy });
    }
    let is_periodic = curves.is_periodic;
    let ribbons: Vec<_> = curves
        .curves
        .par_iter()
        .map(|curve| {
            let (points, widths) = (curve.points.clone(), curve.widths.clone());
            Curve { points, widths, basis, is_periodic }.ribbons(eye)
        })
        .collect();
    // Of several errors the first, whichever was found first.
    let ribbons: std::result::Result<Vec<_>, _> = ribbons.into_iter().collect();
    let bezier =
        ribbons.map_err(unfit("give each curve points for whole segments, and widths for their ends"))?;
    Ok(Shape::of_bezier(bezier.concat()))
}

/// The limit surface of a cage.
fn subdivided(cage: &Cage, levels: u32) -> Made {
    let made = cage::convert(cage, &cage::Options { levels }, &|_| {})
        .map_err(|error| Unfit { problem: error.problem(), remedy: error.remedy() })?;
    let cage::Patches { bezier, gregory, halves, .. } = made;
    Ok(Shape { bezier, gregory, halves, ..Shape::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::read;

    fn made(text: &str) -> Result<Shape> {
        shape_of(&read(text).objects[0], DVec3::new(0.0, 0.0, -10.0), 3)
    }

    fn wrong(text: &str) -> String {
        made(text).expect_err("refused").to_string()
    }

    #[test]
    fn each_kind_of_geometry_becomes_patches() {
        let counts = |text: &str| {
            let shape = made(text).expect("made");
            (shape.bezier.len(), shape.rational.len())
        };
        let grid = |columns: i32, rows: i32| {
            let points = (0..rows).flat_map(|y| (0..columns).map(move |x| format!("{x} {y} {}", x * y)));
            format!("\"P\" [{}]", points.collect::<Vec<_>>().join(" "))
        };
        assert_eq!(counts("Sphere 1 -1 1 360").0, 0);
        assert!(counts("Sphere 1 -1 1 360").1 >= 8);
        assert_eq!(counts(&format!("Patch \"bicubic\" {}", grid(4, 4))), (1, 0));
        assert_eq!(
            counts(&format!("PatchMesh \"bicubic\" 7 \"nonperiodic\" 4 \"nonperiodic\" {}", grid(7, 4))),
            (2, 0)
        );
        assert_eq!(
            counts(&format!("PatchMesh \"bilinear\" 3 \"periodic\" 3 \"nonperiodic\" {}", grid(3, 3))),
            (6, 0)
        );
        assert_eq!(
            counts(&format!("NuPatch 3 3 [0 0 0 1 1 1] 0 1 2 2 [0 0 1 1] 0 1 {}", grid(3, 2))),
            (1, 0)
        );
        assert_eq!(counts("Patch \"bilinear\" \"Pw\" [0 0 0 1 2 0 0 2 0 1 0 1 1 1 0 1]"), (0, 1));
        assert_eq!(counts("Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]"), (1, 0));
        assert_eq!(counts(&format!("Curves \"cubic\" [4 4] \"nonperiodic\" {}", grid(4, 2))), (2, 0));
        let cube = "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4] [0 1 3 2 4 6 7 5 0 4 5 1 2 3 7 6 0 2 6 4 1 5 7 3]";
        let corners = "\"P\" [0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1]";
        assert!(made(&format!("{cube} {corners}")).expect("made").patch_count() > 6);
        assert_eq!(counts(&format!("Curves \"linear\" [3 3] \"periodic\" {}", grid(3, 2))), (6, 0));
    }

    #[test]
    fn u_runs_fastest_in_the_file_and_slowest_in_patches() {
        let shape = made("Patch \"bilinear\" \"P\" [0 0 0 3 0 0 0 6 0 3 6 0]").expect("made");
        let points = shape.bezier[0].points;
        assert_eq!((points[3], points[12]), ([0.0, 6.0, 0.0], [3.0, 0.0, 0.0]));
        let nurbs = made("NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 3 0 0 0 6 0 3 6 0]");
        assert_eq!(nurbs.expect("made").bezier[0].points, points);
    }

    /// Is the front of a patch towards +z of the world?
    fn faces_up(requests: &str) -> bool {
        let scene = read(&format!("{requests} Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]"));
        let object = &scene.objects[0];
        let patch = shape_of(object, DVec3::ZERO, 3).expect("made").bezier[0];
        let at = |index: usize| object.to_world.transform_point3(Vec3::from(patch.points[index]).as_dvec3());
        (at(12) - at(0)).cross(at(3) - at(0)).z > 0.0
    }

    #[test]
    fn fronts_are_where_the_file_has_them_in_mirrors_too() {
        assert!(faces_up(""));
        assert!(!faces_up("ReverseOrientation"));
        // Mirrored points would show their back, unless the front is the other side now.
        assert!(faces_up("Scale -1 1 1"));
        assert!(!faces_up("Scale -1 1 1 ReverseOrientation"));
    }

    #[test]
    fn ribbons_face_the_eye_from_wherever_they_stand() {
        let text = "Rotate 90 0 0 1 Scale 2 2 2 Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0] \"constantwidth\" 0.1";
        let patch = made(text).expect("made").bezier[0];
        let across = Vec3::from(patch.points[3]) - Vec3::from(patch.points[0]);
        assert!((across.length() - 0.1).abs() < 1e-6);
        assert!(across.y.abs() > 0.0999, "{across}");
    }

    #[test]
    fn errors_name_the_request() {
        let points = "\"P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]";
        let curve = "Curves \"cubic\" [4] \"nonperiodic\" \"P\" [0 0 0 1 0 0 2 0 0 3 0 0]";
        for (text, part) in [
            ("\nSphere 0 -1 1 360".to_owned(), "x.rib:2: this quadric: radius is 0"),
            ("\nSphere 1 2 3 360".to_owned(), "x.rib:2: this quadric: nothing"),
            (format!("NuPatch 5 5 [0 0 0 0 0 1 1 1 1 1] 0 1 1 1 [0 1] 0 1 {points}"), "degree is 4"),
            (
                format!("SubdivisionMesh \"catmull-clark\" [3 3] [0 1 2 0 1 3] {points}"),
                "`SubdivisionMesh`: ",
            ),
            (format!("Basis \"power\" 4 \"power\" 4 {curve}"), "\"power\" is not supported"),
            (format!("Basis \"bezier\" 3 \"b-spline\" 2 {curve}"), "step of 2 are not supported"),
        ] {
            assert!(wrong(&text).contains(part), "{}", wrong(&text));
        }
    }
}
