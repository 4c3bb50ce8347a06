// Mirrors `places` of core/src/kernel/mesh.rs: a prefix sum over the draw buffer. One work-group; each of its
// work-items counts an unbroken run of draws, as in `scan.cl`.

// Vertices and triangles of a draw's grid.
static Counts mesh_of(Draw draw) {
    const uint along_u = rate_u(draw), along_v = rate_v(draw);
    return (Counts)((along_u + 1u) * (along_v + 1u), 2u * along_u * along_v, 0u, 0u);
}

// Places of a run of draws behind what there is before it; gives what there is then.
static Counts put_places(__global const Draw *draws, __global MeshPlace *places, uint from, uint to, Counts before) {
    for (uint index = from; index < to; index++) {
        const MeshPlace place = {before.x, before.y};
        places[index] = place;
        before += mesh_of(draws[index]);
    }
    return before;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_mesh_places(__global const Control *control, __global const Draw *draws, __global MeshPlace *places,
                       __global MeshTotals *totals) {
    __local Counts counts[GROUP];
    const uint lane = get_local_id(0), count = control->waiting + control->fresh;
    const uint from = run_start(lane, count), to = run_start(lane + 1u, count);
    const Counts start = (Counts)(totals->vertices, totals->triangles, 0u, 0u);
    Counts own = (Counts)(0u);
    for (uint index = from; index < to; index++) {
        own += mesh_of(draws[index]);
    }
    counts[lane] = own;
    barrier(CLK_LOCAL_MEM_FENCE);
    const Counts after = put_places(draws, places, from, to, start + sum(counts, lane));
    // Behind the last run is what there is in all.
    if (lane == GROUP - 1u) {
        totals->vertices = after.x;
        totals->triangles = after.y;
    }
}
