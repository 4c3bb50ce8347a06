// Mirrors core/src/kernel/dice.rs: a drawn surface becomes a grid of vertices.
//
// A group dices one surface together; what all vertices share lies in workgroup memory: the control net,
// the weights of the columns and the iso-curves of the rows.

const STRIDE: u32 = MAX_RATE + 1u;
const GRID: u32 = STRIDE * STRIDE;

// Eye-space control net: coordinate k of control point l at 16 k + l.
var<workgroup> net: array<f32, 48>;
// Weights of each column: four of the position, three of the derivative.
var<workgroup> column_cubic: array<vec4<f32>, STRIDE>;
var<workgroup> column_slope: array<vec3<f32>, STRIDE>;
// Control points and derivatives across of each row's iso-curve: coordinate k of row r at 3 r + k.
var<workgroup> row_point: array<vec4<f32>, ROW_CURVES>;
var<workgroup> row_across: array<vec4<f32>, ROW_CURVES>;
const ROW_CURVES: u32 = 3u * STRIDE;
// Tangents no longer than this have vanished.
var<workgroup> flat_length: f32;
// The grid on screen: vertex in row r and column c at (rate + 1) r + c.
var<workgroup> grid_x: array<i32, GRID>;
var<workgroup> grid_y: array<i32, GRID>;
var<workgroup> grid_w: array<f32, GRID>;

// Control points 4 i ..= 4 i + 3 of coordinate k.
fn net_row(k: u32, i: u32) -> vec4<f32> {
    let at = 16u * k + 4u * i;
    return vec4<f32>(net[at], net[at + 1u], net[at + 2u], net[at + 3u]);
}

fn net_point(l: u32) -> vec3<f32> {
    return vec3<f32>(net[l], net[16u + l], net[32u + l]);
}

// Differences of neighbouring control points.
fn steps(p: vec4<f32>) -> vec3<f32> {
    return vec3<f32>(sub(p.y, p.x), sub(p.z, p.y), sub(p.w, p.z));
}

// Control points of the curve v = constant, one coordinate.
fn curve_point(k: u32, weights: vec4<f32>) -> vec4<f32> {
    return blend_rows(weights, net_row(k, 0u), net_row(k, 1u), net_row(k, 2u), net_row(k, 3u));
}

fn blend_rows(weights: vec4<f32>, a: vec4<f32>, b: vec4<f32>, c: vec4<f32>, d: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(blend4(weights, a), blend4(weights, b), blend4(weights, c), blend4(weights, d));
}

// Derivatives across that curve at its control points, one coordinate.
fn curve_across(k: u32, weights: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(
        blend3(weights, steps(net_row(k, 0u))),
        blend3(weights, steps(net_row(k, 1u))),
        blend3(weights, steps(net_row(k, 2u))),
        blend3(weights, steps(net_row(k, 3u))),
    );
}

// The curve in row `row`, or the weights of column `column`: one share of what the vertices need.
fn prepare_row(surface: Surface, task: u32) {
    let row = task / 3u;
    let t = param(surface.v + row * (v_size(surface) / frame.rate));
    row_point[task] = curve_point(task % 3u, cubic(t));
    row_across[task] = curve_across(task % 3u, cubic_slope(t));
}

fn prepare_column(surface: Surface, column: u32) {
    let t = param(surface.u + column * (u_size(surface) / frame.rate));
    column_cubic[column] = cubic(t);
    column_slope[column] = cubic_slope(t);
}

// A point and its derivatives along u and along v.
struct Evaluated {
    point: vec3<f32>,
    du: vec3<f32>,
    dv: vec3<f32>,
}

fn evaluate(row: u32, column: u32) -> Evaluated {
    let at = 3u * row;
    let weights = column_cubic[column];
    let slope = column_slope[column];
    let x = row_point[at];
    let y = row_point[at + 1u];
    let z = row_point[at + 2u];
    return Evaluated(
        vec3<f32>(blend4(weights, x), blend4(weights, y), blend4(weights, z)),
        vec3<f32>(blend3(slope, steps(x)), blend3(slope, steps(y)), blend3(slope, steps(z))),
        vec3<f32>(
            blend4(weights, row_across[at]),
            blend4(weights, row_across[at + 1u]),
            blend4(weights, row_across[at + 2u]),
        ),
    );
}

// Vertex number `at` of the grid at word `base`: position, snapped position, normal, colour.
fn dice(surface: Surface, object: u32, at: u32, base: u32) {
    let row = at / (frame.rate + 1u);
    let column = at % (frame.rate + 1u);
    let evaluated = evaluate_any(surface, row, column);
    let vertex = project(evaluated.point);
    grid_x[at] = vertex.x;
    grid_y[at] = vertex.y;
    grid_w[at] = vertex.w;
    put_screen(base, at, vertex);
    put_space(base, at, 0u, evaluated.point);
    var normal = unit_normal(evaluated.du, evaluated.dv, flat_length);
    if largest3(normal) < 0.5 {
        normal = mended_normal(surface, row, column);
    }
    let colour = shade(object, evaluated.point, normal);
    put_space(base, at, 3u, colour);
}

fn put_screen(base: u32, at: u32, vertex: Vertex) {
    grids[screen_base(base, 0u) + at] = bitcast<u32>(vertex.x);
    grids[screen_base(base, 1u) + at] = bitcast<u32>(vertex.y);
    grids[screen_base(base, 2u) + at] = bitcast<u32>(vertex.w);
}

fn put_space(base: u32, at: u32, first: u32, value: vec3<f32>) {
    grids[space_base(base, first) + at] = bitcast<u32>(value.x);
    grids[space_base(base, first + 1u) + at] = bitcast<u32>(value.y);
    grids[space_base(base, first + 2u) + at] = bitcast<u32>(value.z);
}

fn position_at(u: u32, v: u32) -> vec3<f32> {
    let row = cubic(param(v));
    let at = cubic(param(u));
    return vec3<f32>(
        blend4(at, curve_point(0u, row)),
        blend4(at, curve_point(1u, row)),
        blend4(at, curve_point(2u, row)),
    );
}

// Largest side of the box around the control points.
fn size() -> f32 {
    return max(max(side(0u), side(1u)), side(2u));
}

// Core's tree over the sixteen numbers, a row of four at once.
fn side(k: u32) -> f32 {
    let a = net_row(k, 0u);
    let b = net_row(k, 1u);
    let c = net_row(k, 2u);
    let d = net_row(k, 3u);
    let high = max4(max4(a, c), max4(b, d));
    let low = min4(min4(a, c), min4(b, d));
    return sub(
        max(max(high.x, high.z), max(high.y, high.w)),
        min(min(low.x, low.z), min(low.y, low.w)),
    );
}

fn max4(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z), max(a.w, b.w));
}

fn min4(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z), min(a.w, b.w));
}

fn unit_normal(du: vec3<f32>, dv: vec3<f32>, flat_below: f32) -> vec3<f32> {
    let long_u = largest3(du);
    let long_v = largest3(dv);
    let normal = cross3(scale3(du, unit_scale(long_u)), scale3(dv, unit_scale(long_v)));
    let square = dot3(normal, normal);
    let sound = long_u > flat_below && long_v > flat_below && square > PARALLEL;
    let scale = select(0.0, rsqrt(max(square, PARALLEL)), sound);
    return scale3(normal, scale);
}

fn mended_normal(surface: Surface, row: u32, column: u32) -> vec3<f32> {
    let u = surface.u + column * (u_size(surface) / frame.rate);
    let v = surface.v + row * (v_size(surface) / frame.rate);
    return normal_nearby(u, v);
}

fn inward(t: u32) -> u32 {
    return t - t / 64u + PARAM_ONE / 128u;
}

fn normal_nearby(u: u32, v: u32) -> vec3<f32> {
    let row = param(inward(v));
    let column = param(inward(u));
    let weights = cubic(column);
    let slope = cubic_slope(column);
    let row_weights = cubic(row);
    let row_slope = cubic_slope(row);
    let du = vec3<f32>(
        blend3(slope, steps(curve_point(0u, row_weights))),
        blend3(slope, steps(curve_point(1u, row_weights))),
        blend3(slope, steps(curve_point(2u, row_weights))),
    );
    let dv = vec3<f32>(
        blend4(weights, curve_across(0u, row_slope)),
        blend4(weights, curve_across(1u, row_slope)),
        blend4(weights, curve_across(2u, row_slope)),
    );
    let nearby = unit_normal(du, dv, flat_length);
    if largest3(nearby) > 0.5 {
        return nearby;
    }
    let diagonal = unit_normal(chord(0u, 15u), chord(12u, 3u), 0.0);
    if largest3(diagonal) > 0.5 {
        return diagonal;
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

fn chord(a: u32, b: u32) -> vec3<f32> {
    let to = net_point(b);
    let from_a = net_point(a);
    return vec3<f32>(sub(to.x, from_a.x), sub(to.y, from_a.y), sub(to.z, from_a.z));
}
