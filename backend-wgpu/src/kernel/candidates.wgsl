// Mirrors core/src/kernel/sample.rs (put): the nearest wins.
//
// What a group finds in its block of samples is gathered in workgroup memory: the nearest depth of each sample, then, of
// the micropolygons that have it, the smallest patch and u, then the smallest v, then which one that is: four turns, of
// which the last three look at the hits of the first only. Seldom are there more hits than there is room for; then they
// look for them anew.

const BLOCK: u32 = 1u << MOST_BLOCK_BITS;
const BLOCK_SAMPLES: u32 = BLOCK * BLOCK;
// Most draws that are sampled together, and most hits that are kept.
const LISTED: u32 = 64u;
const HITS: u32 = 1024u;
const TURNS: u32 = 4u;
// A key is a cell and, above it, the slot of a draw among those listed.
const SAMPLE_SHIFT: u32 = 24u;
const NOBODY: u32 = 0xffffffffu;

// Bits of the nearest 1 / distance at each sample of the block; 0 = nothing.
var<workgroup> cand_depth: array<atomic<u32>, BLOCK_SAMPLES>;
// Patch, as its rank, and u of the micropolygon that has it; NOBODY if it was there before.
var<workgroup> cand_patch_u: array<atomic<u32>, BLOCK_SAMPLES>;
// Its v, and its key.
var<workgroup> cand_v: array<atomic<u32>, BLOCK_SAMPLES>;
var<workgroup> cand_key: array<atomic<u32>, BLOCK_SAMPLES>;
var<workgroup> hit_count: atomic<u32>;
var<workgroup> hit_depth: array<u32, HITS>;
var<workgroup> hit_place: array<u32, HITS>;
// The draws that are being sampled, as numbers within the chunk; their patches, and how many have a smaller one.
var<workgroup> listed: array<u32, LISTED>;
var<workgroup> listed_patch: array<u32, LISTED>;
var<workgroup> patch_rank: array<u32, LISTED>;
// Of each, see `quads_of`; 0 if it does not touch the block.
var<workgroup> quads: array<u32, LISTED>;

// Which turn is it?
var<private> turn: u32;

// A hit of a sample of the block.
fn put(column: i32, row: i32, found: Found, key: u32) {
    let depth = bitcast<u32>(found.hit.w);
    if !is_behind(listed[key >> CELL_BITS], key & CELL_MASK, depth, place_of(column, row)) {
        return;
    }
    let at = u32(row - limits.z) * BLOCK + u32(column - limits.x);
    if turn > 0u {
        compare(at, depth, key);
    } else if depth >= atomicMax(&cand_depth[at], depth) {
        let place = atomicAdd(&hit_count, 1u);
        if place < HITS {
            hit_depth[place] = depth;
            hit_place[place] = (at << SAMPLE_SHIFT) | key;
        }
    }
}

// Who has the nearest depth?
fn compare(at: u32, depth: u32, key: u32) {
    if depth != atomicLoad(&cand_depth[at]) {
        return;
    }
    let slot = key >> CELL_BITS;
    let it = sample_of(draw_at(listed[slot]), key & CELL_MASK, depth);
    let patch_u = (patch_rank[slot] << PARAM_BITS) | it.u;
    if turn == 1u {
        atomicMin(&cand_patch_u[at], patch_u);
    } else if patch_u == atomicLoad(&cand_patch_u[at]) {
        if turn == 2u {
            atomicMin(&cand_v[at], it.v);
        } else if it.v == atomicLoad(&cand_v[at]) {
            atomicMin(&cand_key[at], key);
        }
    }
}

fn forget(at: u32) {
    atomicStore(&cand_patch_u[at], NOBODY);
    atomicStore(&cand_v[at], NOBODY);
    atomicStore(&cand_key[at], NOBODY);
}

// Shows the candidate of a sample if it is nearer than what is stored; the sample belongs to this invocation.
fn resolve(at: u32) {
    let key = atomicLoad(&cand_key[at]);
    if key == NOBODY {
        return;
    }
    let index = listed[key >> CELL_BITS];
    let item = item_at(key & CELL_MASK);
    let column = limits.x + i32(at % BLOCK);
    let row = limits.z + i32(at / BLOCK);
    let place = place_of(column, row);
    let it = sample_of(draw_at(index), item.cell, atomicLoad(&cand_depth[at]));
    if nearer(it, samples[place]) {
        samples[place] = it;
        let base = grid_base(index);
        colours[place] = colour_of(base, item, found_again(base, item, site(column, row)));
    }
    forget(at);
}
