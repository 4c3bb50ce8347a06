// Mirrors core/src/kernel/sample.rs: micropolygons become samples, one a pixel at its centre; the nearest wins.
//
// What a work-group finds in its tile of the image is gathered in local memory: the nearest depth of each
// pixel, then, of the micropolygons that have it, the smallest patch and u, then the smallest v: three passes,
// of which the last two look at the hits of the first only. Seldom are there more hits than there is room
// for; then they look for them anew. Nothing depends on the order of work-items.
#define TILE_PIXELS (TILE * TILE)
// Most draws that are sampled together, and most hits that are kept.
#define LISTED 128u
#define HITS 1024u
// A key is the slot of a draw among those sampled and, in the low bits, one of its micropolygons:
// column * 32 + row.
#define CELL_BITS 10u
#define CELL_SHIFT 5u
#define CELL_MASK 31u
#define PIXEL_SHIFT 24u
#define RANK_BITS 7u
#define NOBODY 0xffffffffu

// What a work-group knows of its tile.
typedef struct {
    // Bits of the nearest 1 / distance at each pixel; 0 = nothing.
    uint depth[TILE_PIXELS];
    // Patch, as its rank, and u of the micropolygon that has it; NOBODY if it was there before.
    uint patch_u[TILE_PIXELS];
    // Its v, and the rank of its draw.
    uint v_draw[TILE_PIXELS];
    uint hits;
    uint hit_depth[HITS];
    uint hit_place[HITS];
    // All draws that can touch the tile, as numbers within the chunk.
    uint listed;
    ushort list[CHUNK];
    // Blocks of draws that can touch it.
    uint blocks_listed;
    uchar blocks[BLOCKS];
    // Of the draws that are being sampled: how many come before each in the draw buffer, how many have a
    // smaller patch, and the draw of each rank.
    uchar rank[LISTED];
    uchar patch_rank[LISTED];
    ushort order[LISTED];
    // How many micropolygons come before each, and behind the last, how many there are.
    ushort start[LISTED + 1u];
} Tile;

// What is being sampled, and where to.
typedef struct {
    __constant Frame *frame;
    __global const uint *grids;
    // Those of the chunk.
    __global const Draw *draws;
    __local Tile *tile;
    // Left, right, top and bottom of the tile, in pixels of the image.
    int4 box;
    // Number of the draw in the list that has slot 0.
    uint first;
    // Which pass is it: 0, 1 or 2?
    uint turn;
} Sampler;

static bool nearer(Sample new_sample, Sample old) {
    if (new_sample.depth != old.depth) {
        return new_sample.depth > old.depth;
    }
    if (new_sample.patch_id != old.patch_id) {
        return new_sample.patch_id < old.patch_id;
    }
    return new_sample.u != old.u ? new_sample.u < old.u : new_sample.v < old.v;
}

// The numbers of a quad's corners; see `grids.cl`.
typedef struct {
    uint a;
    uint b;
    uint c;
    uint d;
} Quad;

// Row and column of a vertex, or of the micropolygon that starts there.
typedef struct {
    uint column;
    uint row;
} Place;

static Place new_place(uint column, uint row) {
    const Place place = {column, row};
    return place;
}

static uint cell_of(Place place) {
    return place.column << CELL_SHIFT | place.row;
}

static Place place_of(uint cell) {
    return new_place(cell >> CELL_SHIFT, cell & CELL_MASK);
}

// A micropolygon of a grid with so many along u.
static Quad quad_of(uint rate, Place place) {
    const uint a = place.row * (rate + 1u) + place.column, d = a + rate + 1u;
    const Quad quad = {a, a + 1u, d + 1u, d};
    return quad;
}

// The sample of the micropolygon `cell` at this depth.
static Sample sample_of(Surface surface, uint cell, uint depth_bits) {
    const Place place = place_of(cell);
    const Sample sample = {depth_bits, surface.patch_id,
                           surface.u + place.column * (u_size(surface) >> MAX_RATE_BITS),
                           surface.v + place.row * (v_size(surface) >> MAX_RATE_BITS)};
    return sample;
}

// Who has the nearest depth? First by patch and u, then by v.
static void compare(const Sampler *s, uint pixel, uint found, uint key) {
    __local Tile *tile = s->tile;
    if (found != tile->depth[pixel]) {
        return;
    }
    const uint slot = key >> CELL_BITS, cell = key & ((1u << CELL_BITS) - 1u);
    const Surface surface = surface_of(s->draws[tile->list[s->first + slot]]);
    const Sample it = sample_of(surface, cell, found);
    const uint patch_u = (uint)tile->patch_rank[slot] << PARAM_BITS | it.u;
    if (s->turn == 1u) {
        atomic_min(&tile->patch_u[pixel], patch_u);
    } else if (patch_u == tile->patch_u[pixel]) {
        atomic_min(&tile->v_draw[pixel], it.v << RANK_BITS | tile->rank[slot]);
    }
}

// A hit of a pixel of the tile.
static void put(Sampler *s, int column, int row, float w, uint key) {
    const uint pixel = (uint)(row - s->box.z) * TILE + (uint)(column - s->box.x);
    const uint found = as_uint(w);
    volatile __local uint *stored = &s->tile->depth[pixel];
    if (s->turn > 0u) {
        compare(s, pixel, found, key);
    } else if (found >= *stored && found >= atomic_max(stored, found)) {
        const uint place = atomic_inc(&s->tile->hits);
        if (place < HITS) {
            s->tile->hit_depth[place] = found;
            s->tile->hit_place[place] = pixel << PIXEL_SHIFT | key;
        }
    }
}

static float mean4(uint zero, float a, float b, float c, float d) {
    return mul(0.25f, add(add(a, c), add(b, d)));
}

// Mean colour of the four vertices of a micropolygon.
static Colour colour_of(__constant Frame *frame, __global const uint *grids, uint base, Quad quad) {
    const uint zero = frame->zero;
    const float3 a = space_at(frame, grids, base, quad.a, 3u);
    const float3 b = space_at(frame, grids, base, quad.b, 3u);
    const float3 c = space_at(frame, grids, base, quad.c, 3u);
    const float3 d = space_at(frame, grids, base, quad.d, 3u);
    const Colour colour = {{mean4(zero, a.x, b.x, c.x, d.x), mean4(zero, a.y, b.y, c.y, d.y),
                            mean4(zero, a.z, b.z, c.z, d.z), 1.0f}};
    return colour;
}

// The pixels inside the tile whose centres lie in the box around a quad: left, right, top and bottom.
static int4 pixels_of_quad(int4 box, Vertex a, Vertex b, Vertex c, Vertex d) {
    const int2 columns = pixels_between(lesser(lesser(a.x, b.x), lesser(c.x, d.x)),
                                        greater(greater(a.x, b.x), greater(c.x, d.x)));
    const int2 rows = pixels_between(lesser(lesser(a.y, b.y), lesser(c.y, d.y)),
                                     greater(greater(a.y, b.y), greater(c.y, d.y)));
    return (int4)(greater(columns.x, box.x), lesser(columns.y, box.y), greater(rows.x, box.z),
                  lesser(rows.y, box.w));
}
