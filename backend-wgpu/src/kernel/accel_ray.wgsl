// Mirrors core/src/accel/ray.rs: where a ray is in a box, and where it hits a triangle.

// Rounding errors of a place along the ray stay below this share of it.
const RAY_ROUNDING: f32 = 9.5367431640625e-7;
// Nothing is taken to be farther away along an axis.
const RAY_FAR: f32 = 1099511627776.0;
// Directions whose components are smaller than this are taken for parallel to a side: 1 / RAY_FAR.
const RAY_PARALLEL: f32 = 9.094947017729282379150390625e-13;

var<private> direction: vec3<f32>;
// 1 / direction; 0 along axes that the ray is parallel to.
var<private> steps: vec3<f32>;

fn begin(probe: Probe) {
    origin = flush3(vec3<f32>(probe.origin[0], probe.origin[1], probe.origin[2]));
    direction = flush3(vec3<f32>(probe.direction[0], probe.direction[1], probe.direction[2]));
    steps = vec3<f32>(ray_step(direction.x), ray_step(direction.y), ray_step(direction.z));
    limit = probe.far;
}

fn ray_step(x: f32) -> f32 {
    if abs(x) < RAY_PARALLEL {
        return 0.0;
    }
    return recip(x);
}

// What of a span is between two sides of a box.
fn cut(span: vec2<f32>, start: f32, step: f32, low: f32, high: f32) -> vec2<f32> {
    let to_low = between(start, low, RAY_FAR);
    let to_high = between(start, high, RAY_FAR);
    if step == 0.0 {
        return select(vec2<f32>(1.0, 0.0), span, to_low <= 0.0 && to_high >= 0.0);
    }
    let a = mul(to_low, step);
    let b = mul(to_high, step);
    let near = min(a, b);
    let far = max(a, b);
    return vec2<f32>(
        max(span.x, sub(near, mul(abs(near), RAY_ROUNDING))),
        min(span.y, add(far, mul(abs(far), RAY_ROUNDING))),
    );
}

// Between which places the ray may be in a node's box; the first is larger than the second if it is not.
fn enter(node: u32) -> vec2<f32> {
    var span = vec2<f32>(0.0, limit);
    span = cut(span, origin.x, steps.x, nodes[node].low[0], nodes[node].high[0]);
    span = cut(span, origin.y, steps.y, nodes[node].low[1], nodes[node].high[1]);
    return cut(span, origin.z, steps.z, nodes[node].low[2], nodes[node].high[2]);
}

// Where the ray hits a triangle, from either side; -1 if it does not, or not where it is in the triangle's box.
fn distance_to(triangle: u32, span: vec2<f32>) -> f32 {
    let a = corner_of(triangle, 0u);
    let along = offset_to(a, corner_of(triangle, 1u), RAY_FAR);
    let across = offset_to(a, corner_of(triangle, 2u), RAY_FAR);
    let start = offset_to(a, origin, RAY_FAR);
    let p = flush3(cross3(direction, across));
    let signed_size = flush(dot3(along, p));
    let sign = select(1.0, neg(1.0), signed_size < 0.0);
    let size = mul(signed_size, sign);
    let u = mul(flush(dot3(start, p)), sign);
    let q = flush3(cross3(start, along));
    let v = mul(flush(dot3(direction, q)), sign);
    if size == 0.0 || u < 0.0 || v < 0.0 || add(u, v) > size {
        return neg(1.0);
    }
    let t = mul(mul(flush(dot3(across, q)), sign), recip(size));
    return select(neg(1.0), t, span.x <= t && t <= span.y);
}
