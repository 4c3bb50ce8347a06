// No mirror in core: where a chunk of draws lies between its two kernels, the one that dices and shades each
// draw once (`draw.wgsl`) and the one that samples them tile by tile (`tiles.wgsl`).
//
// One buffer of words: the head, a box for every BLOCK of draws, then a grid a draw. A grid is its kind and its box, then
// column, row and 1 / distance, position and colour of all its vertices, a coordinate after the other; all grids have room
// for as many as the largest. A box is the pixels that can be touched, columns and rows, packed as those of a draw.

// Draws a chunk, and draws that share a box.
const CHUNK: u32 = 2048u;
const BLOCK: u32 = 64u;
const BLOCKS: u32 = CHUNK / BLOCK;

// The head: first draw of the chunk and number of its draws; then, is there any grid of kind 1, of kind 2?
const HEAD_START: u32 = 0u;
const HEAD_COUNT: u32 = 1u;
const HEAD_KINDS: u32 = 2u;
// Kinds of grids. Nothing is to be seen of it; it is small and whole, so that it needs neither clipping nor wide
// integers; any other.
const KIND_HIDDEN: u32 = 0u;
const KIND_NEAR: u32 = 1u;
const KIND_GENERAL: u32 = 2u;

// The tiles that its draws can touch: the first, and how many, along columns and rows.
const HEAD_TILES: u32 = 4u;

const BOXES: u32 = 8u;
const GRIDS: u32 = BOXES + 2u * BLOCKS;
// Words of a grid before its vertices.
const GRID_HEAD: u32 = 3u;

// Vertices of the largest grid.
fn vertices() -> u32 {
    return (frame.rate + 1u) * (frame.rate + 1u);
}

// Number of a vertex: all grids have rows as long as the largest's.
fn vertex_number(row: u32, column: u32) -> u32 {
    return row * (frame.rate + 1u) + column;
}

// Pixels a side of the tile that one group samples.
const TILE: u32 = 16u;

fn tiles(pixels: u32) -> u32 {
    return (pixels + TILE - 1u) / TILE;
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
