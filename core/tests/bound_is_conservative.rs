//! `bound` never culls what can be seen, and its pixel boxes contain what is drawn.

mod common;

use common::{exact_point, random, random_patch, random_surface, random_view};
use micropoly_core::abi::{CULL, DRAW, DRAW_LIMITED, Draw, Frame, SPLIT_U, SPLIT_V, Surface, Verdict};
use micropoly_core::kernel::bound::bound;
use micropoly_core::kernel::dice::{Grid, dice};
use micropoly_core::kernel::triangle::samples_between;
use micropoly_core::patch::Net;
use micropoly_core::patch::bezier::param;

/// Pixel coordinates of a point before the near plane.
fn pixel(frame: &Frame, [x, y, z]: [f64; 3]) -> Option<(f64, f64)> {
    let scale = f64::from(frame.focal) / -z;
    let visible = -z >= f64::from(frame.near);
    visible.then_some((f64::from(frame.centre_x) + x * scale, f64::from(frame.centre_y) - y * scale))
}

fn inside(frame: &Frame, (x, y): (f64, f64)) -> bool {
    x >= 0.0 && y >= 0.0 && x <= f64::from(frame.width) && y <= f64::from(frame.height)
}

/// Exact points all over a surface.
fn points(net: &Net, surface: Surface) -> impl Iterator<Item = [f64; 3]> {
    let at = |start: u32, size: u32, k: u32| {
        f64::from(param(start)) + f64::from(param(size)) * f64::from(k) / 16.0
    };
    (0..17 * 17).map(move |k| {
        exact_point(net, at(surface.u, surface.u_size(), k % 17), at(surface.v, surface.v_size(), k / 17))
    })
}

#[test]
fn nothing_visible_is_culled_and_boxes_contain_what_is_drawn() {
    let mut random = random(10);
    let mut seen = [0_u32; 5];
    for round in 0..60_000 {
        let (frame, object) = random_view(&mut random, 0.05);
        let patch = random_patch(&mut random, 0.6);
        let surface = random_surface(&mut random, 16);
        let net = Net::in_eye_space(&patch, &object);
        let verdict = bound(&frame, &patch, &object, surface);
        seen[verdict.code as usize] += 1;
        for point in points(&net, surface) {
            let Some((x, y)) = pixel(&frame, point) else { continue };
            if verdict.code == CULL {
                assert!(!inside(&frame, (x, y)), "round {round}: ({x}, {y}) was culled");
            } else if inside(&frame, (x, y)) {
                let (left, right) = (verdict.columns & 0xffff, verdict.columns >> 16);
                let (top, bottom) = (verdict.rows & 0xffff, verdict.rows >> 16);
                assert!(x >= f64::from(left) && x <= f64::from(right), "round {round}: x = {x}");
                assert!(y >= f64::from(top) && y <= f64::from(bottom), "round {round}: y = {y}");
            }
        }
    }
    assert!(seen[CULL as usize] > 1000 && seen[DRAW as usize] > 1000, "{seen:?}");
    assert!(seen[SPLIT_U as usize] > 1000 && seen[SPLIT_V as usize] > 1000, "{seen:?}");
}

#[test]
fn drawn_surfaces_are_within_the_bound_and_their_vertices_within_the_box() {
    let mut random = random(11);
    let (mut drawn, mut cut) = (0, 0);
    for round in 0..20_000 {
        let (frame, object) = random_view(&mut random, 0.05);
        let patch = random_patch(&mut random, 0.6);
        let surface = random_surface(&mut random, 16);
        let verdict = bound(&frame, &patch, &object, surface);
        if verdict.code != DRAW {
            continue;
        }
        drawn += 1;
        let mut grid = Grid::default();
        dice(&Net::in_eye_space(&patch, &object), &frame, Draw::new(surface, verdict), &mut grid);
        if grid.w[..grid.stride * grid.rows].contains(&0.0) {
            cut += 1;
            continue;
        }
        for at in 0..grid.stride * grid.rows {
            let (first, end) = (samples_between(&frame, grid.y[at], grid.y[at]), verdict.rows);
            let (top, bottom) = ((end & 0xffff) as i32, (end >> 16) as i32);
            let outside = first.1 <= 0 || first.0 >= frame.height as i32;
            assert!(outside || (first.0 >= top && first.1 <= bottom), "round {round}: row {first:?}");
        }
        if surface.borders != [0; 4] {
            continue; // divided anyhow, it may reach farther
        }
        let along = |from: usize, step: usize, count: usize| -> f64 {
            (0..count - 1)
                .map(|k| {
                    let (a, b) = (from + k * step, from + (k + 1) * step);
                    let (dx, dy) = (grid.x[b] - grid.x[a], grid.y[b] - grid.y[a]);
                    f64::from(dx).hypot(f64::from(dy)) / 256.0
                })
                .sum()
        };
        let rows = (0..grid.rows).map(|row| along(row * grid.stride, 1, grid.stride));
        let columns = (0..grid.stride).map(|column| along(column, grid.stride, grid.rows));
        let longest = rows.chain(columns).fold(0.0, f64::max);
        assert!(longest <= f64::from(frame.bound) + 0.5, "round {round}: {longest} pixels");
    }
    assert!(drawn > 1000 && cut * 10 < drawn, "{drawn}, {cut}");
}

#[test]
fn at_the_deepest_level_surfaces_are_drawn_and_said_to_be_limited() {
    let mut random = random(12);
    for _ in 0..5_000 {
        let (mut frame, object) = random_view(&mut random, 0.05);
        let patch = random_patch(&mut random, 0.6);
        let surface = random_surface(&mut random, 8);
        let Verdict { code: free, .. } = bound(&frame, &patch, &object, surface);
        frame.levels = surface.level() + 1;
        let Verdict { code: limited, .. } = bound(&frame, &patch, &object, surface);
        let expected = if free == SPLIT_U || free == SPLIT_V { DRAW_LIMITED } else { free };
        assert_eq!(limited, expected);
    }
}

#[test]
fn a_plane_through_the_eye_takes_few_surfaces() {
    let camera = micropoly_core::camera::Camera::look_at(
        glam::DVec3::new(0.0, 0.0, 0.1),
        glam::DVec3::new(1.0, 0.0, 0.1),
        glam::DVec3::Z,
        50.0,
        0.01,
    )
    .expect("a view");
    let (frame, object) = common::view(&camera, 640, 360);
    let flat = random_patch(&mut random(13), 0.0);
    let (mut stack, mut processed) = (vec![Surface::root(0)], 0);
    while let Some(surface) = stack.pop() {
        processed += 1;
        let verdict = bound(&frame, &flat, &object, surface);
        assert_ne!(verdict.code, DRAW_LIMITED);
        if verdict.code == SPLIT_U || verdict.code == SPLIT_V {
            stack.extend(surface.halves(verdict));
        }
    }
    assert!(processed < 10_000, "{processed}");
}
