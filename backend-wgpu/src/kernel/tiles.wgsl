// Mirrors the second half of core's fused stage, sample: one group a block of the image's samples, over all draws of the
// chunk in the list of its tile that are of this kernel's KIND, some at a time.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> draws: array<Draw>;
@group(0) @binding(2) var<storage, read> grids: array<u32>;
@group(0) @binding(3) var<storage, read> bins: array<u32>;
@group(0) @binding(4) var<storage, read> behind: array<Sample>;
@group(0) @binding(5) var<storage, read_write> samples: array<Sample>;
@group(0) @binding(6) var<storage, read_write> colours: array<Colour>;
@group(0) @binding(7) var<storage, read_write> rounds: Rounds;

const GROUP: u32 = 64u;
// An invocation each lists a draw, and has a word of the set.
const_assert LISTED <= GROUP && CHUNK == 32u * GROUP;

// The tile's list as a set, a bit a draw of the chunk, since it is in no order; and how many are in the words before.
var<workgroup> members: array<atomic<u32>, GROUP>;
var<workgroup> members_before: array<u32, GROUP>;

var<workgroup> hits_shared: u32;
// Draws of the list that earlier rounds have sampled, and the round's budget.
var<workgroup> round_shared: vec2<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let block = first_block() + group.xy;
    limits = vec4<i32>(along(block.x, frame_columns()), along(block.y, frame_rows()));
    let blocks = cut_into(block_bits());
    let place = ((KIND - 1u) * blocks.y + block.y) * blocks.x + block.x;
    if lane == 0u {
        let done = select(0u, rounds.progress[place], rounds.round > 1u);
        round_shared = vec2<u32>(done, rounds.budget[KIND - 1u]);
    }
    let round = workgroupUniformLoad(&round_shared);
    let list = list_of(block);
    let length = list.y - list.x;
    var next = round.x;
    if next < length {
        recall(lane);
        gather(list, lane);
    }
    for (var done = 0u; next < length && done < round.y; done += TOGETHER) {
        let count = select(length - next, TOGETHER, next + TOGETHER < length);
        put_on_list(block, next, count, lane);
        sample_listed(count, lane);
        next += count;
    }
    if lane == 0u {
        rounds.progress[place] = next;
        if next < length {
            rounds.unfinished[KIND - 1u] = 1u;
        }
    }
    if loops_were_cut() {
        rounds.truncated = 1u;
    }
}

// Column and row of the first block that draws of this kind touch.
fn first_block() -> vec2<u32> {
    let box = BOXES + (KIND - 1u) * BOX;
    return 0xffffu - vec2<u32>(bins[box], bins[box + 2u]);
}

// Columns (or rows) of samples of a block, of those that there are.
fn along(block: u32, whole: vec2<i32>) -> vec2<i32> {
    let start = whole.x + i32(block << block_bits());
    return overlap(vec2<i32>(start, start + (1 << block_bits())), whole);
}

// First entry of the list for a block, and one past the last.
fn list_of(block: vec2<u32>) -> vec2<u32> {
    let tile = block >> vec2<u32>(blocks_a_tile());
    let bin = bin_of(KIND, tile.x, tile.y);
    return list_base() + vec2<u32>(select(0u, bins[bin - 1u], bin > BINS), bins[bin]);
}

// What the block's samples show already.
fn recall(lane: u32) {
    for (var at = lane; at < BLOCK_SAMPLES; at += GROUP) {
        let column = limits.x + i32(at % BLOCK);
        let row = limits.z + i32(at / BLOCK);
        var depth = 0u;
        if column < limits.y && row < limits.w {
            depth = samples[place_of(column, row)].depth;
        }
        atomicStore(&cand_depth[at], depth);
        forget(at);
    }
}

// The tile's list as a set.
fn gather(list: vec2<u32>, lane: u32) {
    atomicStore(&members[lane], 0u);
    workgroupBarrier();
    for (var at = list.x + lane; at < list.y; at += GROUP) {
        atomicOr(&members[bins[at] / 32u], 1u << (bins[at] % 32u));
    }
    workgroupBarrier();
    var before = 0u;
    for (var word = 0u; word < lane; word++) {
        before += countOneBits(atomicLoad(&members[word]));
    }
    members_before[lane] = before;
}

// The draws that are sampled next, in the order of the draw buffer, so that the first of several that are the same is
// shown; and the order of their patches. Those beside the block have nothing to sample.
fn put_on_list(block: vec2<u32>, first: u32, count: u32, lane: u32) {
    workgroupBarrier();
    var slot = members_before[lane] - first; // less than 0 is more than any slot
    for (var bits = atomicLoad(&members[lane]); bits != 0u; bits &= bits - 1u) {
        if slot < count {
            listed[slot] = 32u * lane + countTrailingZeros(bits);
        }
        slot += 1u;
    }
    workgroupBarrier();
    if lane < count {
        let index = listed[lane];
        let draw = draw_at(index);
        let base = grid_base(index);
        let touches = is_among(block.x, grids[base + 1u]) && is_among(block.y, grids[base + 2u]);
        listed_patch[lane] = draw.patch_id;
        quads[lane] = select(0u, quads_of(draw), touches);
    }
    if lane == 0u {
        atomicStore(&hit_count, 0u);
    }
    workgroupBarrier();
    if lane < count {
        var smaller = 0u;
        for (var other = 0u; other < count; other++) {
            smaller += select(0u, 1u, listed_patch[other] < listed_patch[lane]);
        }
        patch_rank[lane] = smaller;
    }
    workgroupBarrier();
}

fn is_among(block: u32, blocks: u32) -> bool {
    return block >= (blocks & 0xffffu) && block < (blocks >> 16u);
}

// Samples the listed draws: depths, who has them, then what has become visible.
fn sample_listed(count: u32, lane: u32) {
    turn = 0u;
    var hits = 0u;
    for (var passes = 1u; turn < passes; turn++) {
        sample_all(count, lane);
        workgroupBarrier();
        if lane == 0u {
            hits_shared = atomicLoad(&hit_count);
        }
        hits = workgroupUniformLoad(&hits_shared);
        passes = select(1u, TURNS, hits > HITS);
    }
    for (turn = 1u; turn < TURNS; turn++) {
        for (var hit = lane; hit < select(hits, 0u, hits > HITS); hit += GROUP) {
            let at = hit_place[hit];
            compare(at >> SAMPLE_SHIFT, hit_depth[hit], at & ((1u << SAMPLE_SHIFT) - 1u));
        }
        workgroupBarrier();
    }
    for (var at = lane; at < BLOCK_SAMPLES; at += GROUP) {
        resolve(at);
    }
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
