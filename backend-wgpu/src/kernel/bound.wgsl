// Mirrors core/src/kernel/bound.rs: cull, draw or split a surface by the control hull of its range.

// Control hull of a surface; what rounding can do; how far the surface can be from the one whose hull it is.
struct Hull {
    part: Net,
    slack: f32,
    spread: f32,
}

// Control points on screen, and how far the surface can be outside of their hull.
struct Seen {
    on_screen: OnScreen,
    margin: f32,
}

fn hull_of_bezier(whole: Net, surface: Surface) -> Hull {
    return Hull(restricted(whole, surface), mul(extent(whole), ROUNDING), 0.0);
}

fn nearest_of(hull: Hull) -> f32 {
    return sub(neg(fold_max(hull.part.z)), hull.spread);
}

fn see(hull: Hull, nearest: f32) -> Seen {
    let seen = on_screen(hull.part);
    let scale = recip(nearest);
    let wobble = wobble_of(seen, hull.spread, scale);
    let margin = add(add(1.0, mul(mul(frame.focal, hull.slack), scale)), wobble);
    return Seen(seen, margin);
}

fn seen_pixels(seen: Seen) -> vec4<i32> {
    return pixels_around(seen.on_screen, add(seen.margin, mul(frame.bound, SEAM_ALLOWANCE)));
}

fn bound(surface: Surface) -> Verdict {
    return judge(surface, hull_of_bezier(in_eye_space(surface.patch_id), surface));
}

fn judge(surface: Surface, hull: Hull) -> Verdict {
    let nearest = nearest_of(hull);
    let farthest = add(neg(fold_min(hull.part.z)), hull.spread);
    if add(farthest, hull.slack) < frame.near {
        return verdict(CULL, PIXELS_EMPTY);
    }
    if nearest < frame.near {
        if beside_the_view(hull.part, add(hull.slack, hull.spread)) {
            return verdict(CULL, PIXELS_EMPTY);
        }
        let code = refine(surface, depth_spans(hull.part), false);
        return verdict(code, vec4<i32>(0, i32(frame.width), 0, i32(frame.height)));
    }
    let seen = see(hull, nearest);
    if is_empty(pixels_around(seen.on_screen, seen.margin)) {
        return verdict(CULL, PIXELS_EMPTY);
    }
    let pixels = seen_pixels(seen);
    let extents = extents_of(seen.on_screen);
    if max(extents.x, extents.y) <= frame.bound {
        return verdict(DRAW, pixels);
    }
    return verdict(refine(surface, extents, true), pixels);
}

// Left, right, top and bottom in pixels; right and bottom are one past the last.
const PIXELS_EMPTY: vec4<i32> = vec4<i32>(0, 0, 0, 0);

fn is_empty(pixels: vec4<i32>) -> bool {
    return pixels.x >= pixels.y || pixels.z >= pixels.w;
}

fn verdict(code: u32, pixels: vec4<i32>) -> Verdict {
    return Verdict(
        code,
        u32(pixels.x) | (u32(pixels.y) << 16u),
        u32(pixels.z) | (u32(pixels.w) << 16u),
    );
}

fn refine(surface: Surface, extents: vec2<f32>, limited: bool) -> u32 {
    let open_u = u_level(surface) < MAX_SPLITS;
    let open_v = v_level(surface) < MAX_SPLITS;
    if level(surface) + 1u >= frame.levels {
        return DRAW_LIMITED;
    }
    if extents.x > extents.y {
        if open_u {
            return SPLIT_U;
        }
        if open_v && limited && extents.y > frame.bound {
            return SPLIT_V;
        }
        return DRAW_LIMITED;
    }
    if open_v {
        return SPLIT_V;
    }
    if open_u && limited && extents.x > frame.bound {
        return SPLIT_U;
    }
    return DRAW_LIMITED;
}

fn beside_the_view(part: Net, slack: f32) -> bool {
    return beyond(part.z, part.x, frame.centre_x, slack) || beyond(part.z, part.y, frame.centre_y, slack);
}

fn beyond(depths: array<f32, 16>, coordinates: array<f32, 16>, half: f32, slack: f32) -> bool {
    let tolerance = mul(slack, add(frame.focal, half));
    var z = depths;
    var c = coordinates;
    var low: array<f32, 16>;
    var high: array<f32, 16>;
    for (var l = 0u; l < 16u; l++) {
        let offset = mul(c[l], frame.focal);
        let edge = mul(neg(z[l]), half);
        low[l] = add(edge, offset);
        high[l] = sub(edge, offset);
    }
    return add(fold_max(low), tolerance) < 0.0 || add(fold_max(high), tolerance) < 0.0;
}

fn depth_spans(part: Net) -> vec2<f32> {
    var z = part.z;
    var along_u = 0.0;
    var along_v = 0.0;
    for (var l = 0u; l < 4u; l++) {
        along_u = max(along_u, span(z[l], z[4u + l], z[8u + l], z[12u + l]));
        along_v = max(along_v, span(z[4u * l], z[4u * l + 1u], z[4u * l + 2u], z[4u * l + 3u]));
    }
    return vec2<f32>(along_u, along_v);
}

fn span(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return sub(max(max(a, b), max(c, d)), min(min(a, b), min(c, d)));
}

// Pixel offsets of the control points from the optical axis.
struct OnScreen {
    x: array<f32, 16>,
    y: array<f32, 16>,
}

fn on_screen(part: Net) -> OnScreen {
    var net = part;
    var out: OnScreen;
    for (var l = 0u; l < 16u; l++) {
        let seen = perspective(vec3<f32>(net.x[l], net.y[l], net.z[l]));
        out.x[l] = clamp(seen.x, neg(FAR_OFF), FAR_OFF);
        out.y[l] = clamp(seen.y, neg(FAR_OFF), FAR_OFF);
    }
    return out;
}

fn segment(dx: f32, dy: f32) -> f32 {
    return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));
}

fn length_u(seen: OnScreen) -> f32 {
    var at = seen;
    var lengths: array<f32, 12>;
    for (var l = 0u; l < 12u; l++) {
        lengths[l] = segment(sub(at.x[l + 4u], at.x[l]), sub(at.y[l + 4u], at.y[l]));
    }
    var polygons: array<f32, 4>;
    for (var j = 0u; j < 4u; j++) {
        polygons[j] = add(add(lengths[j], lengths[4u + j]), lengths[8u + j]);
    }
    return max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]));
}

fn length_v(seen: OnScreen) -> f32 {
    var at = seen;
    var lengths: array<f32, 15>;
    for (var l = 0u; l < 15u; l++) {
        lengths[l] = segment(sub(at.x[l + 1u], at.x[l]), sub(at.y[l + 1u], at.y[l]));
    }
    var polygons: array<f32, 4>;
    for (var i = 0u; i < 4u; i++) {
        polygons[i] = add(add(lengths[4u * i], lengths[4u * i + 1u]), lengths[4u * i + 2u]);
    }
    return max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]));
}

fn pixels_around(seen: OnScreen, margin: f32) -> vec4<i32> {
    let columns = pixel_range(seen.x, frame.centre_x, frame.width, margin);
    let rows = pixel_range(seen.y, frame.centre_y, frame.height, margin);
    return vec4<i32>(columns, rows);
}

fn pixel_range(offsets: array<f32, 16>, centre: f32, pixels: u32, margin: f32) -> vec2<i32> {
    let size = float(i32(pixels));
    let low = sub(add(fold_min(offsets), centre), margin);
    let high = add(add(fold_max(offsets), centre), add(margin, 1.0));
    return vec2<i32>(floor(clamp(low, 0.0, size)), floor(clamp(high, 0.0, size)));
}
