// Mirrors core/src/kernel/dice.rs: a drawn surface becomes a grid of vertices.
//
// A group dices one surface together; what all vertices share lies in workgroup memory: the control net,
// the weights of the columns and the iso-curves of the rows; and vertices of the border, which may lie anywhere on it.

const STRIDE: u32 = MAX_RATE + 1u;
const GRID: u32 = STRIDE * STRIDE;
// Vertices on the border of the largest grid.
const BORDER: u32 = 4u * MAX_RATE;

const GROUP: u32 = 64u;
// An invocation each prepares what vertices share.
const_assert BORDER <= GROUP && ROW_CURVES <= GROUP;

// Control nets; the patch's own is number 0. Coordinate k of control point l of net n at 48 n + 16 k + l.
var<workgroup> nets: array<f32, 48u * NETS>;
// Parameters of columns and rows where the grid is regular.
var<workgroup> column_u: array<u32, STRIDE>;
var<workgroup> row_v: array<u32, STRIDE>;
// Weights of each column: four of the position, three of the derivative.
var<workgroup> column_cubic: array<vec4<f32>, STRIDE>;
var<workgroup> column_slope: array<vec3<f32>, STRIDE>;
// Control points and derivatives across of each row's iso-curve: coordinate k of row r at 3 r + k.
var<workgroup> row_point: array<vec4<f32>, ROW_CURVES>;
var<workgroup> row_across: array<vec4<f32>, ROW_CURVES>;
const ROW_CURVES: u32 = 3u * STRIDE;
// Tangents no longer than this have vanished, a net each.
var<workgroup> flat_lengths: array<f32, NETS>;
// Parameters of the border's vertices, and what is there, by `border_slot`.
var<workgroup> border_uv: array<vec2<u32>, BORDER>;
var<workgroup> border: array<Evaluated, BORDER>;

// Is the grid regular up to its border?
var<private> IS_REGULAR: bool;

// Where a vertex is evaluated: number of a net, and u and v there.
struct Owner {
    n: u32,
    u: u32,
    v: u32,
}

// Position and unit normal of a vertex.
struct Diced {
    point: vec3<f32>,
    normal: vec3<f32>,
}

// Control points 4 i ..= 4 i + 3 of coordinate k of net n.
fn net_row(n: u32, k: u32, i: u32) -> vec4<f32> {
    let at = 48u * n + 16u * k + 4u * i;
    return vec4<f32>(nets[at], nets[at + 1u], nets[at + 2u], nets[at + 3u]);
}

fn net_point(n: u32, l: u32) -> vec3<f32> {
    let at = 48u * n + l;
    return vec3<f32>(nets[at], nets[at + 16u], nets[at + 32u]);
}

// Differences of neighbouring control points.
fn steps(p: vec4<f32>) -> vec3<f32> {
    return vec3<f32>(sub(p.y, p.x), sub(p.z, p.y), sub(p.w, p.z));
}

// Control points of the curve v = constant of a net, one coordinate.
fn curve_point(n: u32, k: u32, weights: vec4<f32>) -> vec4<f32> {
    return blend_rows(weights, net_row(n, k, 0u), net_row(n, k, 1u), net_row(n, k, 2u), net_row(n, k, 3u));
}

fn blend_rows(weights: vec4<f32>, a: vec4<f32>, b: vec4<f32>, c: vec4<f32>, d: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(blend4(weights, a), blend4(weights, b), blend4(weights, c), blend4(weights, d));
}

// Derivatives across that curve at its control points, one coordinate.
fn curve_across(n: u32, k: u32, weights: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(
        blend3(weights, steps(net_row(n, k, 0u))),
        blend3(weights, steps(net_row(n, k, 1u))),
        blend3(weights, steps(net_row(n, k, 2u))),
        blend3(weights, steps(net_row(n, k, 3u))),
    );
}

// What vertices share: nets, then the rows' curves and the columns' weights; and the border.
fn prepare(draw: Draw, placed: Instance, rates: vec2<u32>, lane: u32) {
    prepare_nets(placed, lane);
    IS_REGULAR = all(border_words(surface_of(draw)) == vec4<u32>(0u)) && !is_owned_by_others();
    let is_moved = lane < border_count(rates) && !IS_REGULAR;
    if lane <= rates.x {
        prepare_column(draw, lane);
    }
    if lane <= rates.y {
        row_v[lane] = row_of(draw, lane);
    }
    if is_moved {
        prepare_border(draw, lane);
    }
    workgroupBarrier();
    if lane < 3u * (rates.y + 1u) {
        prepare_row(lane);
    }
    if is_moved {
        border[lane] = evaluate_on_border(placed.record, border_uv[lane]);
    }
    let n = GROUP - 1u - lane;
    if n < net_count() {
        flat_lengths[n] = mul(size(n), FLAT);
    }
}

// The curve in row `row`, or the weights of column `column`: one share of what the vertices need.
fn prepare_row(task: u32) {
    let t = param(row_v[task / 3u]);
    row_point[task] = curve_point(0u, task % 3u, cubic(t));
    row_across[task] = curve_across(0u, task % 3u, cubic_slope(t));
}

fn prepare_column(draw: Draw, column: u32) {
    let u = column_of(draw, column);
    column_u[column] = u;
    column_cubic[column] = cubic(param(u));
    column_slope[column] = cubic_slope(param(u));
}

// The border's vertices are numbered row by row, the first and the last one first.
fn border_count(rates: vec2<u32>) -> u32 {
    return 2u * (rates.x + rates.y);
}

fn is_on_border(rates: vec2<u32>, row: u32, column: u32) -> bool {
    return row == 0u || row == rates.y || column == 0u || column == rates.x;
}

fn border_slot(rates: vec2<u32>, row: u32, column: u32) -> u32 {
    let whole_rows = 2u * (rates.x + 1u);
    let in_first = select(rates.x + 1u, 0u, row == 0u) + column;
    let between = whole_rows + 2u * (row - 1u) + select(1u, 0u, column == 0u);
    return select(between, in_first, row == 0u || row == rates.y);
}

// The vertex that has a slot.
fn prepare_border(draw: Draw, slot: u32) {
    let rates = draw_rates(draw);
    let whole_rows = 2u * (rates.x + 1u);
    var row = select(0u, rates.y, slot > rates.x);
    var column = select(slot, slot - rates.x - 1u, slot > rates.x);
    if slot >= whole_rows {
        row = 1u + (slot - whole_rows) / 2u;
        column = select(0u, rates.x, (slot - whole_rows) % 2u != 0u);
    }
    border_uv[slot] = vertex_on_border(draw, row, column);
}

// u and v of a vertex.
fn vertex_of(draw: Draw, row: u32, column: u32) -> vec2<u32> {
    let rates = draw_rates(draw);
    if !IS_REGULAR && is_on_border(rates, row, column) {
        return border_uv[border_slot(rates, row, column)];
    }
    return vec2<u32>(column_u[column], row_v[row]);
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

// A vertex with weights and an iso-curve of its own: the same bits as in a row.
fn evaluate_moved(at: Owner) -> Evaluated {
    let row = param(at.v);
    let weights = cubic(row);
    let row_slope = cubic_slope(row);
    let cubic_u = cubic(param(at.u));
    let slope = cubic_slope(param(at.u));
    let x = curve_point(at.n, 0u, weights);
    let y = curve_point(at.n, 1u, weights);
    let z = curve_point(at.n, 2u, weights);
    return Evaluated(
        vec3<f32>(blend4(cubic_u, x), blend4(cubic_u, y), blend4(cubic_u, z)),
        vec3<f32>(blend3(slope, steps(x)), blend3(slope, steps(y)), blend3(slope, steps(z))),
        vec3<f32>(
            blend4(cubic_u, curve_across(at.n, 0u, row_slope)),
            blend4(cubic_u, curve_across(at.n, 1u, row_slope)),
            blend4(cubic_u, curve_across(at.n, 2u, row_slope)),
        ),
    );
}

fn evaluate_bezier(draw: Draw, row: u32, column: u32) -> Evaluated {
    let rates = draw_rates(draw);
    if !IS_REGULAR && is_on_border(rates, row, column) {
        return border[border_slot(rates, row, column)];
    }
    return evaluate(row, column);
}

// The unit normal of a vertex, or one from nearby where it vanished.
fn normal_of(evaluated: Evaluated, at: Owner) -> vec3<f32> {
    let normal = unit_normal(evaluated.du, evaluated.dv, flat_lengths[at.n]);
    if largest3(normal) < 0.5 {
        return normal_nearby(at);
    }
    return normal;
}

// Largest side of the box around the control points of a net.
fn size(n: u32) -> f32 {
    return max(max(side(n, 0u), side(n, 1u)), side(n, 2u));
}

// Core's tree over the sixteen numbers, a row of four at once.
fn side(n: u32, k: u32) -> f32 {
    let a = net_row(n, k, 0u);
    let b = net_row(n, k, 1u);
    let c = net_row(n, k, 2u);
    let d = net_row(n, k, 3u);
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
    return flush3(scale3(normal, scale));
}

fn inward(t: u32) -> u32 {
    return t - t / 64u + PARAM_ONE / 128u;
}

// The normal a little towards the patch's middle, or that of the patch's diagonals, or towards the eye.
fn normal_nearby(at: Owner) -> vec3<f32> {
    let inside = evaluate_moved(Owner(at.n, inward(at.u), inward(at.v)));
    let nearby = unit_normal(inside.du, inside.dv, flat_lengths[at.n]);
    if largest3(nearby) > 0.5 {
        return nearby;
    }
    let diagonal = unit_normal(chord(at.n, 0u, 15u), chord(at.n, 12u, 3u), 0.0);
    if largest3(diagonal) > 0.5 {
        return diagonal;
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

fn chord(n: u32, a: u32, b: u32) -> vec3<f32> {
    let to = net_point(n, b);
    let from_a = net_point(n, a);
    return vec3<f32>(sub(to.x, from_a.x), sub(to.y, from_a.y), sub(to.z, from_a.z));
}
