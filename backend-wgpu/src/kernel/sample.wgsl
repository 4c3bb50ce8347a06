// Mirrors core/src/kernel/sample.rs: a micropolygon and what it shows at a sample; and core/src/kernel/blend.rs
// (is_behind). What becomes of that is in `candidates.wgsl` and in `sort_last.wgsl`: they have a function `put`.

// Low bits of a number of a micropolygon within its grid: row * 32 + column.
const CELL_BITS: u32 = 10u;
const CELL_MASK: u32 = (1u << CELL_BITS) - 1u;
const CELL_SHIFT: u32 = 5u;

// Samples that are looked at: left, right, top, bottom.
var<private> limits: vec4<i32>;

// What a micropolygon shows at a sample, and which of its triangles: a b c, a c d, or what is left of either when clipped.
struct Found {
    hit: Hit,
    part: u32,
}

const PART_FIRST: u32 = 0u;
const PART_SECOND: u32 = 1u;
const PART_CLIPPED: u32 = 2u;

// One micropolygon of a grid: numbers of its corners, and its cell.
struct Item {
    corners: vec4<u32>,
    cell: u32,
}

// Of a grid, the number of its micropolygons, that of a row, and what to divide by the latter with.
const QUADS_MASK: u32 = 511u;
const ROW_SHIFT: u32 = 9u;
const SHARE_SHIFT: u32 = 14u;
const SHARE_BITS: u32 = 12u;

fn quads_of(draw: Draw) -> u32 {
    let rates = draw_rates(draw);
    let share = ((1u << SHARE_BITS) + rates.x - 1u) / rates.x;
    return (rates.x * rates.y) | (rates.x << ROW_SHIFT) | (share << SHARE_SHIFT);
}

// Micropolygon number `task` of a grid, row by row. For so few this product is the quotient.
fn item_of(shape: u32, task: u32) -> Item {
    let row = (task * (shape >> SHARE_SHIFT)) >> SHARE_BITS;
    return item_at((row << CELL_SHIFT) | (task - row * ((shape >> ROW_SHIFT) & FIVE_BITS)));
}

fn item_at(cell: u32) -> Item {
    let a = vertex_number(cell >> CELL_SHIFT, cell & FIVE_BITS);
    let d = vertex_number((cell >> CELL_SHIFT) + 1u, cell & FIVE_BITS);
    return Item(vec4<u32>(a, a + 1u, d + 1u, d), cell);
}

// Draw number `index` of the chunk.
fn draw_at(index: u32) -> Draw {
    return draws[grids[HEAD_START] + index];
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

// The sample of a micropolygon at this depth.
fn sample_of(draw: Draw, cell: u32, depth_bits: u32) -> Sample {
    return Sample(
        depth_bits, draw.patch_id, column_of(draw, cell & FIVE_BITS), row_of(draw, cell >> CELL_SHIFT));
}

// Is a micropolygon of draw number `index` behind the last layer that was found at a place, if there are layers?
fn is_behind(index: u32, cell: u32, depth_bits: u32, place: u32) -> bool {
    if (frame.flags & FLAG_LAYERS) == 0u {
        return true;
    }
    let last = behind[place];
    if depth_bits != last.depth {
        return last.depth == 0u || depth_bits < last.depth;
    }
    return nearer(last, sample_of(draw_at(index), cell, depth_bits));
}

// Its colour, given what was found of it.
fn colour_of(base: u32, item: Item, found: Found) -> Colour {
    let a = space_at(base, item.corners.x, 3u);
    let b = space_at(base, item.corners.y, 3u);
    let c = space_at(base, item.corners.z, 3u);
    let d = space_at(base, item.corners.w, 3u);
    let opacity = bitcast<f32>(grids[base + 3u]);
    if (frame.flags & FLAG_SMOOTH) == 0u || found.part == PART_CLIPPED {
        return Colour(array<f32, 4>(
            mean4(a.x, b.x, c.x, d.x), mean4(a.y, b.y, c.y, d.y), mean4(a.z, b.z, c.z, d.z), opacity));
    }
    let is_first = found.part == PART_FIRST;
    let p = select(c, b, is_first);
    let q = select(d, c, is_first);
    let hit = found.hit;
    return Colour(array<f32, 4>(
        weighted(vec3<f32>(a.x, p.x, q.x), hit.for_b, hit.for_c),
        weighted(vec3<f32>(a.y, p.y, q.y), hit.for_b, hit.for_c),
        weighted(vec3<f32>(a.z, p.z, q.z), hit.for_b, hit.for_c),
        opacity,
    ));
}

fn mean4(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return mul(0.25, add(add(a, c), add(b, d)));
}

// The samples within the limits that can lie in a quad.
fn samples_of_quad(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> vec4<i32> {
    let columns = samples_between(
        imin(imin(a.x, b.x), imin(c.x, d.x)), imax(imax(a.x, b.x), imax(c.x, d.x)));
    let rows = samples_between(
        imin(imin(a.y, b.y), imin(c.y, d.y)), imax(imax(a.y, b.y), imax(c.y, d.y)));
    return vec4<i32>(overlap(columns, limits.xy), overlap(rows, limits.zw));
}
