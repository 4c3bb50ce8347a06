// Mirrors core/src/patch/net.rs: sixteen control points in eye space, index 4 i + j with i along u.

struct Net {
    x: array<f32, 16>,
    y: array<f32, 16>,
    z: array<f32, 16>,
}

// Patches beyond the length of `patches` lie in `patches_more`: one buffer may be too large to be bound.
fn object_of(patch_id: u32) -> u32 {
    let here = arrayLength(&patches);
    if patch_id < here {
        return patches[patch_id].object;
    }
    return patches_more[patch_id - here].object;
}

// The record of the face points of a Gregory patch or of the weights of a rational one, or 0.
fn faces_of(patch_id: u32) -> u32 {
    let here = arrayLength(&patches);
    if patch_id < here {
        return patches[patch_id].faces;
    }
    return patches_more[patch_id - here].faces;
}

// Bits of what a patch is besides.
fn kind_of(patch_id: u32) -> u32 {
    let here = arrayLength(&patches);
    if patch_id < here {
        return patches[patch_id].kind;
    }
    return patches_more[patch_id - here].kind;
}

// The owner of a side or corner: see core/src/patch/owner.rs.
fn owner_word(patch_id: u32, word: u32) -> u32 {
    let here = arrayLength(&patches);
    if patch_id < here {
        return patches[patch_id].owners[word];
    }
    return patches_more[patch_id - here].owners[word];
}

fn control_point(patch_id: u32, l: u32) -> vec3<f32> {
    let here = arrayLength(&patches);
    if patch_id < here {
        return vec3<f32>(patches[patch_id].x[l], patches[patch_id].y[l], patches[patch_id].z[l]);
    }
    let there = patch_id - here;
    return vec3<f32>(patches_more[there].x[l], patches_more[there].y[l], patches_more[there].z[l]);
}

// One coordinate of a point, given its row of a matrix.
fn row_of_matrix(row: vec4<f32>, p: vec3<f32>) -> f32 {
    return add(add(add(mul(row.x, p.x), mul(row.y, p.y)), mul(row.z, p.z)), row.w);
}

// One coordinate (0, 1, 2) of a point of an object's space, moved to eye space.
fn coordinate_to_eye(object: u32, k: u32, point: vec3<f32>) -> f32 {
    return row_of_matrix(row_to_eye(object, k), point);
}

fn point_to_eye(object: u32, point: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        coordinate_to_eye(object, 0u, point),
        coordinate_to_eye(object, 1u, point),
        coordinate_to_eye(object, 2u, point),
    );
}

// One eye-space coordinate of control point `l`.
fn transformed(patch_id: u32, object: u32, k: u32, l: u32) -> f32 {
    return coordinate_to_eye(object, k, control_point(patch_id, l));
}

fn in_eye_space(patch_id: u32, object: u32) -> Net {
    var net: Net;
    for (var l = 0u; l < 16u; l++) {
        let point = point_to_eye(object, control_point(patch_id, l));
        net.x[l] = point.x;
        net.y[l] = point.y;
        net.z[l] = point.z;
    }
    return net;
}

// The smallest (or largest) of sixteen numbers, reduced in core's tree.
fn fold_min(lanes: array<f32, 16>) -> f32 {
    var all = lanes;
    for (var width = 8u; width > 0u; width /= 2u) {
        for (var l = 0u; l < width; l++) {
            all[l] = min(all[l], all[l + width]);
        }
    }
    return all[0];
}

fn fold_max(lanes: array<f32, 16>) -> f32 {
    var all = lanes;
    for (var width = 8u; width > 0u; width /= 2u) {
        for (var l = 0u; l < width; l++) {
            all[l] = max(all[l], all[l + width]);
        }
    }
    return all[0];
}

fn extent(net: Net) -> f32 {
    var largest: array<f32, 16>;
    for (var l = 0u; l < 16u; l++) {
        largest[l] = max(max(abs(net.x[l]), abs(net.y[l])), abs(net.z[l]));
    }
    return fold_max(largest);
}

fn restricted(net: Net, surface: Surface) -> Net {
    return net_between(net, range_of(surface));
}

// The low and the high end of u, then those of v.
fn range_of(surface: Surface) -> vec4<u32> {
    return vec4<u32>(surface.u, surface.u + u_size(surface), surface.v, surface.v + v_size(surface));
}

fn net_between(net: Net, range: vec4<u32>) -> Net {
    let along_u = blossom(range.x, range.y);
    let along_v = blossom(range.z, range.w);
    return Net(
        combine_v(combine_u(net.x, along_u), along_v),
        combine_v(combine_u(net.y, along_u), along_v),
        combine_v(combine_u(net.z, along_u), along_v),
    );
}

fn combine_u(points: array<f32, 16>, weights: Blossom) -> array<f32, 16> {
    var c = points;
    var rows = weights.rows;
    var out: array<f32, 16>;
    for (var k = 0u; k < 4u; k++) {
        for (var j = 0u; j < 4u; j++) {
            out[4u * k + j] = blend4(rows[k], vec4<f32>(c[j], c[4u + j], c[8u + j], c[12u + j]));
        }
    }
    return out;
}

fn combine_v(points: array<f32, 16>, weights: Blossom) -> array<f32, 16> {
    var c = points;
    var rows = weights.rows;
    var out: array<f32, 16>;
    for (var i = 0u; i < 4u; i++) {
        for (var l = 0u; l < 4u; l++) {
            out[4u * i + l] =
                blend4(rows[l], vec4<f32>(c[4u * i], c[4u * i + 1u], c[4u * i + 2u], c[4u * i + 3u]));
        }
    }
    return out;
}
