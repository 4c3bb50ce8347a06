// Mirrors core/src/kernel/dice_gregory.rs: as `dice.wgsl`, with other inner control points at each vertex.

// A point of a patch and its derivatives; the derivatives are the true ones, those of the blends included.
fn evaluate_gregory(at: Owner) -> Evaluated {
    let u = param(at.u);
    let v = param(at.v);
    let a = blend_here(0u, u, v);
    let b = blend_here(1u, u, v);
    let c = blend_here(2u, u, v);
    let d = blend_here(3u, u, v);
    let shares = vec4<f32>(a.share, b.share, c.share, d.share);
    let along_u = vec4<f32>(a.along_u, b.along_u, c.along_u, d.along_u);
    let along_v = vec4<f32>(a.along_v, b.along_v, c.along_v, d.along_v);
    let x = gregory_coordinate(at.n, 0u, u, v, shares, along_u, along_v);
    let y = gregory_coordinate(at.n, 1u, u, v, shares, along_u, along_v);
    let z = gregory_coordinate(at.n, 2u, u, v, shares, along_u, along_v);
    return Evaluated(vec3<f32>(x.x, y.x, z.x), vec3<f32>(x.y, y.y, z.y), vec3<f32>(x.z, y.z, z.z));
}

// Inner point `m`, one coordinate: its point for the border of constant v, and what the other differs by.
fn face_pair(n: u32, k: u32, m: u32) -> vec2<f32> {
    let at = 24u * n + 8u * k + m;
    let of_v = besides[at + 4u];
    return vec2<f32>(of_v, sub(besides[at], of_v));
}

// Row 1 or 2 of the net that the patch has at these shares of its inner points, one coordinate.
fn row_at(n: u32, k: u32, i: u32, low: f32, high: f32) -> vec4<f32> {
    let outer = net_row(n, k, i);
    let a = face_pair(n, k, 2u * i - 2u);
    let b = face_pair(n, k, 2u * i - 1u);
    return vec4<f32>(outer.x, add(a.x, mul(a.y, low)), add(b.x, mul(b.y, high)), outer.w);
}

fn gregory_coordinate(
    n: u32, k: u32, u: f32, v: f32, shares: vec4<f32>, along_u: vec4<f32>, along_v: vec4<f32>,
) -> vec3<f32> {
    let cubic_u = cubic(u);
    let cubic_v = cubic(v);
    let slope_u = cubic_slope(u);
    let slope_v = cubic_slope(v);
    let a = face_pair(n, k, 0u);
    let b = face_pair(n, k, 1u);
    let c = face_pair(n, k, 2u);
    let d = face_pair(n, k, 3u);
    let row0 = net_row(n, k, 0u);
    let row1 = row_at(n, k, 1u, shares.x, shares.y);
    let row2 = row_at(n, k, 2u, shares.z, shares.w);
    let row3 = net_row(n, k, 3u);
    let moved = vec4<f32>(
        mul(a.y, mul(cubic_u.y, cubic_v.y)),
        mul(b.y, mul(cubic_u.y, cubic_v.z)),
        mul(c.y, mul(cubic_u.z, cubic_v.y)),
        mul(d.y, mul(cubic_u.z, cubic_v.z)),
    );
    let curve = blend_rows(cubic_v, row0, row1, row2, row3);
    let across = vec4<f32>(
        blend3(slope_v, steps(row0)),
        blend3(slope_v, steps(row1)),
        blend3(slope_v, steps(row2)),
        blend3(slope_v, steps(row3)),
    );
    return vec3<f32>(
        blend4(cubic_u, curve),
        add(blend3(slope_u, steps(curve)), change(along_u, moved)),
        add(blend4(cubic_u, across), change(along_v, moved)),
    );
}

// What moving inner points add to a derivative.
fn change(along: vec4<f32>, moved: vec4<f32>) -> f32 {
    let first = add(add(0.0, mul(along.x, moved.x)), mul(along.y, moved.y));
    return add(add(first, mul(along.z, moved.z)), mul(along.w, moved.w));
}
