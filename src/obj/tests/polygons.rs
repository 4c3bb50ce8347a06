//! Vertices and faces.

use super::{SQUARE, assert_refused, cage, read, refusal};

#[test]
fn all_ways_of_writing_a_corner_give_the_same_face() {
    let rest = "vt 0 0\nvt 1 0\nvn 0 0 1\n";
    for face in ["1 2 3 4", "1/1 2/2 3/1 4/2", "1//1 2//1 3//1 4//1", "1/1/1 2/2/1 3/1/1 4/2/1"] {
        let text = format!("{SQUARE}{rest}f {face}\n");
        let cage = cage(&text);
        assert_eq!((cage.face_sizes, cage.corners, cage.face_lines), (vec![4], vec![0, 1, 2, 3], vec![8]));
        assert_eq!(cage.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        let has_texture = face.starts_with("1/1");
        assert_eq!(cage.texture_corners, if has_texture { vec![0, 1, 0, 1] } else { vec![] }, "{face}");
        assert_eq!(cage.texture.len(), if has_texture { 2 } else { 0 });
    }
}

#[test]
fn negative_indices_count_back_from_the_line_where_they_stand() {
    let text =
        format!("{SQUARE}f -4 -3 -2 -1\nv 9 9 9\nf -5 -4 -1\nvt 0 0\nvn 1 0 0\nf -5/-1/-1 -4/1/1 -3/1/-1");
    let cage = cage(text);
    assert_eq!(cage.corners, [0, 1, 2, 3, 0, 1, 4, 0, 1, 2]);
    assert_eq!(cage.face_lines, [5, 7, 10]);
}

#[test]
fn faces_have_any_number_of_corners() {
    let count = 1000;
    let vertices: String = (0..count).map(|i| format!("v {i} {} 0\n", i * i)).collect();
    let corners: String = (1..=count).rev().map(|i| format!(" {i}")).collect();
    let text = format!("{vertices}fo{corners}\nf 1 2 3\n");
    let cage = cage(text);
    assert_eq!(cage.face_sizes, [count, 3]);
    assert_eq!(cage.corners[..2], [count - 1, count - 2]);
}

#[test]
fn any_line_ending_blank_and_continuation_reads_alike() {
    let plain = cage(format!("{SQUARE}f 1 2 3 4\n"));
    let unlike = |cage: crate::cage::Cage| crate::cage::Cage { face_lines: plain.face_lines.clone(), ..cage };
    let spaced = "  v 0 0 0 \n\tv\t1  0 0\n\nv 1 1 0 # corner\nv 0 1 0#none\n f 1 2\t3 4 \t";
    for text in [spaced.to_owned(), spaced.replace('\n', "\r\n"), spaced.replace('\n', "\r")] {
        assert_eq!(unlike(cage(&text)), plain, "{text:?}");
        assert_eq!(cage(&text).face_lines, [6]);
    }
    for continued in ["f 1 2 \\\n 3 4", "f\\\r\n1 2 3\\ \t\n4\\", "f 1 2 3 \\\r\\\r4"] {
        assert_eq!(cage(format!("{SQUARE}{continued}")), plain, "{continued:?}");
    }
    assert_eq!(cage([b"\xef\xbb\xbf", SQUARE.as_bytes(), b"f 1 2 3 4"].concat()), plain);
    assert_eq!(cage([b"#\xff\xfe\\\no \xe9\n", SQUARE.as_bytes(), b"f 1 2 3 4"].concat()).face_lines, [7]);
}

#[test]
fn a_comment_is_not_continued() {
    let cage = cage(format!("# made in C:\\tools\\\n{SQUARE}f 1 2 3\n"));
    assert_eq!(cage.positions.len(), 4);
}

#[test]
fn weights_colours_and_groups_do_not_change_the_cage() {
    let plain = cage("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    let rich = "mtllib a b.mtl\no x\nv 0 0 0 0.5\nv 1 0 0 .1 .2 .3\nv 1 1 0 2 1 1 1\nv 0 1 0\ng a\ns 1\nusemtl m\n\
                f 1 2 3\ng b c\ns off\nf 1 3 4\n";
    let rich = read(rich);
    assert!(rich.warnings.is_empty(), "{:?}", rich.warnings);
    let rich = rich.cage.expect("faces");
    assert_eq!((rich.positions, rich.corners), (plain.positions, plain.corners));
}

#[test]
fn numbers_are_read_to_the_last_bit() {
    let cage = cage("v 0.1 -1.5e-3 +7\nv .5 5. 1E2\nv 0 0 1e-400\nf 1 2 3");
    assert_eq!(cage.positions, [[0.1, -1.5e-3, 7.0], [0.5, 5.0, 100.0], [0.0, 0.0, 0.0]]);
}

#[test]
fn texture_coordinates_of_some_faces_only_are_told_and_not_used() {
    let text = format!("{SQUARE}vt 0 0\nvt .5\nf 1/1 2/2 3/2\nf 1 3 4\nf 1 4 3\n");
    let obj = read(text);
    let part = "x.obj:8: `vt`: other faces have texture coordinates, this one has not: they are not used";
    assert_eq!(obj.warnings, [part]);
    let cage = obj.cage.expect("faces");
    assert!(cage.texture.is_empty() && cage.texture_corners.is_empty());
}

#[test]
fn what_is_not_drawn_is_told_once_a_kind() {
    let obj = read(format!("{SQUARE}l 1 2\np 1\nl 2 3\nf 1 2 3\nwobble 1 2\nl 1 4\n"));
    assert_eq!(
        obj.warnings,
        [
            "x.obj:5: `l`: lines are not drawn (3 times)",
            "x.obj:6: `p`: points are not drawn",
            "x.obj:9: `wobble`: this statement is not known and is passed over",
        ]
    );
}

#[test]
fn errors_of_vertices_name_line_and_word() {
    assert_refused([
        ("v 0 0\n", 1, "2 numbers stand after `v`"),
        ("v 0 0 0\nv\n", 2, "0 numbers"),
        ("v 0 0 0 0 0\n", 1, "5 numbers"),
        ("v 1 2 3 4 5 6 7 8\n", 1, "more than 7 numbers"),
        ("\nv 0 1,5 0\n", 2, "`1,5` stands where a number should be"),
        ("v 0 0\\\n x\n", 2, "`x`"),
        ("v 0 nan 0\n", 1, "`nan` is not finite"),
        ("v 0 0 -inf\n", 1, "`-inf`"),
        ("v 1e39 0 0\n", 1, "beyond 3.4e38"),
        ("v 0 0 0\r\rvt\r", 3, "no number stands after `vt`"),
        ("vt 0 0 0 0\n", 1, "more than 3 numbers stand after `vt`"),
        ("vn 0 0\n", 1, "2 numbers stand after `vn`"),
    ]);
}

#[test]
fn errors_of_faces_name_line_and_word() {
    let with = |rest: &str| format!("{SQUARE}vt 0 0\nvn 0 0 1\n{rest}");
    for (rest, line, part) in [
        ("f 0 1 2", 7, "`0` names vertex 0"),
        ("f 1 2 5", 7, "`5` names vertex 5, but only 4 stand before this line"),
        ("f 1 2 -5", 7, "`-5` counts 5 back from the last vertex, but only 4"),
        ("f 1/2 2/1 3/1", 7, "`1/2` names texture coordinate 2, but only 1"),
        ("f 1//2 2//1 3//1", 7, "`1//2` names normal 2"),
        ("f 1 2 5\nv 0 0 0", 7, "names vertex 5"),
        ("f 1 2\n", 7, "a face with 2 of 3 or more corners"),
        ("f\n", 7, "a face with 0"),
        ("\nf 1 2 \\\n 1\n", 8, "the face has vertex 1 more than once"),
        ("f 1 2 3 4 1 2 3 4 4", 7, "has vertex 1 more than once"),
        ("f 1 2/1 3", 7, "`2/1` is written as v/vt, the corners before it as v"),
        ("f 1//1 2/1/1 3//1", 7, "`2/1/1` is written as v/vt/vn, the corners before it as v//vn"),
        ("f 1 2 x", 7, "`x` stands where a corner should be"),
        ("f 1 2 3.0", 7, "`3.0`"),
        ("f 1 2 99999999999999999999", 7, "`99999999999999999999`"),
        ("f 1 2 9223372036854775807", 7, "names vertex 9223372036854775807"),
        ("f 1 2 -9223372036854775808", 7, "counts 9223372036854775808 back"),
        ("f 1/1/1/1 2 3", 7, "`1/1/1/1` has too many parts"),
        ("f 1/ 2/ 3/", 7, "`1/` stands where a corner should be"),
        ("f /1 2 3", 7, "`/1` stands"),
        ("f 1// 2// 3//", 7, "`1//` stands"),
    ] {
        assert_refused([(with(rest).as_str(), line, part)]);
    }
}

#[test]
fn long_words_are_shortened_in_messages_and_odd_bytes_replaced() {
    let (_, problem, _) = refusal(format!("v 0 0 {}\n", "y".repeat(100_000)));
    assert!(problem.len() < 100 && problem.contains("yyy"));
    let (_, problem, _) = refusal(b"v 0 0 \x1b\xff\n");
    assert!(problem.starts_with("`\u{fffd}\u{fffd}`"), "{problem:?}");
}

#[test]
fn a_file_without_surfaces_is_refused() {
    assert_refused([
        ("", 1, "neither faces"),
        ("# only a comment\n", 2, "neither faces"),
        ("v 0 0 0\nl 1 1\n", 3, "neither faces (`f`) nor surfaces (`surf`)"),
    ]);
}

#[test]
fn a_file_of_many_unknown_statements_is_refused() {
    let words: String = (0..17).map(|i| format!("word{i}\n")).collect();
    let (line, problem, remedy) = refusal(words);
    assert_eq!((line, problem.as_str()), (17, "`word16` and 16 other kinds of statements are not known"));
    assert!(remedy.contains("right file"));
}
