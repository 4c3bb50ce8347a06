//! Bézier evaluation: ends, symmetry, restriction to a sub-range, and dicing against f64.

mod common;

use common::{draw_at, exact_point, random, random_patch, random_rates, random_surface, random_view};
use micropoly_core::abi::{PARAM_ONE, Surface};
use micropoly_core::kernel::dice::{Grid, dice, position_at};
use micropoly_core::patch::Net;
use micropoly_core::patch::bezier::{blend4, blossom, cubic, param};

#[test]
fn weights_are_exact_at_the_ends_and_mirror_each_other() {
    assert_eq!(cubic(0.0), [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(cubic(1.0), [0.0, 0.0, 0.0, 1.0]);
    let mut random = random(2);
    for _ in 0..10_000 {
        let t = random.u32(0..=PARAM_ONE);
        let (there, back) = (cubic(param(t)), cubic(param(PARAM_ONE - t)));
        let reversed = [back[3], back[2], back[1], back[0]];
        assert_eq!(there, reversed, "t = {t}");
        let c = [0; 4].map(|_| random.f32());
        let backwards = [c[3], c[2], c[1], c[0]];
        assert_eq!(blend4(there, c).to_bits(), blend4(back, backwards).to_bits(), "t = {t}");
    }
}

#[test]
fn blossoms_are_convex_and_give_the_same_curve() {
    let mut random = random(3);
    for _ in 0..10_000 {
        let size = PARAM_ONE >> random.u32(0..=20);
        let start = random.u32(0..PARAM_ONE / size) * size;
        let rows = blossom(start, start + size);
        let c = [0; 4].map(|_| f64::from(random.f32()));
        let part = rows.map(|row| (0..4).map(|k| f64::from(row[k]) * c[k]).sum::<f64>());
        for (row, sum) in rows.iter().map(|row| (row, row.iter().sum::<f32>())) {
            assert!(row.iter().all(|&w| w >= 0.0) && (sum - 1.0).abs() < 1.0e-6, "{row:?}");
        }
        let s = f64::from(random.f32());
        let t = (f64::from(start) + s * f64::from(size)) / f64::from(PARAM_ONE);
        let bernstein = |t: f64| {
            let r = 1.0 - t;
            [r * r * r, 3.0 * r * r * t, 3.0 * r * t * t, t * t * t]
        };
        let at = |c: [f64; 4], t: f64| (0..4).map(|k| bernstein(t)[k] * c[k]).sum::<f64>();
        assert!((at(c, t) - at(part, s)).abs() < 2.0e-6);
    }
}

#[test]
fn diced_vertices_lie_on_the_surface_and_do_not_depend_on_the_surface_diced() {
    let mut random = random(4);
    for round in 0..300 {
        let (frame, object) = random_view(&mut random, 0.1);
        let net = Net::in_eye_space(&random_patch(&mut random, 0.7), &object);
        let surface = random_surface(&mut random, 12);
        let mut grid = Grid::default();
        let draw = draw_at(surface, random_rates(&mut random));
        dice(&net, &frame, draw, &mut grid);
        for at in 0..grid.stride * grid.rows {
            let [u, v] = draw.vertex((at / grid.stride) as u32, (at % grid.stride) as u32);
            assert_eq!(grid.point(at), position_at(&net, u, v), "round {round}, vertex {at}");
            let exact = exact_point(&net, f64::from(param(u)), f64::from(param(v)));
            for k in 0..3 {
                assert!((exact[k] - f64::from(grid.point(at)[k])).abs() < 4.0e-6, "round {round}");
            }
            let normal = grid.unit_normal(at);
            let length = normal.iter().map(|n| n * n).sum::<f32>();
            assert!((length - 1.0).abs() < 1.0e-5, "round {round}: normal {normal:?}");
        }
    }
}

#[test]
fn patches_that_share_an_edge_share_its_vertices_whichever_way_it_runs() {
    let mut random = random(5);
    for _ in 0..200 {
        let (_, object) = random_view(&mut random, 0.1);
        let mut a = Net::in_eye_space(&random_patch(&mut random, 0.7), &object);
        let b = Net::in_eye_space(&random_patch(&mut random, 0.7), &object);
        // The edge u = 1 of `a` becomes the edge v = 0 of `b`, backwards.
        for k in 0..4 {
            a.x[12 + k] = b.x[4 * (3 - k)];
            a.y[12 + k] = b.y[4 * (3 - k)];
            a.z[12 + k] = b.z[4 * (3 - k)];
        }
        let t = random.u32(0..=PARAM_ONE);
        assert_eq!(position_at(&a, PARAM_ONE, t), position_at(&b, PARAM_ONE - t, 0));
    }
}

#[test]
fn normals_do_not_vanish_where_an_edge_is_collapsed() {
    let mut random = random(6);
    let (frame, object) = random_view(&mut random, 0.1);
    let patch = random_patch(&mut random, 0.1);
    for edge in 0..4 {
        let mut collapsed = patch;
        for k in 0..4 {
            let index = [k, 12 + k, 4 * k, 4 * k + 3][edge];
            let middle = [1, 13, 4, 7][edge];
            (collapsed.x[index], collapsed.y[index]) = (patch.x[middle], patch.y[middle]);
            collapsed.z[index] = patch.z[middle];
        }
        let net = Net::in_eye_space(&collapsed, &object);
        let mut grid = Grid::default();
        dice(&net, &frame, draw_at(Surface::root(0), [8, 8]), &mut grid);
        let (stride, last) = (grid.stride, grid.stride - 1);
        for k in 0..stride {
            // The vertex on the collapsed edge, and the next one inwards.
            let (at, inner) = [
                (k * stride, k * stride + 1),
                (k * stride + last, k * stride + last - 1),
                (k, k + stride),
                (last * stride + k, (last - 1) * stride + k),
            ][edge];
            let (normal, neighbour) = (grid.unit_normal(at), grid.unit_normal(inner));
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            assert!((dot(normal, normal) - 1.0).abs() < 1.0e-5, "edge {edge}, vertex {k}: {normal:?}");
            let cosine = dot(normal, neighbour).abs();
            assert!(cosine > 0.95, "edge {edge}, vertex {k}: {normal:?} beside {neighbour:?}");
        }
    }
}

#[test]
fn zero_area_patches_still_have_unit_normals() {
    let mut random = random(7);
    let (frame, object) = random_view(&mut random, 0.1);
    let mut line = random_patch(&mut random, 0.0);
    line.y = [0.5; 16];
    line.z = [0.5; 16];
    for patch in [line, micropoly_core::abi::Patch::default()] {
        let mut grid = Grid::default();
        dice(&Net::in_eye_space(&patch, &object), &frame, draw_at(Surface::root(0), [8, 8]), &mut grid);
        for at in 0..grid.stride * grid.rows {
            let length = grid.unit_normal(at).map(|n| n * n).iter().sum::<f32>();
            assert!((length - 1.0).abs() < 1.0e-5);
        }
    }
}
