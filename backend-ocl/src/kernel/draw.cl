// Mirrors the first half of core's fused stages, dice and shade: one work-group a draw of the chunk.
//
// Barriers are reached by all work-items alike.

// A grid this wide or less, in 1/256 pixels, can be sampled in 32 bits: see `triangle.cl`. A sample that is looked at
// lies less than a column of samples beside the grid, and that is 8 pixels at most.
#define NARROW (16384 - 8 * SUBPIXELS)

// What is found out about all vertices of a grid.
typedef struct {
    // The box around them.
    Extents extents;
    // Not 0 if one must be clipped.
    uint must_clip;
    // Not 0 if a micropolygon may face the eye.
    uint faces_eye;
} Measures;

static void clear_measures(__local Measures *measures) {
    measures->extents = nothing();
    measures->must_clip = 0u;
    measures->faces_eye = 0u;
}

static void measure(__local Measures *measures, Vertex vertex) {
    include(&measures->extents, vertex.x, vertex.y);
    if (vertex.w == 0.0f) {
        measures->must_clip = 1u; // whoever writes, it is the same
    }
}

// Vertices and their colours.
static void dice_and_shade(__constant Frame *frame, __global const Object *object, __global const Patch *patch,
                           Draw draw, __local const Grid *grid, __local Measures *measures, __global uint *grids,
                           uint base, uint lane) {
    const uint stride = rate_u(draw) + 1u, count = stride * (rate_v(draw) + 1u);
    for (uint at = lane; at < count; at += GROUP) {
        const uint row = at / stride, column = at % stride;
        const uint2 parameters = vertex_of(draw, grid, row, column);
        float3 position, normal;
        position_and_normal(frame, object, patch, grid, parameters, row, column, &position, &normal);
        if (is_displaced(object)) {
            place_vertex(frame->zero, to_eye_of(object), normal_to_eye_of(object), &position, &normal);
        }
        const Vertex vertex = project(frame, position);
        measure(measures, vertex);
        put_screen(frame, grids, base, at, vertex);
        put_space(frame, grids, base, at, 0u, position);
        put_space(frame, grids, base, at, 3u, shade(frame, object, position, normal));
    }
}

// May the micropolygon be seen from the front? See `faces_away` in core.
static bool may_face_eye(__constant Frame *frame, __global const uint *grids, uint base, uint at, uint below) {
    const Vertex a = vertex_at(frame, grids, base, at), b = vertex_at(frame, grids, base, at + 1u);
    const Vertex c = vertex_at(frame, grids, base, below + 1u), d = vertex_at(frame, grids, base, below);
    const bool whole = a.w > 0.0f && b.w > 0.0f && c.w > 0.0f && d.w > 0.0f;
    return !(whole && signed_area(a, b, c) >= 0 && signed_area(a, c, d) >= 0);
}

// Finds out whether a micropolygon may face the eye, if that matters.
static void seek_faces(__constant Frame *frame, Draw draw, __local Measures *measures,
                       __global const uint *grids, uint base, uint lane) {
    const uint rate = rate_u(draw), stride = rate + 1u;
    const uint count = frame->flags & FLAG_CULL_BACKFACES ? rate * rate_v(draw) : 0u;
    for (uint index = lane; index < count; index += GROUP) {
        const uint at = index / rate * stride + index % rate;
        if (may_face_eye(frame, grids, base, at, at + stride)) {
            measures->faces_eye = 1u; // whoever writes, it is the same
        }
    }
}

static uint kind_of(__constant Frame *frame, __local const Measures *measures) {
    if ((frame->flags & FLAG_CULL_BACKFACES) && measures->faces_eye == 0u) {
        return KIND_HIDDEN;
    }
    const Extents extents = measures->extents;
    const bool narrow =
        extents.high_x - extents.low_x <= NARROW && extents.high_y - extents.low_y <= NARROW;
    return narrow && measures->must_clip == 0u ? KIND_NEAR : KIND_GENERAL;
}

// The box around a draw, snapped: of what must be clipped, the pixels that it was bounded by.
static Extents extents_of(Draw draw, __local const Measures *measures) {
    const Extents bounded = {(int)(draw.columns & 0xffffu) * SUBPIXELS, (int)(draw.columns >> 16) * SUBPIXELS - 1,
                             (int)(draw.rows & 0xffffu) * SUBPIXELS, (int)(draw.rows >> 16) * SUBPIXELS - 1};
    return measures->must_clip == 0u ? measures->extents : bounded;
}

// The frame's samples that can lie in a box.
static int4 samples_in(__constant Frame *frame, Extents extents) {
    const int2 columns = samples_between(frame, extents.low_x, extents.high_x);
    const int2 rows = samples_between(frame, extents.low_y, extents.high_y);
    return common(frame_box(frame), (int4)(columns, rows));
}

static void put_flags(__constant Frame *frame, __global const Object *object, Draw draw,
                      __local const Measures *measures, __global uint *grids, uint index) {
    const uint found = kind_of(frame, measures), place = flags_place(index);
    grids[place] = found | draw.shape >> RATE_U_SHIFT << RATES_SHIFT;
    put_box(grids, index, samples_in(frame, extents_of(draw, measures)));
    grids[place + OPACITY] = as_uint(object->opacity);
    if (found != KIND_HIDDEN) {
        grids[HEAD_KINDS + found - 1u] = 1u; // whoever writes, it is the same
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_draw(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                __global const Draw *draws, __global uint *grids) {
    __local Grid grid;
    __local Measures measures;
    const uint lane = get_local_id(0), index = get_group_id(0);
    const bool is_one = index < grids[HEAD_COUNT];
    // Where there is no draw, the address of one all the same: compilers may load first and branch later.
    const Draw draw = draws[is_one ? grids[HEAD_START] + index : 0u];
    const Instance known = instance(frame, objects, patches, draw.patch_id);
    __global const Patch *patch = patches + known.record;
    __global const Object *object = objects + known.object;
    const uint base = grid_base(frame, index);
    if (!is_one) {
        return;
    }
    if (lane == GROUP - 1u) {
        clear_measures(&measures);
    }
    prepare(frame->zero, to_eye_of(object), object, patches, known.record, draw, &grid, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    dice_and_shade(frame, object, patch, draw, &grid, &measures, grids, base, lane);
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    seek_faces(frame, draw, &measures, grids, base, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0u) {
        put_flags(frame, object, draw, &measures, grids, index);
    }
}
