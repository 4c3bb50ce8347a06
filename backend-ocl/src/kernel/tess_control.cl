// Mirrors `record` of core/src/kernel/tess_control.rs: which levels a patch has, and how many vertices and primitives it
// becomes with them. One work-item a patch.

// The record of a patch with these levels.
static TessRecord record_of(__constant TessFrame *frame, const TessLevels *levels) {
    TessRecord record;
    convert(frame, levels, record.levels);
    const Topology topology = new_topology(frame, record.levels);
    record.vertices = vertex_count(&topology);
    record.primitives = (frame->flags & TESS_POINTS) != 0u ? 0u : primitive_count(&topology);
    record.first_vertex = 0u;
    record.first_primitive = 0u;
    record.first_piece = 0u;
    return record;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_tess_control(__constant TessFrame *tess_frame, __global const TessPatch *tess_patches,
                        __global const TessLevels *levels, __global TessRecord *records) {
    const uint index = get_global_id(0);
    if (index < tess_frame->patch_count) {
        const TessLevels own = levels_of(tess_frame, tess_patches, levels, index);
        records[index] = record_of(tess_frame, &own);
    }
}
