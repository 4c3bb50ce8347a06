// The fused stage: mirrors the loop of core's dice, shade and sample over the draws, one group a tile.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> control: Control;
@group(0) @binding(4) var<storage, read> draws: array<Draw>;
@group(0) @binding(5) var<storage, read_write> samples: array<Sample>;
@group(0) @binding(6) var<storage, read_write> colours: array<Colour>;
@group(0) @binding(7) var<storage, read_write> rounds: Rounds;

const GROUP: u32 = 64u;
// Most draws that are listed at once.
const CHOSEN: u32 = 256u;

// Draws that can touch the tile, in any order: the nearest wins, whoever comes first.
var<workgroup> chosen: array<u32, CHOSEN>;
var<workgroup> chosen_count: atomic<u32>;
var<workgroup> chosen_shared: u32;
var<workgroup> faces_eye_shared: u32;
// First draw to be looked at, and what `rounds` has under `enough` and `budget`.
var<workgroup> round_shared: vec3<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let left = i32(group.x * TILE);
    let top = i32(group.y * TILE);
    tile = vec4<i32>(
        left, imin(left + i32(TILE), i32(frame.width)), top, imin(top + i32(TILE), i32(frame.height)));
    let waiting = control.waiting + control.fresh;
    let place = group.y * ((frame.width + TILE - 1u) / TILE) + group.x;
    if lane == 0u {
        round_shared = vec3<u32>(rounds.progress[place], rounds.enough, rounds.budget);
    }
    let round = workgroupUniformLoad(&round_shared);
    var first = round.x;
    var drawn = 0u;
    while first < waiting && drawn < round.z {
        var listed = 0u;
        clear_list(lane);
        while first < waiting && listed <= round.y {
            listed = choose(first + lane, waiting, lane);
            first += GROUP;
        }
        for (var index = 0u; index < listed; index++) {
            draw_one(workgroupUniformLoad(&chosen[index]), lane);
        }
        drawn += listed;
    }
    if lane == 0u {
        rounds.progress[place] = first;
        if first < waiting {
            rounds.unfinished = 1u;
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

fn clear_list(lane: u32) {
    if lane == 0u {
        atomicStore(&chosen_count, 0u);
    }
    workgroupBarrier();
}

// Lists a draw if it can touch the tile; gives the number of draws listed so far by the whole group.
fn choose(item: u32, waiting: u32, lane: u32) -> u32 {
    if item < waiting && can_touch_tile(item) {
        chosen[atomicAdd(&chosen_count, 1u)] = item;
    }
    workgroupBarrier();
    if lane == 0u {
        chosen_shared = atomicLoad(&chosen_count);
    }
    return workgroupUniformLoad(&chosen_shared);
}

fn can_touch_tile(item: u32) -> bool {
    let columns = draws[item].columns;
    let rows = draws[item].rows;
    return i32(columns & 0xffffu) < tile.y && i32(columns >> 16u) > tile.x
        && i32(rows & 0xffffu) < tile.w && i32(rows >> 16u) > tile.z;
}

// Dices, shades and samples one surface inside the tile.
fn draw_one(item: u32, lane: u32) {
    let draw = draws[item];
    let surface = surface_of(draw);
    let object = patches[draw.patch_id].object;
    prepare(surface, lane);
    workgroupBarrier();
    for (var at = lane; at < (frame.rate + 1u) * (frame.rate + 1u); at += GROUP) {
        dice(surface, object, at);
    }
    clear_candidates(lane);
    workgroupBarrier();
    if (frame.flags & FLAG_CULL_BACKFACES) != 0u {
        if faces_away(lane) {
            return;
        }
    }
    seek_depth = true;
    sample(lane);
    workgroupBarrier();
    seek_depth = false;
    sample(lane);
    workgroupBarrier();
    for (var pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        resolve(surface, pixel);
    }
}

// What all vertices share: the net, then the rows' curves, the columns' weights and the seams.
fn prepare(surface: Surface, lane: u32) {
    if lane < 48u {
        net[lane] = transformed(surface.patch_id, lane / 16u, lane % 16u);
    }
    for (var column = lane; column <= frame.rate; column += GROUP) {
        prepare_column(surface, column);
    }
    workgroupBarrier();
    for (var task = lane; task < 3u * (frame.rate + 1u); task += GROUP) {
        prepare_row(surface, task);
    }
    if lane >= 60u {
        seam(surface, lane - 60u);
    }
    if lane == 59u {
        flat_length = mul(size(), FLAT);
    }
}

fn clear_candidates(lane: u32) {
    for (var pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        atomicStore(&cand_depth[pixel], 0u);
        atomicStore(&cand_cell[pixel], 0xffffffffu);
    }
    if lane == 0u {
        atomicStore(&faces_eye, 0u);
    }
}

// Does no micropolygon of the grid face the eye?
fn faces_away(lane: u32) -> bool {
    for (var index = lane; index < frame.rate * frame.rate; index += GROUP) {
        if may_face_eye(index / frame.rate, index % frame.rate) {
            atomicStore(&faces_eye, 1u);
        }
    }
    workgroupBarrier();
    if lane == 0u {
        faces_eye_shared = atomicLoad(&faces_eye);
    }
    return workgroupUniformLoad(&faces_eye_shared) == 0u;
}

// One pass over all micropolygons and slivers.
fn sample(lane: u32) {
    for (var index = lane; index < frame.rate * frame.rate; index += GROUP) {
        micropolygon(index / frame.rate, index % frame.rate);
    }
    for (var task = lane; task < 4u * frame.rate; task += GROUP) {
        seam_sliver(task);
    }
}

// Keeps the candidate of a pixel if it is nearer than what is stored; the pixel belongs to this invocation.
fn resolve(surface: Surface, pixel: u32) {
    let depth_bits = atomicLoad(&cand_depth[pixel]);
    if depth_bits == 0u {
        return;
    }
    let cell = atomicLoad(&cand_cell[pixel]);
    let column = u32(tile.x) + pixel % TILE;
    let row = u32(tile.z) + pixel / TILE;
    let place = row * frame.width + column;
    let found = sample_of(surface, cell, depth_bits);
    if nearer(found, samples[place]) {
        samples[place] = found;
        colours[place] = colour_of(cell);
    }
}
