// Mirrors core/src/accel/sort.rs (`digit`): keys of a block, of which each work-item has a run.

static uint digit_of(__global const SortKey *key, uint shift) {
    const uint word = shift < 32u ? key->low : key->high;
    return word >> (shift & 31u) & (SORT_DIGITS - 1u);
}

// Where a work-item's run begins.
static uint sort_run(__global const AccelFrame *frame, uint lane) {
    return lesser_of(get_group_id(0) * SORT_BLOCK + lane * SORT_RUN, frame->count);
}

static uint sort_blocks(__global const AccelFrame *frame) {
    return (frame->count + SORT_BLOCK - 1u) / SORT_BLOCK;
}

// How many keys of a run have which digit; digit by digit, and of each one run by run.
static void count_run(__global const AccelFrame *frame, __global const SortKey *keys, uint lane, __local uint *counts) {
    const uint from = sort_run(frame, lane), to = sort_run(frame, lane + 1u);
    for (uint digit = 0u; digit < SORT_DIGITS; digit++) {
        counts[digit * GROUP + lane] = 0u;
    }
    for (uint index = from; index < to; index++) {
        counts[digit_of(keys + index, frame->shift) * GROUP + lane] += 1u;
    }
}
