// Mirrors core/src/tess/evaluate.rs: a vertex of a tessellated patch: a point of its surface, moved along its normal by the
// height map.

// The two texels of a row between which a place is, and how far it is from the first.
typedef struct {
    uint before;
    uint after;
    float share;
} Texels;

static float corner_share(uint zero, __global const float *uv, float4 w, uint axis) {
    const float a = mul(w.x, flush(uv[axis])), b = mul(w.y, flush(uv[2u + axis]));
    const float c = mul(w.z, flush(uv[4u + axis])), d = mul(w.w, flush(uv[6u + axis]));
    return flush(add(add(a, b), add(c, d)));
}

// Texture coordinates: those of the corners times their shares.
static float2 texture(uint zero, __global const float *uv, float4 w) {
    return (float2)(corner_share(zero, uv, w, 0u), corner_share(zero, uv, w, 1u));
}

static float2 on_edge(__constant TessFrame *frame, __global const TessPatch *patch, float4 weights, uint edge) {
    const uint zero = frame->zero;
    const uint2 both = ends(frame, edge);
    const float a = element(weights, both.x), b = element(weights, both.y);
    __global const float *at = patch->edges + 4u * edge;
    return (float2)(flush(add(mul(a, flush(at[0])), mul(b, flush(at[2])))),
                    flush(add(mul(a, flush(at[1])), mul(b, flush(at[3])))));
}

// Where the height of a vertex is looked up: on outer edges and at corners where their owners have it.
static float2 place_of_height(__constant TessFrame *frame, __global const TessPatch *patch, uint3 coordinates,
                              float2 inside) {
    const float4 weights = weights_of(frame, coordinates);
    float2 place = inside;
    for (uint edge = 0u; edge < corner_count(frame); edge++) {
        if (is_on_edge(frame, coordinates, edge)) {
            place = on_edge(frame, patch, weights, edge);
        }
    }
    for (uint corner = 0u; corner < corner_count(frame); corner++) {
        if (element(weights, corner) == 1.0f) {
            place = (float2)(flush(patch->corners[2u * corner]), flush(patch->corners[2u * corner + 1u]));
        }
    }
    return place;
}

// `mix` in core, which is a built-in function here.
static float mixed(uint zero, float a, float b, float t) {
    return flush(add(mul(a, sub(1.0f, t)), mul(b, t)));
}

static Texels texels(uint zero, float place, uint count) {
    const float within = sub(place, number(floor(place)));
    const float at = sub(mul(within, number((int)count)), 0.5f);
    const int first = floor(at);
    // A place that rounding has moved to the very end is that of the last texel.
    const uint last = count - 1u, before = first < 0 ? last : lesser_of((uint)first, last);
    const uint after = before + 1u;
    const Texels found = {before, after < count ? after : 0u, flush(sub(at, number(first)))};
    return found;
}

// Between two texels of a row of the height map.
static float height_of_row(uint zero, __global const float *row, Texels columns) {
    return mixed(zero, flush(row[columns.before]), flush(row[columns.after]), columns.share);
}

// The height at a place of the height map, which repeats itself; texels are at half-integers, heights between them are
// bilinear.
static float height_at(__constant TessFrame *frame, __global const float *heights, float2 place) {
    const uint zero = frame->zero;
    const Texels columns = texels(zero, place.x, frame->columns), rows = texels(zero, place.y, frame->rows);
    const float below = height_of_row(zero, heights + rows.before * frame->columns, columns);
    const float above = height_of_row(zero, heights + rows.after * frame->columns, columns);
    return mixed(zero, below, above, rows.share);
}

// A vertex by its coordinates.
static TessVertex evaluate(__constant TessFrame *frame, __global const TessPatch *patch, const TessSurface *surface,
                           __global const float *heights, uint3 coordinates) {
    const uint zero = frame->zero;
    TessPoint point = surface_at(frame, patch, surface, coordinates);
    const float2 uv = texture(zero, patch->uv, weights_of(frame, coordinates));
    if (frame->columns > 0u) {
        const float height = height_at(frame, heights, place_of_height(frame, patch, coordinates, uv));
        point.position = flush3(add3(point.position, scale3(point.normal, flush(mul(frame->scale, height)))));
    }
    const TessVertex vertex = {{point.position.x, point.position.y, point.position.z},
                               {point.normal.x, point.normal.y, point.normal.z},
                               {uv.x, uv.y}};
    return vertex;
}
