// Mirrors core/src/kernel/weber.rs: the verdict on a surface as Weber's program reaches it.

fn weber_split(surface: Surface, along_u: bool) -> u32 {
    if along_u {
        return select(CULL, SPLIT_U, u_level(surface) < WEBER_SPLITS);
    }
    return select(CULL, SPLIT_V, v_level(surface) < WEBER_SPLITS);
}

// Is a range of one coordinate more than the margin outside of the image, `half` pixels to either side?
fn is_beside(range: vec2<f32>, scale: vec2<f32>, half: f32) -> bool {
    let low = mul(mul(range.x, select(scale.y, scale.x, range.x < 0.0)), frame.focal);
    let high = mul(mul(range.y, select(scale.y, scale.x, range.y > 0.0)), frame.focal);
    let last = sub(add(half, half), 1.0);
    return add(low, half) > add(last, WEBER_MARGIN) || add(high, half) < neg(WEBER_MARGIN);
}

fn is_outside(low: vec3<f32>, high: vec3<f32>) -> bool {
    let nearest = neg(high.z);
    let farthest = neg(low.z);
    if farthest < frame.near || nearest > WEBER_FAR {
        return true;
    }
    let scale = vec2<f32>(recip(max(frame.near, nearest)), recip(farthest));
    return is_beside(vec2<f32>(low.x, high.x), scale, frame.centre_x)
        || is_beside(vec2<f32>(low.y, high.y), scale, frame.centre_y);
}

fn weber_on_screen(point: vec3<f32>) -> vec2<f32> {
    let size = recip(max(abs(point.z), WEBER_TINY));
    let scale = mul(frame.focal, select(size, neg(size), point.z > 0.0));
    return vec2<f32>(
        clamp(mul(point.x, scale), neg(WEBER_FAR_OFF), WEBER_FAR_OFF),
        clamp(mul(point.y, scale), neg(WEBER_FAR_OFF), WEBER_FAR_OFF),
    );
}

fn polyline(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>) -> f32 {
    return add(weber_segment(a, b), weber_segment(b, c));
}

fn weber_segment(a: vec2<f32>, b: vec2<f32>) -> f32 {
    let dx = sub(b.x, a.x);
    let dy = sub(b.y, a.y);
    return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));
}

struct Points {
    at: array<vec3<f32>, 9>,
}

// Lengths of the longest polylines along u and along v.
fn weber_lengths(all: Points) -> vec2<f32> {
    var points = all;
    var seen: array<vec2<f32>, 9>;
    for (var k = 0u; k < 9u; k++) {
        seen[k] = weber_on_screen(points.at[k]);
    }
    var longest = vec2<f32>(0.0, 0.0);
    for (var k = 0u; k < 3u; k++) {
        longest.x = max(longest.x, polyline(seen[k], seen[3u + k], seen[6u + k]));
        longest.y = max(longest.y, polyline(seen[3u * k], seen[3u * k + 1u], seen[3u * k + 2u]));
    }
    return longest;
}

fn weber_points(net: Net, faces: Faces, is_gregory: bool, surface: Surface) -> Points {
    var points: Points;
    for (var k = 0u; k < 9u; k++) {
        let u = surface.u + k / 3u * (u_size(surface) / 2u);
        let v = surface.v + k % 3u * (v_size(surface) / 2u);
        if is_gregory {
            points.at[k] = position_at(net_at(faces, net, u, v), u, v);
        } else {
            points.at[k] = position_at(net, u, v);
        }
    }
    return points;
}

fn weber_code(net: Net, faces: Faces, is_gregory: bool, surface: Surface) -> u32 {
    if level(surface) + 1u >= frame.levels {
        return CULL;
    }
    var points = weber_points(net, faces, is_gregory, surface);
    var low = points.at[0];
    var high = points.at[0];
    for (var k = 0u; k < 9u; k++) {
        let p = points.at[k];
        low = vec3<f32>(min(low.x, p.x), min(low.y, p.y), min(low.z, p.z));
        high = vec3<f32>(max(high.x, p.x), max(high.y, p.y), max(high.z, p.z));
    }
    if is_outside(low, high) {
        return CULL;
    }
    if low.z < mul(0.1, frame.near) && high.z > frame.near {
        return weber_split(surface, u_size(surface) < v_size(surface));
    }
    let lengths = weber_lengths(points);
    if max(lengths.x, lengths.y) <= frame.bound {
        return select(CULL, DRAW, u_level(surface) <= MAX_SPLITS && v_level(surface) <= MAX_SPLITS);
    }
    return weber_split(surface, lengths.x > lengths.y);
}
