// Mirrors `micropolygon`, `clipped` and `triangle` of core/src/kernel/sample.rs: any grid whatever.

const KIND: u32 = KIND_GENERAL;
// Draws that are looked at at once, and so many are enough to be sampled together: few, since each may be long
// work. See `tiles.wgsl`.
const WINDOW: u32 = 16u;
const ENOUGH: u32 = 1u;

fn sample_item(base: u32, item: Item, key: u32) {
    let a = vertex_at(base, item.corners.x);
    let b = vertex_at(base, item.corners.y);
    let c = vertex_at(base, item.corners.z);
    let d = vertex_at(base, item.corners.w);
    let whole = a.w > 0.0 && b.w > 0.0 && c.w > 0.0 && d.w > 0.0;
    if whole {
        micropolygon(a, b, c, d, key);
    } else {
        let from_a = space_at(base, item.corners.x, 0u);
        let to_c = space_at(base, item.corners.z, 0u);
        clipped(from_a, space_at(base, item.corners.y, 0u), to_c, key);
        clipped(from_a, to_c, space_at(base, item.corners.w, 0u), key);
    }
}

// One quad, as the triangles a b c and a c d.
fn micropolygon(a: Vertex, b: Vertex, c: Vertex, d: Vertex, key: u32) {
    let pixels = pixels_of_quad(a, b, c, d);
    for (var y = pixels.z; y < pixels.w; y++) {
        for (var x = pixels.x; x < pixels.y; x++) {
            let w = max(sample_triangle(a, b, c, x, y), sample_triangle(a, c, d, x, y));
            if w > 0.0 {
                put(x, y, w, key);
            }
        }
    }
}

// Clips a triangle and samples what is left of it, as a fan.
fn clipped(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, key: u32) {
    var polygon = clip(a, b, c);
    for (var k = 2u; k < polygon.count; k++) {
        triangle(
            project_clipped(polygon.corners[0]),
            project_clipped(polygon.corners[k - 1u]),
            project_clipped(polygon.corners[k]),
            key,
        );
    }
}

fn triangle(a: Vertex, b: Vertex, c: Vertex, key: u32) {
    let pixels = pixels_of_quad(a, b, c, c);
    for (var y = pixels.z; y < pixels.w; y++) {
        for (var x = pixels.x; x < pixels.y; x++) {
            let w = sample_triangle(a, b, c, x, y);
            if w > 0.0 {
                put(x, y, w, key);
            }
        }
    }
}
