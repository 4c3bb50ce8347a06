// No mirror in core: where a chunk of draws lies between its two kernels, the one that dices and shades each
// draw once (`draw.wgsl`) and the one that samples them tile by tile (`tiles.wgsl`).
//
// One buffer of words: the head, a box for every BLOCK of draws, then a grid a draw. A grid is its flags, then
// column, row and 1 / distance of all its vertices, of which the last eight are the ends of its seams' chords,
// then position and colour of all but those, a coordinate after the other.

// Draws a chunk, and draws that share a box.
const CHUNK: u32 = 2048u;
const BLOCK: u32 = 64u;
const BLOCKS: u32 = CHUNK / BLOCK;

// The head: first draw of the chunk and number of its draws; then, is there any grid of kind 1, of kind 2?
const HEAD_START: u32 = 0u;
const HEAD_COUNT: u32 = 1u;
const HEAD_KINDS: u32 = 2u;
// Low bits of a grid's flags: its kind. Nothing is to be seen of it; it is small and whole, so that it needs
// neither clipping nor wide integers; any other.
const KIND_HIDDEN: u32 = 0u;
const KIND_NEAR: u32 = 1u;
const KIND_GENERAL: u32 = 2u;
const KIND_MASK: u32 = 3u;
// Above them, for each border, log2 of the longest chord of a neighbour (3 bits) and is there one beyond (1 bit).
const SEAM_SHIFT: u32 = 4u;
const SEAM_BITS: u32 = 4u;
const SEAM_CHORD: u32 = 8u;
const SEAM_LONGEST: u32 = 7u;

// The tiles that its draws can touch: the first, and how many, along columns and rows.
const HEAD_TILES: u32 = 4u;

const BOXES: u32 = 8u;
const GRIDS: u32 = BOXES + 2u * BLOCKS;
// Ends of the chords beyond the four borders.
const ENDS: u32 = 8u;

// The dice rate is a power of two: this is its exponent.
fn rate_bits() -> u32 {
    return firstTrailingBit(frame.rate);
}

fn vertices() -> u32 {
    return (frame.rate + 1u) * (frame.rate + 1u);
}

// Pixels a side of the tile that one group samples.
const TILE: u32 = 16u;

fn tiles(pixels: u32) -> u32 {
    return (pixels + TILE - 1u) / TILE;
}

// First word of the grid of draw `index` of the chunk.
fn grid_base(index: u32) -> u32 {
    return GRIDS + index * (1u + 3u * (vertices() + ENDS) + 6u * vertices());
}

// First word of screen coordinate k (column, row, 1 / distance) of a grid.
fn screen_base(base: u32, k: u32) -> u32 {
    return base + 1u + k * (vertices() + ENDS);
}

// First word of number k (position x, y, z, colour red, green, blue) of a grid.
fn space_base(base: u32, k: u32) -> u32 {
    return screen_base(base, 3u) + k * vertices();
}
