// Mirrors core/src/kernel/sample.rs: micropolygons become samples, the nearest wins.
//
// What a group finds in its tile of the image is gathered in workgroup memory: the nearest depth of each
// pixel, then, of the micropolygons that have it, the smallest patch and u, then the smallest v: three passes,
// of which the last two look at the hits of the first only. Seldom are there more hits than there is room
// for; then they look for them anew.

const TILE_PIXELS: u32 = TILE * TILE;
// Most draws that are sampled together, and most hits that are kept.
const LISTED: u32 = 128u;
const HITS: u32 = 1024u;
// A key is the slot of a draw among those listed and, in the low bits, one of its micropolygons:
// column * 32 + row.
const CELL_BITS: u32 = 10u;
const PIXEL_SHIFT: u32 = 24u;
const RANK_BITS: u32 = 7u;
const NOBODY: u32 = 0xffffffffu;

// Bits of the nearest 1 / distance at each pixel of the tile; 0 = nothing.
var<workgroup> cand_depth: array<atomic<u32>, TILE_PIXELS>;
// Patch, as its rank, and u of the micropolygon that has it; NOBODY if it was there before.
var<workgroup> cand_patch_u: array<atomic<u32>, TILE_PIXELS>;
// Its v, and the rank of its draw.
var<workgroup> cand_v_draw: array<atomic<u32>, TILE_PIXELS>;
var<workgroup> hit_count: atomic<u32>;
var<workgroup> hit_depth: array<u32, HITS>;
var<workgroup> hit_place: array<u32, HITS>;
// The draws that are being sampled, as numbers within the chunk, and how many of them come before each in the
// draw buffer, and have a smaller patch.
var<workgroup> listed: array<u32, LISTED>;
var<workgroup> rank: array<u32, LISTED>;
var<workgroup> patch_rank: array<u32, LISTED>;
// Of each of them, the number of its micropolygons, that of a row, and what to divide by the latter with.
var<workgroup> quads: array<u32, LISTED>;
const QUADS_MASK: u32 = 511u;
const ROW_SHIFT: u32 = 9u;
const SHARE_SHIFT: u32 = 14u;
const SHARE_BITS: u32 = 12u;

// The tile of this group: left, right, top, bottom in pixels.
var<private> tile: vec4<i32>;
// Which pass is it: 0, 1 or 2?
var<private> turn: u32;

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

// A hit of a pixel of the tile.
fn put(column: i32, row: i32, w: f32, key: u32) {
    let pixel = u32(row - tile.z) * TILE + u32(column - tile.x);
    let found = bitcast<u32>(w);
    if turn > 0u {
        compare(pixel, found, key);
    } else if found >= atomicMax(&cand_depth[pixel], found) {
        let place = atomicAdd(&hit_count, 1u);
        if place < HITS {
            hit_depth[place] = found;
            hit_place[place] = (pixel << PIXEL_SHIFT) | key;
        }
    }
}

// Who has the nearest depth? First by patch and u, then by v.
fn compare(pixel: u32, found: u32, key: u32) {
    if found != atomicLoad(&cand_depth[pixel]) {
        return;
    }
    let slot = key >> CELL_BITS;
    let cell = key & ((1u << CELL_BITS) - 1u);
    let it = sample_of(surface_of(draw_at(listed[slot])), cell, found);
    let patch_u = (patch_rank[slot] << PARAM_BITS) | it.u;
    if turn == 1u {
        atomicMin(&cand_patch_u[pixel], patch_u);
    } else if patch_u == atomicLoad(&cand_patch_u[pixel]) {
        atomicMin(&cand_v_draw[pixel], (it.v << RANK_BITS) | rank[slot]);
    }
}

// Draw number `index` of the chunk.
fn draw_at(index: u32) -> Draw {
    return draws[grids[HEAD_START] + index];
}

// One micropolygon of a grid: numbers of its corners, and its cell.
struct Item {
    corners: vec4<u32>,
    cell: u32,
}

fn quads_of(draw: Draw) -> u32 {
    let rates = draw_rates(draw);
    let share = ((1u << SHARE_BITS) + rates.x - 1u) / rates.x;
    return (rates.x * rates.y) | (rates.x << ROW_SHIFT) | (share << SHARE_SHIFT);
}

// Micropolygon number `task` of a grid, row by row. For so few this product is the quotient.
fn item_of(shape: u32, task: u32) -> Item {
    let row = (task * (shape >> SHARE_SHIFT)) >> SHARE_BITS;
    return quad_of(row, task - row * ((shape >> ROW_SHIFT) & FIVE_BITS));
}

fn quad_of(row: u32, column: u32) -> Item {
    let a = vertex_number(row, column);
    let d = vertex_number(row + 1u, column);
    return Item(vec4<u32>(a, a + 1u, d + 1u, d), column * 32u + row);
}

fn vertex_at(base: u32, at: u32) -> Vertex {
    return Vertex(
        bitcast<i32>(grids[screen_base(base, 0u) + at]),
        bitcast<i32>(grids[screen_base(base, 1u) + at]),
        bitcast<f32>(grids[screen_base(base, 2u) + at]),
    );
}

// Position (first = 0) or colour (3) of a vertex.
fn space_at(base: u32, at: u32, first: u32) -> vec3<f32> {
    return vec3<f32>(
        bitcast<f32>(grids[space_base(base, first) + at]),
        bitcast<f32>(grids[space_base(base, first + 1u) + at]),
        bitcast<f32>(grids[space_base(base, first + 2u) + at]),
    );
}

// The sample of the micropolygon `cell` at this depth.
fn sample_of(surface: Surface, cell: u32, depth_bits: u32) -> Sample {
    return Sample(
        depth_bits,
        surface.patch_id,
        surface.u + (cell / 32u) * (u_size(surface) >> MAX_RATE_BITS),
        surface.v + (cell % 32u) * (v_size(surface) >> MAX_RATE_BITS),
    );
}

fn mean4(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return mul(0.25, add(add(a, c), add(b, d)));
}

// Mean colour of the four vertices of a micropolygon.
fn colour_of(base: u32, row: u32, column: u32) -> Colour {
    let corners = quad_of(row, column).corners;
    let a = space_at(base, corners.x, 3u);
    let b = space_at(base, corners.y, 3u);
    let c = space_at(base, corners.z, 3u);
    let d = space_at(base, corners.w, 3u);
    return Colour(array<f32, 4>(
        mean4(a.x, b.x, c.x, d.x), mean4(a.y, b.y, c.y, d.y), mean4(a.z, b.z, c.z, d.z), 1.0));
}

// The pixels inside the tile whose centres lie between these snapped coordinates.
fn pixels_of(low_x: i32, high_x: i32, low_y: i32, high_y: i32) -> vec4<i32> {
    let columns = pixels_between(low_x, high_x);
    let rows = pixels_between(low_y, high_y);
    return vec4<i32>(
        imax(columns.x, tile.x), imin(columns.y, tile.y), imax(rows.x, tile.z), imin(rows.y, tile.w));
}

fn pixels_of_quad(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> vec4<i32> {
    return pixels_of(
        imin(imin(a.x, b.x), imin(c.x, d.x)),
        imax(imax(a.x, b.x), imax(c.x, d.x)),
        imin(imin(a.y, b.y), imin(c.y, d.y)),
        imax(imax(a.y, b.y), imax(c.y, d.y)),
    );
}
