// No mirror in core: the next chunk of draws, as many as their tiles' lists have room for, and the groups that dice it and
// that sample it one by one.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> control: Control;
@group(0) @binding(2) var<storage, read> draws: array<Draw>;
@group(0) @binding(3) var<storage, read_write> grids: array<u32>;
@group(0) @binding(4) var<storage, read_write> rounds: Rounds;
@group(0) @binding(5) var<storage, read_write> groups: array<u32, 6>;

const RUNS: u32 = 256u;
// Draws a run.
const RUN: u32 = CHUNK / RUNS;

// Entries of the lists that each run of draws may need.
var<workgroup> entries: array<u32, RUNS>;
// Not 0 if any draw is large.
var<workgroup> some_large: atomic<u32>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let start = rounds.next;
    let waiting = control.waiting + control.fresh;
    let left = select(0u, waiting - start, waiting > start);
    let most = select(left, CHUNK, left > CHUNK);
    if lane == 0u {
        atomicStore(&some_large, 0u);
    }
    workgroupBarrier();
    entries[lane] = 0u;
    for (var index = lane * RUN; index < (lane + 1u) * RUN && index < most; index++) {
        look_at(draws[start + index], lane);
    }
    workgroupBarrier();
    if lane == 0u {
        let count = fitting(start, most);
        grids[HEAD_START] = start;
        rounds.next = start + count;
        rounds.left = left - count;
        rounds.round = 0u;
        put_groups(0u, count, 1u);
        put_groups(3u, count, select(1u, PARTS, atomicLoad(&some_large) != 0u));
    }
}

fn put_groups(at: u32, columns: u32, rows: u32) {
    groups[at] = columns;
    groups[at + 1u] = rows;
    groups[at + 2u] = select(0u, 1u, columns > 0u);
}

fn look_at(draw: Draw, lane: u32) {
    let blocks = blocks_of_draw(draw);
    let rates = draw_rates(draw);
    entries[lane] += tiles_in(blocks.x, blocks.y);
    if is_large(blocks.x, blocks.y, rates.x * rates.y) {
        atomicStore(&some_large, 1u);
    }
}

// Columns and rows of blocks that a draw can touch.
fn blocks_of_draw(draw: Draw) -> vec2<u32> {
    return vec2<u32>(
        blocks_of(samples_of(draw.columns, frame_columns()), i32(frame.sample_left)),
        blocks_of(samples_of(draw.rows, frame_rows()), i32(frame.sample_top)),
    );
}

// How many draws from the first on, up to `most`, the list has room for.
fn fitting(start: u32, most: u32) -> u32 {
    var room = list_room();
    var run = 0u;
    while run < RUNS && entries[run] <= room {
        room -= entries[run];
        run += 1u;
    }
    var count = run * RUN;
    while count < most {
        let blocks = blocks_of_draw(draws[start + count]);
        let needed = tiles_in(blocks.x, blocks.y);
        if needed > room {
            return count;
        }
        room -= needed;
        count += 1u;
    }
    return most;
}
