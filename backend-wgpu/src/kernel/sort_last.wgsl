// Mirrors core/src/kernel/sort_last.rs (Turn, shown): one group a draw of the chunk samples it wherever it is, once a turn;
// several groups, if it is large.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> draws: array<Draw>;
@group(0) @binding(2) var<storage, read> grids: array<u32>;
@group(0) @binding(3) var<storage, read> behind: array<Sample>;
@group(0) @binding(4) var<storage, read> samples: array<Sample>;
@group(0) @binding(5) var<storage, read_write> colours: array<Colour>;
@group(0) @binding(6) var<storage, read_write> keys: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> rounds: Rounds;

const GROUP: u32 = 64u;
// The turn of colours; those before it look for the words of a key.
const TURN_COLOUR: u32 = KEY_WORDS;

// The draw, as a number within the chunk, and where its grid is.
var<private> index: u32;
var<private> base: u32;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    ZERO = frame.zero;
    index = group.x;
    base = grid_base(index);
    if grids[base] == KIND_HIDDEN {
        return;
    }
    limits = vec4<i32>(frame_columns(), frame_rows());
    let shape = quads_of(draw_at(index));
    let count = shape & QUADS_MASK;
    var first = group.y * GROUP + lane;
    var step = groups.y * GROUP;
    if is_large(grids[base + 1u], grids[base + 2u], count) {
        share = vec2<i32>(i32(lane), i32(GROUP));
        first = group.y;
        step = groups.y;
    }
    for (var task = first; task < count; task += step) {
        let item = item_of(shape, task);
        sample_item(base, item, item.cell);
    }
    if loops_were_cut() {
        rounds.truncated = 1u;
    }
}

// A hit, if it is still in question, given the key so far.
fn put(column: i32, row: i32, found: Found, cell: u32) {
    let depth = bitcast<u32>(found.hit.w);
    let place = place_of(column, row);
    if !is_behind(index, cell, depth, place) {
        return;
    }
    let turn = rounds.turn;
    if turn > 0u && depth != atomicLoad(&keys[KEY_WORDS * place]) {
        return;
    }
    let it = sample_of(draw_at(index), cell, depth);
    let own = key_of(it);
    for (var word = 1u; word < turn; word++) {
        if own[word] != atomicLoad(&keys[KEY_WORDS * place + word]) {
            return;
        }
    }
    if turn < TURN_COLOUR {
        atomicMax(&keys[KEY_WORDS * place + turn], own[turn]);
    } else if nearer(it, samples[place]) {
        colours[place] = colour_of(base, item_at(cell), found);
    }
}
