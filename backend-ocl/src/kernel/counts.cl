// No mirror in core: what Rust's integers can do and OpenCL C's cannot, and who of a work-group does what.

static uint lesser_of(uint a, uint b) {
    return a < b ? a : b;
}

static uint saturating_sub(uint a, uint b) {
    return a > b ? a - b : 0u;
}

static uint greater_of(uint a, uint b) {
    return a > b ? a : b;
}

// Entries are shared out in unbroken runs: the first of `count` that is this work-item's.
static uint run_start(uint lane, uint count) {
    return lesser_of(lane * ((count + GROUP - 1u) / GROUP), count);
}

// Up to four sums at once.
typedef uint4 Counts;

// Sum of the first `count` entries.
static Counts sum(__local const Counts *all, uint count) {
    Counts total = (Counts)(0u);
    for (uint index = 0u; index < count; index++) {
        total += all[index];
    }
    return total;
}
