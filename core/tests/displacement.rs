//! Displaced surfaces stay in their boxes, bumps change as their slopes say, and normals are those of the surface.

mod common;

use common::{between, draw_at, random, random_gregory, random_patch, random_rates, random_surface};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use micropoly_core::abi::{CULL, Draw, Frame, MAX_RATE, Object, Patch, SPLIT_U, SPLIT_V, Surface, Verdict};
use micropoly_core::camera::{Camera, FrameOptions, Material};
use micropoly_core::displacement::{Displacement, Unfit};
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::dice_any::dice_any;
use micropoly_core::kernel::displace::{bump, noise};
use micropoly_core::kernel::triangle::samples_between;

fn anywhere(random: &mut fastrand::Rng, extent: f32) -> [f32; 3] {
    [0; 3].map(|_| between(random, -extent, extent))
}

#[test]
fn noise_is_bounded_varied_and_changes_as_its_slope_says() {
    let mut random = random(1);
    let (mut low, mut high, mut sum) = (1.0_f32, -1.0_f32, 0.0);
    for round in 0..20_000 {
        let (point, octave) = (anywhere(&mut random, 50.0), random.u32(0..8));
        let here = noise(point, octave);
        assert!(here.value.abs() <= 1.000_001, "round {round}: {here:?}");
        (low, high, sum) = (low.min(here.value), high.max(here.value), sum + here.value);
        for axis in 0..3 {
            let step = 1.0 / 256.0;
            let at = |by: f32| {
                let mut moved = point;
                moved[axis] += by;
                (moved[axis] - point[axis], noise(moved, octave).value)
            };
            let ((a, before), (b, after)) = (at(-step), at(step));
            let change = (after - before) / (b - a);
            assert!((change - here.slope[axis]).abs() < 0.01, "round {round}: {change}, {here:?}");
        }
    }
    assert!(low < -0.9 && high > 0.9 && (sum / 20_000.0).abs() < 0.02, "{low} {high} {sum}");
}

#[test]
fn bumps_are_no_higher_than_asked_for() {
    let mut random = random(2);
    for octaves in 1..=8 {
        let displacement = Displacement { height: 0.5, frequency: 3.0, octaves };
        let object = Object::default().displaced(&displacement, 10.0);
        let mut highest = 0.0_f32;
        for _ in 0..20_000 {
            let ([value], _) = bump(&object, &anywhere(&mut random, 10.0).map(|c| [c]));
            highest = highest.max(value.abs());
        }
        assert!(highest <= 0.500_001 && highest > 0.3, "{octaves} octaves: {highest}");
    }
}

/// An object that is turned, stretched and mirrored anyhow, displaced, and seen from anywhere near.
fn placed(random: &mut fastrand::Rng, frame: &mut Frame) -> Object {
    let axis =
        |random: &mut fastrand::Rng| DVec3::from(anywhere(random, 1.0).map(f64::from)).normalize_or(DVec3::Z);
    let turned = DMat3::from_axis_angle(axis(random), f64::from(between(random, 0.0, 6.0)));
    let stretched = turned * DMat3::from_diagonal(DVec3::from(anywhere(random, 2.0).map(f64::from)));
    let eye = axis(random) * f64::from(between(random, 0.0, 6.0));
    let camera =
        Camera::look_at(eye, axis(random) * 0.5, DVec3::new(0.1, 0.2, 1.0), 50.0, 0.05).expect("a view");
    let options = FrameOptions { width: 640, height: 360, ..FrameOptions::default() };
    *frame = camera.frame(&options, Vec3::ONE, &[]);
    let material = Material { colour: Vec3::ONE, specular: 0.0, gloss: 0, opacity: 1.0 };
    let to_world = DAffine3::from_mat3_translation(stretched, axis(random));
    let height = [0.01, 0.2, 1.0][random.usize(0..3)];
    let displacement =
        Displacement { height, frequency: between(random, 0.5, 9.0), octaves: random.u32(1..=5) };
    camera.object(to_world, &material).displaced(&displacement, 4.0)
}

fn patches(random: &mut fastrand::Rng) -> Vec<Patch> {
    if random.bool() { vec![random_patch(random, 0.6)] } else { random_gregory(random, 0.6, 0.4).to_vec() }
}

#[test]
fn no_vertex_moves_farther_than_its_reach() {
    let mut random = random(3);
    let (mut most, mut grids) = (0.0_f32, [Grid::default(), Grid::default()]);
    for round in 0..2000 {
        let (patches, mut frame) = (patches(&mut random), Frame::default());
        let object = placed(&mut random, &mut frame);
        let draw = draw_at(random_surface(&mut random, 8), random_rates(&mut random));
        let smooth = Object { reach: 0.0, ..object };
        dice_any(&frame, &patches, 0, &object, draw, &mut grids[0]);
        dice_any(&frame, &patches, 0, &smooth, draw, &mut grids[1]);
        for at in 0..grids[0].stride * grids[0].rows {
            let [moved, unmoved] = [0, 1].map(|k| Vec3::from(grids[k].point(at)));
            let by = (moved - unmoved).abs().max_element();
            assert!(by <= object.reach, "round {round}: {by} of {}", object.reach);
            most = most.max(by / object.reach);
        }
    }
    assert!(most > 0.5, "{most}");
}

#[test]
fn nothing_visible_is_culled_and_boxes_contain_what_is_drawn() {
    let mut random = random(4);
    let (mut seen, mut grid) = ([0_u32; 5], Box::new(Grid::default()));
    for round in 0..30_000 {
        let (patches, mut frame) = (patches(&mut random), Frame::default());
        let object = placed(&mut random, &mut frame);
        let surface = random_surface(&mut random, 14);
        let verdict = bound_any(&frame, &[object], &patches, surface);
        seen[verdict.code as usize] += 1;
        if verdict.code == SPLIT_U || verdict.code == SPLIT_V {
            continue;
        }
        let draw =
            if verdict.code == CULL { draw_at(surface, [MAX_RATE; 2]) } else { Draw::new(surface, verdict) };
        dice_any(&frame, &patches, 0, &object, draw, &mut grid);
        let (columns, rows) = (verdict.columns, verdict.rows);
        // What must be clipped is not looked at.
        for at in (0..grid.stride * grid.rows).filter(|at| grid.w[*at] > 0.0) {
            // Pixels whose samples the vertex touches, if they are in the image.
            let x = samples_between(&frame, grid.x[at], grid.x[at]);
            let y = samples_between(&frame, grid.y[at], grid.y[at]);
            if x.1 <= 0 || x.0 >= frame.width as i32 || y.1 <= 0 || y.0 >= frame.height as i32 {
                continue;
            }
            assert_ne!(verdict.code, CULL, "round {round}: {x:?}, {y:?}");
            let inside = |(first, end): (i32, i32), range: u32| {
                first >= (range & 0xffff) as i32 && end <= (range >> 16) as i32
            };
            assert!(inside(x, columns) && inside(y, rows), "round {round}: {x:?}, {y:?} {verdict:?}");
        }
    }
    assert!(seen.iter().filter(|count| **count > 1000).count() >= 4, "{seen:?}");
}

#[test]
fn normals_are_those_of_the_displaced_surface() {
    // A gentle patch, gentle bumps, a fine grid: facets tell where the surface faces.
    let mut random = random(5);
    let mut grid = Box::new(Grid::default());
    for round in 0..200 {
        let (patch, mut frame) = (random_patch(&mut random, 0.05), Frame::default());
        let mut object = placed(&mut random, &mut frame);
        object = object.displaced(&Displacement { height: 0.02, frequency: 4.0, octaves: 2 }, 4.0);
        let surface = Surface { shape: 4 | 4 << 5, u: 5 << 20, v: 9 << 20, ..Surface::root(0) };
        let verdict = Verdict::default().with_sides([Default::default(); 4], [MAX_RATE; 2]);
        dice_any(&frame, &[patch], 0, &object, Draw::new(surface, verdict), &mut grid);
        let point = |row: usize, column: usize| Vec3::from(grid.point(row * grid.stride + column)).as_dvec3();
        for (row, column) in [(2, 3), (8, 8), (13, 5)] {
            let along_u = point(row, column + 1) - point(row, column - 1);
            let along_v = point(row + 1, column) - point(row - 1, column);
            let facet = along_u.cross(along_v).normalize();
            let normal = Vec3::from(grid.unit_normal(row * grid.stride + column)).as_dvec3();
            let angle = facet.angle_between(normal).to_degrees();
            assert!(angle < 4.0, "round {round}: {angle} degrees");
        }
    }
}

#[test]
fn what_kernels_cannot_displace_is_refused() {
    let sound = Displacement { height: 0.1, frequency: 2.0, octaves: 3 };
    assert_eq!(sound.check(10.0), Ok(()));
    for (wrong, unfit) in [
        (Displacement { height: 0.0, ..sound }, Unfit::Number),
        (Displacement { height: f32::NAN, ..sound }, Unfit::Number),
        (Displacement { frequency: -1.0, ..sound }, Unfit::Number),
        (Displacement { octaves: 0, ..sound }, Unfit::Number),
        (Displacement { octaves: 9, ..sound }, Unfit::Number),
        (Displacement { height: 1.0e6, frequency: 100.0, octaves: 1 }, Unfit::Steep),
        (Displacement { frequency: 1.0e5, ..sound }, Unfit::Fine),
    ] {
        assert_eq!(wrong.check(10.0), Err(unfit), "{wrong:?}");
    }
}
