//! Files that are damaged, or made to do harm: they are read or refused, and take no more room than their length
//! allows.

use std::path::Path;

use super::super::{Obj, parse_bytes};
use super::{SQUARE, cage};

/// The seeds of the fuzz target; some are wrong as they are.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds/obj");
    let entries = std::fs::read_dir(&folder).expect("a folder of seeds");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("a seed")).collect()
}

/// Some bytes changed, removed, repeated or replaced by what may surprise a reader.
fn mutate(bytes: &mut Vec<u8>, random: &mut fastrand::Rng) {
    const PIECES: [&[u8]; 14] = [
        b"-1",
        b"0",
        b"\\\n",
        b"/",
        b"//",
        b"nan",
        b"1e999",
        b"99999999999",
        b"\r",
        b"#",
        b"\xff",
        b"end\n",
        b" ",
        b"t crease 9/9/0 ",
    ];
    for _ in 0..random.usize(1..8) {
        let at = random.usize(..=bytes.len());
        let end = (at + random.usize(..12)).min(bytes.len());
        match random.u8(..4) {
            0 => drop(bytes.drain(at..end)),
            1 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.u8(..)),
            2 => drop(bytes.splice(at..end, PIECES[random.usize(..PIECES.len())].iter().copied())),
            _ => {
                let piece = bytes[at..end].to_vec();
                let to = random.usize(..=bytes.len());
                drop(bytes.splice(to..to, piece));
            }
        }
    }
}

fn assert_whole(obj: &Obj) {
    if let Some(cage) = &obj.cage {
        let corners: u32 = cage.face_sizes.iter().sum();
        assert_eq!(corners as usize, cage.corners.len());
        assert!(cage.corners.iter().all(|&corner| (corner as usize) < cage.positions.len()));
        assert!(cage.texture_corners.is_empty() || cage.texture_corners.len() == cage.corners.len());
        assert!(cage.positions.iter().flatten().all(|value| value.is_finite()));
    }
    for surface in &obj.surfaces {
        let [u, v] = surface.counts();
        assert_eq!(u * v, surface.points.len());
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    let seed = fastrand::u64(..);
    println!("seed {seed}");
    let (seeds, mut random) = (seeds(), fastrand::Rng::with_seed(seed));
    let mut read = 0;
    for _ in 0..20_000 {
        let mut bytes = seeds[random.usize(..seeds.len())].clone();
        mutate(&mut bytes, &mut random);
        if let Ok(obj) = parse_bytes(Path::new("x.obj"), &bytes) {
            assert_whole(&obj);
            read += 1;
        }
    }
    assert!((1000..19_000).contains(&read), "{read} of 20000 were read: the test sees one side only");
}

#[test]
fn seeds_are_read_but_for_the_wrong_one() {
    let results: Vec<_> = seeds().iter().map(|bytes| parse_bytes(Path::new("x.obj"), bytes)).collect();
    assert_eq!(results.iter().filter(|result| result.is_ok()).count(), results.len() - 1);
    assert!(results.len() >= 5);
}

#[test]
fn time_grows_with_the_length_alone() {
    // Each of these takes minutes where a reader looks at the same bytes again and again.
    let started = std::time::Instant::now();
    let count = 300_000;
    let backslashes = format!("{SQUARE}o {}x\nf 1 2 3", "\\ ".repeat(count));
    let blanks = format!("{SQUARE}o \\{}x\nf 1 2 3", " ".repeat(count));
    let lines = format!("{SQUARE}{}f 1 2 3", "l 1 2\n".repeat(count));
    let empty = format!("{SQUARE}{}f 1 2 3", "\\\n".repeat(count));
    for text in [backslashes, blanks, lines, empty] {
        assert_eq!(cage(text).corners, [0, 1, 2]);
    }
    let vertices = "v 0 0 0\n".repeat(count);
    let corners: String = (1..=count).map(|corner| format!(" {corner}")).collect();
    assert_eq!(cage(format!("{vertices}f{corners}\n")).corners.len(), count);
    assert!(started.elapsed().as_secs() < 60);
}
