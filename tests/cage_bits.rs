//! Patches of cages fit together: to the bit where they share an edge, and without a bend where the surface has none.

mod cages;

use std::collections::BTreeMap;

use cages::{list, read_obj, shared};
use micropoly::HalfSide;
use micropoly::cage::{Cage, Evaluation, Options, Origin, Patches, convert};

/// Indices of a side's points in a net; sides are v = 0, v = 1, u = 0, u = 1.
const SIDES: [[usize; 4]; 4] = [[0, 4, 8, 12], [3, 7, 11, 15], [0, 1, 2, 3], [12, 13, 14, 15]];

type Curve = [[u32; 3]; 4];

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    is_gregory: bool,
    patch: usize,
    side: usize,
}

fn patches(cage: &Cage, levels: u32) -> Patches {
    convert(cage, &Options { levels }, &|_| {}).expect("a surface")
}

fn curve(patches: &Patches, side: Side) -> [[f32; 3]; 4] {
    let net =
        if side.is_gregory { patches.gregory[side.patch].net() } else { patches.bezier[side.patch].points };
    SIDES[side.side].map(|at| net[at])
}

/// The same whichever way it runs.
fn key(curve: [[f32; 3]; 4]) -> Curve {
    let there = curve.map(|point| point.map(|x| (x + 0.0).to_bits()));
    let [a, b, c, d] = there;
    there.min([d, c, b, a])
}

fn sides(patches: &Patches) -> impl Iterator<Item = Side> {
    let bezier = (0..patches.bezier.len()).map(|patch| (false, patch));
    let gregory = (0..patches.gregory.len()).map(|patch| (true, patch));
    bezier
        .chain(gregory)
        .flat_map(|(is_gregory, patch)| (0..4).map(move |side| Side { is_gregory, patch, side }))
}

/// Sides by their curves.
fn shared_curves(patches: &Patches) -> BTreeMap<Curve, Vec<Side>> {
    let mut curves: BTreeMap<Curve, Vec<Side>> = BTreeMap::new();
    for side in sides(patches) {
        curves.entry(key(curve(patches, side))).or_default().push(side);
    }
    curves
}

/// Half of a cubic (de Casteljau), in the direction in which it runs.
fn half(curve: [[f32; 3]; 4], is_second: bool) -> [[f64; 3]; 4] {
    let mut points = curve.map(|point| point.map(f64::from));
    if is_second {
        points.reverse();
    }
    let mix = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| (a[k] + b[k]) / 2.0);
    let [a, b, c, d] = points;
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
    let mut first = [a, ab, abc, mix(abc, bcd)];
    if is_second {
        first.reverse();
    }
    first
}

fn check_half(patches: &Patches, half_side: HalfSide, name: &str) {
    let HalfSide { fine, fine_side, coarse, coarse_side, is_reversed, is_second } = half_side;
    let bezier = |patch: u32, side: u8| Side { is_gregory: false, patch: patch as usize, side: side.into() };
    let mut fine = curve(patches, bezier(fine, fine_side));
    let coarse = curve(patches, bezier(coarse, coarse_side));
    if is_reversed {
        fine.reverse();
    }
    let end = if is_second { 3 } else { 0 };
    assert_eq!(fine[end], coarse[end], "{name}: the ends of {half_side:?} differ");
    for (found, wanted) in fine.iter().zip(half(coarse, is_second)) {
        let off = (0..3).map(|k| (f64::from(found[k]) - wanted[k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-5, "{name}: {half_side:?} is {off} off");
    }
}

/// Of each shape the sides that no other side has, less those that are two halves of another.
fn open_sides(patches: &Patches, name: &str) -> Vec<Side> {
    let mut halves: BTreeMap<Side, u32> = BTreeMap::new();
    for &half_side in &patches.halves {
        check_half(patches, half_side, name);
        let HalfSide { fine, fine_side, coarse, coarse_side, is_second, .. } = half_side;
        let side =
            |patch: u32, side: u8| Side { is_gregory: false, patch: patch as usize, side: side.into() };
        assert!(halves.insert(side(fine, fine_side), 3).is_none(), "{name}: a half of two sides");
        let seen = halves.entry(side(coarse, coarse_side)).or_default();
        let bit = 1 << u32::from(is_second);
        assert!(*seen & bit == 0, "{name}: two halves in one place");
        *seen |= bit;
    }
    assert!(halves.values().all(|&seen| seen == 3), "{name}: a half without the other");
    let mut open = Vec::new();
    for (_, sides) in shared_curves(patches) {
        let alone: Vec<Side> = sides.into_iter().filter(|side| !halves.contains_key(side)).collect();
        match alone.len() {
            1 => open.push(alone[0]),
            2 => {}
            more => assert!(more == 0, "{name}: {more} patches share a side: {alone:?}"),
        }
    }
    open
}

#[test]
fn closed_cages_leave_no_side_open() {
    for (name, cage) in list::closed() {
        for levels in 0..6 {
            let open = open_sides(&patches(&cage, levels), &name);
            assert!(open.is_empty(), "{name}, {levels} levels: {} sides are open: {:?}", open.len(), open[0]);
        }
    }
}

#[test]
fn spot_is_closed() {
    let Some(path) = shared("spot_is_closed", "models/spot_control_mesh.obj") else { return };
    let spot = read_obj(&path);
    for levels in [0, 1, 3] {
        let patches = patches(&spot, levels);
        assert_eq!(open_sides(&patches, "spot").len(), 0);
    }
}

fn origin(patches: &Patches, side: Side) -> Origin {
    if side.is_gregory { patches.gregory_origins[side.patch] } else { patches.bezier_origins[side.patch] }
}

#[test]
fn open_cages_are_open_only_at_their_ends_and_holes() {
    for (name, cage, expected) in list::open() {
        for levels in 0..5 {
            let patches = patches(&cage, levels);
            let open = open_sides(&patches, &name);
            let length = |side: &Side| 1.0 / f64::from(1 << origin(&patches, *side).level);
            let length: f64 = open.iter().map(length).sum();
            assert_eq!(length, expected, "{name}, {levels} levels");
        }
    }
}

#[test]
fn a_vertex_has_the_same_bits_in_all_patches_of_all_levels() {
    for (name, cage) in list::closed() {
        let patches = patches(&cage, 3);
        let mut corners: Vec<[f32; 3]> =
            sides(&patches).flat_map(|side| [0, 3].map(|end| curve(&patches, side)[end])).collect();
        corners.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        corners.dedup();
        for (k, a) in corners.iter().enumerate() {
            let near = corners[k + 1..].iter().take_while(|b| b[0] - a[0] < 1e-5);
            for b in near {
                let distance = (0..3).map(|axis| (a[axis] - b[axis]).abs()).fold(0.0, f32::max);
                assert!(distance > 1e-5, "{name}: {a:?} and {b:?}");
            }
        }
    }
}

#[test]
fn patches_do_not_depend_on_the_number_of_threads() {
    for (name, cage) in list::closed() {
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| patches(&cage, 3))
        };
        assert!(with(1) == with(5), "{name}");
    }
}

/// The normal on a side.
fn normal(patches: &Patches, side: Side, t: f64) -> glam::DVec3 {
    let (u, v) = [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)][side.side];
    let found = if side.is_gregory {
        Evaluation::of_gregory(&patches.gregory[side.patch], u, v)
    } else {
        Evaluation::of_bezier(&patches.bezier[side.patch], u, v)
    };
    found.normal
}

/// The largest angle between the normals of two sides, or parts of sides, in degrees.
fn bend(patches: &Patches, a: Side, b: Side, along: impl Fn(f64) -> f64) -> f64 {
    let at = |k: u32| {
        let t = f64::from(k) / 32.0;
        let (n, m) = (normal(patches, a, t), normal(patches, b, along(t)));
        n.cross(m).length().atan2(n.dot(m)).to_degrees()
    };
    (1..32).map(at).fold(0.0, f64::max)
}

/// The largest angle between the normals of two patches along smooth sides that they share.
fn largest_bend(patches: &Patches) -> f64 {
    let is_crease = |side: Side| origin(patches, side).sharp >> side.side & 1 == 1;
    let mut most = 0.0_f64;
    for sides in shared_curves(patches).values() {
        if let &[a, b] = &sides[..]
            && !is_crease(a)
        {
            let is_reversed = curve(patches, a) != curve(patches, b);
            most = most.max(bend(patches, a, b, |t| if is_reversed { 1.0 - t } else { t }));
        }
    }
    for half in &patches.halves {
        let side =
            |patch: u32, side: u8| Side { is_gregory: false, patch: patch as usize, side: side.into() };
        let (fine, coarse) = (side(half.fine, half.fine_side), side(half.coarse, half.coarse_side));
        if !is_crease(fine) {
            let start = if half.is_second { 0.5 } else { 0.0 };
            let along = |t: f64| start + 0.5 * if half.is_reversed { 1.0 - t } else { t };
            most = most.max(bend(patches, fine, coarse, along));
        }
    }
    most
}

#[test]
fn the_surface_does_not_bend_across_smooth_edges() {
    let open = list::open().into_iter().map(|(name, cage, _)| (name, cage));
    for (name, cage) in list::closed().into_iter().chain(open) {
        for levels in 0..4 {
            let bend = largest_bend(&patches(&cage, levels));
            assert!(bend < 0.01, "{name}, {levels} levels: {bend} degrees");
        }
    }
}
