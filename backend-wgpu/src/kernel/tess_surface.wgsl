// Mirrors core/src/tess/surface.rs: built-in evaluation: where a point of a patch is and how it faces there.
//
// On an outer edge everything depends on the edge alone, and summands are paired so that they commute when the edge is run
// the other way: patches that share it find the same bits.

// 1 / 6.
const SIXTH: f32 = 0.16666667;

// A patch as it is evaluated: what all its points need.
struct TessSurface {
    // Corners; for PN triangles two points and a normal an edge besides.
    corners: array<vec3<f32>, 4>,
    normals: array<vec3<f32>, 4>,
    // Of edge `k`, from corner `k + 1` to corner `k + 2`: the point next to the first, and next to the last.
    next: array<vec3<f32>, 6>,
    // The point in the middle of a PN triangle.
    centre: vec3<f32>,
    // Normals in the middle of edges.
    bends: array<vec3<f32>, 3>,
}

// A point and its normal.
struct Posed {
    position: vec3<f32>,
    normal: vec3<f32>,
}

// One of the four corners, of which a triangle has not got the last. Core's `new` begins so.
fn place_corner(index: u32, number: u32) {
    let is_there = number < corner_count();
    let nothing = vec3<f32>(0.0, 0.0, 0.0);
    surface.corners[number] = select(nothing, point(index, number), is_there);
    surface.normals[number] = select(nothing, normal(index, number), is_there);
}

// The control points of an edge of a PN triangle, when its corners are there.
fn bend(edge: u32) {
    let a = (edge + 1u) % 3u;
    let b = (edge + 2u) % 3u;
    let p = surface.corners[a];
    let q = surface.corners[b];
    let m = surface.normals[a];
    let n = surface.normals[b];
    surface.next[2u * edge] = next_to(p, m, q);
    surface.next[2u * edge + 1u] = next_to(q, n, p);
    surface.bends[edge] = bent(p, m, q, n);
}

// The point in the middle of a PN triangle, when its edges are there: the mean of the six, and half of its way from the mean
// of the corners.
fn place_centre() {
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    for (var edge = 0u; edge < 3u; edge++) {
        sum = add3(sum, add3(surface.next[2u * edge], surface.next[2u * edge + 1u]));
    }
    let corners = add3(add3(surface.corners[0], surface.corners[1]), surface.corners[2]);
    surface.centre = flush3(add3(scale3(sum, 0.25), scale3(corners, neg(SIXTH))));
}

// A point of patch `index` and its normal.
fn at(index: u32, coordinates: vec3<u32>) -> Posed {
    let own = weights(coordinates);
    switch tess_frame.evaluation {
        case TESS_COORDINATES: { return Posed(shares(coordinates), vec3<f32>(0.0, 0.0, 0.0)); }
        case TESS_BEZIER: { return bezier(index, shares(coordinates)); }
        case TESS_PN: { return pn(shares(coordinates)); }
        case TESS_PHONG: {
            return Posed(phong(tess_frame.phong, own), unit(sum_of(own, surface.normals)));
        }
        default: { return Posed(sum_of(own, surface.corners), unit(sum_of(own, surface.normals))); }
    }
}

// Cubic points and quadratic normals.
fn pn(t: vec3<f32>) -> Posed {
    let squares = vec4<f32>(mul(t.x, t.x), mul(t.y, t.y), mul(t.z, t.z), 0.0);
    let cubes = vec4<f32>(mul(squares.x, t.x), mul(squares.y, t.y), mul(squares.z, t.z), 0.0);
    var edges: array<vec3<f32>, 4>;
    var bends: array<vec3<f32>, 4>;
    for (var edge = 0u; edge < 3u; edge++) {
        let a = (edge + 1u) % 3u;
        let b = (edge + 2u) % 3u;
        let near = scale3(surface.next[2u * edge], mul(squares[a], t[b]));
        let far = scale3(surface.next[2u * edge + 1u], mul(squares[b], t[a]));
        edges[edge] = scale3(add3(near, far), 3.0);
        bends[edge] = scale3(surface.bends[edge], mul(t[a], t[b]));
    }
    let points = add3(sum_of(cubes, surface.corners), total(edges));
    let position = add3(points, scale3(surface.centre, mul(6.0, mul(mul(t.x, t.y), t.z))));
    let normal = add3(sum_of(squares, surface.normals), total(bends));
    return Posed(flush3(position), unit(flush3(normal)));
}

// Between the flat point and the mean of where the tangent planes at the corners have it.
fn phong(share: f32, own: vec4<f32>) -> vec3<f32> {
    let flat_point = sum_of(own, surface.corners);
    var lifts: array<vec3<f32>, 4>;
    for (var number = 0u; number < 4u; number++) {
        let n = surface.normals[number];
        let height = flush(dot3(flush3(difference(surface.corners[number], flat_point)), n));
        lifts[number] = scale3(n, mul(height, own[number]));
    }
    return flush3(add3(flat_point, scale3(flush3(total(lifts)), share)));
}

// The control point next to corner `p`, whose normal is `n`, towards corner `q`: a third of the way, in the tangent plane.
fn next_to(p: vec3<f32>, n: vec3<f32>, q: vec3<f32>) -> vec3<f32> {
    let height = flush(dot3(flush3(difference(q, p)), n));
    let level_point = add3(add3(p, p), q);
    return flush3(scale3(difference(level_point, scale3(n, height)), THIRD));
}

// The normal in the middle of an edge: those at its ends together, mirrored on the plane across the edge.
fn bent(p: vec3<f32>, m: vec3<f32>, q: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    let along = flush3(difference(q, p));
    let both = add3(m, n);
    let turned = mul(2.0, mul(flush(dot3(along, both)), recip(add(dot3(along, along), LENGTH_TINY))));
    return unit(flush3(difference(both, scale3(along, flush(turned)))));
}

// Corners times their shares.
fn sum_of(own: vec4<f32>, points: array<vec3<f32>, 4>) -> vec3<f32> {
    return flush3(total(array<vec3<f32>, 4>(
        scale3(points[0], own.x),
        scale3(points[1], own.y),
        scale3(points[2], own.z),
        scale3(points[3], own.w),
    )));
}

// Of four vectors; where two of them are zero it does not matter which.
fn total(points: array<vec3<f32>, 4>) -> vec3<f32> {
    return add3(add3(points[0], points[1]), add3(points[2], points[3]));
}

fn difference(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(sub(a.x, b.x), sub(a.y, b.y), sub(a.z, b.z));
}

// A vector made one long; zero stays zero.
fn unit(a: vec3<f32>) -> vec3<f32> {
    let square = dot3(a, a);
    if square > SHADE_TINY {
        return flush3(scale3(a, rsqrt(square)));
    }
    return vec3<f32>(0.0, 0.0, 0.0);
}

// A point of a bicubic patch, and the normal of its tangents.
fn bezier(index: u32, t: vec3<f32>) -> Posed {
    let wu = cubic(t.x);
    let wv = cubic(t.y);
    let su = cubic_slope(t.x);
    let sv = cubic_slope(t.y);
    var position: vec3<f32>;
    var along_u: vec3<f32>;
    var along_v: vec3<f32>;
    for (var axis = 0u; axis < 3u; axis++) {
        var rows: vec4<f32>;
        var slopes: vec4<f32>;
        for (var i = 0u; i < 4u; i++) {
            let c = coordinates_along_v(index, 12u * i + axis);
            rows[i] = blend4(wv, c);
            slopes[i] = blend3(sv, steps(c));
        }
        position[axis] = blend4(wu, rows);
        along_u[axis] = blend3(su, steps(rows));
        along_v[axis] = blend4(wu, slopes);
    }
    return Posed(flush3(position), unit(flush3(cross3(flush3(along_u), flush3(along_v)))));
}

// One coordinate of four points that follow each other along v.
fn coordinates_along_v(index: u32, first: u32) -> vec4<f32> {
    return vec4<f32>(
        flush(tess_patches[index].points[first]),
        flush(tess_patches[index].points[first + 3u]),
        flush(tess_patches[index].points[first + 6u]),
        flush(tess_patches[index].points[first + 9u]),
    );
}

// From each to the next.
fn steps(c: vec4<f32>) -> vec3<f32> {
    return vec3<f32>(sub(c.y, c.x), sub(c.z, c.y), sub(c.w, c.z));
}
