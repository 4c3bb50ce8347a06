//! The arithmetic of `num`: accurate, exact where it says so, and the same as plain f32 where it must be.

mod common;

use micropoly_core::num::*;

/// Numbers of both signs over many orders of magnitude.
fn numbers(smallest: f32, largest: f32) -> impl Iterator<Item = f32> {
    let mut random = common::random(1);
    (0..200_000).map(move |_| {
        let exponent = common::between(&mut random, smallest.log2(), largest.log2());
        exponent.exp2()
    })
}

fn relative_error(found: f32, exact: f64) -> f64 {
    ((f64::from(found) - exact) / exact).abs()
}

#[test]
fn reciprocals_and_roots_are_accurate() {
    let ulp = f64::from(f32::EPSILON);
    for x in numbers(1.0e-37, 1.0e37) {
        let exact = f64::from(x);
        assert!(relative_error(recip(x), 1.0 / exact) < 2.0 * ulp, "recip({x:e})");
        assert_eq!(recip(-x), -recip(x), "{x:e}");
        assert!(relative_error(rsqrt(x), 1.0 / exact.sqrt()) < 3.0 * ulp, "rsqrt({x:e})");
        assert!(relative_error(sqrt(x), exact.sqrt()) < 4.0 * ulp, "sqrt({x:e})");
    }
}

#[test]
fn rounding_and_floor_agree_with_the_standard_library() {
    for x in numbers(1.0e-3, 4.0e6) {
        for x in [x, -x] {
            assert_eq!(round(x), x.round_ties_even() as i32, "round({x})");
            assert_eq!(floor(x), x.floor() as i32, "floor({x})");
        }
    }
    assert_eq!([round(0.5), round(1.5), round(-0.5), round(2.5)], [0, 2, 0, 2]);
}

#[test]
fn unit_scale_brings_numbers_into_one_to_two_exactly() {
    for x in numbers(1.3e-38, 8.0e37) {
        let scaled = x * unit_scale(x);
        assert!((1.0..2.0).contains(&scaled), "{x:e}");
        assert_eq!(scaled / unit_scale(x), x, "a power of two loses nothing");
    }
    assert_eq!([unit_scale(0.0), unit_scale(1.0e-40), unit_scale(f32::INFINITY)], [0.0; 3]);
}

#[test]
fn flush_keeps_products_out_of_the_denormals() {
    assert_eq!(flush(1.0e-20), 0.0);
    assert_eq!(flush(-1.0e-20), 0.0);
    assert_eq!(flush(1.0e-18), 1.0e-18);
    assert!((flush(1.1e-19) * flush(1.1e-19)).is_normal());
}
