//! Patterns of samples are spread evenly, in space, in time and on the lens; the weights of filters are right.

use std::collections::HashSet;

use micropoly_core::abi::{Frame, Tap};
use micropoly_core::pattern::{Region, Samples, TUPLES, Window, tuples};
use micropoly_core::reconstruction::{Filter, Kernel, MAX_TAPS};

#[test]
fn every_pattern_has_one_sample_in_each_field_column_and_row() {
    for samples in Samples::ALL {
        let (count, side) = (samples.count() as i32, 1 << samples.bits());
        let offsets: Vec<[i32; 2]> = (0..samples.count()).map(|index| samples.offset(index)).collect();
        let distinct = |of: &dyn Fn(&[i32; 2]) -> i32| offsets.iter().map(of).collect::<HashSet<i32>>().len();
        assert_eq!(distinct(&|[x, _]| x * count / 256) as i32, count, "{samples:?}: columns");
        assert_eq!(distinct(&|[_, y]| y * count / 256) as i32, count, "{samples:?}: rows");
        for (index, [x, y]) in offsets.iter().enumerate() {
            let (column, row) = (index as i32 % side, index as i32 / side);
            assert_eq!((x * side / 256, y * side / 256), (column, row), "{samples:?}");
        }
        let mean = |axis: usize| offsets.iter().map(|offset| offset[axis]).sum::<i32>();
        assert_eq!([mean(0), mean(1)], [128 * count; 2], "{samples:?} is centred");
    }
    assert_eq!(Samples::Four.offset(0), [96, 32]); // the rotated grid
}

#[test]
fn the_tuples_of_a_blurred_frame_have_each_sample_once() {
    for samples in Samples::ALL {
        for window in [Window::whole(21, 10), Window { left: 3, right: 18, top: 5, bottom: 6 }] {
            let region = Region { samples, window, shown: window };
            let whole = Frame { width: 21, height: 10, ..Frame::default() }.with_region(region, 8);
            let mut places = HashSet::new();
            for tuple in tuples(samples) {
                let frame = whole.with_tuple(samples, tuple);
                for row in frame.sample_top..frame.sample_bottom {
                    for column in frame.sample_left..frame.sample_right {
                        let place = frame.place_first
                            + (row - frame.sample_top) * frame.place_row
                            + (column - frame.sample_left) * frame.place_column;
                        assert!(places.insert(place), "{samples:?}: place {place} twice");
                        // It is where the sample at this place is in the sharp frame.
                        let (bits, wide) = (samples.bits(), window.width() << samples.bits());
                        let (x, y) =
                            (place % wide + (window.left << bits), place / wide + (window.top << bits));
                        let mask = (1 << bits) - 1;
                        let [sharp_x, sharp_y] = samples.offset((y & mask) << bits | (x & mask));
                        let sharp = [(x >> bits) as i32 * 256 + sharp_x, (y >> bits) as i32 * 256 + sharp_y];
                        let site = micropoly_core::kernel::triangle::site(&frame, column as i32, row as i32);
                        assert_eq!(site, sharp, "{samples:?}");
                    }
                }
            }
            assert_eq!(places.len() as u64, whole.sample_count(), "{samples:?}");
        }
    }
}

#[test]
fn moments_and_places_on_the_lens_are_spread_evenly() {
    for samples in Samples::ALL {
        let all: Vec<_> = tuples(samples).collect();
        let count = samples.count() as usize;
        assert_eq!(all.len(), TUPLES as usize);
        let moments: HashSet<u32> = all.iter().map(|tuple| (tuple.time * f64::from(TUPLES)) as u32).collect();
        assert_eq!(moments.len(), all.len(), "{samples:?}: no two at the same time");
        for own in all.chunks(count) {
            // Those of one pixel: one in each stretch of time, one in each of as many rings and sectors of the lens.
            let times: HashSet<usize> =
                own.iter().map(|tuple| (tuple.time * count as f64) as usize).collect();
            assert_eq!(times.len(), count, "{samples:?}");
            let mean = |axis: usize| own.iter().map(|tuple| tuple.lens[axis]).sum::<f64>() / count as f64;
            let off = if count == 1 { 1.0 } else { 0.6 / (count as f64).sqrt() };
            assert!(mean(0).abs() < off && mean(1).abs() < off, "{samples:?}: {} {}", mean(0), mean(1));
        }
        let inside =
            |radius: f64| all.iter().filter(|tuple| tuple.lens[0].hypot(tuple.lens[1]) < radius).count();
        assert_eq!(inside(1.0), 64, "{samples:?}: all are on the lens");
        assert!((inside(0.5) as i32 - 16).abs() <= 4, "{samples:?}: {} in a quarter of it", inside(0.5));
    }
}

#[test]
fn parts_cover_a_window_once_and_are_no_larger_than_asked() {
    for (window, most) in [
        (Window::whole(1280, 720), 65536),
        (Window { left: 7, right: 19, top: 3, bottom: 1000 }, 100),
        (Window::whole(5, 3), 1),
        (Window::whole(16384, 1), 1000),
    ] {
        let mut seen = HashSet::new();
        for part in window.parts(most) {
            assert!(part.pixels() <= most && part.pixels() > 0, "{part:?}");
            for row in part.top..part.bottom {
                for column in part.left..part.right {
                    assert!(seen.insert((column, row)), "{column}, {row} twice");
                }
            }
        }
        assert_eq!(seen.len() as u64, window.pixels(), "{window:?}");
    }
}

#[test]
fn weights_add_up_to_one_and_are_the_filters_own() {
    for samples in Samples::ALL {
        for kernel in Kernel::ALL {
            for radius in [0.5, kernel.usual_radius(), 2.2, 4.0] {
                let filter = Filter { kernel, radius };
                let mut taps = vec![Tap::default(); MAX_TAPS];
                let count = filter.taps(samples, &mut taps);
                let taps = &taps[..count];
                let sum: f64 = taps.iter().map(|tap| f64::from(tap.weight)).sum();
                assert!((sum - 1.0).abs() < 1.0e-5, "{samples:?} {filter:?}: {sum}");
                let mut moments = [0.0; 2];
                for tap in taps {
                    let k = 1 << samples.bits();
                    let [x, y] =
                        samples.offset((tap.row.rem_euclid(k) * k + tap.column.rem_euclid(k)) as u32);
                    let along =
                        |field: i32, offset: i32| f64::from(field.div_euclid(k) * 256 + offset - 128) / 256.0;
                    let (x, y) = (along(tap.column, x), along(tap.row, y));
                    assert!(x.abs() < radius && y.abs() < radius, "{filter:?}: {x} {y}");
                    moments =
                        [moments[0] + x * f64::from(tap.weight), moments[1] + y * f64::from(tap.weight)];
                    if kernel == Kernel::Box {
                        assert!((f64::from(tap.weight) * count as f64 - 1.0).abs() < 1.0e-6, "{filter:?}");
                    }
                }
                assert!(
                    moments.iter().all(|moment| moment.abs() < 0.02),
                    "{samples:?} {filter:?}: {moments:?}"
                );
            }
        }
    }
    // One sample in the middle, taken as it is.
    let mut taps = vec![Tap::default(); MAX_TAPS];
    assert_eq!(Filter::default().taps(Samples::One, &mut taps), 1);
    assert_eq!(taps[0], Tap { weight: 1.0, column: 0, row: 0 });
}
