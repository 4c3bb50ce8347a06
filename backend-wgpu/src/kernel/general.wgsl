// Mirrors `micropolygon`, `clipped` and `triangle` of core/src/kernel/sample.rs: any grid whatever.

const KIND: u32 = KIND_GENERAL;
// Draws that are sampled together by `tiles.wgsl`: few, since each may be long work.
const TOGETHER: u32 = 16u;
// The first of a quad's samples that this invocation looks at, and how many farther the next one is.
var<private> share: vec2<i32> = vec2<i32>(0, 1);

fn sample_item(base: u32, item: Item, key: u32) {
    let a = vertex_at(base, item.corners.x);
    let b = vertex_at(base, item.corners.y);
    let c = vertex_at(base, item.corners.z);
    let d = vertex_at(base, item.corners.w);
    if is_whole(a, b, c, d) {
        micropolygon(a, b, c, d, key);
    } else {
        let from_a = space_at(base, item.corners.x, 0u);
        let to_c = space_at(base, item.corners.z, 0u);
        clipped(from_a, space_at(base, item.corners.y, 0u), to_c, key);
        clipped(from_a, to_c, space_at(base, item.corners.w, 0u), key);
    }
}

fn is_whole(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> bool {
    return a.w > 0.0 && b.w > 0.0 && c.w > 0.0 && d.w > 0.0;
}

// Sample number `index` of a box.
fn sample_in(box: vec4<i32>, index: i32) -> vec2<i32> {
    let wide = box.y - box.x;
    return vec2<i32>(box.x + index % wide, box.z + index / wide);
}

fn count_in(box: vec4<i32>) -> i32 {
    return imax(box.y - box.x, 0) * imax(box.w - box.z, 0);
}

// One quad, as the triangles a b c and a c d.
fn micropolygon(a: Vertex, b: Vertex, c: Vertex, d: Vertex, key: u32) {
    let box = samples_of_quad(a, b, c, d);
    for (var index = share.x; index < count_in(box); index += share.y) {
        let at = sample_in(box, index);
        let found = sample_quad(a, b, c, d, site(at.x, at.y));
        if found.hit.w > 0.0 {
            put(at.x, at.y, found, key);
        }
    }
}

// What a quad shows at a sample: of two triangles that overlap, the nearer, of two equally near the first.
fn sample_quad(a: Vertex, b: Vertex, c: Vertex, d: Vertex, at: vec2<i32>) -> Found {
    let first = sample_triangle(a, b, c, at);
    let second = sample_triangle(a, c, d, at);
    if second.w > first.w {
        return Found(second, PART_SECOND);
    }
    return Found(first, PART_FIRST);
}

// What a micropolygon that was found at a sample shows there.
fn found_again(base: u32, item: Item, at: vec2<i32>) -> Found {
    let a = vertex_at(base, item.corners.x);
    let b = vertex_at(base, item.corners.y);
    let c = vertex_at(base, item.corners.z);
    let d = vertex_at(base, item.corners.w);
    if is_whole(a, b, c, d) {
        return sample_quad(a, b, c, d, at);
    }
    return Found(NO_HIT, PART_CLIPPED);
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
    let box = samples_of_quad(a, b, c, c);
    for (var index = share.x; index < count_in(box); index += share.y) {
        let at = sample_in(box, index);
        let found = sample_triangle(a, b, c, site(at.x, at.y));
        if found.w > 0.0 {
            put(at.x, at.y, Found(found, PART_CLIPPED), key);
        }
    }
}
