// Mirrors core/src/kernel/tess_places.rs: where the vertices and primitives of each patch go, for as many patches as there is
// room for.
//
// One group; each invocation counts a run of neighbouring patches, the runs' totals are summed up, then each invocation
// gives out the places of its run. Sums only grow, so whether a patch fits is told by the sums up to it.

@group(0) @binding(0) var<storage, read> tess_frame: TessFrame;
@group(0) @binding(1) var<storage, read_write> records: array<TessRecord>;
@group(0) @binding(2) var<storage, read_write> totals: TessTotals;

const RUNS: u32 = 256u;

// Vertices, primitives and pieces of each run.
var<workgroup> runs: array<vec3<u32>, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let start = totals.first;
    let rooms = vec2<u32>(totals.vertex_room, totals.primitive_room);
    let count = umin(tess_frame.patch_count - start, TESS_WINDOW);
    let run = (count + RUNS - 1u) / RUNS;
    let first = umin(lane * run, count);
    let end = umin(first + run, count);
    runs[lane] = sum_of(start + first, start + end);
    // Behind it the totals are written.
    workgroupBarrier();
    var before = vec3<u32>(0u, 0u, 0u);
    for (var earlier = 0u; earlier < lane; earlier++) {
        before += runs[earlier];
    }
    if !fits(before, rooms) {
        return;
    }
    var at = first;
    while at < end && fits(before + size_of(start + at), rooms) {
        let size = size_of(start + at);
        records[start + at].first_vertex = before.x;
        records[start + at].first_primitive = before.y;
        records[start + at].first_piece = before.z;
        before += size;
        at++;
    }
    // Who has found the first that does not fit, or else the last.
    if at < end || lane == RUNS - 1u {
        totals = TessTotals(start, start + at, rooms.x, rooms.y, before.x, before.y, before.z);
    }
}

fn sum_of(first: u32, end: u32) -> vec3<u32> {
    var sum = vec3<u32>(0u, 0u, 0u);
    for (var index = first; index < end; index++) {
        sum += size_of(index);
    }
    return sum;
}

fn fits(sum: vec3<u32>, rooms: vec2<u32>) -> bool {
    return all(sum.xy <= rooms);
}

// Vertices, primitives and pieces of a patch.
fn size_of(index: u32) -> vec3<u32> {
    let vertices = records[index].vertices;
    let primitives = records[index].primitives;
    return vec3<u32>(vertices, primitives, pieces(vertices, primitives));
}

// Into how many pieces a patch is cut.
fn pieces(vertices: u32, primitives: u32) -> u32 {
    let a = (vertices + PIECE_VERTICES - 1u) / PIECE_VERTICES;
    let b = (primitives + PIECE_PRIMITIVES - 1u) / PIECE_PRIMITIVES;
    return select(b, a, a > b);
}
