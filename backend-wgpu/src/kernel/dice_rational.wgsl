// Mirrors core/src/kernel/dice_rational.rs and core/src/patch/rational.rs (evaluate): rational patches, vertex by vertex.

// Row i of the weights of net n.
fn weights_row(n: u32, i: u32) -> vec4<f32> {
    let at = 24u * n + 4u * i;
    return vec4<f32>(besides[at], besides[at + 1u], besides[at + 2u], besides[at + 3u]);
}

// Row i of coordinate k of net n, multiplied by its weights; of the weights themselves if k is 3.
fn weighted_row(n: u32, k: u32, i: u32) -> vec4<f32> {
    let weights = weights_row(n, i);
    if k == 3u {
        return weights;
    }
    let row = net_row(n, k, i);
    return vec4<f32>(
        mul(row.x, weights.x), mul(row.y, weights.y), mul(row.z, weights.z), mul(row.w, weights.w));
}

// Coordinate k, before it is divided by the weight, and its derivatives along u and along v.
fn weighted_coordinate(at: Owner, k: u32) -> vec3<f32> {
    let slope_v = cubic_slope(param(at.v));
    let cubic_u = cubic(param(at.u));
    let row0 = weighted_row(at.n, k, 0u);
    let row1 = weighted_row(at.n, k, 1u);
    let row2 = weighted_row(at.n, k, 2u);
    let row3 = weighted_row(at.n, k, 3u);
    let curve = blend_rows(cubic(param(at.v)), row0, row1, row2, row3);
    let across = vec4<f32>(
        blend3(slope_v, steps(row0)),
        blend3(slope_v, steps(row1)),
        blend3(slope_v, steps(row2)),
        blend3(slope_v, steps(row3)),
    );
    let slope_u = cubic_slope(param(at.u));
    return vec3<f32>(blend4(cubic_u, curve), blend3(slope_u, steps(curve)), blend4(cubic_u, across));
}

// A point of a patch and its derivatives, by the quotient rule.
fn evaluate_rational(at: Owner) -> Evaluated {
    let weight = weighted_coordinate(at, 3u);
    let scale = recip(weight.x);
    var out: Evaluated;
    for (var k = 0u; k < 3u; k++) {
        let sum = weighted_coordinate(at, k);
        out.point[k] = mul(sum.x, scale);
        out.du[k] = quotient(out.point[k], sum.y, weight.y, scale);
        out.dv[k] = quotient(out.point[k], sum.z, weight.z, scale);
    }
    return out;
}

// The derivative of a quotient that is `at`, given those of numerator and denominator and 1 / denominator.
fn quotient(at: f32, above: f32, below: f32, scale: f32) -> f32 {
    return mul(sub(above, mul(at, below)), scale);
}
