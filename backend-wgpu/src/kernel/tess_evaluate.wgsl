// Mirrors core/src/kernel/tess_evaluate.rs: vertices and indices of a piece of a patch: a run of its vertices and one of its
// primitives; one group a piece.

@group(0) @binding(0) var<storage, read> tess_frame: TessFrame;
@group(0) @binding(1) var<storage, read> tess_patches: array<TessPatch>;
@group(0) @binding(2) var<storage, read> heights: array<f32>;
@group(0) @binding(3) var<storage, read> records: array<TessRecord>;
@group(0) @binding(4) var<storage, read> totals: TessTotals;
@group(0) @binding(5) var<storage, read_write> tess_vertices: array<TessVertex>;
@group(0) @binding(6) var<storage, read_write> indices: array<u32>;

const GROUP: u32 = 64u;

// Of the piece's patch.
var<workgroup> topology: Topology;
var<workgroup> surface: TessSurface;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = tess_frame.zero;
    let number = group_index(group);
    if number >= totals.pieces {
        return;
    }
    let index = patch_of(number);
    prepare(index, lane);
    let piece = number - records[index].first_piece;
    let vertices = span(piece, PIECE_VERTICES, records[index].vertices);
    for (var item = vertices.x + lane; item < vertices.y; item += GROUP) {
        put_vertex(index, item);
    }
    let primitives = span(piece, PIECE_PRIMITIVES, records[index].primitives);
    for (var item = primitives.x + lane; item < primitives.y; item += GROUP) {
        put_primitive(index, item);
    }
}

// Shares out what all vertices and primitives of a patch need.
fn prepare(index: u32, lane: u32) {
    let is_pn = tess_frame.evaluation == TESS_PN;
    if lane < 6u {
        divide(lane, records[index].levels[level_of(lane)]);
    }
    if lane < 4u {
        place_corner(index, lane);
    }
    workgroupBarrier();
    if is_pn && lane < 3u {
        bend(lane);
    }
    if lane == 0u {
        measure();
    }
    workgroupBarrier();
    if is_pn && lane == 0u {
        place_centre();
    }
    workgroupBarrier();
}

// A run of the vertices, or primitives, of a patch: the first, and one past the last.
fn span(piece: u32, size: u32, count: u32) -> vec2<u32> {
    return vec2<u32>(umin(piece * size, count), umin((piece + 1u) * size, count));
}

// The patch of the chunk that a piece is of: the last one whose pieces begin no later.
fn patch_of(piece: u32) -> u32 {
    var low = totals.first;
    var high = totals.end;
    while high - low > 1u {
        let middle = low + (high - low) / 2u;
        let is_low = records[middle].first_piece <= piece;
        low = select(low, middle, is_low);
        high = select(middle, high, is_low);
    }
    return low;
}

// Indices of a primitive.
fn corners() -> u32 {
    return select(3u, 2u, is_isolines());
}

fn put_vertex(index: u32, item: u32) {
    let side = side_of(item);
    let coordinates = coordinates_of(row_of(side), item - side.first);
    tess_vertices[records[index].first_vertex + item] = evaluated(index, coordinates);
}

fn put_primitive(index: u32, item: u32) {
    let laid = strip_of(item);
    let own = triangle(laid, item - laid.first);
    let is_turned = (tess_frame.flags & TESS_CLOCKWISE) != 0u;
    let turned = select(own, own.xzy, is_turned) + records[index].first_vertex;
    let first = corners() * (records[index].first_primitive + item);
    indices[first] = turned.x;
    indices[first + 1u] = turned.y;
    if !is_isolines() {
        indices[first + 2u] = turned.z;
    }
}
