// Mirrors core/src/kernel/bound.rs: what of it concerns Gregory patches, displacement, the rules of Weber's program,
// and meshes that are to be whole.

// Control points of a surface that is even nearer than the one whose hull is known, if the patch is a Gregory
// patch: its lengths are the surface's.
var<private> FOLLOWER: Net;
// The patch's face points.
var<private> FACES: Faces;
var<private> IS_GREGORY: bool;
// What displacement can do, along any axis of eye space.
var<private> REACH: f32;

fn is_whole() -> bool {
    return (frame.flags & FLAG_WHOLE) != 0u;
}

fn is_displaced() -> bool {
    return REACH > 0.0;
}

// What is nearer than this is measured as if it were this far away.
fn measured_from() -> f32 {
    return max(frame.near, REACH);
}

// Position of a vertex by itself.
fn position_any(hull: Hull, u: u32, v: u32) -> vec3<f32> {
    if IS_GREGORY {
        return gregory_position(hull.whole, u, v);
    }
    return position_at(hull.whole, u, v);
}

// Mirrors core/src/kernel/dice_gregory.rs (evaluate_gregory): the point alone.
fn gregory_position(net: Net, u: u32, v: u32) -> vec3<f32> {
    return position_at(net_at(FACES, net, u, v), u, v);
}

// Where a point is for measuring lengths: on screen; or, if the mesh is to be whole, on a sheet of pixels that
// surrounds the eye.
fn measured_point(point: vec3<f32>) -> vec3<f32> {
    if !is_whole() {
        return vec3<f32>(point_on_screen(measured_from(), point), 0.0);
    }
    let before = max(neg(point.z), mul(largest3(point), frame.around));
    return scale3(point, mul(frame.focal, recip(max(before, measured_from()))));
}

// Lengths on screen of a hull whose control points are measured to be at `points`.
fn lengths_of(surface: Surface, hull: Hull, points: Net) -> Lengths {
    let own = lengths_of_polygons(polygons_u(points), polygons_v(points));
    if !IS_GREGORY {
        return own;
    }
    let sides = sides_of_gregory(hull.whole, surface, own.sides);
    let followed = measured(FOLLOWER);
    let u = longest(polygons_u(followed));
    let v = longest(polygons_v(followed));
    // A surface is no shorter than its sides.
    return Lengths(max(u, max(sides.x, sides.y)), max(v, max(sides.z, sides.w)), sides);
}

// Mirrors core/src/kernel/sides.rs: a side on the patch's edge is as long as that of a Bezier patch, a line inside the
// patch as four chords between its points.
fn sides_of_gregory(net: Net, surface: Surface, lengths: vec4<f32>) -> vec4<f32> {
    let at_u = vec2<u32>(surface.u, surface.u + u_size(surface));
    let at_v = vec2<u32>(surface.v, surface.v + v_size(surface));
    let at = vec4<u32>(at_v, at_u);
    let is_live = (sides_of(surface) & vec4<u32>(FIVE_BITS)) == vec4<u32>(0u);
    let is_inside = (at & vec4<u32>(PARAM_ONE - 1u)) != vec4<u32>(0u);
    var out = lengths;
    for (var side = 0u; side < 4u; side++) {
        if is_live[side] && is_inside[side] {
            out[side] = line_inside(net, surface, side);
        }
    }
    return out;
}

fn line_inside(net: Net, surface: Surface, side: u32) -> f32 {
    let own = extent_of(surface, side);
    var chords: vec4<f32>;
    var from_point = vec3<f32>(0.0, 0.0, 0.0);
    for (var quarter = 0u; quarter < 5u; quarter++) {
        let at = on_side(surface, side, own.start + quarter * ((1u << own.bits) / 4u));
        let point = measured_point(gregory_position(net, at.x, at.y));
        if quarter > 0u {
            chords[quarter - 1u] = distance_of(from_point, point);
        }
        from_point = point;
    }
    return add(add(chords.x, chords.w), add(chords.y, chords.z));
}

// How far, in pixels, points up to `off_axis` pixels from the axis move on screen if they move by `spread` along any
// axis, and come no nearer than `nearest`.
fn wobble(off_axis: f32, spread: f32, nearest: f32) -> f32 {
    return mul(mul(add(frame.focal, off_axis), spread), recip(nearest));
}

fn wobble_of(points: Net, spread: f32, nearest: f32) -> f32 {
    return wobble(max(largest_of(points.x), largest_of(points.y)), spread, nearest);
}

fn largest_of(c: array<f32, 16>) -> f32 {
    return max(fold_max(c), neg(fold_min(c)));
}

// Mirrors core/src/kernel/sides.rs (Strays): where a corner is that has strayed, wherever it is displaced to.
fn stray_at(point: vec3<f32>) -> Strays {
    let seen = point_on_screen(frame.near, point);
    let distances = around(neg(point.z), REACH);
    let by = wobble(max(abs(seen.x), abs(seen.y)), REACH, max(distances.low, frame.near));
    return Strays(around(seen.x, by), around(seen.y, by), distances, true);
}

// As far as `by` around one place.
fn around(place: f32, by: f32) -> Reach {
    return Reach(sub(place, by), add(place, by));
}

fn hull_of_gregory(whole: Net, surface: Surface) -> Hull {
    let slack = mul(max(extent(whole), faces_extent(FACES)), ROUNDING);
    let exchanged = (frame.flags & FLAG_WEBER) != 0u;
    let centred = centre_inner(FACES, whole, surface, exchanged);
    let part = restricted(centred.net, surface);
    FOLLOWER = follow(FACES, part, surface, exchanged);
    return Hull(centred.net, part, slack, centred.spread, centred.spread);
}

// The pixels that drawing the surface inside a hull can touch.
fn pixels_of(hull: Hull) -> vec4<i32> {
    let nearest = nearest_of(hull);
    if nearest < frame.near || is_whole() {
        return whole_window();
    }
    return pixels_seen(see(hull, nearest, measured(hull.part)));
}

// The verdict on one surface of any patch, by the rules of the frame's profile.
fn bound_any(surface: Surface) -> Verdict {
    let record = faces_of(surface.patch_id);
    IS_GREGORY = record != 0u;
    REACH = objects[object_of(surface.patch_id)].reach;
    let whole = in_eye_space(surface.patch_id);
    var hull: Hull;
    if IS_GREGORY {
        FACES = faces_in_eye_space(record);
        hull = hull_of_gregory(whole, surface);
    } else {
        hull = hull_of_bezier(whole, surface);
    }
    hull.spread = add(hull.apart, REACH);
    if (frame.flags & FLAG_WEBER) == 0u {
        return judge(surface, hull);
    }
    return bound_weber(surface, whole, hull);
}

// The verdict by the rules of Weber's program.
fn bound_weber(surface: Surface, whole: Net, hull: Hull) -> Verdict {
    let code = weber_code(whole, FACES, IS_GREGORY, surface);
    var pixels = PIXELS_EMPTY;
    if code == DRAW {
        pixels = pixels_of(hull);
    }
    return with_sides(verdict(code, pixels), vec4<u32>(0u), vec2<u32>(frame.rate));
}
