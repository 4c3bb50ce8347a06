//! Tags of OpenSubdiv's shapes.

use super::{SQUARE, assert_refused, cage, read};
use crate::cage::{Boundary, Crease};

#[test]
fn creases_have_one_sharpness_or_one_each() {
    let text = format!(
        "t crease 2/1/0 0 1 10\n{SQUARE}f 1 2 3 4\nt crease 4/1/0 1 2 2 3 .5\nt crease 4/2/0 3 0 2 1 1 2\n"
    );
    let crease = |a, b, sharpness| Crease { vertices: [a, b], sharpness };
    let expected =
        [crease(0, 1, 10.0), crease(1, 2, 0.5), crease(2, 3, 0.5), crease(3, 0, 1.0), crease(2, 1, 2.0)];
    assert_eq!(cage(text).creases, expected);
}

#[test]
fn corners_and_holes_are_read() {
    let cage = cage(format!(
        "{SQUARE}f 1 2 3\nf 1 3 4\nt corner 1/1/0 3 2.5\nt corner 2/2/0 0 1 3 4\nt hole 2/0/0 1 0"
    ));
    assert_eq!(cage.sharp_vertices, [(3, 2.5), (0, 3.0), (1, 4.0)]);
    assert_eq!(cage.holes, [1, 0]);
}

#[test]
fn boundary_rules_are_numbered_as_in_renderman() {
    let boundary = |tag: &str| cage(format!("{SQUARE}f 1 2 3 4\n{tag}")).boundary;
    assert_eq!(boundary(""), Boundary::EdgeAndCorner);
    assert_eq!(boundary("t interpolateboundary 1/0/0 0"), Boundary::None);
    assert_eq!(boundary("t interpolateboundary 1/0/0 1"), Boundary::EdgeAndCorner);
    assert_eq!(boundary("t interpolateboundary 1/0/0 2"), Boundary::EdgeOnly);
}

#[test]
fn tags_that_are_not_used_are_told_once_by_name() {
    let tags = "t creasemethod 0/0/1 chaikin\nt facevaryinginterpolateboundary 1/0/0 1\nt creasemethod 0/0/1 normal\n";
    assert_eq!(
        read(format!("{SQUARE}f 1 2 3\n{tags}")).warnings,
        [
            "x.obj:6: `t creasemethod`: this tag is not used (2 times)",
            "x.obj:7: `t facevaryinginterpolateboundary`: this tag is not used",
        ]
    );
}

#[test]
fn errors_of_tags_name_the_line() {
    for (tag, part) in [
        ("t", "a tag without a name"),
        ("t crease", "`` stands where a tag's counts should be"),
        ("t crease 2/1 0 1 1", "`2/1` stands where a tag's counts should be"),
        ("t crease 2/1/0/0 0 1 1", "`2/1/0/0`"),
        ("t crease -2/1/0 0 1 1", "`-2/1/0`"),
        ("t crease 2/1/1 0 1 1 x", "`2/1/1`"),
        ("t crease 2/1/0 0 1", "fewer values than the counts"),
        ("t crease 4294967295/4294967295/0 0 1 1", "fewer values than the counts"),
        ("t crease 3/1/0 0 1 1.5", "`1.5` stands where an index should be"),
        ("t crease 2/1/0 0 1 1 1", "`1` stands behind the values"),
        ("t crease 3/1/0 0 1 2 1", "the tag `crease` has 1 edges and 1 numbers"),
        ("t crease 4/3/0 0 1 1 2 1 1 1", "has 2 edges and 3 numbers"),
        ("t crease 0/1/0 1", "has 0 edges"),
        ("t crease 2/0/0 0 1", "and 0 numbers"),
        ("t crease 2/1/0 1 1 1", "from vertex 1 to itself"),
        ("t crease 2/1/0 0 4 1", "the tag `crease` names vertex 4, but the file has 4"),
        ("t crease 2/1/0 0 -1 1", "`-1` stands where an index should be"),
        ("t crease 2/1/0 0 1 -1", "`-1` stands where a sharpness should be"),
        ("t crease 2/1/0 0 1 inf", "`inf` is not finite"),
        ("t corner 1/1/0 4 1", "the tag `corner` names vertex 4"),
        ("t corner 3/2/0 0 1 2 1 1", "has 3 vertices and 2 numbers"),
        ("t hole 1/0/0 1", "the tag `hole` names face 1, but the file has 1"),
        ("t hole 0/0/0", "has 0 faces"),
        ("t hole 1/1/0 0 1", "has 1 faces and 1 numbers"),
        ("t interpolateboundary 1/0/0 3", "there is no boundary rule 3"),
        ("t interpolateboundary 2/0/0 1 1", "has 2 rules"),
    ] {
        assert_refused([(format!("{SQUARE}{tag}\nf 1 2 3\n").as_str(), 5, part)]);
    }
}
