// Mirrors core/src/tess/control.rs: which levels a patch has. The level of an edge depends on nothing but the edge, the same
// from either end.

// Levels of patch `index`: its own, those of all patches, or by its edges. A caller's own control may use it, too.
fn built_in_levels(index: u32) -> TessLevels {
    if tess_frame.control == TESS_GIVEN {
        return levels[index];
    }
    if tess_frame.control == TESS_CONSTANT {
        return TessLevels(tess_frame.outer, tess_frame.inner);
    }
    var edges = array<f32, 4>(1.0, 1.0, 1.0, 1.0);
    for (var edge = 0u; edge < corner_count(); edge++) {
        edges[edge] = edge_level(index, edge);
    }
    let across_u = max(edges[1], edges[3]);
    let across_v = max(edges[0], edges[2]);
    switch tess_frame.domain {
        case TESS_TRIANGLES: {
            let most = max(max(edges[0], edges[1]), edges[2]);
            return TessLevels(edges, array<f32, 2>(most, 1.0));
        }
        case TESS_ISOLINES: {
            return TessLevels(array<f32, 4>(across_v, across_u, 1.0, 1.0), array<f32, 2>(1.0, 1.0));
        }
        default: { return TessLevels(edges, array<f32, 2>(across_u, across_v)); }
    }
}

// Level of an outer edge: never below 1, so that no patch is dropped.
fn edge_level(index: u32, edge: u32) -> f32 {
    let of_edge = ends(edge);
    let middle = scale3(add3(corner(index, of_edge.x), corner(index, of_edge.y)), 0.5);
    let eye = vec3<f32>(tess_frame.eye[0], tess_frame.eye[1], tess_frame.eye[2]);
    let near = mul(tess_frame.factor, recip(length(minus(middle, eye))));
    if tess_frame.control == TESS_LENGTH {
        return max(mul(near, edge_length(index, of_edge)), 1.0);
    }
    return max(near, 1.0);
}

// How long an edge is, or the legs of its control points.
fn edge_length(index: u32, corners: vec2<u32>) -> f32 {
    let a = corner(index, corners.x);
    let d = corner(index, corners.y);
    if tess_frame.evaluation != TESS_BEZIER {
        return length(minus(d, a));
    }
    let first = bezier_corner(corners.x);
    let last = bezier_corner(corners.y);
    let b = point(index, (2u * first + last) / 3u);
    let c = point(index, (first + 2u * last) / 3u);
    return add(add(length(minus(b, a)), length(minus(d, c))), length(minus(c, b)));
}

fn minus(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return flush3(add3(a, vec3<f32>(neg(b.x), neg(b.y), neg(b.z))));
}

// Length of a vector, never 0.
fn length(a: vec3<f32>) -> f32 {
    return sqrt(add(dot3(a, a), LENGTH_TINY));
}
