// No mirror in core: the grids of a chunk are sorted into tiles of the image (Eisenacher & Loop 2010); they are counted,
// the tiles' lists get their places, and each draw is written into the lists of all tiles that it can touch.
//
// One buffer of words: where each tile's list starts; where the last one ends, or UNLISTED; then all lists, one after
// the other. Should there be no room for them, each tile looks at all draws of the chunk.

// Most entries of all lists together; as in `chunk.rs`.
#define LIST_ROOM 1048576u
#define UNLISTED 0xffffffffu

// Log2 of the columns (and rows) of samples of a tile.
static uint tile_bits(__constant Frame *frame) {
    return frame->tile_bits == 0u ? BLOCK_BITS : frame->tile_bits;
}

// Columns, and rows, of tiles.
static uint2 tile_counts(__constant Frame *frame) {
    const uint bits = tile_bits(frame), last = (1u << bits) - 1u;
    return (uint2)((frame->sample_right - frame->sample_left + last) >> bits,
                   (frame->sample_bottom - frame->sample_top + last) >> bits);
}

// Columns and rows of tiles that some samples lie in: first, and one past the last.
static int4 tiles_of(__constant Frame *frame, int4 samples) {
    const uint bits = tile_bits(frame);
    if (is_empty(samples)) {
        return (int4)(0);
    }
    const int left = (int)frame->sample_left, top = (int)frame->sample_top;
    return (int4)((samples.x - left) >> bits, ((samples.y - 1 - left) >> bits) + 1, (samples.z - top) >> bits,
                  ((samples.w - 1 - top) >> bits) + 1);
}

// The tiles that draw `index` of the chunk can touch; none if there is no such draw.
static int4 tiles_of_draw(__constant Frame *frame, __global const uint *grids, uint index) {
    return index < grids[HEAD_COUNT] ? tiles_of(frame, box_at(grids, index)) : (int4)(0);
}

__kernel void count_tiles(__constant Frame *frame, __global const uint *grids, __global uint *lists) {
    const int4 tiles = tiles_of_draw(frame, grids, get_global_id(0));
    const uint across = tile_counts(frame).x;
    for (int row = tiles.z; row < tiles.w; row++) {
        for (int column = tiles.x; column < tiles.y; column++) {
            atomic_inc(lists + row * across + column);
        }
    }
}

// Counts become the ends of lists, which their starts then fall from, one entry after the other.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void scan_tiles(__constant Frame *frame, __global uint *lists) {
    __local ulong sums[GROUP];
    const uint lane = get_local_id(0), count = tile_counts(frame).x * tile_counts(frame).y;
    const uint from = run_start(lane, count), to = run_start(lane + 1u, count);
    ulong own = 0ul, end = 0ul, all = 0ul;
    for (uint tile = from; tile < to; tile++) {
        own += lists[tile];
    }
    sums[lane] = own;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint other = 0u; other < GROUP; other++) {
        end += other < lane ? sums[other] : 0ul;
        all += sums[other];
    }
    for (uint tile = from; tile < to; tile++) {
        end += lists[tile];
        lists[tile] = (uint)end;
    }
    if (lane == 0u) {
        lists[count] = all > LIST_ROOM ? UNLISTED : (uint)all;
    }
}

__kernel void write_tiles(__constant Frame *frame, __global const uint *grids, __global uint *lists) {
    const uint index = get_global_id(0);
    const int4 tiles = tiles_of_draw(frame, grids, index);
    const uint across = tile_counts(frame).x, count = across * tile_counts(frame).y;
    if (lists[count] == UNLISTED) {
        return;
    }
    for (int row = tiles.z; row < tiles.w; row++) {
        for (int column = tiles.x; column < tiles.y; column++) {
            lists[count + atomic_dec(lists + row * across + column)] = index;
        }
    }
}
