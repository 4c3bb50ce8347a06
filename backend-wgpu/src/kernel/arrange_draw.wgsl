// No mirror in core: the next chunk of draws, its boxes, and the groups that dice it.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> control: Control;
@group(0) @binding(2) var<storage, read> draws: array<Draw>;
@group(0) @binding(3) var<storage, read_write> grids: array<u32>;
@group(0) @binding(4) var<storage, read_write> rounds: Rounds;
@group(0) @binding(5) var<storage, read_write> groups: array<u32, 3>;

@compute @workgroup_size(BLOCKS)
fn main(@builtin(local_invocation_index) block: u32) {
    let start = rounds.chunk * CHUNK;
    let waiting = control.waiting + control.fresh;
    let count = clamped(waiting, start) - start;
    box_of(block, start, start + count);
    storageBarrier();
    if block != 0u {
        return;
    }
    grids[HEAD_START] = start;
    grids[HEAD_COUNT] = count;
    put_tiles();
    grids[HEAD_KINDS] = 0u;
    grids[HEAD_KINDS + 1u] = 0u;
    rounds.chunk += 1u;
    rounds.round = 0u;
    groups[0] = count;
    groups[1] = 1u;
    groups[2] = select(0u, 1u, count > 0u);
}

// The end of the chunk that starts here.
fn clamped(waiting: u32, start: u32) -> u32 {
    let end = select(waiting, start + CHUNK, waiting > start + CHUNK);
    return select(end, start, end < start);
}

// The pixels that the draws of a block can touch, packed as those of a draw.
fn box_of(block: u32, start: u32, end: u32) {
    var extents = vec2<u32>(0xffffu, 0xffffu);
    for (var index = 0u; index < BLOCK; index++) {
        let item = start + block * BLOCK + index;
        if item < end {
            extents = joined(extents, vec2<u32>(draws[item].columns, draws[item].rows));
        }
    }
    grids[BOXES + 2u * block] = extents.x;
    grids[BOXES + 2u * block + 1u] = extents.y;
}

// The box around two, columns and rows.
fn joined(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let mask = vec2<u32>(0xffffu);
    let half = vec2<u32>(16u);
    let low = select(b & mask, a & mask, (a & mask) < (b & mask));
    let high = select(b >> half, a >> half, (a >> half) > (b >> half));
    return low | (high << half);
}

// The tiles that the boxes of all blocks touch.
fn put_tiles() {
    var extents = vec2<u32>(0xffffu, 0xffffu);
    for (var block = 0u; block < BLOCKS; block++) {
        extents = joined(extents, vec2<u32>(grids[BOXES + 2u * block], grids[BOXES + 2u * block + 1u]));
    }
    for (var k = 0u; k < 2u; k++) {
        let first = (extents[k] & 0xffffu) / TILE;
        let end = tiles(extents[k] >> 16u);
        grids[HEAD_TILES + 2u * k] = first;
        grids[HEAD_TILES + 2u * k + 1u] = select(0u, end - first, end > first);
    }
}
