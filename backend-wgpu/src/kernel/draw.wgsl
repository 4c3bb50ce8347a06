// Mirrors the first half of core's fused stage, dice and shade: one group a draw of the chunk.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> draws: array<Draw>;
@group(0) @binding(4) var<storage, read_write> grids: array<u32>;
@group(0) @binding(5) var<storage, read> patches_more: array<Patch>;

// A grid this wide or less, in 1/256 pixels, can be sampled in 32 bits: no corner is 16384 away from any sample of its box,
// and no sample of its box as far outside of it as one column of samples is from the next, 2048 at most.
const NARROW: i32 = 14000;

// The grid on screen, by `vertex_number`.
var<workgroup> grid_x: array<i32, GRID>;
var<workgroup> grid_y: array<i32, GRID>;
var<workgroup> grid_w: array<f32, GRID>;
// The box around all vertices.
var<workgroup> low_x: atomic<i32>;
var<workgroup> high_x: atomic<i32>;
var<workgroup> low_y: atomic<i32>;
var<workgroup> high_y: atomic<i32>;
// Not 0 if a vertex must be clipped.
var<workgroup> must_clip: atomic<u32>;
// Not 0 if a micropolygon may face the eye.
var<workgroup> faces_eye: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let draw = draws[grids[HEAD_START] + group.x];
    let rates = draw_rates(draw);
    let base = grid_base(group.x);
    if lane == 63u {
        clear_measures();
    }
    let placed = instance(draw.patch_id);
    prepare(draw, placed, rates, lane);
    workgroupBarrier();
    let stride = rates.x + 1u;
    for (var task = lane; task < stride * (rates.y + 1u); task += GROUP) {
        dice(draw, placed, task / stride, task % stride, base);
    }
    workgroupBarrier();
    seek_faces(rates, lane);
    workgroupBarrier();
    if lane == 0u {
        put_head(draw, placed.object, base);
    }
}

// One vertex of the grid at word `base`: snapped position, position, colour.
fn dice(draw: Draw, placed: Instance, row: u32, column: u32, base: u32) {
    let diced = dice_any(draw, placed, row, column);
    let vertex = project(diced.point);
    let at = vertex_number(row, column);
    grid_x[at] = vertex.x;
    grid_y[at] = vertex.y;
    grid_w[at] = vertex.w;
    measure(vertex);
    put_screen(base, at, vertex);
    put_space(base, at, 0u, diced.point);
    put_space(base, at, 3u, shade(placed.object, diced.point, diced.normal));
}

fn put_screen(base: u32, at: u32, vertex: Vertex) {
    grids[screen_base(base, 0u) + at] = bitcast<u32>(vertex.x);
    grids[screen_base(base, 1u) + at] = bitcast<u32>(vertex.y);
    grids[screen_base(base, 2u) + at] = bitcast<u32>(vertex.w);
}

fn put_space(base: u32, at: u32, first: u32, value: vec3<f32>) {
    grids[space_base(base, first) + at] = bitcast<u32>(value.x);
    grids[space_base(base, first + 1u) + at] = bitcast<u32>(value.y);
    grids[space_base(base, first + 2u) + at] = bitcast<u32>(value.z);
}

fn clear_measures() {
    atomicStore(&low_x, 0x7fffffff);
    atomicStore(&high_x, -0x7fffffff);
    atomicStore(&low_y, 0x7fffffff);
    atomicStore(&high_y, -0x7fffffff);
    atomicStore(&must_clip, 0u);
    atomicStore(&faces_eye, 0u);
}

fn measure(vertex: Vertex) {
    atomicMin(&low_x, vertex.x);
    atomicMax(&high_x, vertex.x);
    atomicMin(&low_y, vertex.y);
    atomicMax(&high_y, vertex.y);
    if vertex.w == 0.0 {
        atomicStore(&must_clip, 1u);
    }
}

// Finds out whether a micropolygon may face the eye, if that matters.
fn seek_faces(rates: vec2<u32>, lane: u32) {
    let count = select(0u, rates.x * rates.y, (frame.flags & FLAG_CULL_BACKFACES) != 0u);
    for (var index = lane; index < count; index += GROUP) {
        if may_face_eye(index / rates.x, index % rates.x) {
            atomicStore(&faces_eye, 1u);
        }
    }
}

fn kind() -> u32 {
    if (frame.flags & FLAG_CULL_BACKFACES) != 0u && atomicLoad(&faces_eye) == 0u {
        return KIND_HIDDEN;
    }
    let narrow = atomicLoad(&high_x) - atomicLoad(&low_x) <= NARROW
        && atomicLoad(&high_y) - atomicLoad(&low_y) <= NARROW;
    return select(KIND_GENERAL, KIND_NEAR, narrow && atomicLoad(&must_clip) == 0u);
}

// What a grid that is whole can touch is known better now than when it was bounded.
fn put_head(draw: Draw, object: u32, base: u32) {
    var columns = samples_of(draw.columns, frame_columns());
    var rows = samples_of(draw.rows, frame_rows());
    let found = kind();
    if found == KIND_NEAR {
        columns = overlap(columns, samples_between(atomicLoad(&low_x), atomicLoad(&high_x)));
        rows = overlap(rows, samples_between(atomicLoad(&low_y), atomicLoad(&high_y)));
    }
    grids[base] = found;
    grids[base + 1u] = blocks_of(columns, i32(frame.sample_left));
    grids[base + 2u] = blocks_of(rows, i32(frame.sample_top));
    grids[base + 3u] = bitcast<u32>(objects[object].opacity);
}

fn on_screen(row: u32, column: u32) -> Vertex {
    let at = vertex_number(row, column);
    return Vertex(grid_x[at], grid_y[at], grid_w[at]);
}

// May the micropolygon be seen from the front? See `faces_away` in core.
fn may_face_eye(row: u32, column: u32) -> bool {
    let a = on_screen(row, column);
    let b = on_screen(row, column + 1u);
    let c = on_screen(row + 1u, column + 1u);
    let d = on_screen(row + 1u, column);
    let whole = a.w > 0.0 && b.w > 0.0 && c.w > 0.0 && d.w > 0.0;
    return !(whole && signed_area(a, b, c) >= 0 && signed_area(a, c, d) >= 0);
}
