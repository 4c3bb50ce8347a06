// Mirrors core/src/kernel/tess_places.rs: where the vertices and primitives of each patch go, for as many patches as
// there is room for. One work-group; each of its work-items counts an unbroken run of patches, as in `scan.cl`.

// Into how many pieces a patch is cut.
static uint pieces_of(__global const TessRecord *record) {
    const uint a = (record->vertices + PIECE_VERTICES - 1u) / PIECE_VERTICES;
    const uint b = (record->primitives + PIECE_PRIMITIVES - 1u) / PIECE_PRIMITIVES;
    return greater_of(a, b);
}

// Vertices, primitives and pieces of a patch, and itself.
static Counts counted_patch(__global const TessRecord *record) {
    return (Counts)(record->vertices, record->primitives, pieces_of(record), 1u);
}

// Sums never fall, so that with a patch for which there is no room there is none for those behind it.
static bool is_room_for(__global const TessTotals *totals, Counts all) {
    return all.x <= totals->vertex_room && all.y <= totals->primitive_room;
}

// Places of a run of patches behind what there is before it, while there is room; gives what those come to.
static Counts put_patches(__global const TessTotals *totals, __global TessRecord *records, uint from, uint to,
                          Counts before) {
    Counts own = (Counts)(0u);
    for (uint index = from; index < to; index++) {
        __global TessRecord *record = records + index;
        const Counts at = before + own, with = own + counted_patch(record);
        if (!is_room_for(totals, before + with)) {
            break;
        }
        record->first_vertex = at.x;
        record->first_primitive = at.y;
        record->first_piece = at.z;
        own = with;
    }
    return own;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_tess_places(__constant TessFrame *tess_frame, __global TessRecord *records, __global TessTotals *totals) {
    __local Counts counts[GROUP];
    const uint lane = get_local_id(0), first = totals->first;
    const uint count = lesser_of(tess_frame->patch_count - first, TESS_WINDOW);
    const uint from = first + run_start(lane, count), to = first + run_start(lane + 1u, count);
    Counts own = (Counts)(0u);
    for (uint index = from; index < to; index++) {
        own += counted_patch(records + index);
    }
    counts[lane] = own;
    barrier(CLK_LOCAL_MEM_FENCE);
    const Counts before = sum(counts, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    counts[lane] = put_patches(totals, records, from, to, before);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0u) {
        const Counts all = sum(counts, GROUP);
        totals->vertices = all.x;
        totals->primitives = all.y;
        totals->pieces = all.z;
        totals->end = first + all.w;
    }
}
