// Mirrors core/src/kernel/mesh.rs (mesh): drawn surfaces become vertices and triangles, one group a draw.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
// As many as are to be meshed: its binding ends there.
@group(0) @binding(3) var<storage, read> draws: array<Draw>;
@group(0) @binding(4) var<storage, read> places: array<MeshPlace>;
@group(0) @binding(5) var<storage, read_write> vertices: array<MeshVertex>;
@group(0) @binding(6) var<storage, read_write> indices: array<u32>;
@group(0) @binding(7) var<storage, read> patches_more: array<Patch>;

// Positions of the grid's vertices, row after row.
var<workgroup> positions: array<vec3<f32>, GRID>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let index = group_index(group);
    if index >= arrayLength(&draws) {
        return;
    }
    let draw = draws[index];
    let base = places[index];
    let placed = instance(draw.patch_id);
    let rates = draw_rates(draw);
    let stride = rates.x + 1u;
    prepare(draw, placed, rates, lane);
    workgroupBarrier();
    for (var at = lane; at < stride * (rates.y + 1u); at += GROUP) {
        vertices[base.vertex + at] = vertex_at(draw, placed, at, at / stride, at % stride);
    }
    workgroupBarrier();
    for (var quad = lane; quad < rates.x * rates.y; quad += GROUP) {
        let a = quad / rates.x * stride + quad % rates.x;
        let first = 3u * (base.triangle + 2u * quad);
        put_triangle(first, base.vertex, vec3<u32>(a, a + 1u, a + stride + 1u));
        put_triangle(first + 3u, base.vertex, vec3<u32>(a, a + stride + 1u, a + stride));
    }
}

fn vertex_at(draw: Draw, placed: Instance, at: u32, row: u32, column: u32) -> MeshVertex {
    let diced = dice_any(draw, placed, row, column);
    let point = diced.point;
    let normal = diced.normal;
    positions[at] = point;
    let uv = vertex_of(draw, row, column);
    return MeshVertex(
        array<f32, 3>(point.x, point.y, point.z),
        array<f32, 3>(normal.x, normal.y, normal.z),
        array<f32, 2>(param(uv.x), param(uv.y)),
        draw.patch_id,
    );
}

// Indices of a triangle of the grid, or thrice the same one.
fn put_triangle(at: u32, vertex: u32, corners: vec3<u32>) {
    let a = positions[corners.x];
    let b = positions[corners.y];
    let c = positions[corners.z];
    let has_collapsed = all(a == b) || all(b == c) || all(c == a);
    let own = vertex + select(corners, corners.xxx, has_collapsed);
    indices[at] = own.x;
    indices[at + 1u] = own.y;
    indices[at + 2u] = own.z;
}
