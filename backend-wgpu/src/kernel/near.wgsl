// Mirrors `sample_quad` of core/src/kernel/sample.rs for grids that are small and whole.

const KIND: u32 = KIND_NEAR;
// Draws that are looked at at once, and so many are enough to be sampled together; see `tiles.wgsl`.
const WINDOW: u32 = 64u;
const ENOUGH: u32 = 32u;

fn sample_item(base: u32, item: Item, key: u32) {
    let a = vertex_at(base, item.corners.x);
    let b = vertex_at(base, item.corners.y);
    let c = vertex_at(base, item.corners.z);
    let d = vertex_at(base, item.corners.w);
    let pixels = pixels_of_quad(a, b, c, d);
    if pixels.x >= pixels.y {
        return;
    }
    var x = pixels.x;
    var y = pixels.z;
    while y < pixels.w {
        let w = sample_quad(a, b, c, d, x, y);
        if w > 0.0 {
            put(x, y, w, key);
        }
        x += 1;
        if x == pixels.y {
            x = pixels.x;
            y += 1;
        }
    }
}

// 1 / distance at the centre of a pixel if one of the quad's two triangles, a b c and a c d, owns it; of two
// that overlap, the nearer; 0 if there is none.
fn sample_quad(v_a: Vertex, v_b: Vertex, v_c: Vertex, v_d: Vertex, column: i32, row: i32) -> f32 {
    let a = corner(v_a, column, row);
    let b = corner(v_b, column, row);
    let c = corner(v_c, column, row);
    let d = corner(v_d, column, row);
    let diagonal = edge(c, a);
    let first = vec3<i32>(edge(b, c), diagonal, edge(a, b));
    let second = vec3<i32>(edge(c, d), edge(d, a), 0 - diagonal);
    var owners = select(0u, 1u, owns_near(a, b, c, first)) | select(0u, 2u, owns_near(a, c, d, second));
    var nearest = 0.0;
    while owners != 0u {
        let is_first = (owners & 1u) != 0u;
        let w = vec3<f32>(a.w, select(c.w, b.w, is_first), select(d.w, c.w, is_first));
        nearest = max(nearest, depth_near(w, select(second, first, vec3<bool>(is_first))));
        owners &= owners - 1u;
    }
    return nearest;
}

fn owns_near(a: Corner, b: Corner, c: Corner, edges: vec3<i32>) -> bool {
    let signs = vec3<i32>(int_sign(edges.x), int_sign(edges.y), int_sign(edges.z));
    return owns(a, b, c, signs, int_sign(edges.x + edges.y + edges.z));
}

// 1 / distance from the edges of the triangle that owns the sample.
fn depth_near(w: vec3<f32>, edges: vec3<i32>) -> f32 {
    let whole = magnitude(edges.x + edges.y + edges.z);
    let spare = spare_bits(32u + countLeadingZeros(whole));
    return depth(w, whole >> spare, magnitude(edges.y) >> spare, magnitude(edges.z) >> spare);
}
