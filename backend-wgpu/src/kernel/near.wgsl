// Mirrors `sample_quad` of core/src/kernel/sample.rs for grids that are small and whole.

const KIND: u32 = KIND_NEAR;
// Draws that are sampled together by `tiles.wgsl`.
const TOGETHER: u32 = LISTED;

fn sample_item(base: u32, item: Item, key: u32) {
    let a = vertex_at(base, item.corners.x);
    let b = vertex_at(base, item.corners.y);
    let c = vertex_at(base, item.corners.z);
    let d = vertex_at(base, item.corners.w);
    let box = samples_of_quad(a, b, c, d);
    if box.x >= box.y {
        return;
    }
    var x = box.x;
    var y = box.z;
    while y < box.w {
        let found = sample_quad(a, b, c, d, site(x, y));
        if found.hit.w > 0.0 {
            put(x, y, found, key);
        }
        x += 1;
        if x == box.y {
            x = box.x;
            y += 1;
        }
    }
}

// What a micropolygon that was found at a sample shows there.
fn found_again(base: u32, item: Item, at: vec2<i32>) -> Found {
    return sample_quad(
        vertex_at(base, item.corners.x),
        vertex_at(base, item.corners.y),
        vertex_at(base, item.corners.z),
        vertex_at(base, item.corners.w),
        at,
    );
}

// What the quad shows at a sample if one of its two triangles, a b c and a c d, owns it; of two that overlap, the nearer,
// of two equally near the first.
fn sample_quad(v_a: Vertex, v_b: Vertex, v_c: Vertex, v_d: Vertex, at: vec2<i32>) -> Found {
    let a = corner(v_a, at);
    let b = corner(v_b, at);
    let c = corner(v_c, at);
    let d = corner(v_d, at);
    let diagonal = edge(c, a);
    let first = vec3<i32>(edge(b, c), diagonal, edge(a, b));
    let second = vec3<i32>(edge(c, d), edge(d, a), 0 - diagonal);
    var owners = select(0u, 1u, owns_near(a, b, c, first)) | select(0u, 2u, owns_near(a, c, d, second));
    var nearest = Found(NO_HIT, PART_FIRST);
    while owners != 0u {
        let is_first = (owners & 1u) != 0u;
        let w = vec3<f32>(a.w, select(c.w, b.w, is_first), select(d.w, c.w, is_first));
        let found = hit_near(w, select(second, first, vec3<bool>(is_first)));
        if found.w > nearest.hit.w {
            nearest = Found(found, select(PART_SECOND, PART_FIRST, is_first));
        }
        owners &= owners - 1u;
    }
    return nearest;
}

fn owns_near(a: Corner, b: Corner, c: Corner, edges: vec3<i32>) -> bool {
    let signs = vec3<i32>(int_sign(edges.x), int_sign(edges.y), int_sign(edges.z));
    return owns(a, b, c, signs, int_sign(edges.x + edges.y + edges.z));
}

// From the edges of the triangle that owns the sample.
fn hit_near(w: vec3<f32>, edges: vec3<i32>) -> Hit {
    let whole = magnitude(edges.x + edges.y + edges.z);
    let spare = spare_bits(32u + countLeadingZeros(whole));
    return hit(w, whole >> spare, magnitude(edges.y) >> spare, magnitude(edges.z) >> spare);
}
