//! Surfaces bounded many at once get the verdicts that they get one by one, bit for bit.

mod common;

use common::{between, random, random_gregory, random_patch, random_surface, random_view};
use micropoly_core::abi::{CULL, DRAW, FLAG_WEBER, Patch, SPLIT_U, Surface, Verdict};
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::bound_lanes::{LANES, Lanes, bound_lanes};

/// Bézier patches, tiny, large and flat ones among them, and a few Gregory patches with their face points.
fn patches(random: &mut fastrand::Rng) -> Vec<Patch> {
    let mut patches: Vec<Patch> = (0..24).map(|_| random_patch(random, 0.6)).collect();
    for patch in &mut patches {
        let scale = [1.0, 1.0, 0.01, 0.0, 1.0e4][random.usize(0..5)];
        for c in [&mut patch.x, &mut patch.y, &mut patch.z] {
            let shift = between(random, -1.0, 1.0);
            c.iter_mut().for_each(|c| *c = *c * scale + shift);
        }
    }
    for k in 0..6 {
        let [mut patch, record] = random_gregory(random, 0.4, 0.2);
        patch.faces = 30 + k;
        patches.insert(4 * k as usize, patch);
        patches.push(record);
    }
    patches
}

/// In runs of one patch, as on a stack.
fn surfaces(random: &mut fastrand::Rng, count: usize) -> Vec<Surface> {
    let mut patch_id = 0;
    (0..count)
        .map(|_| {
            if random.u32(0..3) == 0 {
                patch_id = random.u32(0..30);
            }
            Surface { patch_id, ..random_surface(random, 12) }
        })
        .collect()
}

#[test]
fn many_surfaces_get_the_verdicts_of_each() {
    let random = &mut random(11);
    let mut seen = [0; 5];
    for round in 0..600 {
        let (mut frame, object) = random_view(random, 0.05);
        frame.flags = if round % 8 == 0 { FLAG_WEBER } else { 0 };
        frame.levels = if round % 5 == 0 { 7 } else { frame.levels };
        let patches = patches(random);
        let count = random.usize(0..3 * LANES);
        let surfaces = surfaces(random, count);
        let mut verdicts = vec![Verdict::default(); surfaces.len()];
        bound_lanes(&frame, &[object], &patches, &surfaces, &mut verdicts, &mut Lanes::default());
        for (surface, verdict) in surfaces.iter().zip(&verdicts) {
            let alone = bound_any(&frame, &[object], &patches, *surface);
            assert_eq!(*verdict, alone, "round {round}: {surface:?}");
            seen[verdict.code as usize] += 1;
        }
    }
    assert!(
        seen[CULL as usize] > 100 && seen[DRAW as usize] > 100 && seen[SPLIT_U as usize] > 100,
        "{seen:?}"
    );
}
