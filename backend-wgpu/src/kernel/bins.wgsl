// No mirror in core: the grids of a chunk, sorted by kind and tile (Eisenacher & Loop 2010).
//
// One buffer of words: for each kind the blocks that its grids touch, then a bin for every tile and kind, then the list.
// While grids are counted, a bin is their number; then where its part of the list starts (`scan_bins.wgsl`); and that
// moves on as they are written, until it is where the part ends.

// Of each kind: 0xffff less the first column of blocks, one past the last, and the same of rows; 0 if there are no grids,
// so that all of them are maxima.
const BOXES: u32 = 0u;
const BOX: u32 = 4u;
const BINS: u32 = BOXES + 2u * BOX;
// Entries of the list, at least.
const ENTRIES: u32 = 1u << 20u;

fn bin_count() -> u32 {
    return 2u * tile_count();
}

// Entries that the list has room for: a draw always fits.
fn list_room() -> u32 {
    let tiles = tile_count();
    return select(tiles, ENTRIES, tiles < ENTRIES);
}

// First word of the list.
fn list_base() -> u32 {
    return BINS + bin_count();
}

// Word of the bin of a tile, and of a kind of grids other than hidden.
fn bin_of(kind: u32, column: u32, row: u32) -> u32 {
    return BINS + (kind - KIND_NEAR) * tile_count() + row * cut_into(tile_bits()).x + column;
}
