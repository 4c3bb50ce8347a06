// Mirrors core/src/kernel/bound.rs: cull, draw or split a surface by the control hull of its range.

// Control hull of a surface, and of its whole patch; what rounding can do; how far the surface can be from the one
// whose hull it is.
struct Hull {
    whole: Net,
    part: Net,
    slack: f32,
    apart: f32,
    spread: f32,
}

// Where on screen a surface lies, and how far what is drawn can be outside of that.
struct Seen {
    x: Reach,
    y: Reach,
    margin: f32,
}

fn hull_of_bezier(whole: Net, surface: Surface) -> Hull {
    return Hull(whole, restricted(whole, surface), mul(extent(whole), ROUNDING), 0.0, 0.0);
}

fn nearest_of(hull: Hull) -> f32 {
    return sub(neg(fold_max(hull.part.z)), hull.spread);
}

// Before the surface is displaced.
fn nearest_smooth(hull: Hull) -> f32 {
    return sub(neg(fold_max(hull.part.z)), hull.apart);
}

fn farthest_of(hull: Hull) -> f32 {
    return add(neg(fold_min(hull.part.z)), hull.spread);
}

// What the image shows of a hull that lies beyond the near plane, `nearest` away.
fn see(hull: Hull, nearest: f32, points: Net) -> Seen {
    let margin = add(margin_of(hull.slack, nearest), wobble_of(points, hull.spread, nearest));
    return Seen(reach_of(points.x), reach_of(points.y), margin);
}

// How far, in pixels, rounding and the snap can move what is drawn of a surface that is `nearest` away.
fn margin_of(slack: f32, nearest: f32) -> f32 {
    return add(1.0, mul(mul(frame.focal, slack), recip(nearest)));
}

fn reach_of(offsets: array<f32, 16>) -> Reach {
    return Reach(fold_min(offsets), fold_max(offsets));
}

fn pixels_seen(seen: Seen) -> vec4<i32> {
    return vec4<i32>(
        pixel_range(seen.x, frame.centre_x, vec2<u32>(frame.left, frame.right), seen.margin),
        pixel_range(seen.y, frame.centre_y, vec2<u32>(frame.top, frame.bottom), seen.margin),
    );
}

// Of the pixels from `whole.x` to `whole.y`.
fn pixel_range(reach: Reach, centre: f32, whole: vec2<u32>, margin: f32) -> vec2<i32> {
    let first = float(i32(whole.x));
    let end = float(i32(whole.y));
    let low = sub(add(reach.low, centre), margin);
    let high = add(add(reach.high, centre), add(margin, 1.0));
    return vec2<i32>(floor(clamp(low, first, end)), floor(clamp(high, first, end)));
}

fn bound(surface: Surface) -> Verdict {
    let whole = in_eye_space(surface.patch_id, object_of(surface.patch_id));
    return judge(surface, hull_of_bezier(whole, surface));
}

fn judge(surface: Surface, hull: Hull) -> Verdict {
    let nearest = nearest_of(hull);
    let farthest = farthest_of(hull);
    let strays = strays_of(surface, hull);
    let crosses = nearest < frame.near && add(farthest, hull.slack) >= frame.near;
    // Boxes of what is displaced are wide where it is near.
    let is_vague = (crosses || is_displaced()) && !strays.exist;
    if !is_whole() && is_out_of_view(hull, max(farthest, strays.distances.high), is_vague) {
        return culled();
    }
    let points = measured(hull.part);
    let lengths = lengths_of(surface, hull, points);
    var extents = vec2<f32>(lengths.u, lengths.v);
    var pixels = whole_window();
    if crosses && !is_whole() {
        if nearest_smooth(hull) < measured_from() && !is_flat() {
            extents = extents_if_cut(hull.part);
        }
        if !strays.exist {
            pixels = pixels_if_cut(hull, farthest);
        }
    } else if min(nearest, strays.distances.low) >= frame.near && !is_whole() {
        let seen = see(hull, nearest, points);
        pixels = pixels_seen(Seen(joined(seen.x, strays.x), joined(seen.y, strays.y), seen.margin));
        if is_empty(pixels) {
            return culled();
        }
    }
    return divided_verdict(surface, lengths, verdict(by_extents(surface, extents), pixels));
}

// Is all of a hull, as far as `end` away, before the near plane, or, if its box is vague, beside the view?
fn is_out_of_view(hull: Hull, end: f32, is_vague: bool) -> bool {
    return add(end, hull.slack) < frame.near
        || (is_vague && beside_the_view(hull.part, add(hull.slack, hull.spread)));
}

// Left, right, top and bottom in pixels; right and bottom are one past the last.
fn whole_window() -> vec4<i32> {
    return vec4<i32>(i32(frame.left), i32(frame.right), i32(frame.top), i32(frame.bottom));
}

const PIXELS_EMPTY: vec4<i32> = vec4<i32>(0, 0, 0, 0);

fn is_empty(pixels: vec4<i32>) -> bool {
    return pixels.x >= pixels.y || pixels.z >= pixels.w;
}

fn culled() -> Verdict {
    return verdict(CULL, PIXELS_EMPTY);
}

fn verdict(code: u32, pixels: vec4<i32>) -> Verdict {
    return Verdict(
        code,
        u32(pixels.x) | (u32(pixels.y) << 16u),
        u32(pixels.z) | (u32(pixels.w) << 16u),
        0u,
        0u,
    );
}

// The verdict, with sides and rates.
fn divided_verdict(surface: Surface, lengths: Lengths, found: Verdict) -> Verdict {
    let sides = divide(surface, lengths, found.code);
    let plain = with_sides(found, sides, vec2<u32>(0u));
    if plain.code == SPLIT_U || plain.code == SPLIT_V {
        return plain;
    }
    return with_sides(found, sides, rates_for(divided(surface, plain), lengths));
}

// What becomes of a surface in view that is so long, if nothing forces it to be split.
fn by_size(surface: Surface, extents: vec2<f32>) -> u32 {
    if max(extents.x, extents.y) <= frame.bound {
        return DRAW;
    }
    return refine(surface, extents);
}

// Is there a level for each of so many splits?
fn may_split(surface: Surface, times: u32) -> bool {
    return level(surface) + times < frame.levels;
}

fn refine(surface: Surface, extents: vec2<f32>) -> u32 {
    let open_u = u_level(surface) < most_splits();
    let open_v = v_level(surface) < most_splits();
    if !may_split(surface, 1u) {
        return DRAW_LIMITED;
    }
    if extents.x > extents.y {
        if open_u {
            return SPLIT_U;
        }
        if open_v && extents.y > frame.bound {
            return SPLIT_V;
        }
        return DRAW_LIMITED;
    }
    if open_v {
        return SPLIT_V;
    }
    if open_u && extents.x > frame.bound {
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

// Lengths along u and along v of a surface that crosses the near plane: as if all of it were there, and turned to the
// eye.
fn extents_if_cut(part: Net) -> vec2<f32> {
    let scale = mul(frame.focal, recip(measured_from()));
    var points = part;
    for (var l = 0u; l < 16u; l++) {
        points.x[l] = clamp(mul(points.x[l], scale), neg(FAR_OFF), FAR_OFF);
        points.y[l] = clamp(mul(points.y[l], scale), neg(FAR_OFF), FAR_OFF);
        points.z[l] = clamp(mul(points.z[l], scale), neg(FAR_OFF), FAR_OFF);
    }
    return vec2<f32>(longest(polygons_u(points)), longest(polygons_v(points)));
}

// The pixels that drawing a surface can touch of which parts lie as near as the near plane.
fn pixels_if_cut(hull: Hull, farthest: f32) -> vec4<i32> {
    let scale = vec2<f32>(recip(frame.near), recip(max(add(farthest, hull.slack), frame.near)));
    let margin = margin_of(add(hull.slack, hull.spread), frame.near);
    let x = reach_if_cut(fold_min(hull.part.x), fold_max(hull.part.x), scale);
    let y = reach_if_cut(neg(fold_max(hull.part.y)), neg(fold_min(hull.part.y)), scale);
    return pixels_seen(Seen(x, y, margin));
}

// What is off the axis is seen farthest off it at the near plane.
fn reach_if_cut(low: f32, high: f32, scale: vec2<f32>) -> Reach {
    return Reach(
        mul(mul(low, frame.focal), select(scale.y, scale.x, low < 0.0)),
        mul(mul(high, frame.focal), select(scale.y, scale.x, high > 0.0)),
    );
}

// Where the control points are for measuring lengths.
fn measured(part: Net) -> Net {
    var points = part;
    for (var l = 0u; l < 16u; l++) {
        let point = measured_point(vec3<f32>(points.x[l], points.y[l], points.z[l]));
        points.x[l] = point.x;
        points.y[l] = point.y;
        points.z[l] = point.z;
    }
    return points;
}

// Pixel offsets of one point from the optical axis.
fn point_on_screen(near: f32, point: vec3<f32>) -> vec2<f32> {
    let seen = perspective(near, point);
    return vec2<f32>(clamp(seen.x, neg(FAR_OFF), FAR_OFF), clamp(seen.y, neg(FAR_OFF), FAR_OFF));
}

fn distance_of(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let d = vec3<f32>(sub(b.x, a.x), sub(b.y, a.y), sub(b.z, a.z));
    return sqrt(add(dot3(d, d), LENGTH_TINY));
}

// Lengths in pixels of the control polygons along u.
fn polygons_u(points: Net) -> vec4<f32> {
    var at = points;
    var lengths: array<f32, 12>;
    for (var l = 0u; l < 12u; l++) {
        let to = vec3<f32>(at.x[l + 4u], at.y[l + 4u], at.z[l + 4u]);
        lengths[l] = distance_of(vec3<f32>(at.x[l], at.y[l], at.z[l]), to);
    }
    var polygons: vec4<f32>;
    for (var j = 0u; j < 4u; j++) {
        polygons[j] = polygon(lengths[j], lengths[4u + j], lengths[8u + j]);
    }
    return polygons;
}

// Lengths in pixels of the control polygons along v.
fn polygons_v(points: Net) -> vec4<f32> {
    var at = points;
    var lengths: array<f32, 15>;
    for (var l = 0u; l < 15u; l++) {
        let to = vec3<f32>(at.x[l + 1u], at.y[l + 1u], at.z[l + 1u]);
        lengths[l] = distance_of(vec3<f32>(at.x[l], at.y[l], at.z[l]), to);
    }
    var polygons: vec4<f32>;
    for (var i = 0u; i < 4u; i++) {
        polygons[i] = polygon(lengths[4u * i], lengths[4u * i + 1u], lengths[4u * i + 2u]);
    }
    return polygons;
}
