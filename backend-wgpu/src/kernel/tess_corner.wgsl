// Mirrors core/src/tess/corner.rs: corners and outer edges of a patch, and the share that each corner has in a point.

// Where the normals of a patch begin among its points.
const NORMALS: u32 = 4u;
// A coordinate's unit, 2^-16.
const TESS_STEP: f32 = 0.0000152587890625;

// The corners at which an outer edge begins and ends, on its way around the patch.
fn ends(edge: u32) -> vec2<u32> {
    if tess_frame.domain == TESS_TRIANGLES {
        return vec2<u32>((edge + 1u) % 3u, (edge + 2u) % 3u);
    }
    return vec2<u32>((edge + 3u) % 4u, edge);
}

// Number of corners, and of outer edges.
fn corner_count() -> u32 {
    return select(4u, 3u, tess_frame.domain == TESS_TRIANGLES);
}

// Is a point on an outer edge?
fn is_on_edge(coordinates: vec3<u32>, edge: u32) -> bool {
    if tess_frame.domain == TESS_TRIANGLES {
        return coordinates[edge] == 0u;
    }
    // Edges 2 and 3 are across from 0 and 1.
    return coordinates[edge % 2u] == select(0u, TESS_UNIT, edge > 1u);
}

// Coordinates as floats: exact.
fn shares(coordinates: vec3<u32>) -> vec3<f32> {
    return vec3<f32>(
        mul(float(i32(coordinates.x)), TESS_STEP),
        mul(float(i32(coordinates.y)), TESS_STEP),
        mul(float(i32(coordinates.z)), TESS_STEP),
    );
}

// How much of each corner is in a point. On an outer edge this is exact, and 0 for the corners across.
fn weights(coordinates: vec3<u32>) -> vec4<f32> {
    let own = shares(coordinates);
    if tess_frame.domain == TESS_TRIANGLES {
        return vec4<f32>(own, 0.0);
    }
    let s = sub(1.0, own.x);
    let t = sub(1.0, own.y);
    return vec4<f32>(mul(s, t), mul(own.x, t), mul(own.x, own.y), mul(s, own.y));
}

// A point of patch `index`, by its number.
fn point(index: u32, number: u32) -> vec3<f32> {
    let at = 3u * number;
    return flush3(vec3<f32>(
        tess_patches[index].points[at],
        tess_patches[index].points[at + 1u],
        tess_patches[index].points[at + 2u],
    ));
}

// The normal at a corner.
fn normal(index: u32, number: u32) -> vec3<f32> {
    return point(index, NORMALS + number);
}

// A corner of a patch, wherever it is among its points.
fn corner(index: u32, number: u32) -> vec3<f32> {
    return point(index, select(number, bezier_corner(number), tess_frame.evaluation == TESS_BEZIER));
}

// Which of the 16 points of a Bezier patch a corner is.
fn bezier_corner(number: u32) -> u32 {
    let u = select(0u, 12u, number == 1u || number == 2u);
    return u + select(0u, 3u, number > 1u);
}
