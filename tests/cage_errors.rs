//! What is no cage is refused with a reason, and nothing that is given makes the program fail.

mod cages;

use cages::{bumpy_grid, cage_of, crease, cube, list};
use micropoly::cage::{Boundary, Cage, CageError, MOST_LEVELS, Options, Patches, convert};

fn converted(cage: &Cage, levels: u32) -> Result<Patches, CageError> {
    convert(cage, &Options { levels }, &|_| {})
}

fn error(change: impl FnOnce(&mut Cage)) -> CageError {
    let mut cage = cube();
    change(&mut cage);
    let error = converted(&cage, 1).expect_err("no cage");
    assert!(!error.problem().is_empty() && !error.remedy().is_empty());
    error
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(error(|c| c.corners.truncate(23)), CageError::Sizes { corners: 23, needed: 24 });
    assert_eq!(error(|c| c.corners[9] = 8), CageError::NoVertex { face: 2, vertex: 8, vertices: 8 });
    assert_eq!(error(|c| c.corners[9] = c.corners[8]), CageError::RepeatedVertex { face: 2, vertex: 0 });
    assert_eq!(error(|c| c.positions[3][1] = f64::NAN), CageError::Position { face: Some(0), vertex: 3 });
    assert_eq!(error(|c| c.positions[3][1] = 1e39), CageError::Position { face: Some(0), vertex: 3 });
    let two_corners = |c: &mut Cage| {
        c.corners.extend([0, 1]);
        c.face_sizes.push(2);
    };
    assert_eq!(error(two_corners), CageError::FewCorners { face: 6, corners: 2 });
    assert!(matches!(error(|c| c.corners[..4].reverse()), CageError::Winding { face: 0, .. }));
    let third = |c: &mut Cage| {
        c.positions.push([5.0; 3]);
        c.corners.extend([0, 2, 8]);
        c.face_sizes.push(3);
    };
    assert_eq!(error(third), CageError::CrowdedEdge { face: 0, vertices: [0, 2] });
    assert_eq!(error(|c| c.creases.push(crease(0, 7, 1.0))), CageError::NoEdge { vertices: [0, 7] });
    assert_eq!(error(|c| c.creases.push(crease(0, 99, 1.0))), CageError::NoEdge { vertices: [0, 99] });
    assert_eq!(error(|c| c.creases.push(crease(0, 1, f32::NAN))), CageError::Sharpness { vertex: 0 });
    assert_eq!(
        error(|c| c.sharp_vertices.push((8, 1.0))),
        CageError::NoSharpVertex { vertex: 8, vertices: 8 }
    );
    assert_eq!(error(|c| c.sharp_vertices.push((2, f32::NAN))), CageError::Sharpness { vertex: 2 });
    assert_eq!(error(|c| c.holes.push(6)), CageError::NoHole { hole: 6, faces: 6 });
    let too_many = converted(&cube(), MOST_LEVELS + 1);
    assert_eq!(too_many, Err(CageError::Levels { levels: MOST_LEVELS + 1, most: MOST_LEVELS }));
}

#[test]
fn errors_are_reported_with_the_line_of_the_face() {
    let cage = Cage { face_lines: vec![9, 10, 11, 12, 13, 14], ..cube() };
    let error = CageError::RepeatedVertex { face: 2, vertex: 5 };
    let text = error.in_file("mesh.obj".as_ref(), &cage).to_string();
    assert!(text.starts_with("mesh.obj:11: ") && text.contains("help:"), "{text}");
    let text = CageError::NoHole { hole: 9, faces: 6 }.in_file("mesh.obj".as_ref(), &cage).to_string();
    assert!(text.starts_with("mesh.obj: "), "{text}");
}

#[test]
fn loose_vertices_and_no_faces_are_no_error() {
    assert_eq!(converted(&Cage::default(), 3), Ok(Patches::default()));
    let mut cage = cube();
    let expected = converted(&cage, 3);
    cage.positions.push([9.0; 3]);
    let found = converted(&cage, 3).expect("a surface");
    assert_eq!(Ok(found.gregory.len()), expected.map(|patches| patches.gregory.len()));
}

#[test]
fn sharpness_below_0_is_none_and_the_last_of_two_creases_counts() {
    let plain = converted(&cube(), 3);
    let creased = |creases| converted(&Cage { creases, ..cube() }, 3);
    assert_eq!(creased(vec![crease(0, 1, -3.0)]), plain);
    assert_eq!(creased(vec![crease(0, 1, 10.0), crease(1, 0, 0.0)]), plain);
    assert_eq!(creased(vec![crease(1, 0, f32::INFINITY)]), creased(vec![crease(0, 1, 10.0)]));
}

#[test]
fn two_quads_back_to_back_are_a_surface() {
    let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [1.0, 1.0, 0.0], [0.0, 1.0, 0.3]];
    let patches = converted(&cage_of(square, &[&[0, 1, 2, 3], &[3, 2, 1, 0]]), 3).expect("a surface");
    let mut numbers = patches.bezier.iter().flat_map(|patch| &patch.points).flatten();
    assert!(numbers.all(|x| x.is_finite()));
    let mut numbers = patches.gregory.iter().flat_map(|patch| &patch.points).flatten();
    assert!(numbers.all(|x| x.is_finite()));
}

#[test]
fn a_pole_with_many_faces_takes_no_longer_than_they_do() {
    let patches = converted(&cages::drum(20_000), 0).expect("a surface");
    assert!(patches.bezier.len() > 20_000);
}

#[test]
fn every_patch_is_finite_and_within_reach_of_its_cage() {
    let open = list::open().into_iter().map(|(name, cage, _)| (name, cage));
    for (name, cage) in list::closed().into_iter().chain(open) {
        let reach = cage.positions.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs())) as f32 * 1.5;
        for levels in [0, 2, 7] {
            let patches = converted(&cage, levels).expect("a surface");
            let bezier = patches.bezier.iter().flat_map(|patch| &patch.points);
            let gregory = patches.gregory.iter().flat_map(|patch| &patch.points);
            for x in bezier.chain(gregory).flatten() {
                assert!(x.abs() <= reach, "{name}, {levels} levels: {x}");
            }
        }
    }
}

#[test]
fn whatever_is_given_there_are_patches_or_an_error() {
    let mut random = fastrand::Rng::with_seed(3);
    let (mut sound, mut wrong) = (0, 0);
    for _ in 0..4000 {
        let vertices = random.u32(3..9);
        let coordinate =
            |random: &mut fastrand::Rng| if random.u8(..) == 0 { f64::INFINITY } else { random.f64() };
        let positions = (0..vertices).map(|_| [0; 3].map(|_| coordinate(&mut random))).collect();
        let face = |random: &mut fastrand::Rng| {
            let mut corners: Vec<u32> = (0..vertices).collect();
            random.shuffle(&mut corners);
            corners.truncate(random.usize(3..6));
            corners
        };
        let faces: Vec<Vec<u32>> = (0..random.u32(0..4)).map(|_| face(&mut random)).collect();
        let mut cage = cage_of(positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>());
        cage.boundary = [Boundary::None, Boundary::EdgeOnly, Boundary::EdgeAndCorner][random.usize(..3)];
        if let Some(face) = faces.first().filter(|_| random.bool()) {
            cage.creases.push(crease(face[0], face[1], 12.0 * random.f32()));
            cage.sharp_vertices.push((face[2], 4.0 * random.f32()));
        }
        cage.creases.retain(|crease| crease.sharpness < 5.0 || crease.sharpness >= 10.0);
        match converted(&cage, random.u32(..3)) {
            Ok(_) => sound += 1,
            Err(_) => wrong += 1,
        }
    }
    assert!(sound > 500 && wrong > 500, "{sound} sound, {wrong} wrong");
}

#[test]
fn faces_of_a_mostly_regular_cage_are_left_whole() {
    let patches = converted(&bumpy_grid(40, 40), 3).expect("a surface");
    assert_eq!((patches.bezier.len(), patches.gregory.len()), (1600, 0));
}
