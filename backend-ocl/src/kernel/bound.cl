// Mirrors core/src/kernel/bound.rs: cull, draw or split a surface, by the control hull of its range.

// Left, right, top and bottom in pixels; right and bottom are one past the last.
typedef int4 PixelBox;

// Where on screen the control points of a surface lie, and corners that have strayed from it; how far what is drawn
// can be outside of their hull.
typedef struct {
    Reach x;
    Reach y;
    float margin;
} Seen;

static Verdict new_verdict(uint code, PixelBox pixels) {
    const Verdict verdict = {code, (uint)pixels.x | (uint)pixels.y << 16, (uint)pixels.z | (uint)pixels.w << 16, 0u,
                             0u};
    return verdict;
}

static PixelBox whole_window(__constant Frame *frame) {
    return (PixelBox)((int)frame->left, (int)frame->right, (int)frame->top, (int)frame->bottom);
}

// The patch's own points, and what rounding and displacement can do.
static void put_patch(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                      Surface surface, Hull *hull) {
    const uint zero = frame->zero;
    const Instance known = instance(frame, objects, patches, surface.patch_id);
    __global const Patch *patch = patches + known.record;
    __global const Object *object = objects + known.object;
    hull->patches = patches;
    hull->patch = patch;
    hull->object = object;
    hull->is_rational = is_rational(patch);
    hull->is_gregory = patch->faces != 0u && !hull->is_rational;
    in_eye_space(zero, patch, object, &hull->whole);
    float largest = extent(&hull->whole);
    if (patch->faces != 0u) {
        faces_in_eye_space(zero, patches + patch->faces, object, &hull->faces);
    }
    if (hull->is_gregory) {
        largest = max(largest, faces_extent(&hull->faces));
    }
    hull->slack = mul(largest, ROUNDING);
    if (hull->is_rational) {
        // Numerator and denominator each round, and so does the quotient.
        hull->slack = mul(hull->slack, 4.0f);
    }
    hull->reach = object->reach;
    hull->near = max(frame->near, object->reach);
}

static void copy_net(const Net *from, Net *to) {
    for (uint l = 0u; l < 16u; l++) {
        to->x[l] = from->x[l];
        to->y[l] = from->y[l];
        to->z[l] = from->z[l];
    }
}

// The control points of a part of the patch. The inner points of a Gregory patch must be those that are in the middle.
static void put_range(uint zero, const Hull *hull, uint4 range, Net *part) {
    if (hull->is_rational) {
        rational_part(zero, &hull->whole, hull->patches + hull->patch->faces, range, part);
    } else {
        part_between(zero, &hull->whole, range, part);
    }
}

// The surface's part of it.
static void put_part(__constant Frame *frame, Surface surface, Hull *hull) {
    const uint zero = frame->zero;
    const bool exchanged = (frame->flags & FLAG_WEBER) != 0u;
    const uint4 range = range_of(surface);
    hull->apart = hull->is_gregory ? centre_inner(zero, &hull->faces, &hull->whole, range, exchanged) : 0.0f;
    hull->spread = add(hull->apart, hull->reach);
    put_range(zero, hull, range, &hull->part);
    if (hull->is_gregory) {
        copy_net(&hull->part, &hull->follower);
        follow(zero, &hull->faces, &hull->follower, range, exchanged);
    }
}

static float nearest_of(uint zero, const Hull *hull) {
    return sub(neg(fold_max(hull->part.z)), hull->spread);
}

static float nearest_smooth(uint zero, const Hull *hull) {
    return sub(neg(fold_max(hull->part.z)), hull->apart);
}

static float farthest_of(uint zero, const Hull *hull) {
    return add(neg(fold_min(hull->part.z)), hull->spread);
}

static float largest_of(const float *c) {
    return max(fold_max(c), neg(fold_min(c)));
}

static float margin(__constant Frame *frame, float slack, float nearest) {
    const uint zero = frame->zero;
    return add(1.0f, mul(mul(frame->focal, slack), recip(nearest)));
}

// Where the control points are for measuring lengths.
static void measured(__constant Frame *frame, float near, const Net *part, Net *points) {
    for (uint l = 0u; l < 16u; l++) {
        const float3 at = measured_point(frame, near, (float3)(part->x[l], part->y[l], part->z[l]));
        points->x[l] = at.x;
        points->y[l] = at.y;
        points->z[l] = at.z;
    }
}

static float segment(uint zero, const Net *points, uint from, uint to) {
    return distance_of(zero, (float3)(points->x[from], points->y[from], points->z[from]),
                       (float3)(points->x[to], points->y[to], points->z[to]));
}

// Lengths of the control polygons in one direction; `step` control points from one to the next, `row` between polygons.
static void polygons(uint zero, const Net *points, uint step, uint row, float *lengths) {
    for (uint j = 0u; j < 4u; j++) {
        const uint at = j * row;
        lengths[j] = polygon(zero, segment(zero, points, at, at + step),
                             segment(zero, points, at + step, at + 2u * step),
                             segment(zero, points, at + 2u * step, at + 3u * step));
    }
}

static void polygon_lengths(uint zero, const Net *points, Lengths *lengths) {
    float along_u[4], along_v[4];
    polygons(zero, points, 4u, 1u, along_u);
    polygons(zero, points, 1u, 4u, along_v);
    put_lengths(along_u, along_v, lengths);
}

// How many times as flat as a surface one of its sides has to be: the same for whoever has it.
static float strictness(uint zero, const Hull *hull, Surface surface, uint side) {
    const uint bits = extent_of(surface, side).y;
    return strictness_of(zero, is_half_line(hull->patch, surface, side) ? bits - 1u : bits);
}

// Control points of a part of the patch, or of a Bézier patch that is nearly the same there; `Hull::between` in core.
static void put_between(uint zero, Hull *hull, uint4 range, Net *part) {
    if (!hull->is_gregory) {
        put_range(zero, hull, range, part);
        return;
    }
    centre_inner(zero, &hull->faces, &hull->whole, range, false);
    put_range(zero, hull, range, part);
    follow(zero, &hull->faces, part, range, false);
}

// How far what is drawn in a range is from triangles.
static float off_in(__constant Frame *frame, Hull *hull, uint4 range) {
    Net part;
    put_between(frame->zero, hull, range, &part);
    return part_flatness(frame, hull->near, &part);
}

// How far the sides of a surface of a Gregory patch are from their chords, each by itself.
static void lines_of_gregory(__constant Frame *frame, Hull *hull, Surface surface, float *sides) {
    for (uint side = 0u; side < 4u; side++) {
        const uint2 ends = corners_of(side);
        const uint2 first = seeming_corner(surface, ends.x), last = seeming_corner(surface, ends.y);
        Net part;
        put_between(frame->zero, hull, around(first, last, last), &part);
        sides[side] = side_flatness(frame, hull->near, &part, side);
    }
}

// How far a live side that begins or ends with a corner that has strayed is from being flat, at least.
static float side_astray(__constant Frame *frame, Hull *hull, Surface surface, uint side) {
    const uint zero = frame->zero;
    const uint2 ends = corners_of(side);
    if (side_of(surface, side).steps != 0u || !(has_strayed(surface, ends.x) || has_strayed(surface, ends.y))) {
        return 0.0f;
    }
    const uint2 from = corner(surface, ends.x), to = corner(surface, ends.y);
    return mul(strictness(zero, hull, surface, side), off_in(frame, hull, around(from, to, to)));
}

// With what is enclosed by corners that have strayed, in place of the surface itself, and of such sides.
static void with_astray(__constant Frame *frame, Hull *hull, Surface surface, Lengths *lengths) {
    const uint zero = frame->zero;
    const uint2 a = corner(surface, 0u), b = corner(surface, 1u), d = corner(surface, 2u), c = corner(surface, 3u);
    float sides[4];
    for (uint side = 0u; side < 4u; side++) {
        sides[side] = max(lengths->sides[side], side_astray(frame, hull, surface, side));
    }
    lengths->u = max(off_in(frame, hull, around(a, b, c)), off_in(frame, hull, around(a, c, d)));
    lengths->v = lengths->u;
    put_sides(sides, lengths);
}

static void put_flatness(__constant Frame *frame, float near, const Net *part, Lengths *lengths) {
    lengths->u = part_flatness(frame, near, part);
    lengths->v = lengths->u;
    for (uint side = 0u; side < 4u; side++) {
        lengths->sides[side] = side_flatness(frame, near, part, side);
    }
}

// How far a surface and its sides are from being flat; `Hull::flatness` in core.
static void flatness_of(__constant Frame *frame, Hull *hull, Surface surface, Lengths *lengths) {
    const uint zero = frame->zero;
    float sides[4];
    if (hull->is_gregory) {
        lengths->u = part_flatness(frame, hull->near, &hull->follower);
        lengths->v = lengths->u;
        lines_of_gregory(frame, hull, surface, lengths->sides);
    } else {
        put_flatness(frame, hull->near, &hull->part, lengths);
        with_half_lines(frame, hull, surface, lengths);
    }
    for (uint side = 0u; side < 4u; side++) {
        sides[side] = mul(strictness(zero, hull, surface, side), lengths->sides[side]);
    }
    put_sides(sides, lengths);
    if (!keeps_its_corners(surface)) {
        with_astray(frame, hull, surface, lengths);
    }
}

// Lengths on screen of a hull whose control points are measured to be at `points`, which are then another's.
static void lengths_of(__constant Frame *frame, Hull *hull, Surface surface, Net *points, Lengths *lengths) {
    const uint zero = frame->zero;
    if (frame->flags & FLAG_FLAT) {
        flatness_of(frame, hull, surface, lengths);
        return;
    }
    polygon_lengths(zero, points, lengths);
    if (!hull->is_gregory) {
        with_half_lines(frame, hull, surface, lengths);
        return;
    }
    float sides[4];
    copy_sides(lengths, sides);
    sides_of_gregory(frame, hull, surface, sides);
    measured(frame, hull->near, &hull->follower, points);
    polygon_lengths(zero, points, lengths);
    put_sides(sides, lengths);
}

// What the image shows of a hull that lies beyond the near plane.
static Seen seen_of(__constant Frame *frame, const Hull *hull, float nearest, const Net *points) {
    const uint zero = frame->zero;
    const float off_axis = max(largest_of(points->x), largest_of(points->y));
    const float moved = wobble(frame, off_axis, hull->spread, nearest);
    const Seen seen = {{fold_min(points->x), fold_max(points->x)},
                       {fold_min(points->y), fold_max(points->y)},
                       add(margin(frame, hull->slack, nearest), moved)};
    return seen;
}

static Seen with_strays(Seen seen, Strays strays) {
    if (strays.are_some) {
        seen.x = joined(seen.x, strays.x);
        seen.y = joined(seen.y, strays.y);
    }
    return seen;
}

static int2 pixel_range(uint zero, Reach reach, float centre, uint2 limits, float margin) {
    const float first = number((int)limits.x), end = number((int)limits.y);
    const float low = sub(add(reach.low, centre), margin);
    const float high = add(add(reach.high, centre), add(margin, 1.0f));
    return (int2)(floor(clamp(low, first, end)), floor(clamp(high, first, end)));
}

// The pixels that drawing what is seen can touch.
static PixelBox box_around(__constant Frame *frame, Seen seen) {
    const uint2 columns = (uint2)(frame->left, frame->right), rows = (uint2)(frame->top, frame->bottom);
    return (PixelBox)(pixel_range(frame->zero, seen.x, frame->centre_x, columns, seen.margin),
                      pixel_range(frame->zero, seen.y, frame->centre_y, rows, seen.margin));
}

static bool is_empty(PixelBox box) {
    return box.x >= box.y || box.z >= box.w;
}

// Does a patch of this kind have two others beside one of these sides, a bit a side?
static bool is_halved(uint kind, uint sides) {
    return (kind & KIND_HALVED & sides) != 0u;
}

// Is there a level for each of so many splits?
static bool may_split(__constant Frame *frame, Surface surface, uint times) {
    return level(surface) + times < frame->levels;
}

// Most halvings of a patch of this kind along either parameter.
static uint most_splits(uint kind) {
    return (kind & (KIND_HALVED | KIND_HALVED << KIND_HALF_SHIFT)) != 0u ? JOINED_SPLITS : MAX_SPLITS;
}

static uint refine(__constant Frame *frame, Surface surface, uint kind, float u, float v) {
    const bool open_u = u_level(surface) < most_splits(kind);
    const bool open_v = v_level(surface) < most_splits(kind);
    if (!may_split(frame, surface, 1u)) {
        return DRAW_LIMITED;
    }
    if (u > v) {
        return open_u ? SPLIT_U : open_v && v > frame->bound ? SPLIT_V : DRAW_LIMITED;
    }
    return open_v ? SPLIT_V : open_u && u > frame->bound ? SPLIT_U : DRAW_LIMITED;
}

// What becomes of a surface that is so far from being flat: it is split into four, in two steps.
static uint quartered(__constant Frame *frame, Surface surface, uint kind, float off) {
    if (is_half_way(frame, surface)) {
        return SPLIT_V;
    }
    const bool is_whole = level(surface) == 0u && is_halved(kind, KIND_HALVED);
    if (off <= frame->bound && !is_whole) {
        return DRAW;
    }
    const bool may = u_level(surface) < most_splits(kind) && may_split(frame, surface, 2u);
    return may ? SPLIT_U : DRAW_LIMITED;
}

// What becomes of a surface in view, of a patch of this kind, that is so long.
static uint by_extents(__constant Frame *frame, Surface surface, uint kind, float2 extents) {
    if (frame->flags & FLAG_FLAT) {
        return quartered(frame, surface, kind, max(extents.x, extents.y));
    }
    if (is_halved(kind, 3u) && u_level(surface) == 0u) {
        return may_split(frame, surface, 1u) ? SPLIT_U : DRAW_LIMITED;
    }
    if (is_halved(kind, 12u) && v_level(surface) == 0u) {
        return may_split(frame, surface, 1u) ? SPLIT_V : DRAW_LIMITED;
    }
    return max(extents.x, extents.y) <= frame->bound ? DRAW : refine(frame, surface, kind, extents.x, extents.y);
}

// The verdict, with sides and rates.
static Verdict with_sides(__constant Frame *frame, Surface surface, uint kind, const Lengths *lengths,
                          Verdict verdict) {
    Side sides[4];
    divide(frame, surface, kind, lengths, verdict.code, sides);
    const Verdict halved = with_packed(verdict, sides, (uint2)(0u));
    if (verdict.code == SPLIT_U || verdict.code == SPLIT_V) {
        return halved;
    }
    return with_packed(verdict, sides, rates(frame, divided(surface, halved), lengths));
}

// The verdict on a surface in view that is so long.
static Verdict by_length(__constant Frame *frame, Surface surface, uint kind, const Lengths *lengths,
                         PixelBox pixels) {
    const uint code = by_extents(frame, surface, kind, (float2)(lengths->u, lengths->v));
    return with_sides(frame, surface, kind, lengths, new_verdict(code, pixels));
}

static bool beyond(__constant Frame *frame, const float *z, const float *c, float centre, float slack) {
    const uint zero = frame->zero;
    const float tolerance = mul(slack, add(frame->focal, centre));
    float low[16], high[16];
    for (uint l = 0u; l < 16u; l++) {
        const float offset = mul(c[l], frame->focal);
        const float edge = mul(neg(z[l]), centre);
        low[l] = add(edge, offset);
        high[l] = sub(edge, offset);
    }
    return add(fold_max(low), tolerance) < 0.0f || add(fold_max(high), tolerance) < 0.0f;
}

static bool beside_the_view(__constant Frame *frame, const Net *part, float slack) {
    return beyond(frame, part->z, part->x, frame->centre_x, slack)
        || beyond(frame, part->z, part->y, frame->centre_y, slack);
}

// Lengths along u and along v of a surface that crosses the near plane: as if all of it were there, and turned to the eye.
static float2 extents_if_cut(__constant Frame *frame, float near, const Net *part, Net *points) {
    const uint zero = frame->zero;
    const float scale = mul(frame->focal, recip(near));
    for (uint l = 0u; l < 16u; l++) {
        points->x[l] = clamp(mul(part->x[l], scale), neg(FAR_OFF), FAR_OFF);
        points->y[l] = clamp(mul(part->y[l], scale), neg(FAR_OFF), FAR_OFF);
        points->z[l] = clamp(mul(part->z[l], scale), neg(FAR_OFF), FAR_OFF);
    }
    Lengths lengths;
    polygon_lengths(zero, points, &lengths);
    return (float2)(lengths.u, lengths.v);
}

// What is off the axis is seen farthest off it at the near plane.
static Reach reach_if_cut(__constant Frame *frame, float low, float high, float at_near, float at_far) {
    const uint zero = frame->zero;
    return new_reach(mul(mul(low, frame->focal), low < 0.0f ? at_near : at_far),
                     mul(mul(high, frame->focal), high > 0.0f ? at_near : at_far));
}

// The pixels that drawing a surface can touch of which parts lie as near as the near plane.
static PixelBox pixels_if_cut(__constant Frame *frame, const Hull *hull, float farthest) {
    const uint zero = frame->zero;
    const Net *part = &hull->part;
    const float at_near = recip(frame->near), at_far = recip(max(add(farthest, hull->slack), frame->near));
    const Seen seen = {
        reach_if_cut(frame, fold_min(part->x), fold_max(part->x), at_near, at_far),
        reach_if_cut(frame, neg(fold_max(part->y)), neg(fold_min(part->y)), at_near, at_far),
        margin(frame, add(hull->slack, hull->spread), frame->near)};
    return box_around(frame, seen);
}

// The verdict on a surface inside a hull that crosses the near plane, or does not.
static Verdict judge_seen(__constant Frame *frame, Hull *hull, Surface surface, Strays strays, bool crosses) {
    const uint zero = frame->zero;
    const float nearest = nearest_of(zero, hull), farthest = farthest_of(zero, hull);
    Net points;
    Lengths lengths;
    PixelBox pixels = whole_window(frame);
    measured(frame, hull->near, &hull->part, &points);
    if (!crosses && !(strays.are_some && min(nearest, strays.nearest) < frame->near)) {
        pixels = box_around(frame, with_strays(seen_of(frame, hull, nearest, &points), strays));
    }
    if (!crosses && is_empty(pixels)) {
        return new_verdict(CULL, (PixelBox)(0));
    }
    lengths_of(frame, hull, surface, &points, &lengths);
    if (!crosses) {
        return by_length(frame, surface, hull->patch->kind, &lengths, pixels);
    }
    if (!strays.are_some) {
        pixels = pixels_if_cut(frame, hull, farthest);
    }
    const bool is_cut = nearest_smooth(zero, hull) < hull->near && (frame->flags & FLAG_FLAT) == 0u;
    const float2 extents =
        is_cut ? extents_if_cut(frame, hull->near, &hull->part, &points) : (float2)(lengths.u, lengths.v);
    const uint kind = hull->patch->kind, code = by_extents(frame, surface, kind, extents);
    return with_sides(frame, surface, kind, &lengths, new_verdict(code, pixels));
}

static Verdict judge(__constant Frame *frame, Hull *hull, Surface surface) {
    const uint zero = frame->zero;
    if (frame->flags & FLAG_WHOLE) {
        Net points;
        Lengths lengths;
        measured(frame, hull->near, &hull->part, &points);
        lengths_of(frame, hull, surface, &points, &lengths);
        return by_length(frame, surface, hull->patch->kind, &lengths, whole_window(frame));
    }
    const float nearest = nearest_of(zero, hull), farthest = farthest_of(zero, hull);
    const Strays strays = strays_of(frame, hull, surface);
    const float end = strays.are_some ? max(farthest, strays.farthest) : farthest;
    const bool crosses = nearest < frame->near && add(farthest, hull->slack) >= frame->near;
    // Boxes of what is displaced are wide where it is near.
    const bool is_vague = crosses || hull->reach > 0.0f;
    const bool is_beside = is_vague && !strays.are_some
        && beside_the_view(frame, &hull->part, add(hull->slack, hull->spread));
    if (add(end, hull->slack) < frame->near || is_beside) {
        return new_verdict(CULL, (PixelBox)(0));
    }
    return judge_seen(frame, hull, surface, strays, crosses);
}

// The pixels that drawing the surface inside a hull can touch.
static PixelBox pixels_of(__constant Frame *frame, const Hull *hull) {
    const float nearest = nearest_of(frame->zero, hull);
    if (nearest < frame->near || (frame->flags & FLAG_WHOLE) != 0u) {
        return whole_window(frame);
    }
    Net points;
    measured(frame, frame->near, &hull->part, &points);
    return box_around(frame, seen_of(frame, hull, nearest, &points));
}

// The verdict by the rules of Weber's program.
static Verdict bound_weber(__constant Frame *frame, Hull *hull, Surface surface) {
    const bool has_faces = hull->is_gregory || hull->is_rational; // he knows no weights, and takes them for face points
    const uint code = weber_code(frame, &hull->whole, &hull->faces, has_faces, surface);
    const Side live = {0u, 0u};
    const Side sides[4] = {live, live, live, live};
    PixelBox pixels = (PixelBox)(0);
    if (code == DRAW) {
        // As it was before his points were looked at.
        in_eye_space(frame->zero, hull->patch, hull->object, &hull->whole);
        put_part(frame, surface, hull);
        pixels = pixels_of(frame, hull);
    }
    return with_packed(new_verdict(code, pixels), sides, (uint2)(frame->rate));
}

// The verdict on one surface of any patch, by the rules of the frame's profile.
static Verdict bound_any(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                         Surface surface) {
    Hull hull;
    put_patch(frame, objects, patches, surface, &hull);
    if (frame->flags & FLAG_WEBER) {
        return bound_weber(frame, &hull, surface);
    }
    put_part(frame, surface, &hull);
    return judge(frame, &hull, surface);
}

__kernel void stage_bound(__constant Frame *frame, __global const Object *objects,
                          __global const Patch *patches, __global const Control *control,
                          __global const Surface *stack, __global Surface *batch,
                          __global Verdict *verdicts) {
    const uint index = get_global_id(0);
    if (index < control->taken) {
        const Surface surface = member(control, stack, batch, index);
        batch[index] = surface;
        verdicts[index] = bound_any(frame, objects, patches, surface);
    }
}
