//! Gregory patches: borders of a Bézier patch, derivatives, and a bound that is conservative.

mod common;

use common::{random, random_gregory, random_surface, random_view};
use micropoly_core::abi::{CULL, DRAW, FLAG_WEBER, Frame, Object, PARAM_ONE, Patch, Surface, Verdict};
use micropoly_core::kernel::bound::bound_any;
use micropoly_core::kernel::dice::{Grid, dice, position_at};
use micropoly_core::kernel::dice_gregory::{Vertex, dice_gregory, evaluate_gregory};
use micropoly_core::kernel::project::project;
use micropoly_core::kernel::seam::Seam;
use micropoly_core::kernel::seam_gregory::seams_gregory;
use micropoly_core::kernel::triangle::pixels_between;
use micropoly_core::patch::gregory::patch_count;
use micropoly_core::patch::{Faces, Net};

/// Makes the line v = 1/2 seem short from end to end, though its middle is far away: the control points of the
/// net that follows the blends along it, whose shares are 7/9, all move to the first one.
fn shrink_middle([patch, record]: &mut [Patch; 2]) {
    for (c, faces) in [(&mut patch.x, record.x), (&mut patch.y, record.y), (&mut patch.z, record.z)] {
        let at_middle = |p: [f32; 4]| (p[0] + 3.0 * p[1] + 3.0 * p[2] + p[3]) / 8.0;
        let inner = |m: usize| faces[4 + m] + 7.0 / 9.0 * (faces[m] - faces[4 + m]);
        let goal = at_middle([c[0], c[1], c[2], c[3]]);
        for (i, inner) in [(1, [inner(0), inner(1)]), (2, [inner(2), inner(3)]), (3, [c[13], c[14]])] {
            let (low, high) = (4 * i, 4 * i + 3);
            let missing = goal - at_middle([c[low], inner[0], inner[1], c[high]]);
            (c[low], c[high]) = (c[low] + 4.0 * missing, c[high] + 4.0 * missing);
        }
    }
}

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

    /// With more and longer seams, large micropolygons, a large bound, face points far apart; and a surface.
    fn with_seams(random: &mut fastrand::Rng) -> (Self, Surface) {
        let mut case = Self::new(random, false);
        case.frame.rate = 1 << random.u32(0..=3);
        case.frame.bound = [8.0, 40.0, 200.0][random.usize(0..3)];
        let apart = [0.1, 1.0, 4.0][random.usize(0..3)];
        case.patches = random_gregory(random, 0.6, apart);
        let mut surface = random_surface(random, 16);
        if random.u8(0..4) == 0 {
            case.frame.rate = 1;
            shrink_middle(&mut case.patches);
            let half = PARAM_ONE / 2;
            let along = half >> random.u32(1..4);
            surface = surface_at(1, (half - along, along), (half - along, along));
        }
        case.net = Net::in_eye_space(&case.patches[0], &case.object);
        case.faces = Faces::in_eye_space(&case.patches[1], &case.object);
        (case, surface)
    }

    fn seams(&self, surface: Surface) -> [Seam; 4] {
        seams_gregory(&self.net, &self.faces, &self.frame, surface)
    }

    fn grid(&self, surface: Surface) -> Grid {
        let mut grid = Grid::default();
        dice_gregory(&self.net, &self.faces, &self.frame, surface, &mut grid);
        grid
    }
}

#[test]
fn borders_are_those_of_the_bezier_patch_bit_by_bit() {
    let mut random = random(60);
    for round in 0..500 {
        let case = Case::new(&mut random, round % 2 == 0);
        let t = random.u32(0..=PARAM_ONE);
        for (u, v) in [(0, t), (PARAM_ONE, t), (t, 0), (t, PARAM_ONE)] {
            assert_eq!(case.at(u, v).point, position_at(&case.net, u, v), "round {round}: ({u}, {v})");
        }
        let (grid, mut plain) = (case.grid(Surface::root(0)), Grid::default());
        dice(&case.net, &case.frame, Surface::root(0), &mut plain);
        let last = grid.stride - 1;
        for k in 0..=last {
            for at in [k, last * grid.stride + k, k * grid.stride, k * grid.stride + last] {
                let (a, b) = ((grid.x[at], grid.y[at], grid.w[at]), (plain.x[at], plain.y[at], plain.w[at]));
                assert_eq!(a, b, "round {round}: vertex {at}");
            }
        }
        assert_eq!(grid.seams, plain.seams);
    }
}

#[test]
fn grids_hold_the_points_that_are_evaluated_alone() {
    let mut random = random(61);
    for round in 0..300 {
        let mut case = Case::new(&mut random, round % 2 == 0);
        case.frame.rate = 1 << random.u32(0..=4);
        let surface = random_surface(&mut random, 12);
        let grid = case.grid(surface);
        for at in 0..grid.stride * grid.stride {
            let (row, column) = ((at / grid.stride) as u32, (at % grid.stride) as u32);
            let u = surface.u + column * (surface.u_size() / case.frame.rate);
            let v = surface.v + row * (surface.v_size() / case.frame.rate);
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
        let surface = random_surface(&mut random, 16);
        let verdict = case.bound(surface);
        seen[verdict.code as usize] += u32::from(!weber);
        if weber && verdict.code != DRAW {
            continue;
        }
        let (left, right) = ((verdict.columns & 0xffff) as i32, (verdict.columns >> 16) as i32);
        let (top, bottom) = ((verdict.rows & 0xffff) as i32, (verdict.rows >> 16) as i32);
        let grid = case.grid(surface);
        for at in (0..grid.stride * grid.stride).filter(|&at| grid.w[at] > 0.0) {
            let (x, y) = (pixels_between(grid.x[at], grid.x[at]), pixels_between(grid.y[at], grid.y[at]));
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
        if case.bound(surface).code != DRAW {
            continue;
        }
        drawn += 1;
        let grid = case.grid(surface);
        let along = |from: usize, step: usize| -> f64 {
            (0..grid.stride - 1)
                .map(|k| {
                    let (a, b) = (from + k * step, from + (k + 1) * step);
                    f64::from(grid.x[b] - grid.x[a]).hypot(f64::from(grid.y[b] - grid.y[a])) / 256.0
                })
                .sum()
        };
        for k in 0..grid.stride {
            longest = longest.max(along(k * grid.stride, 1)).max(along(k, grid.stride));
        }
    }
    assert!(drawn > 1000, "{drawn}");
    assert!(longest <= 8.1, "{longest} pixels");
}

/// A surface's borders of constant v, with u and v exchanged those of constant u: which of all four it is, where
/// along it starts, where across it lies, and how long it is.
fn borders(surface: Surface) -> [(usize, u32, u32, u32); 4] {
    let Surface { u, v, .. } = surface;
    let (size_u, size_v) = (surface.u_size(), surface.v_size());
    [(0, u, v, size_u), (1, u, v + size_v, size_u), (2, v, u, size_v), (3, v, u + size_u, size_v)]
}

/// The surface with this range along a border and this one across it.
fn surface_at(border: usize, along: (u32, u32), across: (u32, u32)) -> Surface {
    let (u, v) = if border < 2 { (along, across) } else { (across, along) };
    let mut surface = Surface::root(0);
    while surface.u_size() > u.1 {
        surface = halves_with(surface.halves_u(), |half| u.0 < half.u + half.u_size());
    }
    while surface.v_size() > v.1 {
        surface = halves_with(surface.halves_v(), |half| v.0 < half.v + half.v_size());
    }
    assert_eq!((surface.u, surface.v, surface.u_size(), surface.v_size()), (u.0, v.0, u.1, v.1));
    surface
}

fn halves_with([low, high]: [Surface; 2], is_in: impl Fn(Surface) -> bool) -> Surface {
    if is_in(low) { low } else { high }
}

/// Some surface on either side of a line that lies across at `place`, with this range along it.
fn neighbour(random: &mut fastrand::Rng, border: usize, along: (u32, u32), place: u32) -> Surface {
    let widest = (place & place.wrapping_neg()).min(PARAM_ONE / 2);
    let size = widest >> random.u32(0..=12).min(widest.trailing_zeros().saturating_sub(4));
    let start = if random.bool() { place } else { place - size };
    surface_at(border, along, (start, size))
}

#[test]
fn seams_inside_reach_the_chords_of_every_neighbour_that_is_drawn() {
    let mut random = random(66);
    let (mut drawn, mut jumps) = (0, 0);
    for round in 0..6_000 {
        let (case, surface) = Case::with_seams(&mut random);
        let seams = case.seams(surface);
        for (border, start, place, size) in borders(surface) {
            if place == 0 || place == PARAM_ONE {
                continue;
            }
            let mut was_drawn = true;
            for ancestor in (1..).map(|k| size << k).take_while(|&ancestor| ancestor <= PARAM_ONE) {
                let along = (start & !(ancestor - 1), ancestor);
                let beside = neighbour(&mut random, border, along, place);
                let is_drawn = case.bound(beside).code == DRAW;
                drawn += u32::from(is_drawn);
                jumps += u32::from(is_drawn && !was_drawn);
                was_drawn = is_drawn;
                let longest = seams[border].longest;
                assert!(!is_drawn || ancestor / size <= longest, "round {round}: {beside:?}, {longest}");
            }
        }
    }
    assert!(drawn > 2000 && jumps > 20, "{drawn}, {jumps}");
}

#[test]
fn both_sides_of_a_line_inside_find_the_same_seams() {
    let mut random = random(67);
    let (mut seams, mut chords) = (0, 0);
    for round in 0..6_000 {
        let (case, surface) = Case::with_seams(&mut random);
        for (border, start, place, size) in borders(surface) {
            if place == 0 || place == PARAM_ONE {
                continue;
            }
            let own = case.seams(surface)[border];
            let beside = neighbour(&mut random, border, (start, size), place);
            let same =
                borders(beside).into_iter().find(|&(k, _, there, _)| k / 2 == border / 2 && there == place);
            let (theirs, ..) = same.expect("a common line");
            assert_eq!(own, case.seams(beside)[theirs], "round {round}: {surface:?}, {beside:?}");
            seams += u32::from(own.longest > 1);
            if let Some(chord) = own.chord {
                chords += 1;
                let end = start + size;
                let half = end & end.wrapping_neg();
                let ends = [end - half, end + half].map(|t| if border < 2 { (t, place) } else { (place, t) });
                assert_eq!(chord, ends.map(|(u, v)| case.at(u, v).point), "round {round}");
            }
        }
    }
    assert!(seams > 1000 && chords > 200, "{seams}, {chords}");
}

#[test]
fn boxes_contain_the_chords_beyond_borders() {
    let mut random = random(68);
    let mut checked = 0;
    for round in 0..40_000 {
        let (case, surface) = Case::with_seams(&mut random);
        let verdict = case.bound(surface);
        if verdict.code == CULL {
            continue;
        }
        let (left, right) = ((verdict.columns & 0xffff) as i32, (verdict.columns >> 16) as i32);
        let (top, bottom) = ((verdict.rows & 0xffff) as i32, (verdict.rows >> 16) as i32);
        for (seam, (border, start, place, size)) in case.seams(surface).into_iter().zip(borders(surface)) {
            let (u, v) = if border < 2 { (start + size, place) } else { (place, start + size) };
            let middle = project(&case.frame, case.at(u, v).point);
            let ends = seam.chord.map(|chord| chord.map(|end| project(&case.frame, end)));
            let Some(ends) = ends.filter(|ends| middle.w > 0.0 && ends.iter().all(|end| end.w > 0.0)) else {
                continue; // not drawn
            };
            for end in ends {
                checked += 1;
                let (x, y) = (pixels_between(end.x, end.x), pixels_between(end.y, end.y));
                let (width, height) = (case.frame.width as i32, case.frame.height as i32);
                let columns = x.1 <= 0 || x.0 >= width || (x.0 >= left && x.1 <= right);
                let rows = y.1 <= 0 || y.0 >= height || (y.0 >= top && y.1 <= bottom);
                assert!(columns && rows, "round {round}: an end at {x:?}, {y:?}");
            }
        }
    }
    assert!(checked > 500, "{checked}");
}
