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
    let left = i32(group.x * TILE);
    let top = i32(group.y * TILE);
    tile = vec4<i32>(
        left, imin(left + i32(TILE), i32(frame.width)), top, imin(top + i32(TILE), i32(frame.height)));
    let place = ((KIND - 1u) * tiles(frame.height) + group.y) * tiles(frame.width) + group.x;
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
        let item = grids[HEAD_START] + index;
        let is_kind = (grids[grid_base(index)] & KIND_MASK) == KIND;
        if is_kind && touches(draws[item].columns, draws[item].rows) {
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
        atomicStore(&cand_key[pixel], NO_KEY);
    }
}

// Samples the listed draws: depths, then keys, then what has become visible.
fn sample_listed(count: u32, lane: u32) {
    for (var slot = lane; slot < count; slot += GROUP) {
        let ranked = rank_of(slot, count);
        rank[slot] = ranked;
        order[ranked] = slot;
    }
    if lane == 0u {
        atomicStore(&hit_count, 0u);
    }
    workgroupBarrier();
    second_time = false;
    var hits = 0u;
    for (var times = 0u; times < 1u + select(0u, 1u, hits > HITS); times++) {
        sample_all(count, lane);
        workgroupBarrier();
        if lane == 0u {
            hits_shared = atomicLoad(&hit_count);
        }
        hits = workgroupUniformLoad(&hits_shared);
        second_time = true;
    }
    for (var hit = lane; hit < select(hits, 0u, hits > HITS); hit += GROUP) {
        let at = hit_place[hit];
        resolve_hit(at >> PIXEL_SHIFT, hit_depth[hit], at & ((1u << PIXEL_SHIFT) - 1u));
    }
    workgroupBarrier();
    for (var pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        resolve(pixel);
    }
}

// How many listed draws come before this one in the order of (patch, u, v).
fn rank_of(slot: u32, count: u32) -> u32 {
    let mine = draws[grids[HEAD_START] + listed[slot]];
    var before = 0u;
    for (var other = 0u; other < count; other++) {
        let it = draws[grids[HEAD_START] + listed[other]];
        let is_before = it.patch_id < mine.patch_id || (it.patch_id == mine.patch_id
            && (it.u < mine.u || (it.u == mine.u && it.v < mine.v)));
        before += select(0u, 1u, is_before);
    }
    return before;
}

fn sample_all(count: u32, lane: u32) {
    var slot = lane / items();
    var task = lane % items();
    let slots = GROUP / items();
    let tasks = GROUP % items();
    while slot < count {
        let base = grid_base(listed[slot]);
        let item = item_of(grids[base], task);
        sample_item(base, item, (rank[slot] << CELL_BITS) | item.cell);
        let next = task + tasks;
        slot += slots + select(0u, 1u, next >= items());
        task = next - select(0u, items(), next >= items());
    }
}

// Shows the candidate of a pixel if it is nearer than what is stored; the pixel belongs to this invocation.
fn resolve(pixel: u32) {
    let key = atomicLoad(&cand_key[pixel]);
    if key == NO_KEY {
        return;
    }
    let index = listed[order[key >> CELL_BITS]];
    let cell = key & ((1u << CELL_BITS) - 1u);
    let place = (u32(tile.z) + pixel / TILE) * frame.width + u32(tile.x) + pixel % TILE;
    let surface = surface_of(draws[grids[HEAD_START] + index]);
    let found = sample_of(surface, cell, atomicLoad(&cand_depth[pixel]));
    if nearer(found, samples[place]) {
        samples[place] = found;
        colours[place] = colour_of(grid_base(index), cell);
    }
    atomicStore(&cand_key[pixel], NO_KEY);
}
