//! What the flatness oracle draws is as near to the surface as the tolerance says, and closed.

mod common;

use common::{exact_point, random, random_patch, random_view};
use micropoly_core::abi::{Draw, FLAG_FLAT, Frame, Object, Patch};
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::patch::Net;
use micropoly_core::schedule::for_each_draw;

#[test]
fn debug() {
    let mut random = random(1);
    for round in 0..20 {
        let patch = random_patch(&mut random, 0.4);
        let (mut frame, object) = random_view(&mut random, 0.1);
        frame.flags |= FLAG_FLAT;
        (frame.bound, frame.rate, frame.density) = (0.4, 1, 1.0);
        let mut count = 0;
        let mut deepest = (0, None);
        for_each_draw(&frame, &[object], &[patch], 0, |draw: Draw, _| {
            count += 1;
            let level = draw.surface().level();
            if level > deepest.0 { deepest = (level, Some(draw)); }
            if count > 200_000 { panic!("{round}: {deepest:?} {:?} corners {:?}", draw, (0..4).map(|c| draw.surface().corner(c)).collect::<Vec<_>>()); }
        });
        println!("{round} {count} {}", deepest.0);
    }
}
