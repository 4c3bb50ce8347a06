// Mirrors core/src/kernel/dice_gregory.rs: as `dice.cl`, with other inner control points at each vertex.

// What moving inner points add to a derivative, one coordinate; `moved` are their differences times weights.
static float change(uint zero, float4 along, float4 moved) {
    const float first = add(add(0.0f, mul(along.x, moved.x)), mul(along.y, moved.y));
    return add(add(first, mul(along.z, moved.z)), mul(along.w, moved.w));
}

// Bernstein weights of the inner points.
static float4 inner_weights(uint zero, float4 cubic_u, float4 cubic_v) {
    return (float4)(mul(cubic_u.y, cubic_v.y), mul(cubic_u.y, cubic_v.z), mul(cubic_u.z, cubic_v.y),
                    mul(cubic_u.z, cubic_v.z));
}

// The inner points at these shares, one coordinate.
static float4 inner_points(uint zero, __local const float *f, float4 share) {
    const float4 of_v = vload4(1, f);
    return add4(zero, of_v, mul4(zero, sub4(zero, vload4(0, f), of_v), share));
}

// A coordinate of a point and of its derivatives along u and along v; `c` and `f` are the net's and the faces'.
static float3 gregory_coordinate(uint zero, __local const float *c, __local const float *f, float u, float v,
                                 float4 share, float4 along_u, float4 along_v) {
    const float4 cubic_u = cubic(zero, u), cubic_v = cubic(zero, v);
    const float3 slope_u = cubic_slope(zero, u), slope_v = cubic_slope(zero, v);
    const float4 differences = sub4(zero, vload4(0, f), vload4(1, f));
    const float4 inside = inner_points(zero, f, share);
    const float4 moved = mul4(zero, differences, inner_weights(zero, cubic_u, cubic_v));
    const float4 row0 = vload4(0, c), row3 = vload4(3, c);
    const float4 row1 = (float4)(c[4], inside.x, inside.y, c[7]);
    const float4 row2 = (float4)(c[8], inside.z, inside.w, c[11]);
    const float4 curve = (float4)(blend4(zero, cubic_v, row0), blend4(zero, cubic_v, row1),
                                  blend4(zero, cubic_v, row2), blend4(zero, cubic_v, row3));
    const float4 across =
        (float4)(blend3(zero, slope_v, along(zero, row0)), blend3(zero, slope_v, along(zero, row1)),
                 blend3(zero, slope_v, along(zero, row2)), blend3(zero, slope_v, along(zero, row3)));
    return (float3)(blend4(zero, cubic_u, curve),
                    add(blend3(zero, slope_u, along(zero, curve)), change(zero, along_u, moved)),
                    add(blend4(zero, cubic_u, across), change(zero, along_v, moved)));
}

// Position at a parameter, and the derivatives there along u and along v.
static void evaluate_gregory(__constant Frame *frame, __local const Source *source, uint2 at, float3 *position,
                             float3 *du, float3 *dv) {
    const uint zero = frame->zero;
    const float u = param(zero, at.x), v = param(zero, at.y);
    const float3 a = blend_here(frame, 0u, u, v), b = blend_here(frame, 1u, u, v);
    const float3 c = blend_here(frame, 2u, u, v), d = blend_here(frame, 3u, u, v);
    const float4 share = (float4)(a.x, b.x, c.x, d.x);
    const float4 along_u = (float4)(a.y, b.y, c.y, d.y), along_v = (float4)(a.z, b.z, c.z, d.z);
    __local const float *net = source->net;
    __local const float *faces = source->more;
    const float3 x = gregory_coordinate(zero, net, faces, u, v, share, along_u, along_v);
    const float3 y = gregory_coordinate(zero, net + 16, faces + 8, u, v, share, along_u, along_v);
    const float3 z = gregory_coordinate(zero, net + 32, faces + 16, u, v, share, along_u, along_v);
    *position = (float3)(x.x, y.x, z.x);
    *du = (float3)(x.y, y.y, z.y);
    *dv = (float3)(x.z, y.z, z.z);
}
