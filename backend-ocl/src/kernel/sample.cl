// Mirrors core/src/kernel/sample.rs: micropolygons become samples, one a pixel at its centre; the nearest wins.
//
// A grid is sampled twice: the first time each pixel of the tile learns its largest depth, the second time
// the smallest place among the micropolygons that have it. Nothing depends on the order of work-items.
#define TILE 16u
#define TILE_PIXELS (TILE * TILE)
#define NO_CELL 0xffffffffu
// Places of slivers a border: one for the chord beyond its end, the rest by span and start.
#define SLIVERS MAX_RATE

// What a work-group knows of its tile.
typedef struct {
    uint depth[TILE_PIXELS];
    uint cell[TILE_PIXELS];
    uint list[GROUP];
    uint listed;
} Tile;

// What is being sampled, and where to.
typedef struct {
    __constant Frame *frame;
    __local const Grid *grid;
    __local Tile *tile;
    Surface surface;
    // Left, right, top and bottom of the tile, in pixels of the image.
    int4 box;
    bool second_time;
    // Was a sample put?
    bool found;
} Sampler;

// Row and column of a vertex, or of the micropolygon that starts there; in y and x.
typedef uint2 Place;

static bool nearer(Sample new_sample, Sample old) {
    if (new_sample.depth != old.depth) {
        return new_sample.depth > old.depth;
    }
    if (new_sample.patch_id != old.patch_id) {
        return new_sample.patch_id < old.patch_id;
    }
    return new_sample.u != old.u ? new_sample.u < old.u : new_sample.v < old.v;
}

// Number of a micropolygon: in the order of its u, then v.
static uint cell_of(Place place) {
    return place.x * 2u * MAX_RATE + place.y;
}

static Place place_of(uint cell) {
    return (Place)(cell / (2u * MAX_RATE), cell % (2u * MAX_RATE));
}

static void put(Sampler *s, int column, int row, Place place, float w) {
    const uint pixel = (uint)(row - s->box.z) * TILE + (uint)(column - s->box.x);
    if (!s->second_time) {
        atomic_max(&s->tile->depth[pixel], as_uint(w));
    } else if (s->tile->depth[pixel] == as_uint(w)) {
        atomic_min(&s->tile->cell[pixel], cell_of(place));
    }
    s->found = true;
}

static Vertex grid_vertex(__local const Grid *grid, Place place) {
    const uint at = place.y * grid->stride + place.x;
    const Vertex vertex = {grid->x[at], grid->y[at], grid->w[at]};
    return vertex;
}

static Sample sample_of(__constant Frame *frame, Surface surface, Place place, uint depth_bits) {
    const Sample sample = {depth_bits, surface.patch_id, surface.u + place.x * (u_size(surface) / frame->rate),
                           surface.v + place.y * (v_size(surface) / frame->rate)};
    return sample;
}

// Mean colour of the four vertices of a micropolygon.
static Colour cell_colour(uint zero, __local const Grid *grid, Place place) {
    const uint at = place.y * grid->stride + place.x;
    const uint below = at + grid->stride;
    Colour out;
    for (uint k = 0u; k < 3u; k++) {
        __local const float *colour = grid->colour[k];
        out.rgba[k] = mul(0.25f, add(add(colour[at], colour[below + 1u]), add(colour[at + 1u], colour[below])));
    }
    out.rgba[3] = 1.0f;
    return out;
}

// The part of a box of pixels, given as columns and rows, inside the tile.
static int4 within(int4 box, int2 columns, int2 rows) {
    return (int4)(greater(columns.x, box.x), lesser(columns.y, box.y), greater(rows.x, box.z),
                  lesser(rows.y, box.w));
}

static void triangle(Sampler *s, Vertex a, Vertex b, Vertex c, Place place) {
    const int2 columns = pixels_between(lesser(lesser(a.x, b.x), c.x), greater(greater(a.x, b.x), c.x));
    const int2 rows = pixels_between(lesser(lesser(a.y, b.y), c.y), greater(greater(a.y, b.y), c.y));
    const int4 pixels = within(s->box, columns, rows);
    for (int y = pixels.z; y < pixels.w; y++) {
        for (int x = pixels.x; x < pixels.y; x++) {
            const float w = sample_triangle(s->frame->zero, a, b, c, x, y);
            if (w > 0.0f) {
                put(s, x, y, place, w);
            }
        }
    }
}

// 1 / distance at the centre of a pixel if one of the triangles a b c and a c d owns it; of two, the nearer.
static float sample_quad(uint zero, const Vertex *quad, int column, int row) {
    const Corner a = new_corner(quad[0], column, row);
    const Corner b = new_corner(quad[1], column, row);
    const Corner c = new_corner(quad[2], column, row);
    const Corner d = new_corner(quad[3], column, row);
    const long ab = edge(a, b), bc = edge(b, c), ca = edge(c, a), cd = edge(c, d), da = edge(d, a);
    float w = 0.0f;
    if (owns(a, b, c, bc, ca, ab)) {
        w = depth(zero, a.w, b.w, c.w, bc, ca, ab);
    }
    if (owns(a, c, d, cd, da, -ca)) {
        w = max(w, depth(zero, a.w, c.w, d.w, cd, da, -ca));
    }
    return w;
}

// Clips a triangle and samples what is left of it, as a fan.
static void clipped(Sampler *s, float3 a, float3 b, float3 c, Place place) {
    Polygon polygon;
    clip(s->frame, a, b, c, &polygon);
    for (uint k = 2u; k < polygon.count; k++) {
        triangle(s, project_clipped(s->frame, polygon.corners[0]),
                 project_clipped(s->frame, polygon.corners[k - 1u]),
                 project_clipped(s->frame, polygon.corners[k]), place);
    }
}

// A vertex's position in eye space: not kept, since only clipping needs it.
static float3 point_of(const Sampler *s, Place place) {
    const uint step_u = u_size(s->surface) / s->frame->rate, step_v = v_size(s->surface) / s->frame->rate;
    return position_at(s->frame->zero, &s->grid->net, s->surface.u + place.x * step_u,
                       s->surface.v + place.y * step_v);
}

static void clipped_quad(Sampler *s, Place place) {
    const float3 a = point_of(s, place), c = point_of(s, place + (Place)(1u, 1u));
    clipped(s, a, point_of(s, place + (Place)(1u, 0u)), c, place);
    clipped(s, a, c, point_of(s, place + (Place)(0u, 1u)), place);
}

static void load_quad(__local const Grid *grid, Place place, Vertex *quad) {
    quad[0] = grid_vertex(grid, place);
    quad[1] = grid_vertex(grid, place + (Place)(1u, 0u));
    quad[2] = grid_vertex(grid, place + (Place)(1u, 1u));
    quad[3] = grid_vertex(grid, place + (Place)(0u, 1u));
}

static bool must_be_clipped(const Vertex *quad) {
    return !(quad[0].w > 0.0f && quad[1].w > 0.0f && quad[2].w > 0.0f && quad[3].w > 0.0f);
}

// Samples one quad of any size as the triangles a b c and a c d.
static void micropolygon(Sampler *s, Place place) {
    Vertex q[4];
    load_quad(s->grid, place, q);
    if (must_be_clipped(q)) {
        clipped_quad(s, place);
        return;
    }
    const int2 columns = pixels_between(lesser(lesser(q[0].x, q[1].x), lesser(q[2].x, q[3].x)),
                                        greater(greater(q[0].x, q[1].x), greater(q[2].x, q[3].x)));
    const int2 rows = pixels_between(lesser(lesser(q[0].y, q[1].y), lesser(q[2].y, q[3].y)),
                                     greater(greater(q[0].y, q[1].y), greater(q[2].y, q[3].y)));
    const int4 pixels = within(s->box, columns, rows);
    for (int y = pixels.z; y < pixels.w; y++) {
        for (int x = pixels.x; x < pixels.y; x++) {
            const float w = sample_quad(s->frame->zero, q, x, y);
            if (w > 0.0f) {
                put(s, x, y, place, w);
            }
        }
    }
}

static Place border_place(uint border, uint last, uint t) {
    const uint fixed = border & 1u ? last : 0u;
    return border < 2u ? (Place)(t, fixed) : (Place)(fixed, t);
}

// A triangle before the near plane and within the guard band, drawn as a part of a micropolygon that has
// the vertex `middle`.
static void sliver(Sampler *s, Vertex a, Vertex b, Vertex c, Place middle) {
    const uint last = s->frame->rate - 1u;
    if (a.w > 0.0f && b.w > 0.0f && c.w > 0.0f) {
        triangle(s, a, b, c, (Place)(middle.x < last ? middle.x : last, middle.y < last ? middle.y : last));
    }
}

// Sliver 0 of a border joins the chord beyond its end; then come one of the whole border's span, two of half
// of it, four of a quarter, down to a span of 2.
static void seam(Sampler *s, uint border, uint number_on_border) {
    __local const Seam *seam = &s->grid->seams[border];
    const uint last = s->frame->rate;
    if (number_on_border == 0u) {
        if (seam->has_chord != 0u) {
            const Place middle = border_place(border, last, last);
            sliver(s, project(s->frame, seam->chord[0]), grid_vertex(s->grid, middle),
                   project(s->frame, seam->chord[1]), middle);
        }
        return;
    }
    const uint halvings = 31u - clz(number_on_border);
    const uint span = last >> halvings;
    if (span < 2u || span > seam->longest) {
        return;
    }
    const uint start = (number_on_border - (1u << halvings)) * span;
    const Place middle = border_place(border, last, start + span / 2u);
    sliver(s, grid_vertex(s->grid, border_place(border, last, start)), grid_vertex(s->grid, middle),
           grid_vertex(s->grid, border_place(border, last, start + span)), middle);
}

// Does this micropolygon face the eye, or can that not be said?
static bool faces_the_eye(__local const Grid *grid, Place place) {
    Vertex q[4];
    load_quad(grid, place, q);
    return must_be_clipped(q) || signed_area(q[0], q[1], q[2]) < 0 || signed_area(q[0], q[2], q[3]) < 0;
}

// A work-item's share of a grid: every 64th micropolygon and sliver. `hits` says, a bit each, which of them
// put a sample the first time; the second time only those are looked at. Returns the new `hits`.
static uint sample_share(Sampler *s, uint lane, uint hits) {
    const uint rate = s->frame->rate, cells = rate * rate, all = cells + 4u * SLIVERS;
    uint bit = 1u, found = 0u;
    for (uint item = lane; item < all; item += GROUP, bit *= 2u) {
        if (hits & bit) {
            s->found = false;
            if (item < cells) {
                micropolygon(s, (Place)(item % rate, item / rate));
            } else {
                seam(s, (item - cells) / SLIVERS, (item - cells) % SLIVERS);
            }
            found |= s->found ? bit : 0u;
        }
    }
    return found;
}
