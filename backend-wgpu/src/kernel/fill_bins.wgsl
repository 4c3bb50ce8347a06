// No mirror in core: visits the bins of all grids of a chunk, one group a grid; what for is in the file before.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> grids: array<u32>;
@group(0) @binding(2) var<storage, read_write> bins: array<atomic<u32>>;

const GROUP: u32 = 64u;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let base = grid_base(group.x);
    let kind = grids[base];
    let columns = grids[base + 1u];
    let rows = grids[base + 2u];
    let count = tiles_in(columns, rows);
    if kind == KIND_HIDDEN || count == 0u {
        return;
    }
    if lane == 0u {
        widen(BOXES + (kind - KIND_NEAR) * BOX, columns);
        widen(BOXES + (kind - KIND_NEAR) * BOX + 2u, rows);
    }
    let across = tiles_of(columns);
    let first_row = tiles_of(rows).x;
    let wide = across.y - across.x;
    for (var tile = lane; tile < count; tile += GROUP) {
        visit(bin_of(kind, across.x + tile % wide, first_row + tile / wide), group.x);
    }
}

// Lets the box of a kind hold these blocks.
fn widen(at: u32, blocks: u32) {
    atomicMax(&bins[at], 0xffffu - (blocks & 0xffffu));
    atomicMax(&bins[at + 1u], blocks >> 16u);
}
