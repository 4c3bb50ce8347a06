// No mirror in core: the frame's samples, cut into tiles, which have a list of grids each, and tiles into blocks, each of
// which a group of `tiles.wgsl` samples. A tile has as many columns and rows as the frame says; a block is as large, but
// not larger than local memory has room for.

// Log2 of the columns (and rows) of the largest block: of a tile, too, if the frame leaves that open.
const MOST_BLOCK_BITS: u32 = 4u;

fn tile_bits() -> u32 {
    return select(frame.tile_bits, MOST_BLOCK_BITS, frame.tile_bits == 0u);
}

fn block_bits() -> u32 {
    return select(MOST_BLOCK_BITS, tile_bits(), tile_bits() < MOST_BLOCK_BITS);
}

// Log2 of the blocks along one side of a tile.
fn blocks_a_tile() -> u32 {
    return tile_bits() - block_bits();
}

// Columns and rows of blocks, or of tiles.
fn cut_into(bits: u32) -> vec2<u32> {
    let columns = frame.sample_right - frame.sample_left;
    let rows = frame.sample_bottom - frame.sample_top;
    return (vec2<u32>(columns, rows) + (1u << bits) - 1u) >> vec2<u32>(bits);
}

fn tile_count() -> u32 {
    let tiles = cut_into(tile_bits());
    return tiles.x * tiles.y;
}

// Columns (or rows) of samples, of those from `whole.x` to `whole.y`, in a box of pixels, packed as those of a draw.
fn samples_of(packed: u32, whole: vec2<i32>) -> vec2<i32> {
    let low = i32(packed & 0xffffu) * SUBPIXELS;
    let high = i32(packed >> 16u) * SUBPIXELS;
    return overlap(samples_between(low, high - 1), whole);
}

// Columns (or rows) of blocks that have these samples: the first in the low half, one past the last in the high half.
fn blocks_of(samples: vec2<i32>, first: i32) -> u32 {
    if samples.x >= samples.y {
        return 0u;
    }
    let low = u32(samples.x - first) >> block_bits();
    let end = (u32(samples.y - 1 - first) >> block_bits()) + 1u;
    return low | (end << 16u);
}

// Groups that share the micropolygons of a draw in `sort_last.wgsl`, if any draw is large.
const PARTS: u32 = 64u;

// Is a draw of so many micropolygons, in these columns and rows of blocks, so large that the invocations of a group rather
// look at the samples of one of them together?
fn is_large(columns: u32, rows: u32, count: u32) -> bool {
    let blocks = ((columns >> 16u) - (columns & 0xffffu)) * ((rows >> 16u) - (rows & 0xffffu));
    return blocks > 8u && blocks > count / 8u;
}

// Columns (or rows) of tiles that have these blocks: the first, and one past the last.
fn tiles_of(blocks: u32) -> vec2<u32> {
    let shift = blocks_a_tile();
    return vec2<u32>((blocks & 0xffffu) >> shift, ((blocks >> 16u) + (1u << shift) - 1u) >> shift);
}

// Number of tiles in some columns and rows of blocks.
fn tiles_in(columns: u32, rows: u32) -> u32 {
    let across = tiles_of(columns);
    let down = tiles_of(rows);
    return (across.y - across.x) * (down.y - down.x);
}
