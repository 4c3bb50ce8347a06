// Mirrors core/src/kernel/clip.rs: clipping at the near plane and the guard band.

const MAX_CORNERS: u32 = 8u;

struct Polygon {
    corners: array<vec3<f32>, MAX_CORNERS>,
    count: u32,
}

const PLANES: u32 = 5u;
const PLANE_NEAR: u32 = 0u;
const PLANE_LEFT: u32 = 1u;
const PLANE_RIGHT: u32 = 2u;
const PLANE_BOTTOM: u32 = 3u;

fn push(polygon: ptr<function, Polygon>, corner: vec3<f32>) {
    if (*polygon).count < MAX_CORNERS {
        (*polygon).corners[(*polygon).count] = corner;
        (*polygon).count += 1u;
    }
}

// How far inside a point is; negative outside.
fn inside(plane: u32, p: vec3<f32>) -> f32 {
    let edge = mul(neg(p.z), GUARD_BAND);
    switch plane {
        case PLANE_NEAR: {
            return sub(neg(p.z), frame.near);
        }
        case PLANE_LEFT: {
            return add(edge, mul(p.x, frame.focal));
        }
        case PLANE_RIGHT: {
            return sub(edge, mul(p.x, frame.focal));
        }
        case PLANE_BOTTOM: {
            return add(edge, mul(p.y, frame.focal));
        }
        default: {
            return sub(edge, mul(p.y, frame.focal));
        }
    }
}

// Where the edge from an inner to an outer point meets the plane.
fn cut(plane: u32, inner: vec3<f32>, outer: vec3<f32>) -> vec3<f32> {
    let start = inside(plane, inner);
    let share = mul(start, recip(sub(start, inside(plane, outer))));
    let x = add(inner.x, mul(share, sub(outer.x, inner.x)));
    let y = add(inner.y, mul(share, sub(outer.y, inner.y)));
    if plane == PLANE_NEAR {
        return vec3<f32>(x, y, neg(frame.near));
    }
    return vec3<f32>(x, y, add(inner.z, mul(share, sub(outer.z, inner.z))));
}

fn clip(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Polygon {
    var polygon: Polygon;
    push(&polygon, a);
    push(&polygon, b);
    push(&polygon, c);
    for (var plane = 0u; plane < PLANES; plane++) {
        polygon = clip_by(plane, polygon);
    }
    return polygon;
}

fn clip_by(plane: u32, whole: Polygon) -> Polygon {
    var polygon = whole;
    var out: Polygon;
    for (var index = 0u; index < polygon.count; index++) {
        let here = polygon.corners[index];
        let next = polygon.corners[(index + 1u) % polygon.count];
        let here_in = inside(plane, here) >= 0.0;
        let next_in = inside(plane, next) >= 0.0;
        if here_in {
            push(&out, here);
        }
        if here_in && !next_in {
            push(&out, cut(plane, here, next));
        } else if next_in && !here_in {
            push(&out, cut(plane, next, here));
        }
    }
    return out;
}
