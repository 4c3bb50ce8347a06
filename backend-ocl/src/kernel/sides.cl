// Mirrors core/src/kernel/sides.rs: how the four sides of a surface are divided, and how finely its grid is diced.
// Also where points are for measuring lengths, and the control hull, which core has in core/src/kernel/bound.rs.

// Control hull of a surface, and of the whole patch; what rounding can do, what displacement can do, how far the surface
// can be from the one whose hull it is, and the sum of both. Of a Gregory patch also another net, whose lengths are the
// surface's, but which bounds nothing.
typedef struct {
    __global const Patch *patches;
    __global const Patch *patch;
    __global const Object *object;
    Net whole;
    Faces faces;
    Net part;
    Net follower;
    bool is_gregory;
    bool is_rational;
    float slack;
    float reach;
    float apart;
    float spread;
    // What is nearer than this is measured as if it were this far away.
    float near;
} Hull;

// Lengths in pixels: of the longest lines along u and along v, and of the sides, by number.
typedef struct {
    float u;
    float v;
    float sides[4];
} Lengths;

// Least and largest of one coordinate on screen, in pixels from the optical axis.
typedef struct {
    float low;
    float high;
} Reach;

// Where corners are that have strayed from a surface; how near and far they are from the eye plane.
typedef struct {
    bool are_some;
    Reach x;
    Reach y;
    float nearest;
    float farthest;
} Strays;

static float2 point_on_screen(__constant Frame *frame, float near, float3 point) {
    const float3 seen = perspective(frame, near, point);
    return (float2)(clamp(seen.x, neg(FAR_OFF), FAR_OFF), clamp(seen.y, neg(FAR_OFF), FAR_OFF));
}

// Where a point is for measuring lengths: on screen; or on a sheet of pixels that surrounds the eye.
static float3 measured_point(__constant Frame *frame, float near, float3 point) {
    const uint zero = frame->zero;
    if ((frame->flags & FLAG_WHOLE) == 0u) {
        const float2 seen = point_on_screen(frame, near, point);
        return (float3)(seen.x, seen.y, 0.0f);
    }
    const float before = max(neg(point.z), mul(largest3(point), frame->around));
    return scale3(point, mul(frame->focal, recip(max(before, near))));
}

// `distance` in core, which is a function of OpenCL's that may not be called here.
static float distance_of(uint zero, float3 a, float3 b) {
    const float dx = sub(b.x, a.x), dy = sub(b.y, a.y), dz = sub(b.z, a.z);
    return sqrt(add(add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz)), LENGTH_TINY));
}

static float longest(const float *all) {
    return max(max(all[0], all[1]), max(all[2], all[3]));
}

// Of a surface whose control polygons along u and along v are so long, each in order.
static void put_lengths(const float *u, const float *v, Lengths *lengths) {
    lengths->u = longest(u);
    lengths->v = longest(v);
    lengths->sides[0] = u[0];
    lengths->sides[1] = u[3];
    lengths->sides[2] = v[0];
    lengths->sides[3] = v[3];
}

// A surface is no shorter than its sides.
static void put_sides(const float *sides, Lengths *lengths) {
    lengths->u = max(lengths->u, max(sides[0], sides[1]));
    lengths->v = max(lengths->v, max(sides[2], sides[3]));
    for (uint side = 0u; side < 4u; side++) {
        lengths->sides[side] = sides[side];
    }
}

static void copy_sides(const Lengths *lengths, float *sides) {
    for (uint side = 0u; side < 4u; side++) {
        sides[side] = lengths->sides[side];
    }
}

// Length of a polygon of three pieces; the same from either end.
static float polygon(uint zero, float a, float b, float c) {
    return add(add(a, c), b);
}

// Steps of a line that is so long on screen.
static uint steps_of(__constant Frame *frame, float length) {
    const uint zero = frame->zero;
    const float steps = clamp(mul(length, frame->density), 1.0f, num_float(zero, (int)frame->rate));
    return (uint)(-floor(neg(steps)));
}

// Has a surface that is split into four been split once?
static bool is_half_way(__constant Frame *frame, Surface surface) {
    return (frame->flags & FLAG_FLAT) != 0u && u_level(surface) > v_level(surface);
}

// Is a side all of one side of its patch, with two patches on the other side of it?
static bool is_to_be_halved(Surface surface, uint kind, uint side) {
    return (kind & KIND_HALVED & 1u << side) != 0u && extent_of(surface, side).y == PARAM_BITS
        && is_outer(surface, side);
}

// How the sides of a surface of a patch of this kind are divided: as they were, unless they are live and short enough; or
// long, but may not be halved any more. Half way through a split into four nothing is decided.
static void divide(__constant Frame *frame, Surface surface, uint kind, const Lengths *lengths, uint code, Side *sides) {
    for (uint number = 0u; number < 4u; number++) {
        const float length = lengths->sides[number];
        Side side = side_of(surface, number);
        const bool is_short = length <= frame->bound && !is_to_be_halved(surface, kind, number);
        const bool is_last = (is_short && !is_half_way(frame, surface)) || code == DRAW_LIMITED;
        if (side.steps == 0u && is_last && (frame->flags & FLAG_NAIVE) == 0u) {
            side.steps = steps_of(frame, length);
            side.bits = extent_of(surface, number).y;
        }
        sides[number] = side;
    }
}

// Micropolygons of a surface in one direction: enough for its length, and for the vertices of two sides.
static uint rate_for(__constant Frame *frame, Surface surface, float length, uint first) {
    const uint needed = greater_of(steps_needed(surface, first), steps_needed(surface, first + 1u));
    return greater_of(steps_of(frame, length), needed);
}

// Micropolygons along u and along v of a surface whose sides are divided.
static uint2 rates(__constant Frame *frame, Surface surface, const Lengths *lengths) {
    if (frame->flags & FLAG_FIXED) {
        return (uint2)(frame->rate);
    }
    return (uint2)(rate_for(frame, surface, lengths->u, 0u), rate_for(frame, surface, lengths->v, 2u));
}

// Length of a line's control polygon on screen, or how far it is from its chord.
static float line_extent(__constant Frame *frame, float near, float3 *line) {
    const uint zero = frame->zero;
    if (frame->flags & FLAG_FLAT) {
        return line_flatness(frame, near, line);
    }
    for (uint k = 0u; k < 4u; k++) {
        line[k] = measured_point(frame, near, line[k]);
    }
    return polygon(zero, distance_of(zero, line[0], line[1]), distance_of(zero, line[1], line[2]),
                   distance_of(zero, line[2], line[3]));
}

// The same of a side that is half of another patch's side, given what it is there.
static float halved_extent(__constant Frame *frame, const Hull *hull, Surface surface, uint side) {
    const uint2 extent = extent_of(surface, side);
    float3 line[4];
    line_of_half(frame->zero, hull->patches, hull->object, hull->patch->owners[side], extent.x,
                 extent.x + (1u << extent.y), line);
    return line_extent(frame, hull->near, line);
}

// Is a side of a surface half of another patch's side, or a piece of it?
static bool is_half_line(__global const Patch *patch, Surface surface, uint side) {
    return is_half(patch, side) && is_outer(surface, side);
}

// Lengths of the sides of a surface, those replaced that are halves of other patches' sides.
static void with_half_lines(__constant Frame *frame, const Hull *hull, Surface surface, Lengths *lengths) {
    float sides[4];
    if (!has_halves(hull->patch)) {
        return;
    }
    for (uint side = 0u; side < 4u; side++) {
        const bool is_there = is_half_line(hull->patch, surface, side);
        sides[side] = is_there ? halved_extent(frame, hull, surface, side) : lengths->sides[side];
    }
    put_sides(sides, lengths);
}

// Length of a side inside a Gregory patch: four chords between its points.
static float side_inside(__constant Frame *frame, Hull *hull, Surface surface, uint side) {
    const uint zero = frame->zero;
    const uint quarter = (side < 2u ? u_size(surface) : v_size(surface)) / 4u;
    float3 seen[5];
    for (uint k = 0u; k < 5u; k++) {
        const uint2 at = on_side(surface, side, extent_of(surface, side).x + k * quarter);
        const float3 point = point_at(frame, &hull->whole, &hull->faces, true, at.x, at.y);
        seen[k] = measured_point(frame, hull->near, point);
    }
    const float outer = add(distance_of(zero, seen[0], seen[1]), distance_of(zero, seen[3], seen[4]));
    return add(outer, add(distance_of(zero, seen[1], seen[2]), distance_of(zero, seen[2], seen[3])));
}

// Lengths of the sides of a surface of a Gregory patch: those on the patch's edge are as they were in `sides`.
static void sides_of_gregory(__constant Frame *frame, Hull *hull, Surface surface, float *sides) {
    for (uint side = 0u; side < 4u; side++) {
        const uint2 on_it = on_side(surface, side, 0u);
        const uint end = side < 2u ? on_it.y : on_it.x;
        if (side_of(surface, side).steps == 0u && end != 0u && end != PARAM_ONE) {
            sides[side] = side_inside(frame, hull, surface, side);
        }
    }
}

static Reach new_reach(float low, float high) {
    const Reach reach = {low, high};
    return reach;
}

// As far as `by` around one place.
static Reach reach_around(uint zero, float offset, float by) {
    return new_reach(sub(offset, by), add(offset, by));
}

// Both, and all that lies between them.
static Reach joined(Reach a, Reach b) {
    return new_reach(min(a.low, b.low), max(a.high, b.high));
}

// How far, in pixels, points up to `off_axis` pixels from the axis move on screen if they move by `spread` along any
// axis, and come no nearer than `nearest`.
static float wobble(__constant Frame *frame, float off_axis, float spread, float nearest) {
    const uint zero = frame->zero;
    return mul(mul(add(frame->focal, off_axis), spread), recip(nearest));
}

// Where a vertex of the hull's patch is.
static float3 position_on(__constant Frame *frame, Hull *hull, uint2 at) {
    if (hull->is_rational) {
        return rational_point(frame->zero, &hull->whole, hull->patches + hull->patch->faces, at);
    }
    if (hull->is_gregory) {
        return point_at(frame, &hull->whole, &hull->faces, true, at.x, at.y);
    }
    return joined_position(frame->zero, hull->patches, hull->object, hull->patch, &hull->whole, at);
}

static Strays strays_of(__constant Frame *frame, Hull *hull, Surface surface) {
    const uint zero = frame->zero;
    const Reach none = {0.0f, 0.0f};
    Strays found = {false, none, none, 0.0f, 0.0f};
    for (uint number = 0u; number < 4u; number++) {
        if (!has_strayed(surface, number)) {
            continue;
        }
        const uint2 at = corner(surface, number);
        const float3 point = position_on(frame, hull, at);
        const float2 seen = point_on_screen(frame, frame->near, point);
        const float away = neg(point.z);
        const float nearest = sub(away, hull->reach), farthest = add(away, hull->reach);
        const float by = wobble(frame, max(abs(seen.x), abs(seen.y)), hull->reach, max(nearest, frame->near));
        const Reach x = reach_around(zero, seen.x, by), y = reach_around(zero, seen.y, by);
        found.x = found.are_some ? joined(found.x, x) : x;
        found.y = found.are_some ? joined(found.y, y) : y;
        found.nearest = found.are_some ? min(found.nearest, nearest) : nearest;
        found.farthest = found.are_some ? max(found.farthest, farthest) : farthest;
        found.are_some = true;
    }
    return found;
}
