// Mirrors core/src/kernel/bound.rs: cull, draw or split a surface, by the control hull of its range.

// Left, right, top and bottom in pixels; right and bottom are one past the last.
typedef int4 PixelBox;

static Verdict new_verdict(uint code, PixelBox pixels) {
    const Verdict verdict = {code, (uint)pixels.x | (uint)pixels.y << 16, (uint)pixels.z | (uint)pixels.w << 16};
    return verdict;
}

static uint refine(__constant Frame *frame, Surface surface, float u, float v, bool too_long_u, bool too_long_v) {
    const bool open_u = u_level(surface) < MAX_SPLITS;
    const bool open_v = v_level(surface) < MAX_SPLITS;
    if (level(surface) + 1u >= frame->levels) {
        return DRAW_LIMITED;
    }
    if (u > v) {
        return open_u ? SPLIT_U : open_v && too_long_v ? SPLIT_V : DRAW_LIMITED;
    }
    return open_v ? SPLIT_V : open_u && too_long_u ? SPLIT_U : DRAW_LIMITED;
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

static float span(uint zero, float a, float b, float c, float d) {
    return sub(max(max(a, b), max(c, d)), min(min(a, b), min(c, d)));
}

// How much the distance varies along u and along v.
static float2 depth_spans(uint zero, const float *z) {
    float2 spans = (float2)(0.0f, 0.0f);
    for (uint l = 0u; l < 4u; l++) {
        const float *p = z + 4u * l;
        spans.x = max(spans.x, span(zero, z[l], z[4u + l], z[8u + l], z[12u + l]));
        spans.y = max(spans.y, span(zero, p[0], p[1], p[2], p[3]));
    }
    return spans;
}

static void on_screen(__constant Frame *frame, const Net *part, float *xs, float *ys) {
    for (uint l = 0u; l < 16u; l++) {
        const float3 seen = perspective(frame, (float3)(part->x[l], part->y[l], part->z[l]));
        xs[l] = clamp(seen.x, neg(FAR_OFF), FAR_OFF);
        ys[l] = clamp(seen.y, neg(FAR_OFF), FAR_OFF);
    }
}

static float segment(uint zero, const float *x, const float *y, uint from, uint to) {
    const float dx = sub(x[to], x[from]), dy = sub(y[to], y[from]);
    return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));
}

// Length of the longest control polygon; `step` control points from one to the next, `row` between polygons.
static float longest_polygon(uint zero, const float *x, const float *y, uint step, uint row) {
    float polygons[4];
    for (uint j = 0u; j < 4u; j++) {
        const uint at = j * row;
        const float first = segment(zero, x, y, at, at + step);
        const float second = segment(zero, x, y, at + step, at + 2u * step);
        polygons[j] = add(add(first, second), segment(zero, x, y, at + 2u * step, at + 3u * step));
    }
    return max(max(polygons[0], polygons[1]), max(polygons[2], polygons[3]));
}

static float length_u(uint zero, const float *x, const float *y) {
    return longest_polygon(zero, x, y, 4u, 1u);
}

static float length_v(uint zero, const float *x, const float *y) {
    return longest_polygon(zero, x, y, 1u, 4u);
}

static int2 pixel_range(uint zero, const float *offsets, float centre, uint size, float margin) {
    const float end = number((int)size);
    const float low = sub(add(fold_min(offsets), centre), margin);
    const float high = add(add(fold_max(offsets), centre), add(margin, 1.0f));
    return (int2)(floor(clamp(low, 0.0f, end)), floor(clamp(high, 0.0f, end)));
}

static PixelBox box_around(__constant Frame *frame, const float *x, const float *y, float margin) {
    const int2 columns = pixel_range(frame->zero, x, frame->centre_x, frame->width, margin);
    const int2 rows = pixel_range(frame->zero, y, frame->centre_y, frame->height, margin);
    return (PixelBox)(columns, rows);
}

static bool is_empty(PixelBox box) {
    return box.x >= box.y || box.z >= box.w;
}

// Control hull of a surface; what rounding can do; how far the surface can be from the one whose hull it is, and
// another net, whose lengths are the surface's.
typedef struct {
    Net part;
    Net follower;
    float slack;
    float spread;
} Hull;

// Control points on screen, and how far the surface can be outside of their hull.
typedef struct {
    float x[16];
    float y[16];
    float margin;
} Seen;

static float largest_of(const float *c) {
    return max(fold_max(c), neg(fold_min(c)));
}

static void copy_net(const Net *from, Net *to) {
    for (uint l = 0u; l < 16u; l++) {
        to->x[l] = from->x[l];
        to->y[l] = from->y[l];
        to->z[l] = from->z[l];
    }
}

static void hull_of(__constant Frame *frame, Net *whole, const Faces *faces, bool is_gregory, Surface surface,
                    Hull *hull) {
    const uint zero = frame->zero;
    float reach = extent(whole);
    hull->spread = 0.0f;
    if (is_gregory) {
        reach = max(reach, faces_extent(faces));
        hull->spread = centre_inner(zero, faces, whole, surface, (frame->flags & FLAG_WEBER) != 0u);
    }
    hull->slack = mul(reach, ROUNDING);
    restricted(zero, whole, surface, &hull->part);
    if (is_gregory) {
        copy_net(&hull->part, &hull->follower);
        follow(zero, faces, &hull->follower, surface, (frame->flags & FLAG_WEBER) != 0u);
    }
}

static float nearest_of(uint zero, const Hull *hull) {
    return sub(neg(fold_max(hull->part.z)), hull->spread);
}

static void see(__constant Frame *frame, const Hull *hull, float nearest, Seen *seen) {
    const uint zero = frame->zero;
    on_screen(frame, &hull->part, seen->x, seen->y);
    const float scale = recip(nearest);
    const float off_axis = max(largest_of(seen->x), largest_of(seen->y));
    const float wobble = mul(mul(add(frame->focal, off_axis), hull->spread), scale);
    seen->margin = add(add(1.0f, mul(mul(frame->focal, hull->slack), scale)), wobble);
}

static PixelBox seen_pixels(__constant Frame *frame, const Seen *seen) {
    const uint zero = frame->zero;
    return box_around(frame, seen->x, seen->y, add(seen->margin, mul(frame->bound, SEAM_ALLOWANCE)));
}

// The verdict on a surface that reaches before the near plane.
static Verdict bound_near(__constant Frame *frame, const Hull *hull, Surface surface) {
    const uint zero = frame->zero;
    if (beside_the_view(frame, &hull->part, add(hull->slack, hull->spread))) {
        return new_verdict(CULL, (PixelBox)(0));
    }
    const float2 spans = depth_spans(zero, hull->part.z);
    const uint code = refine(frame, surface, spans.x, spans.y, false, false);
    return new_verdict(code, (PixelBox)(0, (int)frame->width, 0, (int)frame->height));
}

// The verdict on a surface that lies beyond the near plane.
static Verdict bound_far(__constant Frame *frame, const Hull *hull, bool is_gregory, Surface surface,
                         float nearest) {
    const uint zero = frame->zero;
    Seen seen;
    see(frame, hull, nearest, &seen);
    if (is_empty(box_around(frame, seen.x, seen.y, seen.margin))) {
        return new_verdict(CULL, (PixelBox)(0));
    }
    const PixelBox pixels = seen_pixels(frame, &seen);
    if (is_gregory) {
        on_screen(frame, &hull->follower, seen.x, seen.y);
    }
    const float u = length_u(zero, seen.x, seen.y), v = length_v(zero, seen.x, seen.y);
    if (max(u, v) <= frame->bound) {
        return new_verdict(DRAW, pixels);
    }
    return new_verdict(refine(frame, surface, u, v, u > frame->bound, v > frame->bound), pixels);
}

static Verdict judge(__constant Frame *frame, const Hull *hull, bool is_gregory, Surface surface) {
    const uint zero = frame->zero;
    const float nearest = nearest_of(zero, hull);
    const float farthest = add(neg(fold_min(hull->part.z)), hull->spread);
    if (add(farthest, hull->slack) < frame->near) {
        return new_verdict(CULL, (PixelBox)(0));
    }
    if (nearest < frame->near) {
        return bound_near(frame, hull, surface);
    }
    return bound_far(frame, hull, is_gregory, surface, nearest);
}

// The pixels that drawing the surface inside a hull can touch.
static PixelBox pixels_of(__constant Frame *frame, const Hull *hull) {
    const float nearest = nearest_of(frame->zero, hull);
    if (nearest < frame->near) {
        return (PixelBox)(0, (int)frame->width, 0, (int)frame->height);
    }
    Seen seen;
    see(frame, hull, nearest, &seen);
    return seen_pixels(frame, &seen);
}

// The verdict by the rules of Weber's program.
static Verdict bound_weber(__constant Frame *frame, Net *net, const Faces *faces, bool is_gregory,
                           Surface surface) {
    const uint code = weber_code(frame, net, faces, is_gregory, surface);
    if (code != DRAW) {
        return new_verdict(code, (PixelBox)(0));
    }
    Hull hull;
    hull_of(frame, net, faces, is_gregory, surface, &hull);
    return new_verdict(code, pixels_of(frame, &hull));
}

// The verdict on one surface of any patch, by the rules of the frame's profile.
static Verdict bound_any(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                         Surface surface) {
    const uint zero = frame->zero;
    __global const Patch *patch = patches + surface.patch_id;
    __global const Object *object = objects + patch->object;
    const bool is_gregory = patch->faces != 0u;
    Net net;
    Faces faces;
    in_eye_space(zero, patch, object, &net);
    if (is_gregory) {
        faces_in_eye_space(zero, patches + patch->faces, object, &faces);
    }
    if (frame->flags & FLAG_WEBER) {
        return bound_weber(frame, &net, &faces, is_gregory, surface);
    }
    Hull hull;
    hull_of(frame, &net, &faces, is_gregory, surface, &hull);
    return judge(frame, &hull, is_gregory, surface);
}

__kernel void stage_bound(__constant Frame *frame, __global const Object *objects,
                          __global const Patch *patches, __global const Control *control,
                          __global const Surface *stack, __global Surface *batch,
                          __global Verdict *verdicts) {
    const uint index = get_global_id(0);
    if (index < control->taken) {
        const Surface surface = member(control, stack, index);
        batch[index] = surface;
        verdicts[index] = bound_any(frame, objects, patches, surface);
    }
}
