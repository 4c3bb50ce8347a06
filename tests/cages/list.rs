//! Cages of all kinds, by name.

use micropoly::cage::{Boundary, Cage, Crease};

use super::{bumpy_grid, crease, cube, drum, star, tetrahedron};

/// Closed ones, without holes: what they enclose must not leak.
pub(crate) fn closed() -> Vec<(String, Cage)> {
    let mut list: Vec<(String, Cage)> = vec![("cube".into(), cube()), ("tetrahedron".into(), tetrahedron())];
    list.extend((3..=12).map(|count| (format!("drum of {count}"), drum(count))));
    let rim = |count: u32, sharpness: f32| {
        (0..count).map(move |k| crease(count + k, count + (k + 1) % count, sharpness))
    };
    let mut add = |name: &str, cage: Cage, creases: Vec<Crease>| {
        list.push((name.to_owned(), Cage { creases, ..cage }));
    };
    add("cube with a dart", cube(), vec![crease(0, 1, 10.0)]);
    add("cube with a corner", cube(), [1, 2, 4].map(|end| crease(0, end, 10.0)).to_vec());
    add(
        "cube of decaying creases",
        cube(),
        vec![crease(0, 1, 1.5), crease(1, 3, 2.3), crease(3, 2, 0.4), crease(1, 5, 3.7)],
    );
    add(
        "cube with a crease around",
        cube(),
        vec![crease(0, 1, 10.0), crease(1, 3, 10.0), crease(3, 2, 10.0), crease(2, 0, 10.0)],
    );
    add("drum with a rim", drum(6), rim(6, 10.0).collect());
    add("drum with a soft rim", drum(7), rim(7, 3.4).collect());
    add(
        "drum with three creases from its pole",
        drum(8),
        [8, 10, 12].map(|end| crease(17, end, 10.0)).to_vec(),
    );
    add(
        "drum with creases of all kinds",
        drum(5),
        (0..5).map(|k| crease(k, 5 + k, 0.3 + 0.7 * k as f32)).chain(rim(5, 10.0)).collect(),
    );
    add("drum with a dart", drum(5), vec![crease(11, 5, 10.0)]);
    list.push(("cube with a tip".into(), Cage { sharp_vertices: vec![(0, 10.0)], ..cube() }));
    list.push(("cube with a blunt tip".into(), Cage { sharp_vertices: vec![(0, 2.6), (7, 0.5)], ..cube() }));
    list
}

/// Those with a boundary, or holes, and how long the ends of the surface are there, in sides of faces and sub-faces.
pub(crate) fn open() -> Vec<(String, Cage, f64)> {
    let mut list: Vec<(String, Cage, f64)> =
        (3..=12).map(|count| (format!("star of {count}"), star(count), f64::from(2 * count))).collect();
    let mut add = |name: &str, cage: Cage, length: f64| list.push((name.to_owned(), cage, length));
    let with = |boundary: Boundary, cage: Cage| Cage { boundary, ..cage };
    add("grid, none", with(Boundary::None, bumpy_grid(5, 4)), 10.0);
    add("grid, edge only", with(Boundary::EdgeOnly, bumpy_grid(5, 4)), 18.0);
    add("star, none", with(Boundary::None, star(5)), 0.0);
    add("star, edge only", with(Boundary::EdgeOnly, star(5)), 10.0);
    let sharp_vertices = vec![(2, 10.0)];
    add("grid with a sharp vertex", Cage { sharp_vertices, ..bumpy_grid(4, 4) }, 16.0);
    add("grid with holes", Cage { holes: vec![7, 12], ..bumpy_grid(5, 5) }, 26.0);
    let creases = vec![crease(16, 23, 10.0), crease(23, 30, 10.0)];
    add("grid with two darts", Cage { creases, ..bumpy_grid(6, 6) }, 24.0);
    add("drum with a hole", Cage { holes: vec![1], ..drum(5) }, 5.0);
    list
}
