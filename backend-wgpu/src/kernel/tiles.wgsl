// Mirrors the second half of core's fused stage, sample: one group a tile of the image, over all draws of the
// chunk that can touch it and are of this kernel's KIND, up to LISTED at a time.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> draws: array<Draw>;
@group(0) @binding(2) var<storage, read> grids: array<u32>;
@group(0) @binding(3) var<storage, read_write> samples: array<Sample>;
@group(0) @binding(4) var<storage, read_write> colours: array<Colour>;
@group(0) @binding(5) var<storage, read_write> rounds: Rounds;

const GROUP: u32 = 64u;

var<workgroup> listed_count: atomic<u32>;
var<workgroup> listed_shared: u32;
var<workgroup> hits_shared: u32;
// Slot in `listed` of the draw of each rank.
var<workgroup> order: array<u32, LISTED>;
// First draw to be looked at, and the round's budget.
var<workgroup> round_shared: vec2<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let tile_x = grids[HEAD_TILES] + group.x;
    let tile_y = grids[HEAD_TILES + 2u] + group.y;
    let left = i32(tile_x * TILE);
    let top = i32(tile_y * TILE);
    tile = vec4<i32>(
        left, imin(left + i32(TILE), i32(frame.width)), top, imin(top + i32(TILE), i32(frame.height)));
    let place = ((KIND - 1u) * tiles(frame.height) + tile_y) * tiles(frame.width) + tile_x;
    if lane == 0u {
        let first = select(0u, rounds.progress[place], rounds.round > 1u);
        round_shared = vec2<u32>(first, rounds.budget[KIND - 1u]);
    }
    let round = workgroupUniformLoad(&round_shared);
    let count = grids[HEAD_COUNT];
    var found = seek(round.x, count, lane);
    if found.listed > 0u {
        recall(lane);
    }
    var done = 0u;
    while found.listed > 0u {
        sample_listed(found.listed, lane);
        done += found.listed;
        if done >= round.y {
            break;
        }
        found = seek(found.next, count, lane);
    }
    if lane == 0u {
        rounds.progress[place] = found.next;
        if found.next < count {
            rounds.unfinished[KIND - 1u] = 1u;
        }
    }
    if loops_were_cut() {
        rounds.truncated = 1u;
    }
}

// Mesa's llvmpipe silently ends all loops once a shader has gone through 65535 iterations in all; then this
// one, too, ends early. ZERO keeps compilers from counting it out.
fn loops_were_cut() -> bool {
    var rounds = 0u;
    while rounds < 4u + ZERO {
        rounds += 1u;
    }
    return rounds != 4u;
}

// How many draws are listed, and the number of the first that was not looked at.
struct Found {
    listed: u32,
    next: u32,
}

// Lists draws from number `first` on until there are enough.
fn seek(first: u32, count: u32, lane: u32) -> Found {
    workgroupBarrier();
    if lane == 0u {
        atomicStore(&listed_count, 0u);
    }
    workgroupBarrier();
    var found = Found(0u, first);
    while found.next < count && found.listed < ENOUGH {
        let box = BOXES + found.next / BLOCK * 2u;
        if touches(grids[box], grids[box + 1u]) {
            let index = found.next + lane;
            found.listed = list(index, lane < WINDOW && index < count, lane);
            found.next += WINDOW;
        } else {
            found.next = (found.next / BLOCK + 1u) * BLOCK;
        }
    }
    return found;
}

fn touches(columns: u32, rows: u32) -> bool {
    return i32(columns & 0xffffu) < tile.y && i32(columns >> 16u) > tile.x
        && i32(rows & 0xffffu) < tile.w && i32(rows >> 16u) > tile.z;
}

// Lists a draw if it can touch the tile; gives the number of draws listed so far by the whole group.
fn list(index: u32, is_one: bool, lane: u32) -> u32 {
    if is_one {
        let base = grid_base(index);
        if grids[base] == KIND && touches(grids[base + 1u], grids[base + 2u]) {
            listed[atomicAdd(&listed_count, 1u)] = index;
        }
    }
    workgroupBarrier();
    if lane == 0u {
        listed_shared = atomicLoad(&listed_count);
    }
    return workgroupUniformLoad(&listed_shared);
}

// What the tile's pixels show already.
fn recall(lane: u32) {
    for (var pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        let column = u32(tile.x) + pixel % TILE;
        let row = u32(tile.z) + pixel / TILE;
        var depth_bits = 0u;
        if column < frame.width && row < frame.height {
            depth_bits = samples[row * frame.width + column].depth;
        }
        atomicStore(&cand_depth[pixel], depth_bits);
        atomicStore(&cand_patch_u[pixel], NOBODY);
        atomicStore(&cand_v_draw[pixel], NOBODY);
    }
}

// Samples the listed draws: depths, who has them, then what has become visible.
fn sample_listed(count: u32, lane: u32) {
    for (var slot = lane; slot < count; slot += GROUP) {
        give_ranks(slot, count);
        order[rank[slot]] = slot;
    }
    if lane == 0u {
        atomicStore(&hit_count, 0u);
    }
    workgroupBarrier();
    turn = 0u;
    var hits = 0u;
    for (var passes = 1u; turn < passes; turn++) {
        sample_all(count, lane);
        workgroupBarrier();
        if lane == 0u {
            hits_shared = atomicLoad(&hit_count);
        }
        hits = workgroupUniformLoad(&hits_shared);
        passes = select(1u, 3u, hits > HITS);
    }
    for (turn = 1u; turn < 3u; turn++) {
        for (var hit = lane; hit < select(hits, 0u, hits > HITS); hit += GROUP) {
            let at = hit_place[hit];
            compare(at >> PIXEL_SHIFT, hit_depth[hit], at & ((1u << PIXEL_SHIFT) - 1u));
        }
        workgroupBarrier();
    }
    for (var pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        resolve(pixel);
    }
}

fn give_ranks(slot: u32, count: u32) {
    let draw = draw_at(listed[slot]);
    var before = 0u;
    var smaller = 0u;
    for (var other = 0u; other < count; other++) {
        before += select(0u, 1u, listed[other] < listed[slot]);
        smaller += select(0u, 1u, draw_at(listed[other]).patch_id < draw.patch_id);
    }
    rank[slot] = before;
    patch_rank[slot] = smaller;
    quads[slot] = quads_of(draw);
}

// All micropolygons of all listed draws one after the other, every GROUP-th for this invocation.
fn sample_all(count: u32, lane: u32) {
    var slot = 0u;
    var task = lane;
    while true {
        while slot < count && task >= (quads[slot] & QUADS_MASK) {
            task -= quads[slot] & QUADS_MASK;
            slot += 1u;
        }
        if slot >= count {
            break;
        }
        let item = item_of(quads[slot], task);
        sample_item(grid_base(listed[slot]), item, (slot << CELL_BITS) | item.cell);
        task += GROUP;
    }
}

// Shows the candidate of a pixel if it is nearer than what is stored; the pixel belongs to this invocation.
fn resolve(pixel: u32) {
    let patch_u = atomicLoad(&cand_patch_u[pixel]);
    if patch_u == NOBODY {
        return;
    }
    let v_draw = atomicLoad(&cand_v_draw[pixel]);
    let index = listed[order[v_draw & ((1u << RANK_BITS) - 1u)]];
    let surface = surface_of(draw_at(index));
    let u = patch_u & (PARAM_ONE - 1u);
    let v = v_draw >> RANK_BITS;
    let found = Sample(atomicLoad(&cand_depth[pixel]), surface.patch_id, u, v);
    let place = (u32(tile.z) + pixel / TILE) * frame.width + u32(tile.x) + pixel % TILE;
    if nearer(found, samples[place]) {
        samples[place] = found;
        let column = (u - surface.u) / (u_size(surface) >> MAX_RATE_BITS);
        let row = (v - surface.v) / (v_size(surface) >> MAX_RATE_BITS);
        colours[place] = colour_of(grid_base(index), row, column);
    }
    atomicStore(&cand_patch_u[pixel], NOBODY);
    atomicStore(&cand_v_draw[pixel], NOBODY);
}
