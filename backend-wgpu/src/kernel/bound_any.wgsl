// Mirrors core/src/kernel/bound.rs: what of it concerns Gregory patches, rational ones, sides that are halves of others',
// instances, displacement, the rules of Weber's program, surfaces that are to be flat, and meshes that are to be whole.

// The surface's patch, what it is besides, and its object.
var<private> RECORD: u32;
var<private> KIND: u32;
var<private> OBJECT: u32;
// Control points of a surface that is even nearer than the one whose hull is known, if the patch is a Gregory
// patch: its lengths are the surface's.
var<private> FOLLOWER: Net;
// The patch's face points.
var<private> FACES: Faces;
var<private> IS_GREGORY: bool;
// The patch's weights.
var<private> WEIGHTS: Weights;
var<private> IS_RATIONAL: bool;
// What displacement can do, along any axis of eye space.
var<private> REACH: f32;

fn is_flat() -> bool {
    return (frame.flags & FLAG_FLAT) != 0u;
}

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
    if IS_RATIONAL {
        return rational_position(WEIGHTS, hull.whole, u, v);
    }
    let side = joined_side(KIND, vec2<u32>(u, v));
    if side < 4u {
        // Of the larger patch only the side matters, and of that one point.
        let along = select(v, u, side < 2u);
        var line = half_line(owner_word(RECORD, side), OBJECT, along, along);
        return line.points[0];
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
    if is_flat() {
        return flatness_of(surface, hull);
    }
    let own = lengths_of_polygons(polygons_u(points), polygons_v(points));
    if !IS_GREGORY {
        return with_half_lines(surface, own);
    }
    let sides = sides_of_gregory(hull.whole, surface, own.sides);
    let followed = measured(FOLLOWER);
    return with_own_sides(lengths_of_polygons(polygons_u(followed), polygons_v(followed)), sides);
}

// How far a surface and its sides are from being flat. What has to be looked at for that is numbered, so that compilers
// see it once: 0 to 3 are sides; 4 to 7 what the vertices of a side enclose; 8 and 9 what those of both triangles do, or,
// if no corner has strayed, 8 is the whole surface.
fn flatness_of(surface: Surface, hull: Hull) -> Lengths {
    var sides = vec4<f32>(0.0, 0.0, 0.0, 0.0);
    var whole = 0.0;
    for (var part = 0u; part < 10u; part++) {
        if is_looked_at(surface, part) {
            let off = part_off(surface, hull, part);
            let side = part & 3u;
            let strict = mul(side_strictness(surface, side), off);
            sides = select(sides, with_side(sides, side, max(strict, side_length(sides, side))), part < 8u);
            whole = select(max(whole, off), whole, part < 8u);
        }
    }
    return with_own_sides(Lengths(whole, whole, sides), sides);
}

// Live sides that begin or end with a corner that has strayed are looked at twice.
fn is_looked_at(surface: Surface, part: u32) -> bool {
    let strayed = strayed_corners(surface);
    if part < 4u || part == 8u {
        return true;
    }
    let corners = (1u << first_corner(part & 3u)) | (1u << last_corner(part & 3u));
    let is_live = side_of(surface, part & 3u).steps == 0u;
    return (part == 9u || is_live) && (strayed & select(corners, 15u, part == 9u)) != 0u;
}

// How far part of what has to be flat is from being so.
fn part_off(surface: Surface, hull: Hull, part: u32) -> f32 {
    var net = hull.part;
    if IS_GREGORY {
        net = FOLLOWER;
    }
    if (IS_GREGORY && part < 4u) || (part > 3u && strayed_corners(surface) != 0u) {
        net = between_any(hull, range_of_part(surface, part));
    }
    if part > 3u {
        return part_flatness(net);
    }
    var line = side_line(net, part);
    if is_half_line(surface, part) {
        line = half_line_of(surface, part);
    }
    return line_flatness(line);
}

// Lines inside a Gregory patch are found each by itself: a surface's own net, which is another one on the other side of a
// line, has no part in it.
fn range_of_part(surface: Surface, part: u32) -> vec4<u32> {
    let first = first_corner(part & 3u);
    let last = last_corner(part & 3u);
    if part < 4u {
        let end = seeming_corner(surface, last);
        return range_around(seeming_corner(surface, first), end, end);
    }
    var corners = vec3<u32>(first, last, last);
    if part > 7u {
        corners = select(vec3<u32>(0u, 3u, 2u), vec3<u32>(0u, 1u, 3u), part == 8u);
    }
    return range_around(
        corner_at(surface, corners.x), corner_at(surface, corners.y), corner_at(surface, corners.z));
}

// How many times as flat as a surface one of its sides has to be: the same for whoever has it.
fn side_strictness(surface: Surface, side: u32) -> f32 {
    let bits = extent_of(surface, side).bits;
    return strictness(select(bits, bits - 1u, is_half_line(surface, side)));
}

// Control points of a part of the patch, or of a Bezier patch that is nearly the same there.
fn between_any(hull: Hull, range: vec4<u32>) -> Net {
    var net = hull.whole;
    if IS_GREGORY {
        net = centre_inner(FACES, net, range, false).net;
    }
    net = net_between(net, range);
    if IS_RATIONAL {
        net = divided_by(net, WEIGHTS, range);
    }
    if IS_GREGORY {
        net = follow(FACES, net, range, false);
    }
    return net;
}

// What becomes of a surface in view that is so long.
fn by_extents(surface: Surface, extents: vec2<f32>) -> u32 {
    if is_flat() {
        return quartered(surface, max(extents.x, extents.y));
    }
    let is_forced_u = is_halved(3u) && u_level(surface) == 0u;
    if is_forced_u || (is_halved(12u) && v_level(surface) == 0u) {
        return select(DRAW_LIMITED, select(SPLIT_V, SPLIT_U, is_forced_u), may_split(surface, 1u));
    }
    return by_size(surface, extents);
}

// Does the patch have two others beside one of these sides, a bit a side?
fn is_halved(sides: u32) -> bool {
    return (KIND & KIND_HALVED & sides) != 0u;
}

// Most halvings along either parameter.
fn most_splits() -> u32 {
    let is_joined = (KIND & (KIND_HALVED | (KIND_HALVED << KIND_HALF_SHIFT))) != 0u;
    return select(MAX_SPLITS, JOINED_SPLITS, is_joined);
}

// What becomes of a surface that is so far from being flat: it is split into four, in two steps.
fn quartered(surface: Surface, off: f32) -> u32 {
    if is_half_way(surface) {
        return SPLIT_V;
    }
    let is_whole_and_halved = level(surface) == 0u && is_halved(KIND_HALVED);
    if off <= frame.bound && !is_whole_and_halved {
        return DRAW;
    }
    return select(DRAW_LIMITED, SPLIT_U, u_level(surface) < most_splits() && may_split(surface, 2u));
}

// Mirrors core/src/kernel/sides.rs: is a side not to be divided yet, however short it is?
fn stays_live(surface: Surface, side: u32) -> bool {
    return is_half_way(surface) || is_to_be_halved(surface, side);
}

// Has a surface that is split into four been split once?
fn is_half_way(surface: Surface) -> bool {
    return is_flat() && u_level(surface) > v_level(surface);
}

// Is a side all of one side of its patch, with two patches on the other side of it?
fn is_to_be_halved(surface: Surface, side: u32) -> bool {
    return is_halved(1u << side) && extent_of(surface, side).bits == PARAM_BITS && is_outer(surface, side);
}

// Is a side half of another patch's?
fn is_half_line(surface: Surface, side: u32) -> bool {
    return (KIND & (1u << (side + KIND_HALF_SHIFT))) != 0u && is_outer(surface, side);
}

fn half_line_of(surface: Surface, side: u32) -> Line {
    let own = extent_of(surface, side);
    return half_line(owner_word(RECORD, side), OBJECT, own.start, own.start + (1u << own.bits));
}

// Lengths of the sides of a surface, those replaced that are halves of other patches' sides.
fn with_half_lines(surface: Surface, own: Lengths) -> Lengths {
    var sides = own.sides;
    for (var side = 0u; side < 4u; side++) {
        if is_half_line(surface, side) {
            sides = with_side(sides, side, line_extent(half_line_of(surface, side)));
        }
    }
    return with_own_sides(own, sides);
}

// Length of a line's control polygon on screen.
fn line_extent(line: Line) -> f32 {
    var seen = line.points;
    for (var k = 0u; k < 4u; k++) {
        seen[k] = measured_point(seen[k]);
    }
    return polygon(
        distance_of(seen[0], seen[1]), distance_of(seen[1], seen[2]), distance_of(seen[2], seen[3]));
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
            out = with_side(out, side, line_inside(net, surface, side));
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

// Of a rational patch, the control points of all of it are multiplied by their weights.
fn hull_of_any(net: Net, surface: Surface) -> Hull {
    let range = range_of(surface);
    let exchanged = (frame.flags & FLAG_WEBER) != 0u;
    var whole = net;
    var slack = mul(extent(net), ROUNDING);
    var spread = 0.0;
    if IS_RATIONAL {
        whole = homogeneous(WEIGHTS, net);
        // Numerator and denominator each round, and so does the quotient.
        slack = mul(slack, 4.0);
    }
    if IS_GREGORY {
        let centred = centre_inner(FACES, net, range, exchanged);
        whole = centred.net;
        slack = mul(max(extent(net), faces_extent(FACES)), ROUNDING);
        spread = centred.spread;
    }
    var part = net_between(whole, range);
    if IS_RATIONAL {
        part = divided_by(part, WEIGHTS, range);
    }
    if IS_GREGORY {
        FOLLOWER = follow(FACES, part, range, exchanged);
    }
    return Hull(whole, part, slack, spread, add(spread, REACH));
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
    let known = instance(surface.patch_id);
    RECORD = known.record;
    OBJECT = known.object;
    KIND = kind_of(RECORD);
    REACH = objects[OBJECT].reach;
    let more = faces_of(RECORD);
    IS_RATIONAL = (KIND & KIND_RATIONAL) != 0u;
    IS_GREGORY = more != 0u && !IS_RATIONAL;
    if more != 0u {
        FACES = faces_in_eye_space(more, OBJECT);
        WEIGHTS = weights_of(more);
    }
    let whole = in_eye_space(RECORD, OBJECT);
    let hull = hull_of_any(whole, surface);
    if (frame.flags & FLAG_WEBER) != 0u {
        return bound_weber(surface, whole, hull, more != 0u);
    }
    return judge(surface, hull);
}

// The verdict by the rules of Weber's program.
fn bound_weber(surface: Surface, whole: Net, hull: Hull, has_faces: bool) -> Verdict {
    let code = weber_code(whole, FACES, has_faces, surface);
    var pixels = PIXELS_EMPTY;
    if code == DRAW {
        pixels = pixels_of(hull);
    }
    return with_sides(verdict(code, pixels), vec4<u32>(0u), vec2<u32>(frame.rate));
}
