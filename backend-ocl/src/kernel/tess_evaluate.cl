// Mirrors core/src/kernel/tess_evaluate.rs: vertices and indices of a piece of a patch: a run of its vertices and one of
// its primitives. One work-group a piece.

// The part of `count` that is a piece's: its first, and one past its last.
static uint2 span(uint piece, uint size, uint count) {
    return (uint2)(lesser_of(piece * size, count), lesser_of((piece + 1u) * size, count));
}

// The patch of a chunk that a piece is of: the last one whose pieces begin no later.
static uint patch_of(__global const TessRecord *records, uint first, uint end, uint piece) {
    uint low = first, high = end;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (records[middle].first_piece <= piece) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Indices of a primitive.
static uint corners_of(__constant TessFrame *frame) {
    return frame->domain == TESS_ISOLINES ? 2u : 3u;
}

// Lays a primitive of a patch whose first vertex has index `base`.
static void put_primitive(__constant TessFrame *frame, const Topology *topology, uint base, uint primitive,
                          __global uint *out) {
    const Strip strip = strip_of(topology, primitive);
    const uint3 at = base + triangle(&strip, primitive - strip.first);
    const bool is_turned = (frame->flags & TESS_CLOCKWISE) != 0u;
    out[0] = at.x;
    out[1] = is_turned ? at.z : at.y;
    if (corners_of(frame) == 3u) {
        out[2] = is_turned ? at.y : at.z;
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_tess_evaluate(__constant TessFrame *tess_frame, __global const TessPatch *tess_patches,
                         __global const float *heights, __global const TessRecord *records,
                         __global const TessTotals *totals, __global TessVertex *tess_vertices,
                         __global uint *indices) {
    const uint lane = get_local_id(0), piece = get_group_id(0);
    const uint index = patch_of(records, totals->first, totals->end, piece);
    const TessRecord record = records[index];
    const Topology topology = new_topology(tess_frame, record.levels);
    const uint2 vertices = span(piece - record.first_piece, PIECE_VERTICES, record.vertices);
    for (uint at = vertices.x + lane; at < vertices.y; at += GROUP) {
        const Side side = side_of(&topology, at);
        const uint3 coordinates = coordinates_of(row_of(&topology, side), at - side.first);
        tess_vertices[record.first_vertex + at] = evaluated(tess_frame, tess_patches, heights, index, coordinates);
    }
    const uint2 primitives = span(piece - record.first_piece, PIECE_PRIMITIVES, record.primitives);
    for (uint at = primitives.x + lane; at < primitives.y; at += GROUP) {
        __global uint *out = indices + (size_t)corners_of(tess_frame) * (record.first_primitive + at);
        put_primitive(tess_frame, &topology, record.first_vertex, at, out);
    }
}
