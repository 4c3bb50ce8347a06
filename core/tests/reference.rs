//! Samples against an independent reference: every triangle at every sample, in integers and exact rationals, on soups of
//! grids with shared edges, slivers, triangles smaller than the space between samples, huge ones, folded ones and ties.

mod common;

use micropoly_core::abi::{Colour, Draw, FLAG_SMOOTH, Frame, MAX_RATE, Sample, Surface, Verdict};
use micropoly_core::kernel::dense::Pattern;
use micropoly_core::kernel::dice::Grid;
use micropoly_core::kernel::sample::{Band, sample};
use micropoly_core::pattern::{Region, Samples, Window, tuples};

const WIDTH: u32 = 13;
const HEIGHT: u32 = 9;

/// One triangle of a micropolygon: snapped corners, their 1 / distance and colour, and whose it is.
struct Triangle {
    corners: [(i128, i128); 3],
    w: [f64; 3],
    colours: [f64; 3],
    mean: f64,
    id: (u32, u32, u32),
}

/// Where a sample is, in snapped units, from the definition of the pattern: sample (i, j) of k × k in a pixel lies in column
/// i·k + (k - 1 - j) and row j·k + i of a grid of k² × k², in the middle of its field.
fn place(k: i32, pixel: (i32, i32), (i, j): (i32, i32)) -> (i128, i128) {
    let step = 256 / (k * k);
    let along = |pixel: i32, field: i32| i128::from(pixel * 256 + field * step + step / 2);
    (along(pixel.0, i * k + k - 1 - j), along(pixel.1, j * k + i))
}

/// Is a point inside a triangle, or on an edge of it that owns its points: a top or a left one?
fn owns(corners: [(i128, i128); 3], p: (i128, i128)) -> bool {
    let area = |a: (i128, i128), b: (i128, i128), c: (i128, i128)| {
        (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
    };
    let [a, b, c] = corners;
    let whole = area(a, b, c);
    let corners = if whole < 0 { [a, c, b] } else { [a, b, c] };
    whole != 0
        && (0..3).all(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let side = area(from, to, p);
            side > 0 || (side == 0 && (to.1 < from.1 || (to.1 == from.1 && to.0 > from.0)))
        })
}

/// An affine value of the corners at a point, by exact weights.
fn at(corners: [(i128, i128); 3], values: [f64; 3], p: (i128, i128)) -> f64 {
    let area = |a: (i128, i128), b: (i128, i128), c: (i128, i128)| {
        (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
    };
    let [a, b, c] = corners;
    let weights = [area(p, b, c), area(a, p, c), area(a, b, p)].map(|part| part as f64);
    (0..3).map(|k| weights[k] * values[k]).sum::<f64>() / area(a, b, c) as f64
}

/// A grid of some kind, whose vertices are shared by neighbouring micropolygons.
fn grid(random: &mut fastrand::Rng, kind: usize) -> Grid {
    let rates = [random.usize(1..=5), random.usize(1..=5)];
    let mut grid = Grid::default();
    (grid.stride, grid.rows) = (rates[0] + 1, rates[1] + 1);
    let cell = [random.i32(1..40), random.i32(100..400), random.i32(1000..6000), 90_000][kind % 4];
    let (wide, high) = if random.u8(0..4) == 0 { (cell, random.i32(0..3)) } else { (cell, cell) };
    let (left, top) = (random.i32(-300..3500), random.i32(-300..2500));
    // Constant depths tie; the others do not but by chance.
    let flat = random.bool();
    let w = [0.25, 0.5][random.usize(0..2)];
    let lattice = [0, 7, 15, 127][random.usize(0..4)];
    for at in 0..grid.stride * grid.rows {
        let (row, column) = ((at / grid.stride) as i32, (at % grid.stride) as i32);
        let mut jitter = |cell: i32| random.i32(-cell..=cell) * i32::from(kind >= 4);
        grid.x[at] = (left + column * wide + jitter(wide)) & !lattice;
        grid.y[at] = (top + row * high + jitter(high)) & !lattice;
        grid.w[at] = if flat { w } else { 0.2 + random.f32() * 0.5 };
        for k in 0..3 {
            grid.colour[k][at] = random.f32();
        }
    }
    grid
}

/// Both triangles of all micropolygons of a grid.
fn triangles(draw: Draw, grid: &Grid) -> Vec<Triangle> {
    let mut out = Vec::new();
    for row in 0..grid.rows - 1 {
        for column in 0..grid.stride - 1 {
            let a = row * grid.stride + column;
            let [a, b, c, d] = [a, a + 1, a + grid.stride + 1, a + grid.stride];
            let mean = [a, b, c, d].map(|at| f64::from(grid.colour[0][at])).iter().sum::<f64>() / 4.0;
            for corners in [[a, b, c], [a, c, d]] {
                out.push(Triangle {
                    corners: corners.map(|at| (i128::from(grid.x[at]), i128::from(grid.y[at]))),
                    w: corners.map(|at| f64::from(grid.w[at])),
                    colours: corners.map(|at| f64::from(grid.colour[0][at])),
                    mean,
                    id: (draw.patch_id, draw.column(column as u32), draw.row(row as u32)),
                });
            }
        }
    }
    out
}

/// A draw of the whole of a patch, of as many micropolygons as the grid has.
fn draw_of(patch: u32, grid: &Grid) -> Draw {
    assert!(grid.stride <= MAX_RATE as usize + 1);
    let rates = [grid.stride as u32 - 1, grid.rows as u32 - 1];
    let surface = Surface::root(patch);
    let sides = micropoly_core::border::SIDES.map(|side| surface.side(side));
    Draw::new(surface, Verdict::default().with_sides(sides, rates))
}

/// What is wrong with a sample, given all triangles; nothing if it is right.
fn wrong(found: Sample, colour: f32, smooth: bool, all: &[Triangle], p: (i128, i128)) -> Option<String> {
    let here: Vec<(f64, &Triangle)> = all
        .iter()
        .filter(|triangle| owns(triangle.corners, p))
        .map(|triangle| (at(triangle.corners, triangle.w, p), triangle))
        .collect();
    let Some(nearest) = here.iter().map(|(w, _)| *w).reduce(f64::max) else {
        return (found.depth != 0).then(|| "something where nothing is".to_owned());
    };
    if found.depth == 0 {
        return Some("nothing where something is".to_owned());
    }
    let w = f64::from(f32::from_bits(found.depth));
    // Depths of f32: what is nearer by less than their rounding may win; exact ties go to the smallest identity.
    let rounding = 3.0e-6 * nearest;
    let id = (found.patch_id, found.u, found.v);
    let own = here.iter().filter(|(_, triangle)| triangle.id == id).map(|(w, _)| *w).fold(0.0, f64::max);
    if own < nearest - rounding || (w - own).abs() > rounding {
        return Some(format!("depth {w}, of its micropolygon {own}, nearest {nearest}"));
    }
    let flat = |triangle: &Triangle| triangle.w[0] == triangle.w[1] && triangle.w[1] == triangle.w[2];
    let contenders: Vec<&Triangle> =
        here.iter().filter(|(w, _)| *w >= nearest - rounding).map(|(_, triangle)| *triangle).collect();
    if contenders.iter().all(|triangle| flat(triangle)) {
        let least = contenders.iter().map(|triangle| triangle.id).min();
        if least != Some(id) {
            return Some(format!("a tie went to {id:?} instead of {least:?}"));
        }
    }
    let colours = contenders.iter().filter(|triangle| triangle.id == id);
    let mut colours = colours
        .map(|triangle| if smooth { at(triangle.corners, triangle.colours, p) } else { triangle.mean });
    let is_right = colours.any(|wanted| (wanted - f64::from(colour)).abs() < 2.0e-4);
    (!is_right).then(|| format!("colour {colour}"))
}

fn soup(random: &mut fastrand::Rng) -> Vec<(Draw, Grid)> {
    (0..random.u32(1..8))
        .map(|patch| {
            let kind = random.usize(0..8);
            let grid = grid(random, kind);
            (draw_of(patch, &grid), grid)
        })
        .collect()
}

fn render(frame: &Frame, soup: &[(Draw, Grid)], samples: &mut [Sample], colours: &mut [Colour]) {
    let mut band = Band::whole(frame, samples, colours);
    for (draw, grid) in soup {
        sample(frame, &Pattern::new(frame), (*draw, 1.0), grid, &mut band);
    }
}

#[test]
fn no_sample_is_wrong() {
    let mut random = common::random(90);
    let (mut checked, mut covered) = (0_u64, 0_u64);
    for round in 0..600 {
        let samples = Samples::ALL[round % 4];
        let k = 1 << samples.bits();
        let region = Region::whole(WIDTH, HEIGHT, samples);
        let mut frame = Frame { width: WIDTH, height: HEIGHT, ..Frame::default() }.with_region(region, 0);
        let smooth = random.bool();
        frame.flags = if smooth { FLAG_SMOOTH } else { 0 };
        let soup = soup(&mut random);
        let all: Vec<Triangle> = soup.iter().flat_map(|(draw, grid)| triangles(*draw, grid)).collect();
        let count = frame.sample_count() as usize;
        let (mut found, mut colours) = (vec![Sample::default(); count], vec![Colour::default(); count]);
        // All at once, or, as in a blurred image, in the order of tuples.
        if random.u8(0..3) == 0 {
            for tuple in tuples(samples) {
                render(&frame.with_tuple(samples, tuple), &soup, &mut found, &mut colours);
            }
        } else {
            render(&frame, &soup, &mut found, &mut colours);
        }
        for (index, (found, colour)) in found.into_iter().zip(colours).enumerate() {
            let (column, row) = (index as i32 % (WIDTH as i32 * k), index as i32 / (WIDTH as i32 * k));
            let p = place(k, (column / k, row / k), (column % k, row % k));
            let problem = wrong(found, colour.rgba[0], smooth, &all, p);
            assert!(
                problem.is_none(),
                "round {round}, sample {column}, {row}: {}",
                problem.unwrap_or_default()
            );
            checked += 1;
            covered += u64::from(found.depth > 0);
        }
    }
    assert!(checked > 1_000_000 && covered > checked / 10, "{covered} of {checked}");
}

#[test]
fn a_part_of_the_image_has_the_samples_of_the_whole() {
    let mut random = common::random(91);
    for round in 0..60 {
        let samples = Samples::ALL[round % 4];
        let soup = soup(&mut random);
        let bare = Frame { width: WIDTH, height: HEIGHT, ..Frame::default() };
        let image = |window: Window| {
            let frame = bare.with_region(Region { samples, window, shown: window }, 0);
            let count = frame.sample_count() as usize;
            let (mut found, mut colours) = (vec![Sample::default(); count], vec![Colour::default(); count]);
            render(&frame, &soup, &mut found, &mut colours);
            found
        };
        let whole = image(Window::whole(WIDTH, HEIGHT));
        let window = Window { left: 3, right: 11, top: 2, bottom: 7 };
        let part = image(window);
        let k = 1 << samples.bits();
        let wide = window.width() * k;
        for (index, found) in part.into_iter().enumerate() {
            let (column, row) = (index as u32 % wide + 3 * k, index as u32 / wide + 2 * k);
            assert_eq!(found, whole[(row * WIDTH * k + column) as usize], "round {round}: {column}, {row}");
        }
    }
}
