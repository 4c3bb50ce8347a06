// No mirror in core: where a chunk of draws lies between its kernels, the one that dices and shades each draw once
// (`draw.wgsl`) and those that sample them, tile by tile (`tiles.wgsl`) or one by one (`sort_last.wgsl`).
//
// One buffer of words: the head, then a grid a draw. A grid is its kind, the blocks that it can touch and its opacity, then
// column, row and 1 / distance, position and colour of all its vertices, a coordinate after the other; all grids have room
// for as many as the largest.

// Draws a chunk, at most.
const CHUNK: u32 = 2048u;

// The head: the first draw of the chunk.
const HEAD_START: u32 = 0u;
const GRIDS: u32 = 1u;
// Kinds of grids. Nothing is to be seen of it; it is small and whole, so that it needs neither clipping nor wide
// integers; any other.
const KIND_HIDDEN: u32 = 0u;
const KIND_NEAR: u32 = 1u;
const KIND_GENERAL: u32 = 2u;

// Words of a grid before its vertices: kind, columns and rows of blocks, opacity.
const GRID_HEAD: u32 = 4u;

// Vertices of the largest grid.
fn vertices() -> u32 {
    return (frame.rate + 1u) * (frame.rate + 1u);
}

// Number of a vertex: all grids have rows as long as the largest's.
fn vertex_number(row: u32, column: u32) -> u32 {
    return row * (frame.rate + 1u) + column;
}

// First word of the grid of draw `index` of the chunk.
fn grid_base(index: u32) -> u32 {
    return GRIDS + index * (GRID_HEAD + 9u * vertices());
}

// First word of screen coordinate k (column, row, 1 / distance) of a grid.
fn screen_base(base: u32, k: u32) -> u32 {
    return base + GRID_HEAD + k * vertices();
}

// First word of number k (position x, y, z, colour red, green, blue) of a grid.
fn space_base(base: u32, k: u32) -> u32 {
    return screen_base(base, 3u + k);
}
