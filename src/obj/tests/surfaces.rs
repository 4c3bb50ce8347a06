//! Free-form surfaces.

use super::{assert_refused, read};

/// Six control points, 3 along u and 2 along v: x is the place along u, y along v.
const NET: &str = "v 0 0 0\nv 1 0 0 .5\nv 2 0 0\nv 0 1 0\nv 1 1 0 2\nv 2 1 0\n";
const BEZIER: &str = "cstype bezier\ndeg 2 1\nsurf 0 1 0 2 1 2 3 4 5 6\nparm u 0 1\nparm v 0 2\nend\n";

#[test]
fn points_are_turned_so_that_v_runs_fastest() {
    let obj = read(format!("{NET}{BEZIER}"));
    assert!(obj.cage.is_none() && obj.warnings.is_empty());
    let surface = &obj.surfaces[0];
    assert_eq!((surface.degree, surface.counts(), surface.line), ([2, 1], [3, 2], 9));
    assert_eq!(
        (surface.is_bezier, surface.is_rational, surface.range),
        (true, false, [[0.0, 1.0], [0.0, 2.0]])
    );
    for i in 0..3 {
        for j in 0..2 {
            assert_eq!(surface.points[i * 2 + j], [i as f64, j as f64, 0.0, 1.0]);
        }
    }
}

#[test]
fn weights_count_in_rational_surfaces_only() {
    let obj = read(format!("{NET}{}", BEZIER.replace("cstype", "cstype rat")));
    let weights: Vec<f64> = obj.surfaces[0].points.iter().map(|point| point[3]).collect();
    assert_eq!(weights, [1.0, 1.0, 0.5, 2.0, 1.0, 1.0]);
    assert!(obj.surfaces[0].is_rational);
}

#[test]
fn control_points_are_named_as_corners_of_faces_are() {
    let plain = read(format!("{NET}{BEZIER}"));
    for names in ["-6 -5 -4 -3 -2 -1", "1/1 2/1 3/1 4/1 5/1 6/1", "1//1 2//1 \\\n3//1 4//1 5//1 6//1"] {
        let text = format!("{NET}vt 0 0\nvn 0 0 1\n{}", BEZIER.replace("1 2 3 4 5 6", names));
        let obj = read(text);
        assert_eq!(obj.surfaces[0].points, plain.surfaces[0].points, "{names}");
    }
}

#[test]
fn pieces_and_knots_say_how_many_points_there_are() {
    let net: String = (0..7 * 5).map(|i| format!("v {i} 0 0\n")).collect();
    let points: String = (1..=35).map(|i| format!(" {i}")).collect();
    let text =
        format!("{net}cstype bezier\ndeg 3 2\nsurf 0 2 0 1{points}\nparm u 0 1 2\nparm v 0 .5 1\nend\n");
    let obj = read(text);
    assert_eq!(obj.surfaces[0].counts(), [7, 5]);
    let u = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0];
    assert_eq!(obj.surfaces[0].spline_knots(), [u, vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0]]);

    let spline = "parm u -1 -1 -1 -1 0 .1 .2 2 2 2 2\nparm v 0 1 2 3 4 5 6 7\nend\n";
    let obj = read(format!("{net}cstype rat bspline\ndeg 3 2\nsurf 0 2 2 5{points}\n{spline}"));
    assert_eq!(obj.surfaces[0].counts(), [7, 5]);
    assert_eq!(obj.surfaces[0].spline_knots(), obj.surfaces[0].knots);
}

#[test]
fn type_and_degree_hold_for_all_surfaces_that_follow() {
    let again = "surf 0 1 0 2 1 2 3 4 5 6\nparm u 0 1\nparm v 0 2\nend\n";
    let obj = read(format!("{NET}{BEZIER}v 9 9 9\n{again}f 1 2 3\n"));
    assert_eq!((obj.surfaces.len(), obj.surfaces[1].line), (2, 14));
    assert_eq!(obj.surfaces[0].points, obj.surfaces[1].points);
    assert!(obj.cage.is_some());
}

#[test]
fn trims_and_curves_are_told_once() {
    let trims = "trim 0 1 1\nhole 0 1 2\ntrim 0 1 1\nsp 1\nscrv 0 1 1\nend\n";
    let curves = "cstype taylor\nvp 0 0\ncurv 0 1 1 2 3\nparm u 0 1 2\nend\ncurv2 1 1\nparm u 0 1\nend\ncon 1 0 1 1 1 0 1 1\n";
    let obj = read(format!("{NET}{}{curves}", BEZIER.replace("end\n", trims)));
    assert_eq!(obj.surfaces.len(), 1);
    assert_eq!(
        obj.warnings,
        [
            "x.obj:12: `trim`: surfaces are drawn as a whole, not trimmed (2 times)",
            "x.obj:13: `hole`: surfaces are drawn as a whole, not trimmed",
            "x.obj:15: `sp`: curves and points that a surface should contain are not used",
            "x.obj:16: `scrv`: curves and points that a surface should contain are not used",
            "x.obj:20: `curv`: curves are not drawn",
            "x.obj:23: `curv2`: curves are not drawn",
            "x.obj:26: `con`: surfaces are not joined",
        ]
    );
}

#[test]
fn errors_of_surfaces_name_the_line() {
    let changed = |from: &str, to: &str| format!("{NET}{}", BEZIER.replace(from, to));
    for (text, line, part) in [
        (changed("bezier", "nurbs"), 7, "`nurbs` is no type"),
        (changed("bezier", "bmatrix"), 9, "surfaces of type `bmatrix` cannot be drawn"),
        (changed("bezier", "rat cardinal"), 9, "`cardinal` cannot be drawn"),
        (changed("cstype bezier", ""), 9, "no `cstype`"),
        (changed("deg 2 1", ""), 9, "no `deg` with two degrees"),
        (changed("deg 2 1", "deg 2"), 9, "no `deg` with two degrees"),
        (changed("deg 2 1", "deg 2 1 1"), 8, "`1` stands where a degree should be"),
        (changed("deg 2 1", "deg two 1"), 8, "`two` stands where a degree should be"),
        (changed("deg 2 1", "deg 4 1"), 9, "degrees 4 and 1; only 1 to 3"),
        (changed("deg 2 1", "deg 2 0"), 9, "degrees 2 and 0"),
        (changed("4 5 6", "4 5"), 9, "5 control points; its degrees and parameters ask for 3 times 2"),
        (changed("u 0 1", "u 0 1 2"), 9, "6 control points; its degrees and parameters ask for 5 times 2"),
        (changed("4 5 6", "4 5 7"), 9, "`7` names vertex 7"),
        (changed("surf 0 1 0 2 1 2 3 4 5 6", "surf 0 1 0"), 9, "fewer than four numbers"),
        (changed("surf 0 1", "surf 1 1"), 9, "from parameter 1 to 1"),
        (changed("parm u 0 1\n", ""), 9, "0 parameters along u, and needs 2"),
        (changed("parm v 0 2", "parm w 0 2"), 11, "`w` stands where `u` or `v` should be"),
        (changed("parm v 0 2", "parm v 0 0"), 11, "parameter 2 of `parm v` is 0, after 0"),
        (changed("parm v 0 2", "parm v 0 x"), 11, "`x` stands"),
        (changed("end", ""), 9, "has no `end`"),
        (changed("end", "surf 0 1 0 1 1 2 3 4 5 6\nend"), 9, "has no `end`"),
        (changed("deg 2 1", "parm u 0 1"), 8, "`parm` stands outside"),
        (changed("deg 2 1", "end"), 8, "`end` stands outside"),
        (changed("bezier", "bspline"), 9, "2 parameters along u, and needs 6"),
        (changed("bezier", "rat bezier").replace(".5", "0"), 9, "has weight 0"),
        (
            changed("bezier", "bspline").replace("u 0 1", "u 0 1 0"),
            10,
            "parameter 3 of `parm u` is 0, after 1",
        ),
    ] {
        assert_refused([(text.as_str(), line, part)]);
    }
}
