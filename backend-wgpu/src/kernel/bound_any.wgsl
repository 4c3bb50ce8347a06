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
    let at = vec2<u32>(u, v);
    let side = joined_side(KIND, at);
    if side < 4u {
        return joined_position(owner_word(RECORD, side), side, at);
    }
    return position_at(hull.whole, u, v);
}

// On a larger patch, given the word of the side that is half of a side of it.
fn joined_position(word: u32, side: u32, at: vec2<u32>) -> vec3<f32> {
    let there = joined_place(word, side, at);
    return position_at(in_eye_space((word >> OWNER_SHIFT) - 1u, OBJECT), there.x, there.y);
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

// How far a surface and its sides are from being flat.
fn flatness_of(surface: Surface, hull: Hull) -> Lengths {
    var sides: vec4<f32>;
    for (var side = 0u; side < 4u; side++) {
        sides[side] = mul(side_strictness(surface, side), line_flatness(line_of(surface, hull, side)));
    }
    if strayed_corners(surface) != 0u {
        return flatness_astray(surface, hull, sides);
    }
    var net = hull.part;
    if IS_GREGORY {
        net = FOLLOWER;
    }
    let whole = part_flatness(net);
    return with_own_sides(Lengths(whole, whole, sides), sides);
}

// Control points of a side. Those inside a Gregory patch are found each by itself: a surface's own net, which is another
// one on the other side of a line, has no part in it.
fn line_of(surface: Surface, hull: Hull, side: u32) -> Line {
    if is_half_line(surface, side) {
        return half_line_of(surface, side);
    }
    var net = hull.part;
    if IS_GREGORY {
        let first = seeming_corner(surface, first_corner(side));
        let last = seeming_corner(surface, last_corner(side));
        net = between_any(hull, range_around(first, last, last));
    }
    return side_line(net, side);
}

// What is enclosed by corners that have strayed, in place of the surface itself: vertices may be anywhere in it, so all of
// it has to be twice as flat. The same goes for live sides that begin or end with such a corner.
fn flatness_astray(surface: Surface, hull: Hull, own: vec4<f32>) -> Lengths {
    var sides = own;
    var most = 0.0;
    for (var part = 0u; part < 6u; part++) {
        let corners = corners_around(part);
        let has_strayed = (strayed_corners(surface) & ((1u << corners.x) | (1u << corners.z))) != 0u;
        if part > 3u || (has_strayed && side_of(surface, part).steps == 0u) {
            let range = range_around(
                corner_at(surface, corners.x), corner_at(surface, corners.y), corner_at(surface, corners.z));
            let off = part_flatness(between_any(hull, range));
            if part > 3u {
                most = max(most, mul(2.0, off));
            } else {
                sides[part] = max(sides[part], mul(side_strictness(surface, part), off));
            }
        }
    }
    return with_own_sides(Lengths(most, most, sides), sides);
}

// The corners of a part that has to be flat: of a side, which has the last one twice, or, from number 4 on, of one of
// both triangles.
fn corners_around(part: u32) -> vec3<u32> {
    if part < 4u {
        return vec3<u32>(first_corner(part), last_corner(part), last_corner(part));
    }
    return select(vec3<u32>(0u, 3u, 2u), vec3<u32>(0u, 1u, 3u), part == 4u);
}

// How many times as flat as a surface one of its sides has to be: the same for whoever has it.
fn side_strictness(surface: Surface, side: u32) -> f32 {
    let bits = extent_of(surface, side).bits;
    return strictness(select(bits, bits - 1u, is_half_line(surface, side)));
}

// Control points of a part of the patch, or of a Bezier patch that is nearly the same there.
fn between_any(hull: Hull, range: vec4<u32>) -> Net {
    if IS_RATIONAL {
        return rational_between(WEIGHTS, hull.whole, range);
    }
    if IS_GREGORY {
        let centred = centre_inner(FACES, hull.whole, range, false);
        return follow(FACES, net_between(centred.net, range), range, false);
    }
    return net_between(hull.whole, range);
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
            sides[side] = line_extent(half_line_of(surface, side));
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
    let range = range_of(surface);
    let centred = centre_inner(FACES, whole, range, exchanged);
    let part = net_between(centred.net, range);
    FOLLOWER = follow(FACES, part, range, exchanged);
    return Hull(centred.net, part, slack, centred.spread, centred.spread);
}

// Its patch's control points are multiplied by their weights.
fn hull_of_rational(whole: Net, surface: Surface) -> Hull {
    // Numerator and denominator each round, and so does the quotient.
    let slack = mul(mul(extent(whole), ROUNDING), 4.0);
    let weighted = homogeneous(WEIGHTS, whole);
    return Hull(weighted, rational_between(WEIGHTS, weighted, range_of(surface)), slack, 0.0, 0.0);
}

fn hull_of_any(whole: Net, surface: Surface) -> Hull {
    if IS_GREGORY {
        return hull_of_gregory(whole, surface);
    }
    if IS_RATIONAL {
        return hull_of_rational(whole, surface);
    }
    return hull_of_bezier(whole, surface);
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
    var hull = hull_of_any(whole, surface);
    hull.spread = add(hull.apart, REACH);
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
