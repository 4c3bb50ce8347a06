// Mirrors core/src/kernel/sample.rs: micropolygons become samples, the nearest wins.
//
// A group owns a tile of the image. What it finds is gathered in workgroup memory in two passes: the nearest
// depth of each pixel, then the smallest micropolygon that has it.

const TILE: u32 = 16u;
const TILE_PIXELS: u32 = TILE * TILE;

// Bits of the nearest 1 / distance of the surface at each pixel of the tile; 0 = nothing.
var<workgroup> cand_depth: array<atomic<u32>, TILE_PIXELS>;
// The micropolygon that has it: column * 32 + row, which is ordered as (u, v) is.
var<workgroup> cand_cell: array<atomic<u32>, TILE_PIXELS>;
// Not 0 if a micropolygon may face the eye.
var<workgroup> faces_eye: atomic<u32>;

// The tile of this group: left, right, top, bottom in pixels.
var<private> tile: vec4<i32>;
// Does this pass look for depths, rather than for the micropolygons that have them?
var<private> seek_depth: bool;

fn nearer(new_sample: Sample, old: Sample) -> bool {
    if new_sample.depth != old.depth {
        return new_sample.depth > old.depth;
    }
    if new_sample.patch_id != old.patch_id {
        return new_sample.patch_id < old.patch_id;
    }
    if new_sample.u != old.u {
        return new_sample.u < old.u;
    }
    return new_sample.v < old.v;
}

fn imin(a: i32, b: i32) -> i32 {
    return select(b, a, a < b);
}

fn imax(a: i32, b: i32) -> i32 {
    return select(b, a, a > b);
}

// A candidate for a pixel of the tile, at the micropolygon `cell`.
fn put(column: i32, row: i32, w: f32, cell: u32) {
    let place = u32(row - tile.z) * TILE + u32(column - tile.x);
    let found = bitcast<u32>(w);
    if seek_depth {
        atomicMax(&cand_depth[place], found);
    } else if found == atomicLoad(&cand_depth[place]) {
        atomicMin(&cand_cell[place], cell);
    }
}

fn cell_of(row: u32, column: u32) -> u32 {
    return column * 32u + row;
}

fn vertex_at(row: u32, column: u32) -> Vertex {
    let at = row * (frame.rate + 1u) + column;
    return Vertex(grid_x[at], grid_y[at], grid_w[at]);
}

fn point_at(row: u32, column: u32) -> vec3<f32> {
    let at = row * (frame.rate + 1u) + column;
    return vec3<f32>(grid_px[at], grid_py[at], grid_pz[at]);
}

// The sample of the micropolygon `cell` at this depth.
fn sample_of(surface: Surface, cell: u32, depth_bits: u32) -> Sample {
    return Sample(
        depth_bits,
        surface.patch_id,
        surface.u + (cell / 32u) * (u_size(surface) / frame.rate),
        surface.v + (cell % 32u) * (v_size(surface) / frame.rate),
    );
}

fn mean4(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return mul(0.25, add(add(a, c), add(b, d)));
}

// Mean colour of the four vertices of a micropolygon.
fn colour_of(cell: u32) -> Colour {
    let a = (cell % 32u) * (frame.rate + 1u) + cell / 32u;
    let b = a + 1u;
    let d = a + frame.rate + 1u;
    let c = d + 1u;
    return Colour(array<f32, 4>(
        mean4(grid_red[a], grid_red[b], grid_red[c], grid_red[d]),
        mean4(grid_green[a], grid_green[b], grid_green[c], grid_green[d]),
        mean4(grid_blue[a], grid_blue[b], grid_blue[c], grid_blue[d]),
        1.0,
    ));
}

// The part of a box of pixels inside the tile.
fn within_tile(columns: vec2<i32>, rows: vec2<i32>) -> vec4<i32> {
    return vec4<i32>(
        imax(columns.x, tile.x), imin(columns.y, tile.y), imax(rows.x, tile.z), imin(rows.y, tile.w));
}

// One quad, as the triangles a b c and a c d.
fn micropolygon(row: u32, column: u32) {
    let a = vertex_at(row, column);
    let b = vertex_at(row, column + 1u);
    let c = vertex_at(row + 1u, column + 1u);
    let d = vertex_at(row + 1u, column);
    if a.w == 0.0 || b.w == 0.0 || c.w == 0.0 || d.w == 0.0 {
        clipped_quad(row, column);
        return;
    }
    let columns = pixels_between(imin(imin(a.x, b.x), imin(c.x, d.x)), imax(imax(a.x, b.x), imax(c.x, d.x)));
    let rows = pixels_between(imin(imin(a.y, b.y), imin(c.y, d.y)), imax(imax(a.y, b.y), imax(c.y, d.y)));
    let pixels = within_tile(columns, rows);
    let cell = cell_of(row, column);
    for (var y = pixels.z; y < pixels.w; y++) {
        for (var x = pixels.x; x < pixels.y; x++) {
            let w = max(sample_triangle(a, b, c, x, y), sample_triangle(a, c, d, x, y));
            if w > 0.0 {
                put(x, y, w, cell);
            }
        }
    }
}

fn clipped_quad(row: u32, column: u32) {
    let cell = cell_of(row, column);
    let a = point_at(row, column);
    let c = point_at(row + 1u, column + 1u);
    clipped(a, point_at(row, column + 1u), c, cell);
    clipped(a, c, point_at(row + 1u, column), cell);
}

// Clips a triangle and samples what is left of it, as a fan.
fn clipped(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, cell: u32) {
    var polygon = clip(a, b, c);
    for (var k = 2u; k < polygon.count; k++) {
        triangle(
            project_clipped(polygon.corners[0]),
            project_clipped(polygon.corners[k - 1u]),
            project_clipped(polygon.corners[k]),
            cell,
        );
    }
}

fn triangle(a: Vertex, b: Vertex, c: Vertex, cell: u32) {
    let columns = pixels_between(imin(imin(a.x, b.x), c.x), imax(imax(a.x, b.x), c.x));
    let rows = pixels_between(imin(imin(a.y, b.y), c.y), imax(imax(a.y, b.y), c.y));
    let pixels = within_tile(columns, rows);
    for (var y = pixels.z; y < pixels.w; y++) {
        for (var x = pixels.x; x < pixels.y; x++) {
            let w = sample_triangle(a, b, c, x, y);
            if w > 0.0 {
                put(x, y, w, cell);
            }
        }
    }
}

// Row and column of step `t` of a border.
fn border_place(border: u32, t: u32) -> vec2<u32> {
    switch border {
        case 0u: {
            return vec2<u32>(0u, t);
        }
        case 1u: {
            return vec2<u32>(frame.rate, t);
        }
        case 2u: {
            return vec2<u32>(t, 0u);
        }
        default: {
            return vec2<u32>(t, frame.rate);
        }
    }
}

// Sliver number `task` of 4 * rate: `rate` a border. Number 0 of a border is that of the chord beyond it;
// the others are numbered as a heap is: one over the whole border, two over its halves, and so on.
fn seam_sliver(task: u32) {
    let border = task / frame.rate;
    let number = task % frame.rate;
    if seam_longest[border] <= 1u {
        return;
    }
    if number == 0u {
        if seam_chord[border] != 0u {
            let middle = border_place(border, frame.rate);
            sliver(seam_ends[2u * border], middle, seam_ends[2u * border + 1u]);
        }
        return;
    }
    let height = firstLeadingBit(number);
    let span = frame.rate >> height;
    if span > seam_longest[border] {
        return;
    }
    let start = (number - (1u << height)) * span;
    let first = border_place(border, start);
    let last = border_place(border, start + span);
    let middle = border_place(border, start + span / 2u);
    sliver(vertex_at(first.x, first.y), middle, vertex_at(last.x, last.y));
}

fn sliver(a: Vertex, middle: vec2<u32>, c: Vertex) {
    let b = vertex_at(middle.x, middle.y);
    if a.w > 0.0 && b.w > 0.0 && c.w > 0.0 {
        let last = frame.rate - 1u;
        let row = select(middle.x, last, middle.x > last);
        let column = select(middle.y, last, middle.y > last);
        triangle(a, b, c, cell_of(row, column));
    }
}

// May the micropolygon be seen from the front? See `faces_away` in core.
fn may_face_eye(row: u32, column: u32) -> bool {
    let a = vertex_at(row, column);
    let b = vertex_at(row, column + 1u);
    let c = vertex_at(row + 1u, column + 1u);
    let d = vertex_at(row + 1u, column);
    let whole = a.w > 0.0 && b.w > 0.0 && c.w > 0.0 && d.w > 0.0;
    return !(whole && signed_area(a, b, c) >= 0 && signed_area(a, c, d) >= 0);
}
