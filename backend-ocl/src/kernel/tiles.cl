// Mirrors the second half of core's fused stage, sample: one work-group a block of samples, over all draws in the list of
// its tile that can touch it and are of the kernel's kind, up to LISTED at a time.
//
// Barriers are reached by all work-items alike.

// The block of this work-group, cut off where the samples end: a tile, or a part of one.
static int4 own_box(__constant Frame *frame) {
    const int side = 1 << lesser_of(tile_bits(frame), BLOCK_BITS);
    const int4 all = frame_box(frame);
    const int left = all.x + (int)get_group_id(0) * side, top = all.z + (int)get_group_id(1) * side;
    return common(all, (int4)(left, left + side, top, top + side));
}

// Lists the draws that can touch the block and are of this kind.
static void list_draws(const Sampler *s, uint kind, __global const uint *lists, uint lane) {
    const uint2 counts = tile_counts(s->frame);
    const int4 own = tiles_of(s->frame, s->box);
    const uint tile = (uint)own.z * counts.x + (uint)own.x, end = counts.x * counts.y;
    const bool is_listed = lists[end] != UNLISTED;
    const uint to = is_listed ? lists[tile + 1u] : s->grids[HEAD_COUNT];
    for (uint entry = (is_listed ? lists[tile] : 0u) + lane; entry < to; entry += GROUP) {
        const uint index = is_listed ? lists[end + 1u + entry] : entry;
        const bool is_touched = !is_empty(common(s->box, box_at(s->grids, index)));
        if ((s->grids[flags_place(index)] & KIND_MASK) == kind && is_touched) {
            s->block->list[atomic_inc(&s->block->listed)] = index;
        }
    }
}

// What is known of the block's samples already.
static void recall(const Sampler *s, uint lane) {
    for (uint at = lane; at < BLOCK_SAMPLES; at += GROUP) {
        const int column = s->box.x + (int)(at % BLOCK), row = s->box.z + (int)(at / BLOCK);
        const bool is_one = column < s->box.y && row < s->box.w;
        s->block->depth[at] = is_one ? s->samples[place_of_sample(s->frame, column, row)].depth : 0u;
        s->block->patch_u[at] = NOBODY;
        s->block->v_draw[at] = NOBODY;
    }
}

// Micropolygons of draw `index` of the chunk.
static uint micropolygons(const Sampler *s, uint index) {
    const uint2 rates = rates_in(s->grids[flags_place(index)]);
    return rates.x * rates.y;
}

// Ranks `count` listed draws, from number `first` of the list on, and numbers their micropolygons.
static void give_ranks(const Sampler *s, uint count, uint lane) {
    __local Block *block = s->block;
    for (uint slot = lane; slot < count; slot += GROUP) {
        const uint index = block->list[s->first + slot], patch_id = s->draws[index].patch_id;
        uint before = 0u, smaller = 0u, start = 0u;
        for (uint other = 0u; other < count; other++) {
            const uint its = block->list[s->first + other];
            before += its < index ? 1u : 0u;
            smaller += s->draws[its].patch_id < patch_id ? 1u : 0u;
            start += other < slot ? micropolygons(s, its) : 0u;
        }
        block->rank[slot] = before;
        block->patch_rank[slot] = smaller;
        block->order[before] = index;
        block->start[slot] = start;
        if (slot + 1u == count) {
            block->start[count] = start + micropolygons(s, index);
        }
    }
}

// Samples the micropolygons of the listed draws, every 64th a work-item.
static void sample_all(Sampler *s, uint kind, uint count, uint lane) {
    __local const ushort *start = s->block->start;
    const uint all = start[count];
    uint slot = 0u;
    for (uint task = lane; task < all; task += GROUP) {
        while (task >= start[slot + 1u]) {
            slot += 1u;
        }
        sample_one(s, kind, s->block->list[s->first + slot], task - start[slot], slot);
    }
}

static void compare_hits(const Sampler *s, uint lane) {
    __local Block *block = s->block;
    for (uint hit = lane; hit < block->hits; hit += GROUP) {
        const uint place = block->hit_place[hit];
        compare(s, place >> PLACE_SHIFT, block->hit_depth[hit], place & ((1u << PLACE_SHIFT) - 1u));
    }
}

// Shows the candidate of a sample if it is nearer than what is stored.
static void resolve_sample(const Sampler *s, uint at, __global Sample *samples) {
    __local const Block *block = s->block;
    const int column = s->box.x + (int)(at % BLOCK), row = s->box.z + (int)(at / BLOCK);
    const uint index = block->order[block->v_draw[at] & ((1u << RANK_BITS) - 1u)];
    const Draw draw = s->draws[index];
    const Sample found = {block->depth[at], draw.patch_id, block->patch_u[at] & (PARAM_ONE - 1u),
                          block->v_draw[at] >> RANK_BITS};
    const uint place = place_of_sample(s->frame, column, row);
    if (nearer(found, samples[place])) {
        samples[place] = found;
        s->colours[place] = colour_at(s, index, place_of_parameters(draw, found.u, found.v), column, row);
    }
}

static void resolve(const Sampler *s, __global Sample *samples, uint lane) {
    for (uint at = lane; at < BLOCK_SAMPLES; at += GROUP) {
        if (s->block->patch_u[at] != NOBODY) {
            resolve_sample(s, at, samples);
            s->block->patch_u[at] = NOBODY;
            s->block->v_draw[at] = NOBODY;
        }
    }
}

// Depths, who has them, then what has become visible, LISTED draws at a time.
static void sample_listed(Sampler *s, uint kind, __global Sample *samples, uint lane) {
    const uint listed = s->block->listed;
    for (s->first = 0u; s->first < listed; s->first += LISTED) {
        const uint count = listed - s->first < LISTED ? listed - s->first : LISTED;
        give_ranks(s, count, lane);
        if (s->first == 0u) {
            recall(s, lane);
        }
        if (lane == 0u) {
            s->block->hits = 0u;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (s->turn = 0u; s->turn < 3u; s->turn++) {
            if (s->turn > 0u && s->block->hits <= HITS) {
                compare_hits(s, lane);
            } else {
                sample_all(s, kind, count, lane);
            }
            barrier(CLK_LOCAL_MEM_FENCE);
        }
        resolve(s, samples, lane);
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

static void tiles(__constant Frame *frame, uint kind, __global const Draw *draws, __global const uint *grids,
                  __global const uint *lists, __global const Sample *behind, __global Sample *samples,
                  __global Colour *colours, __local Block *block) {
    const uint lane = get_local_id(0);
    if (grids[HEAD_KINDS + kind - 1u] == 0u) {
        return;
    }
    Sampler s = {frame, grids, &draws[grids[HEAD_START]], behind, own_box(frame), 0u, block, 0u, 0, samples, colours};
    if (lane == 0u) {
        block->listed = 0u;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    list_draws(&s, kind, lists, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    sample_listed(&s, kind, samples, lane);
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void tiles_near(__constant Frame *frame, __global const Draw *draws, __global const uint *grids,
                __global const uint *lists, __global const Sample *behind, __global Sample *samples,
                __global Colour *colours) {
    __local Block block;
    tiles(frame, KIND_NEAR, draws, grids, lists, behind, samples, colours, &block);
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void tiles_general(__constant Frame *frame, __global const Draw *draws, __global const uint *grids,
                   __global const uint *lists, __global const Sample *behind, __global Sample *samples,
                   __global Colour *colours) {
    __local Block block;
    tiles(frame, KIND_GENERAL, draws, grids, lists, behind, samples, colours, &block);
}
