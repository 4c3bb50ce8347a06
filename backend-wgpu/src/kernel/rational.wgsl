// Mirrors core/src/patch/rational.rs: every control point has a weight.

struct Weights {
    at: array<f32, 16>,
}

// From the record that holds them.
fn weights_of(record: u32) -> Weights {
    var weights: Weights;
    for (var l = 0u; l < 16u; l++) {
        weights.at[l] = control_point(record, l).x;
    }
    return weights;
}

// Control points multiplied by their weights.
fn homogeneous(weights: Weights, net: Net) -> Net {
    var w = weights;
    var out = net;
    for (var l = 0u; l < 16u; l++) {
        out.x[l] = mul(out.x[l], w.at[l]);
        out.y[l] = mul(out.y[l], w.at[l]);
        out.z[l] = mul(out.z[l], w.at[l]);
    }
    return out;
}

// Control points of a part of a patch, not multiplied by their weights, given them multiplied.
fn divided_by(weighted: Net, weights: Weights, range: vec4<u32>) -> Net {
    var part = weighted;
    var w = combine_v(combine_u(weights.at, blossom(range.x, range.y)), blossom(range.z, range.w));
    for (var l = 0u; l < 16u; l++) {
        let scale = recip(w[l]);
        part.x[l] = mul(part.x[l], scale);
        part.y[l] = mul(part.y[l], scale);
        part.z[l] = mul(part.z[l], scale);
    }
    return part;
}

// The point alone of a vertex of a patch that is given as `homogeneous`.
fn rational_position(weights: Weights, weighted: Net, u: u32, v: u32) -> vec3<f32> {
    let weight = coordinate_at(weights.at, cubic(param(u)), cubic(param(v)));
    return scale3(position_at(weighted, u, v), recip(weight));
}
