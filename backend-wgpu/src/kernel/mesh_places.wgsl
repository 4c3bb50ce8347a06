// Mirrors core/src/kernel/mesh.rs (places): places of all draws in a mesh.
//
// One group; each invocation counts a run of neighbouring draws, the runs' totals are summed up, then each invocation
// gives out the places of its run.

@group(0) @binding(0) var<storage, read> control: Control;
@group(0) @binding(1) var<storage, read> draws: array<Draw>;
@group(0) @binding(2) var<storage, read_write> places: array<MeshPlace>;
@group(0) @binding(3) var<storage, read_write> totals: MeshTotals;

const RUNS: u32 = 256u;

// Vertices and triangles of each run.
var<workgroup> runs: array<vec2<u32>, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let count = control.waiting + control.fresh;
    let run = (count + RUNS - 1u) / RUNS;
    let first = umin(lane * run, count);
    let end = umin(first + run, count);
    var own = vec2<u32>(0u, 0u);
    for (var item = first; item < end; item++) {
        own += size_of(draws[item]);
    }
    runs[lane] = own;
    workgroupBarrier();
    var before = vec2<u32>(totals.vertices, totals.triangles);
    for (var earlier = 0u; earlier < lane; earlier++) {
        before += runs[earlier];
    }
    for (var item = first; item < end; item++) {
        places[item] = MeshPlace(before.x, before.y);
        before += size_of(draws[item]);
    }
    storageBarrier();
    if lane == RUNS - 1u {
        totals = MeshTotals(before.x, before.y);
    }
}

// Vertices and triangles of a draw's grid.
fn size_of(draw: Draw) -> vec2<u32> {
    let rates = draw_rates(draw);
    return vec2<u32>((rates.x + 1u) * (rates.y + 1u), 2u * rates.x * rates.y);
}
