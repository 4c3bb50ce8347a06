// Mirrors core/src/kernel/clip.rs: clipping at the near plane and the guard band.
#define MAX_CORNERS 8u
#define PLANES 5u

typedef struct {
    float3 corners[MAX_CORNERS];
    uint count;
} Polygon;

static void push(Polygon *polygon, float3 corner) {
    if (polygon->count < MAX_CORNERS) {
        polygon->corners[polygon->count] = corner;
        polygon->count += 1u;
    }
}

// How far inside plane near, left, right, bottom or top a point is; negative outside.
static float inside(__constant Frame *frame, uint plane, float3 p) {
    const uint zero = frame->zero;
    const float reach = mul(neg(p.z), GUARD_BAND);
    switch (plane) {
    case 0u: return sub(neg(p.z), frame->near);
    case 1u: return add(reach, mul(p.x, frame->focal));
    case 2u: return sub(reach, mul(p.x, frame->focal));
    case 3u: return add(reach, mul(p.y, frame->focal));
    default: return sub(reach, mul(p.y, frame->focal));
    }
}

static float towards(uint zero, float inner, float outer, float share) {
    return add(inner, mul(share, sub(outer, inner)));
}

static float3 cut(__constant Frame *frame, uint plane, float3 inner, float3 outer) {
    const uint zero = frame->zero;
    const float from = inside(frame, plane, inner);
    const float share = mul(from, recip(sub(from, inside(frame, plane, outer))));
    const float3 point = (float3)(towards(zero, inner.x, outer.x, share), towards(zero, inner.y, outer.y, share),
                                  towards(zero, inner.z, outer.z, share));
    return plane == 0u ? (float3)(point.x, point.y, neg(frame->near)) : point;
}

static void clip_by(__constant Frame *frame, uint plane, const Polygon *polygon, Polygon *out) {
    out->count = 0u;
    for (uint index = 0u; index < polygon->count; index++) {
        const float3 here = polygon->corners[index];
        const float3 next = polygon->corners[(index + 1u) % polygon->count];
        const bool here_in = inside(frame, plane, here) >= 0.0f;
        const bool next_in = inside(frame, plane, next) >= 0.0f;
        if (here_in) {
            push(out, here);
        }
        if (here_in && !next_in) {
            push(out, cut(frame, plane, here, next));
        } else if (next_in && !here_in) {
            push(out, cut(frame, plane, next, here));
        }
    }
}

// Corner by corner: a compiler is known that loses corners when it copies the struct as a whole.
static void copy(const Polygon *from, Polygon *to) {
    to->count = from->count;
    for (uint index = 0u; index < MAX_CORNERS; index++) {
        to->corners[index] = from->corners[index];
    }
}

static void clip(__constant Frame *frame, float3 a, float3 b, float3 c, Polygon *polygon) {
    polygon->count = 0u;
    push(polygon, a);
    push(polygon, b);
    push(polygon, c);
    for (uint plane = 0u; plane < PLANES; plane++) {
        Polygon before;
        copy(polygon, &before);
        clip_by(frame, plane, &before, polygon);
    }
}
