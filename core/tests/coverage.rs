//! Coverage is exact: against a brute-force reference, each sample of a mesh once, and the quick way
//! through `quads.rs` agrees with the general one.

mod common;

use micropoly_core::abi::{Colour, Draw, Frame, Sample, Surface};
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::dice::{GRID, Grid};
use micropoly_core::kernel::project::Vertex;
use micropoly_core::kernel::quads::{FOUND, GENERAL, NOTHING, Quads};
use micropoly_core::kernel::sample::{Band, sample};
use micropoly_core::kernel::triangle::{sample_triangle, samples_between, site};
use micropoly_core::pattern::{Region, Samples};

const SIZE: i32 = 24;

fn frame(rate: u32) -> Frame {
    let size = SIZE as u32;
    let frame = Frame { width: size, height: size, rate, ..Frame::default() };
    frame.with_region(Region::whole(size, size, Samples::One), 0)
}

/// Where the centre of a pixel is.
fn centre(column: i32, row: i32) -> [i32; 2] {
    site(&frame(1), column, row)
}

fn vertex(random: &mut fastrand::Rng, spread: i32) -> Vertex {
    let mut at = || random.i32(-spread..SIZE * 256 + spread);
    Vertex { x: at(), y: at(), w: 0.5 }
}

/// Top-left coverage from first principles, in i128: inside, or on an edge that owns its samples.
fn reference([a, b, c]: [Vertex; 3], column: i32, row: i32) -> bool {
    let (x, y) = (i128::from(column * 256 + 128), i128::from(row * 256 + 128));
    let point = |v: Vertex| (i128::from(v.x), i128::from(v.y));
    let area = |p: (i128, i128), q: (i128, i128), r: (i128, i128)| {
        (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0)
    };
    let (a, b, c) = (point(a), point(b), point(c));
    let whole = area(a, b, c);
    let corners = if whole < 0 { [a, c, b] } else { [a, b, c] };
    whole != 0
        && (0..3).all(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let side = area(from, to, (x, y));
            let top_left = to.1 < from.1 || (to.1 == from.1 && to.0 > from.0);
            side > 0 || (side == 0 && top_left)
        })
}

#[test]
fn triangles_of_all_shapes_agree_with_the_reference() {
    let mut random = common::random(30);
    let mut covered = 0;
    for round in 0..20_000 {
        let mut triangle = [0; 3].map(|_| vertex(&mut random, 2000));
        match round % 5 {
            // Vertices on sample positions and pixel corners: samples on edges and vertices.
            0 => triangle = triangle.map(|v| Vertex { x: v.x & !127, y: v.y & !127, ..v }),
            // Slivers.
            1 => triangle[2] = Vertex { x: triangle[0].x + random.i32(-3..4), y: triangle[0].y + 1, w: 0.5 },
            // Smaller than a pixel.
            2 => {
                for k in 1..3 {
                    triangle[k].x = triangle[0].x + random.i32(-200..200);
                    triangle[k].y = triangle[0].y + random.i32(-200..200);
                }
            }
            // Huge.
            3 => triangle = triangle.map(|v| Vertex { x: v.x * 400, y: v.y * 400, ..v }),
            _ => {}
        }
        for k in 0..SIZE * SIZE {
            let (column, row) = (k % SIZE, k / SIZE);
            let found = sample_triangle(triangle, centre(column, row));
            assert_eq!(found.is_some(), reference(triangle, column, row), "round {round}: {triangle:?}");
            assert!(found.is_none_or(|hit| hit.w == 0.5));
            covered += usize::from(found.is_some());
        }
    }
    assert!(covered > 100_000, "{covered}");
}

#[test]
fn depth_is_interpolated() {
    let at = |x: i32, y: i32, w: f32| Vertex { x: x * 256, y: y * 256, w };
    let triangle = [at(0, 0, 0.1), at(20, 0, 0.3), at(0, 20, 0.2)];
    let w = sample_triangle(triangle, centre(4, 8)).expect("inside").w;
    assert!((w - (0.1 + 0.2 * 4.5 / 20.0 + 0.1 * 8.5 / 20.0)).abs() < 1.0e-6, "{w}");
}

/// A grid whose snapped vertices are jittered but never fold over, and its frame.
fn jittered_grid(random: &mut fastrand::Rng, rate: u32, cell: i32) -> (Frame, Grid) {
    let frame = frame(rate);
    let mut grid = Grid::default();
    (grid.stride, grid.rows) = (rate as usize + 1, rate as usize + 1);
    let jitter = cell / 4;
    let (left, top) = (random.i32(-500..3000), random.i32(-500..3000));
    for at in 0..grid.stride * grid.stride {
        let (row, column) = ((at / grid.stride) as i32, (at % grid.stride) as i32);
        grid.x[at] = left + column * cell + random.i32(-jitter..=jitter);
        grid.y[at] = top + row * cell + random.i32(-jitter..=jitter);
        grid.w[at] = 0.25 + random.f32() * 0.5;
    }
    (frame, grid)
}

fn corner(grid: &Grid, at: usize) -> Vertex {
    Vertex { x: grid.x[at], y: grid.y[at], w: grid.w[at] }
}

fn triangles(grid: &Grid, at: usize) -> [[Vertex; 3]; 2] {
    let [a, b, c, d] = [at, at + 1, at + grid.stride + 1, at + grid.stride].map(|at| corner(grid, at));
    [[a, b, c], [a, c, d]]
}

#[test]
fn every_sample_inside_a_grid_belongs_to_exactly_one_triangle() {
    let mut random = common::random(31);
    for round in 0..300 {
        let cell = random.i32(8..600);
        let (_, grid) = jittered_grid(&mut random, 8, cell);
        for k in 0..SIZE * SIZE {
            let (column, row) = (k % SIZE, k / SIZE);
            let owners = (0..72)
                .filter(|at| at % 9 != 8)
                .flat_map(|at| triangles(&grid, at))
                .filter(|triangle| sample_triangle(*triangle, centre(column, row)).is_some())
                .count();
            assert!(owners <= 1, "round {round}: {owners} owners");
            let (x, y) = (column * 256 + 128, row * 256 + 128);
            let margin = cell / 2;
            let safe = |low: i32, high: i32, at: i32| at > low + margin && at < high - margin;
            if safe(grid.x[0], grid.x[0] + 8 * cell, x) && safe(grid.y[0], grid.y[0] + 8 * cell, y) {
                assert_eq!(owners, 1, "round {round}: nobody owns ({column}, {row})");
            }
        }
    }
}

#[test]
fn the_quick_way_agrees_with_the_general_one() {
    let mut random = common::random(32);
    let mut states = [0; 3];
    for round in 0..20_000 {
        let cell = random.i32(4..500);
        let (frame, mut grid) = jittered_grid(&mut random, 8, cell);
        if round % 3 == 0 {
            for at in 0..GRID {
                (grid.x[at], grid.y[at]) = (grid.x[at] & !127, grid.y[at] & !127);
            }
        }
        let row = random.usize(0..8);
        let quads = Quads::new(&frame, &grid, row * grid.stride);
        let finds = quads.find();
        for l in 0..8 {
            states[finds.state[l] as usize] += 1;
            let [left, right, top, bottom] = quads.samples(l);
            let pixels = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
            let general = pixels.flat_map(|(x, y)| {
                triangles(&grid, row * grid.stride + l)
                    .map(|triangle| (x, y, sample_triangle(triangle, centre(x, y))))
            });
            let owned: Vec<_> =
                general.filter_map(|(x, y, hit)| hit.map(|hit| (x, y, hit.w.to_bits()))).collect();
            match finds.state[l] {
                NOTHING => assert_eq!(owned, [], "round {round}"),
                FOUND => assert_eq!(owned, [(left, top, finds.w[l].to_bits())], "round {round}"),
                _ => {}
            }
        }
    }
    assert!(states[NOTHING as usize] > 1000 && states[FOUND as usize] > 1000, "{states:?}");
    assert!(states[GENERAL as usize] > 1000, "{states:?}");
}

#[test]
fn ties_in_depth_go_to_the_smaller_identity_in_any_order() {
    let mut random = common::random(33);
    let (frame, mut grid) = jittered_grid(&mut random, 8, 300);
    grid.w = [0.5; GRID];
    let draw = |patch: u32| Draw { patch_id: patch, ..Draw::default() };
    let image = |order: [u32; 3]| {
        let pixels = (SIZE * SIZE) as usize;
        let (mut samples, mut colours) = (vec![Sample::default(); pixels], vec![Colour::default(); pixels]);
        for patch in order {
            let mut band = Band::whole(&frame, &mut samples, &mut colours);
            sample(&frame, &Pattern::new(&frame), (draw(patch), 1.0), &grid, &mut band);
        }
        samples
    };
    let first = image([4, 9, 7]);
    assert!(first.iter().any(|sample| sample.depth > 0));
    assert!(first.iter().all(|sample| sample.depth == 0 || sample.patch_id == 4));
    for order in [[9, 7, 4], [7, 4, 9], [9, 4, 7]] {
        assert_eq!(image(order), first, "{order:?}");
    }
}

#[test]
fn bands_together_are_the_whole_image() {
    let mut random = common::random(34);
    let (frame, grid) = jittered_grid(&mut random, 8, 500);
    let draw = Draw::new(Surface::root(3), micropoly_core::abi::Verdict::default());
    let render = |heights: &[i32]| {
        let pixels = (SIZE * SIZE) as usize;
        let (mut samples, mut colours) = (vec![Sample::default(); pixels], vec![Colour::default(); pixels]);
        let mut top = 0;
        for &height in heights {
            let mut band = Band::whole(&frame, &mut samples, &mut colours);
            band.limits = [0, SIZE, top, top + height];
            sample(&frame, &Pattern::new(&frame), (draw, 1.0), &grid, &mut band);
            top += height;
        }
        samples
    };
    assert_eq!(render(&[24]), render(&[5, 1, 7, 11]));
}

#[test]
fn ranges_hold_exactly_the_centres_of_pixels() {
    for low in -700..700 {
        for high in low..low + 600 {
            let (first, end) = samples_between(&frame(1), low, high);
            let inside = (-5..8).filter(|pixel| (low..=high).contains(&(pixel * 256 + 128)));
            assert_eq!(inside.collect::<Vec<_>>(), (first..end).collect::<Vec<_>>(), "{low} {high}");
        }
    }
}
