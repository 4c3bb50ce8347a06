// Mirrors core/src/accel/sort.rs (`digit`): keys of a block, of which each invocation has a run.

// How many keys of a run have which digit; digit by digit, and of each one run by run.
var<workgroup> runs: array<u32, SORT_DIGITS * ITEM_GROUP>;

fn digit_of(index: u32) -> u32 {
    let shift = accel_frame.shift;
    let word = select(keys[index].high, keys[index].low, shift < 32u);
    return (word >> (shift & 31u)) & (SORT_DIGITS - 1u);
}

// Where an invocation's run begins.
fn run_start(block: u32, lane: u32) -> u32 {
    return umin(block * SORT_BLOCK + lane * SORT_RUN, accel_frame.count);
}

// Where the count of a digit of a block is.
fn count_place(digit: u32, block: u32) -> u32 {
    return digit * ((accel_frame.count + SORT_BLOCK - 1u) / SORT_BLOCK) + block;
}

fn count_run(block: u32, lane: u32) {
    for (var digit = 0u; digit < SORT_DIGITS; digit++) {
        runs[digit * ITEM_GROUP + lane] = 0u;
    }
    let end = run_start(block, lane + 1u);
    for (var index = run_start(block, lane); index < end; index++) {
        runs[digit_of(index) * ITEM_GROUP + lane] += 1u;
    }
}
