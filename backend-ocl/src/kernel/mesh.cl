// Mirrors core/src/kernel/mesh.rs: drawn surfaces become vertices and triangles. One work-group a draw.

// Indices of a micropolygon.
#define QUAD_INDICES 6u

// Positions of a grid's vertices: coordinate k of vertex `at` at k POINTS + at.
#define POINTS (SIDE * SIDE)

// The transform that leaves points where they are; -0 becomes 0, as in core. No compiler is to know its numbers.
static Transform as_it_is(uint zero) {
    const float none = number(0), whole = number(1);
    const Transform transform = {(float4)(whole, none, none, none), (float4)(none, whole, none, none),
                                 (float4)(none, none, whole, none)};
    return transform;
}

// The one that leaves normals as they are.
static NormalTransform normals_as_they_are(uint zero) {
    const float none = number(0), whole = number(1);
    const NormalTransform transform = {(float3)(whole, none, none), (float3)(none, whole, none),
                                       (float3)(none, none, whole)};
    return transform;
}

static void put_point(__local float *points, uint at, float3 point) {
    points[at] = point.x;
    points[POINTS + at] = point.y;
    points[2u * POINTS + at] = point.z;
}

INLINED bool is_same_point(__local const float *points, uint a, uint b) {
    return points[a] == points[b] && points[POINTS + a] == points[POINTS + b]
        && points[2u * POINTS + a] == points[2u * POINTS + b];
}

static MeshVertex new_mesh_vertex(uint zero, uint patch_id, uint2 at, float3 point, float3 normal) {
    const MeshVertex vertex = {{point.x, point.y, point.z},
                               {normal.x, normal.y, normal.z},
                               {param(zero, at.x), param(zero, at.y)},
                               patch_id};
    return vertex;
}

static void put_vertices(__constant Frame *frame, __global const Object *object, __global const Patch *patch,
                         Draw draw, __local const Grid *grid, __local float *points, __global MeshVertex *vertices,
                         uint lane) {
    const uint zero = frame->zero;
    const uint stride = rate_u(draw) + 1u, count = stride * (rate_v(draw) + 1u);
    for (uint at = lane; at < count; at += GROUP) {
        const uint row = at / stride, column = at % stride;
        const uint2 parameters = vertex_of(draw, grid, row, column);
        float3 position, normal;
        position_and_normal(frame, object, patch, grid, parameters, row, column, &position, &normal);
        if (is_displaced(object)) {
            place_vertex(zero, as_it_is(zero), normals_as_they_are(zero), &position, &normal);
        }
        put_point(points, at, position);
        vertices[at] = new_mesh_vertex(zero, draw.patch_id, parameters, position, normal);
    }
}

// A triangle of the grid whose vertices start at `first`, or thrice the same corner if it has collapsed.
INLINED void put_triangle(__local const float *points, uint first, uint a, uint b, uint c, __global uint *indices) {
    const bool collapsed =
        is_same_point(points, a, b) || is_same_point(points, b, c) || is_same_point(points, c, a);
    indices[0] = first + a;
    indices[1] = first + (collapsed ? a : b);
    indices[2] = first + (collapsed ? a : c);
}

static void put_indices(Draw draw, __local const float *points, uint first, __global uint *indices, uint lane) {
    const uint rate = rate_u(draw), count = rate * rate_v(draw);
    for (uint index = lane; index < count; index += GROUP) {
        const Quad quad = quad_of(rate, new_place(index % rate, index / rate));
        __global uint *own = indices + QUAD_INDICES * index;
        put_triangle(points, first, quad.a, quad.b, quad.c, own);
        put_triangle(points, first, quad.a, quad.c, quad.d, own + 3);
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_mesh(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                __global const Draw *draws, __global const MeshPlace *places, __global MeshVertex *vertices,
                __global uint *indices) {
    __local Grid grid;
    __local float points[3u * POINTS];
    const uint lane = get_local_id(0), index = get_group_id(0), zero = frame->zero;
    const Draw draw = draws[index];
    const MeshPlace place = places[index];
    const Instance known = instance(frame, objects, patches, draw.patch_id);
    __global const Patch *patch = patches + known.record;
    __global const Object *object = objects + known.object;
    prepare(zero, as_it_is(zero), object, patches, known.record, draw, &grid, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    put_vertices(frame, object, patch, draw, &grid, points, vertices + place.vertex, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    put_indices(draw, points, place.vertex, indices + 3u * (size_t)place.triangle, lane);
}
