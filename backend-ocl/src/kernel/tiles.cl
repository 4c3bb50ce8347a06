// Mirrors the second half of core's fused stage, sample: one work-group a tile of the image, over all draws of
// the chunk that can touch it and are of the kernel's kind, up to LISTED at a time.
//
// Barriers are reached by all work-items alike.

// The tile of this work-group, cut off at the image's border.
static int4 tile_box(__constant Frame *frame) {
    const int left = get_group_id(0) * TILE, top = get_group_id(1) * TILE;
    return (int4)(left, lesser(left + (int)TILE, frame->width), top, lesser(top + (int)TILE, frame->height));
}

static bool touches(int4 box, uint columns, uint rows) {
    return (int)(columns & 0xffffu) < box.y && (int)(columns >> 16) > box.x && (int)(rows & 0xffffu) < box.w
        && (int)(rows >> 16) > box.z;
}

// Lists the blocks that can touch the tile.
static void list_blocks(const Sampler *s, uint lane) {
    for (uint block = lane; block < BLOCKS; block += GROUP) {
        if (touches(s->box, s->grids[BOXES + 2u * block], s->grids[BOXES + 2u * block + 1u])) {
            s->tile->blocks[atomic_inc(&s->tile->blocks_listed)] = block;
        }
    }
}

// Lists the draws of those blocks that can touch it and are of this kind.
static void list_draws(const Sampler *s, uint kind, uint lane) {
    const uint count = s->grids[HEAD_COUNT];
    for (uint place = 0u; place < s->tile->blocks_listed; place++) {
        const uint index = s->tile->blocks[place] * BLOCK + lane;
        __global const uint *flags = s->grids + flags_place(index);
        if (index < count && (flags[0] & KIND_MASK) == kind && touches(s->box, flags[1], flags[2])) {
            s->tile->list[atomic_inc(&s->tile->listed)] = index;
        }
    }
}

// What the tile's pixels show already.
static void recall(const Sampler *s, __global const Sample *samples, uint lane) {
    for (uint pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        const int column = s->box.x + (int)(pixel % TILE), row = s->box.z + (int)(pixel / TILE);
        const bool is_one = column < s->box.y && row < s->box.w;
        s->tile->depth[pixel] = is_one ? samples[(uint)row * s->frame->width + (uint)column].depth : 0u;
        s->tile->patch_u[pixel] = NOBODY;
        s->tile->v_draw[pixel] = NOBODY;
    }
}

// Micropolygons of draw `index` of the chunk.
static uint micropolygons(const Sampler *s, uint index) {
    const uint2 rates = rates_in(s->grids[flags_place(index)]);
    return rates.x * rates.y;
}

// Ranks `count` listed draws, from number `first` of the list on, and numbers their micropolygons.
static void give_ranks(const Sampler *s, uint count, uint lane) {
    __local Tile *tile = s->tile;
    for (uint slot = lane; slot < count; slot += GROUP) {
        const uint index = tile->list[s->first + slot], patch_id = s->draws[index].patch_id;
        uint before = 0u, smaller = 0u, start = 0u;
        for (uint other = 0u; other < count; other++) {
            const uint its = tile->list[s->first + other];
            before += its < index ? 1u : 0u;
            smaller += s->draws[its].patch_id < patch_id ? 1u : 0u;
            start += other < slot ? micropolygons(s, its) : 0u;
        }
        tile->rank[slot] = before;
        tile->patch_rank[slot] = smaller;
        tile->order[before] = index;
        tile->start[slot] = start;
        if (slot + 1u == count) {
            tile->start[count] = start + micropolygons(s, index);
        }
    }
}

// Samples a micropolygon of the draw in a slot.
static void sample_one(Sampler *s, uint kind, uint slot, uint number) {
    const uint index = s->tile->list[s->first + slot], base = grid_base(s->frame, index);
    const uint rate = rates_in(s->grids[flags_place(index)]).x;
    const Place place = new_place(number % rate, number / rate);
    const uint key = slot << CELL_BITS | cell_of(place);
    if (kind == KIND_NEAR) {
        sample_near(s, base, quad_of(rate, place), key);
    } else {
        sample_general(s, base, quad_of(rate, place), key);
    }
}

// Samples the micropolygons of the listed draws, every 64th a work-item.
static void sample_all(Sampler *s, uint kind, uint count, uint lane) {
    __local const ushort *start = s->tile->start;
    const uint all = start[count];
    uint slot = 0u;
    for (uint task = lane; task < all; task += GROUP) {
        while (task >= start[slot + 1u]) {
            slot += 1u;
        }
        sample_one(s, kind, slot, task - start[slot]);
    }
}

static void compare_hits(const Sampler *s, uint lane) {
    __local Tile *tile = s->tile;
    for (uint hit = lane; hit < tile->hits; hit += GROUP) {
        const uint place = tile->hit_place[hit];
        compare(s, place >> PIXEL_SHIFT, tile->hit_depth[hit], place & ((1u << PIXEL_SHIFT) - 1u));
    }
}

// Shows the candidate of a pixel if it is nearer than what is stored.
static void resolve_pixel(const Sampler *s, uint pixel, uint at, __global Sample *samples,
                          __global Colour *colours) {
    __local const Tile *tile = s->tile;
    const uint index = tile->order[tile->v_draw[pixel] & ((1u << RANK_BITS) - 1u)];
    const Surface surface = surface_of(s->draws[index]);
    const uint u = tile->patch_u[pixel] & (PARAM_ONE - 1u), v = tile->v_draw[pixel] >> RANK_BITS;
    const Sample found = {tile->depth[pixel], surface.patch_id, u, v};
    if (nearer(found, samples[at])) {
        const Place place = new_place((u - surface.u) / (u_size(surface) >> MAX_RATE_BITS),
                                      (v - surface.v) / (v_size(surface) >> MAX_RATE_BITS));
        const Quad quad = quad_of(rates_in(s->grids[flags_place(index)]).x, place);
        samples[at] = found;
        colours[at] = colour_of(s->frame, s->grids, grid_base(s->frame, index), quad);
    }
}

static void resolve(const Sampler *s, __global Sample *samples, __global Colour *colours, uint lane) {
    for (uint pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        if (s->tile->patch_u[pixel] != NOBODY) {
            const uint column = s->box.x + pixel % TILE, row = s->box.z + pixel / TILE;
            resolve_pixel(s, pixel, row * s->frame->width + column, samples, colours);
            s->tile->patch_u[pixel] = NOBODY;
            s->tile->v_draw[pixel] = NOBODY;
        }
    }
}

// Depths, who has them, then what has become visible, LISTED draws at a time.
static void sample_listed(Sampler *s, uint kind, __global Sample *samples, __global Colour *colours, uint lane) {
    const uint listed = s->tile->listed;
    for (s->first = 0u; s->first < listed; s->first += LISTED) {
        const uint count = listed - s->first < LISTED ? listed - s->first : LISTED;
        give_ranks(s, count, lane);
        if (s->first == 0u) {
            recall(s, samples, lane);
        }
        if (lane == 0u) {
            s->tile->hits = 0u;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (s->turn = 0u; s->turn < 3u; s->turn++) {
            if (s->turn > 0u && s->tile->hits <= HITS) {
                compare_hits(s, lane);
            } else {
                sample_all(s, kind, count, lane);
            }
            barrier(CLK_LOCAL_MEM_FENCE);
        }
        resolve(s, samples, colours, lane);
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

static void tiles(__constant Frame *frame, uint kind, __global const Draw *all_draws,
                  __global const uint *grids, __global Sample *samples, __global Colour *colours,
                  __local Tile *tile) {
    const uint lane = get_local_id(0);
    if (grids[HEAD_KINDS + kind - 1u] == 0u) {
        return;
    }
    Sampler s = {frame, grids, all_draws + grids[HEAD_START], tile, tile_box(frame), 0u, 0u};
    if (lane == 0u) {
        tile->blocks_listed = 0u;
        tile->listed = 0u;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    list_blocks(&s, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    list_draws(&s, kind, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    sample_listed(&s, kind, samples, colours, lane);
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void tiles_near(__constant Frame *frame, __global const Draw *draws, __global const uint *grids,
                __global Sample *samples, __global Colour *colours) {
    __local Tile tile;
    tiles(frame, KIND_NEAR, draws, grids, samples, colours, &tile);
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void tiles_general(__constant Frame *frame, __global const Draw *draws, __global const uint *grids,
                   __global Sample *samples, __global Colour *colours) {
    __local Tile tile;
    tiles(frame, KIND_GENERAL, draws, grids, samples, colours, &tile);
}
