// Mirrors core/src/tess/evaluate.rs: a vertex of a tessellated patch: a point of its surface, moved along its normal by the
// height map.

// A vertex of patch `index` by its coordinates. A caller's own evaluation may use it, too.
fn evaluate(index: u32, coordinates: vec3<u32>) -> TessVertex {
    let posed = at(index, coordinates);
    let uv = texture_of(index, weights(coordinates));
    if tess_frame.columns == 0u {
        return vertex_of(posed.position, posed.normal, uv);
    }
    let height = height_at(place_of_height(index, coordinates, uv));
    let lift = scale3(posed.normal, flush(mul(tess_frame.scale, height)));
    return vertex_of(flush3(add3(posed.position, lift)), posed.normal, uv);
}

fn vertex_of(position: vec3<f32>, normal: vec3<f32>, uv: vec2<f32>) -> TessVertex {
    return TessVertex(
        array<f32, 3>(position.x, position.y, position.z),
        array<f32, 3>(normal.x, normal.y, normal.z),
        array<f32, 2>(uv.x, uv.y),
    );
}

// Texture coordinates: those of the corners times their shares.
fn texture_of(index: u32, own: vec4<f32>) -> vec2<f32> {
    return vec2<f32>(share_of(index, own, 0u), share_of(index, own, 1u));
}

fn share_of(index: u32, own: vec4<f32>, axis: u32) -> f32 {
    let a = mul(own.x, flush(tess_patches[index].uv[axis]));
    let b = mul(own.y, flush(tess_patches[index].uv[2u + axis]));
    let c = mul(own.z, flush(tess_patches[index].uv[4u + axis]));
    let d = mul(own.w, flush(tess_patches[index].uv[6u + axis]));
    return flush(add(add(a, b), add(c, d)));
}

// Where the height of a vertex is looked up: on outer edges and at corners where their owners have it.
fn place_of_height(index: u32, coordinates: vec3<u32>, inside: vec2<f32>) -> vec2<f32> {
    let own = weights(coordinates);
    var found = inside;
    for (var edge = 0u; edge < corner_count(); edge++) {
        if is_on_edge(coordinates, edge) {
            found = on_edge(index, own, edge);
        }
    }
    for (var number = 0u; number < corner_count(); number++) {
        if own[number] == 1.0 {
            found = vec2<f32>(
                flush(tess_patches[index].corners[2u * number]),
                flush(tess_patches[index].corners[2u * number + 1u]),
            );
        }
    }
    return found;
}

fn on_edge(index: u32, own: vec4<f32>, edge: u32) -> vec2<f32> {
    return vec2<f32>(along_edge(index, own, edge, 0u), along_edge(index, own, edge, 1u));
}

// One coordinate of a place on an edge.
fn along_edge(index: u32, own: vec4<f32>, edge: u32, axis: u32) -> f32 {
    let of_edge = ends(edge);
    let first = 4u * edge + axis;
    let a = mul(own[of_edge.x], flush(tess_patches[index].edges[first]));
    let b = mul(own[of_edge.y], flush(tess_patches[index].edges[first + 2u]));
    return flush(add(a, b));
}

// The height at a place of the height map, which repeats itself; texels are at half-integers, heights between them are
// bilinear.
fn height_at(spot: vec2<f32>) -> f32 {
    let across = texels(spot.x, tess_frame.columns);
    let up = texels(spot.y, tess_frame.rows);
    let below = mix(texel(across.before, up.before), texel(across.after, up.before), across.share);
    let above = mix(texel(across.before, up.after), texel(across.after, up.after), across.share);
    return mix(below, above, up.share);
}

fn texel(column: u32, row: u32) -> f32 {
    return flush(heights[row * tess_frame.columns + column]);
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    return flush(add(mul(a, sub(1.0, t)), mul(b, t)));
}

// The two texels of a row between which a place is, and how far it is from the first.
struct Texels {
    before: u32,
    after: u32,
    share: f32,
}

fn texels(spot: f32, count: u32) -> Texels {
    let within = sub(spot, float(floor(spot)));
    let centred = sub(mul(within, float(i32(count))), 0.5);
    let first = floor(centred);
    let share = flush(sub(centred, float(first)));
    // A place that rounding has moved to the very end is that of the last texel.
    let before = select(umin(u32(first), count - 1u), count - 1u, first < 0);
    return Texels(before, select(0u, before + 1u, before + 1u < count), share);
}
