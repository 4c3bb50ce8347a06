// Mirrors core/src/kernel/sample.rs: micropolygons become samples; the nearest wins.
//
// Where samples go is one of two: a work-group's own block of samples (`tiles.cl`), or all of the frame's, shared by all
// work-groups (`sort_last.cl`).
//
// What a work-group finds in its block is gathered in local memory: the nearest depth of each sample, then, of the
// micropolygons that have it, the smallest patch and u, then the smallest v: three passes, of which the last two look at
// the hits of the first only. Seldom are there more hits than there is room for; then they look for them anew. Nothing
// depends on the order of work-items.
#define BLOCK_SAMPLES (BLOCK * BLOCK)
// Most draws that are sampled together, and most hits that are kept.
#define LISTED 128u
#define HITS 1024u
// A key is the slot of a draw among those sampled (sort-last: its number in the chunk) and, in the low bits, one of its
// micropolygons: column * 32 + row.
#define CELL_BITS 10u
#define CELL_SHIFT 5u
#define CELL_MASK 31u
#define PLACE_SHIFT 24u
#define RANK_BITS 7u
#define NOBODY 0xffffffffu

// What a work-group knows of its block.
typedef struct {
    // Bits of the nearest 1 / distance at each sample; 0 = nothing.
    uint depth[BLOCK_SAMPLES];
    // Patch, as its rank, and u of the micropolygon that has it; NOBODY if it was there before.
    uint patch_u[BLOCK_SAMPLES];
    // Its v, and the rank of its draw.
    uint v_draw[BLOCK_SAMPLES];
    uint hits;
    uint hit_depth[HITS];
    uint hit_place[HITS];
    // All draws that can touch the block, as numbers within the chunk.
    uint listed;
    ushort list[CHUNK];
    // Of the draws that are being sampled: how many come before each in the draw buffer, how many have a
    // smaller patch, and the draw of each rank.
    uchar rank[LISTED];
    uchar patch_rank[LISTED];
    ushort order[LISTED];
    // How many micropolygons come before each, and behind the last, how many there are.
    ushort start[LISTED + 1u];
} Block;

// What is being sampled, and where to.
typedef struct {
    __constant Frame *frame;
    __global const uint *grids;
    // Those of the chunk.
    __global const Draw *draws;
    __global const Sample *behind;
    // Left, right, top and bottom of the samples that are looked for.
    int4 box;
    // Which pass is it, from 0 on?
    uint turn;
    // A block's own memory; number of the draw in the list that has slot 0.
    __local Block *block;
    uint first;
    // Sort-last: a key for each of the frame's samples, else null; what was there before, and colours.
    __global Sample *keys;
    __global const Sample *samples;
    __global Colour *colours;
} Sampler;

static bool nearer(Sample new_sample, Sample old) {
    return new_sample.depth != old.depth ? new_sample.depth > old.depth : comes_before(new_sample, old);
}

// Place of a sample in the frame's buffers.
static uint place_of_sample(__constant Frame *frame, int column, int row) {
    return frame->place_first + ((uint)row - frame->sample_top) * frame->place_row
        + ((uint)column - frame->sample_left) * frame->place_column;
}

// The numbers of a quad's corners; see `grids.cl`.
typedef struct {
    uint a;
    uint b;
    uint c;
    uint d;
} Quad;

// The corners themselves.
typedef struct {
    Vertex a;
    Vertex b;
    Vertex c;
    Vertex d;
} Corners;

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

static Corners corners_at(const Sampler *s, uint base, Quad quad) {
    const Corners corners = {vertex_at(s->frame, s->grids, base, quad.a), vertex_at(s->frame, s->grids, base, quad.b),
                             vertex_at(s->frame, s->grids, base, quad.c), vertex_at(s->frame, s->grids, base, quad.d)};
    return corners;
}

// Need nothing of it be clipped?
static bool is_whole(Corners quad) {
    return quad.a.w > 0.0f && quad.b.w > 0.0f && quad.c.w > 0.0f && quad.d.w > 0.0f;
}

// What a quad shows at a sample that one of its two triangles, a b c and a c d, owns, and whether that is the second; of
// two that overlap, the nearer, of two equally near the first.
static Hit sample_quad(uint zero, Corners quad, int2 site, bool *second) {
    const Hit p = sample_triangle(zero, quad.a, quad.b, quad.c, site);
    const Hit q = sample_triangle(zero, quad.a, quad.c, quad.d, site);
    *second = q.w > p.w;
    return *second ? q : p;
}

// The sample of a micropolygon of a draw at this depth.
static Sample sample_of(Draw draw, Place place, uint depth_bits) {
    const Sample sample = {depth_bits, draw.patch_id, column_at(draw, place.column), row_at(draw, place.row)};
    return sample;
}

// The step of `steps` that ends at `along`, which one does, in a piece 2^bits long; see `place` in `border.cl`. Places are
// rounded down in its lower half, and up in its upper one.
static uint step_at(uint along, uint steps, uint bits) {
    const uint before = (along * steps) >> bits;
    return place(before, steps, bits) == along ? before : before + 1u;
}

// The micropolygon of a draw with this u and v.
static Place place_of_parameters(Draw draw, uint u, uint v) {
    const Surface surface = surface_of(draw);
    return new_place(step_at(u - draw.u, rate_u(draw), PARAM_BITS - u_level(surface)),
                     step_at(v - draw.v, rate_v(draw), PARAM_BITS - v_level(surface)));
}

// Mean colour of the four vertices of a micropolygon.
static Colour mean_colour(const Sampler *s, uint base, Quad quad, float opacity) {
    const uint zero = s->frame->zero;
    Colour colour = {{0.0f, 0.0f, 0.0f, opacity}};
    for (uint k = 0u; k < 3u; k++) {
        __global const uint *all = s->grids + space_base(s->frame, base, 3u + k);
        const float a = as_float(all[quad.a]), b = as_float(all[quad.b]);
        const float c = as_float(all[quad.c]), d = as_float(all[quad.d]);
        colour.rgba[k] = mul(0.25f, add(add(a, c), add(b, d)));
    }
    return colour;
}

// Colour between the vertices `a`, `p` and `q` of a triangle.
static Colour smooth_colour(const Sampler *s, uint base, uint a, uint p, uint q, Hit hit, float opacity) {
    const uint zero = s->frame->zero;
    Colour colour = {{0.0f, 0.0f, 0.0f, opacity}};
    for (uint k = 0u; k < 3u; k++) {
        __global const uint *all = s->grids + space_base(s->frame, base, 3u + k);
        colour.rgba[k] =
            weighted(zero, as_float(all[a]), as_float(all[p]), as_float(all[q]), hit.for_b, hit.for_c);
    }
    return colour;
}

// Colour of a micropolygon of draw `index` of the chunk, at a sample that it shows.
static Colour colour_at(const Sampler *s, uint index, Place place, int column, int row) {
    __global const uint *flags = s->grids + flags_place(index);
    const float opacity = as_float(flags[OPACITY]);
    const uint base = grid_base(s->frame, index);
    const Quad quad = quad_of(rates_in(flags[0]).x, place);
    const Corners corners = corners_at(s, base, quad);
    if ((s->frame->flags & FLAG_SMOOTH) == 0u || !is_whole(corners)) {
        return mean_colour(s, base, quad, opacity);
    }
    bool second;
    const Hit hit = sample_quad(s->frame->zero, corners, site(s->frame, column, row), &second);
    return smooth_colour(s, base, quad.a, second ? quad.c : quad.b, second ? quad.d : quad.c, hit, opacity);
}

// Draw of a key, as its number in the chunk.
static uint index_of(const Sampler *s, uint key) {
    const uint slot = key >> CELL_BITS;
    return s->keys == 0 ? s->block->list[s->first + slot] : slot;
}

static Place place_of_key(uint key) {
    return place_of(key & ((1u << CELL_BITS) - 1u));
}

// Who has the nearest depth? First by patch and u, then by v.
static void compare(const Sampler *s, uint place, uint found, uint key) {
    __local Block *block = s->block;
    if (found != block->depth[place]) {
        return;
    }
    const uint slot = key >> CELL_BITS;
    const Sample it = sample_of(s->draws[index_of(s, key)], place_of_key(key), found);
    const uint patch_u = (uint)block->patch_rank[slot] << PARAM_BITS | it.u;
    if (s->turn == 1u) {
        atomic_min(&block->patch_u[place], patch_u);
    } else if (patch_u == block->patch_u[place]) {
        atomic_min(&block->v_draw[place], it.v << RANK_BITS | block->rank[slot]);
    }
}

// A hit of a sample of the block.
static void put_into_block(const Sampler *s, int column, int row, uint found, uint key) {
    const uint place = (uint)(row - s->box.z) * BLOCK + (uint)(column - s->box.x);
    volatile __local uint *stored = &s->block->depth[place];
    if (s->turn > 0u) {
        compare(s, place, found, key);
    } else if (found >= *stored && found >= atomic_max(stored, found)) {
        const uint number = atomic_inc(&s->block->hits);
        if (number < HITS) {
            s->block->hit_depth[number] = found;
            s->block->hit_place[number] = place << PLACE_SHIFT | key;
        }
    }
}

// A hit anywhere: its part of the sample's key that is looked for; see core/src/kernel/sort_last.rs.
static void put_into_keys(const Sampler *s, int column, int row, uint found, uint key) {
    const uint place = place_of_sample(s->frame, column, row), index = index_of(s, key);
    __global Sample *stored = s->keys + place;
    if (s->turn == 0u) {
        atomic_max(&stored->depth, found);
    }
    if (s->turn == 0u || found != stored->depth) {
        return;
    }
    const Sample it = sample_of(s->draws[index], place_of_key(key), found);
    if (s->turn == 1u) {
        atomic_min(&stored->patch_id, it.patch_id);
    } else if (it.patch_id != stored->patch_id) {
        return;
    } else if (s->turn == 2u) {
        atomic_min(&stored->u, it.u);
    } else if (it.u != stored->u) {
        return;
    } else if (s->turn == 3u) {
        atomic_min(&stored->v, it.v);
    } else if (it.v == stored->v && nearer(it, s->samples[place])) {
        s->colours[place] = colour_at(s, index, place_of_key(key), column, row);
    }
}

// Is a hit behind the last layer that was found?
static bool is_in_question(const Sampler *s, int column, int row, uint found, uint key) {
    if ((s->frame->flags & FLAG_LAYERS) == 0u) {
        return true;
    }
    const Sample last = s->behind[place_of_sample(s->frame, column, row)];
    return is_behind(sample_of(s->draws[index_of(s, key)], place_of_key(key), found), last);
}

// A hit.
static void put(const Sampler *s, int column, int row, float w, uint key) {
    const uint found = as_uint(w);
    if (!is_in_question(s, column, row, found, key)) {
        return;
    }
    if (s->keys == 0) {
        put_into_block(s, column, row, found, key);
    } else {
        put_into_keys(s, column, row, found, key);
    }
}

// The samples looked for that lie in the box around a quad: left, right, top and bottom.
static int4 samples_of_quad(const Sampler *s, Corners quad) {
    const int2 columns = samples_between(s->frame, lesser(lesser(quad.a.x, quad.b.x), lesser(quad.c.x, quad.d.x)),
                                         greater(greater(quad.a.x, quad.b.x), greater(quad.c.x, quad.d.x)));
    const int2 rows = samples_between(s->frame, lesser(lesser(quad.a.y, quad.b.y), lesser(quad.c.y, quad.d.y)),
                                      greater(greater(quad.a.y, quad.b.y), greater(quad.c.y, quad.d.y)));
    return common(s->box, (int4)(columns, rows));
}
