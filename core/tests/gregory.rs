//! Gregory patches: borders of a Bézier patch, derivatives, and a bound that is conservative.

mod common;

use common::{draw_at, random, random_gregory, random_rates, random_surface, random_view};
use micropoly_core::abi::{CULL, DRAW, Draw, FLAG_WEBER, Frame, Object, PARAM_ONE, Patch, Surface, Verdict};
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::dice::Vertex;
use micropoly_core::kernel::dice::{Grid, dice, position_at};
use micropoly_core::kernel::dice_gregory::{dice_gregory, evaluate_gregory};
use micropoly_core::kernel::triangle::samples_between;
use micropoly_core::patch::gregory::patch_count;
use micropoly_core::patch::{Faces, Net};

struct Case {
    frame: Frame,
    object: Object,
    patches: [Patch; 2],
    net: Net,
    faces: Faces,
}

impl Case {
    fn new(random: &mut fastrand::Rng, weber: bool) -> Self {
        let (mut frame, object) = random_view(random, 0.05);
        frame.flags = if weber { FLAG_WEBER } else { 0 };
        let apart = [0.0, 0.05, 0.6][random.usize(0..3)];
        let patches = random_gregory(random, 0.6, apart);
        let net = Net::in_eye_space(&patches[0], &object);
        let faces = Faces::in_eye_space(&patches[1], &object);
        Self { frame, object, patches, net, faces }
    }

    fn at(&self, u: u32, v: u32) -> Vertex {
        evaluate_gregory(&self.net, &self.faces, &self.frame, u, v)
    }

    fn bound(&self, surface: Surface) -> Verdict {
        bound_any(&self.frame, &[self.object], &self.patches, surface)
    }

    fn grid(&self, draw: Draw) -> Grid {
        let mut grid = Grid::default();
        dice_gregory(&self.net, &self.faces, &self.frame, draw, &mut grid);
        grid
    }
}

#[test]
fn borders_are_those_of_the_bezier_patch_bit_by_bit() {
    let mut random = random(60);
    for round in 0..500 {
        let case = Case::new(&mut random, round % 2 == 0);
        let root = draw_at(Surface::root(0), [8, 8]);
        let t = random.u32(0..=PARAM_ONE);
        for (u, v) in [(0, t), (PARAM_ONE, t), (t, 0), (t, PARAM_ONE)] {
            assert_eq!(case.at(u, v).point, position_at(&case.net, u, v), "round {round}: ({u}, {v})");
        }
        let (grid, mut plain) = (case.grid(root), Grid::default());
        dice(&case.net, &case.frame, root, &mut plain);
        let last = grid.stride - 1;
        for k in 0..=last {
            for at in [k, last * grid.stride + k, k * grid.stride, k * grid.stride + last] {
                let (a, b) = ((grid.x[at], grid.y[at], grid.w[at]), (plain.x[at], plain.y[at], plain.w[at]));
                assert_eq!(a, b, "round {round}: vertex {at}");
            }
        }
    }
}

#[test]
fn grids_hold_the_points_that_are_evaluated_alone() {
    let mut random = random(61);
    for round in 0..300 {
        let case = Case::new(&mut random, round % 2 == 0);
        let draw = draw_at(random_surface(&mut random, 12), random_rates(&mut random));
        let grid = case.grid(draw);
        for at in 0..grid.stride * grid.rows {
            let [u, v] = draw.vertex((at / grid.stride) as u32, (at % grid.stride) as u32);
            assert_eq!(grid.point(at), case.at(u, v).point, "round {round}, vertex {at}");
        }
    }
}

#[test]
fn equal_face_points_make_a_bezier_patch() {
    let mut random = random(62);
    let (frame, object) = random_view(&mut random, 0.05);
    let [patch, record] = random_gregory(&mut random, 0.6, 0.0);
    let (net, faces) = (Net::in_eye_space(&patch, &object), Faces::in_eye_space(&record, &object));
    for _ in 0..500 {
        let (u, v) = (random.u32(0..=PARAM_ONE), random.u32(0..=PARAM_ONE));
        let point = evaluate_gregory(&net, &faces, &frame, u, v).point;
        for (a, b) in point.into_iter().zip(position_at(&net, u, v)) {
            assert!((a - b).abs() < 4.0e-6, "{a} is not {b}");
        }
    }
    assert_eq!(patch_count(&[patch, record]), 1);
}

#[test]
fn derivatives_are_those_of_the_surface() {
    let mut random = random(63);
    for round in 0..2000 {
        let case = Case::new(&mut random, round % 2 == 0);
        let step = 1 << 14;
        let (u, v) = (random.u32(step..PARAM_ONE - step), random.u32(step..PARAM_ONE - step));
        if u.min(v).min(PARAM_ONE - u).min(PARAM_ONE - v) < PARAM_ONE / 16 {
            continue; // differences are too coarse beside the corners
        }
        let Vertex { du, dv, .. } = case.at(u, v);
        let slope = |low: [f32; 3], high: [f32; 3], k: usize| {
            (high[k] - low[k]) * (1 << 24) as f32 / (2 * step) as f32
        };
        for k in 0..3 {
            let along_u = slope(case.at(u - step, v).point, case.at(u + step, v).point, k);
            let along_v = slope(case.at(u, v - step).point, case.at(u, v + step).point, k);
            assert!((along_u - du[k]).abs() < 0.01 && (along_v - dv[k]).abs() < 0.01, "round {round}");
        }
    }
}

#[test]
fn nothing_visible_is_culled_and_boxes_contain_what_is_drawn() {
    let mut random = random(64);
    let mut seen = [0_u32; 5];
    for round in 0..20_000 {
        // Weber's rules cull what can be seen, but their boxes must be right too.
        let weber = round % 4 == 0;
        let case = Case::new(&mut random, weber);
        let mut surface = random_surface(&mut random, 16);
        if weber {
            surface.borders = [0; 4]; // his rules know nothing of them
        }
        let verdict = case.bound(surface);
        seen[verdict.code as usize] += u32::from(!weber);
        if weber && verdict.code != DRAW {
            continue;
        }
        let (left, right) = ((verdict.columns & 0xffff) as i32, (verdict.columns >> 16) as i32);
        let (top, bottom) = ((verdict.rows & 0xffff) as i32, (verdict.rows >> 16) as i32);
        let grid = case.grid(draw_at(surface.divided(verdict), [8, 8]));
        for at in (0..grid.stride * grid.rows).filter(|&at| grid.w[at] > 0.0) {
            let (x, y) = (
                samples_between(&case.frame, grid.x[at], grid.x[at]),
                samples_between(&case.frame, grid.y[at], grid.y[at]),
            );
            let outside =
                x.1 <= 0 || y.1 <= 0 || x.0 >= case.frame.width as i32 || y.0 >= case.frame.height as i32;
            assert!(outside || verdict.code != CULL, "round {round}: a vertex at {x:?}, {y:?} was culled");
            let inside = x.0 >= left && x.1 <= right && y.0 >= top && y.1 <= bottom;
            assert!(outside || inside, "round {round}: a vertex at {x:?}, {y:?}");
        }
    }
    assert!(seen.iter().take(4).all(|&count| count > 500), "{seen:?}");
}

#[test]
fn drawn_surfaces_are_within_the_bound() {
    let mut random = random(65);
    let (mut drawn, mut longest) = (0, 0.0_f64);
    for _ in 0..40_000 {
        let case = Case::new(&mut random, false);
        let surface = random_surface(&mut random, 16);
        let verdict = case.bound(surface);
        let grid = case.grid(draw_at(surface.divided(verdict), [8, 8]));
        let is_cut = grid.w[..grid.stride * grid.rows].contains(&0.0);
        if verdict.code != DRAW || is_cut || surface.borders != [0; 4] {
            continue;
        }
        drawn += 1;
        let along = |from: usize, step: usize, count: usize| -> f64 {
            (0..count - 1)
                .map(|k| {
                    let (a, b) = (from + k * step, from + (k + 1) * step);
                    f64::from(grid.x[b] - grid.x[a]).hypot(f64::from(grid.y[b] - grid.y[a])) / 256.0
                })
                .sum()
        };
        let rows = (0..grid.rows).map(|row| along(row * grid.stride, 1, grid.stride));
        let columns = (0..grid.stride).map(|column| along(column, grid.stride, grid.rows));
        longest = rows.chain(columns).fold(longest, f64::max);
    }
    assert!(drawn > 1000, "{drawn}");
    assert!(longest <= 16.5, "{longest} pixels");
}
