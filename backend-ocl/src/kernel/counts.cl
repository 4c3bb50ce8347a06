// No mirror in core: what Rust's integers can do and OpenCL C's cannot.

static uint lesser_of(uint a, uint b) {
    return a < b ? a : b;
}

static uint saturating_sub(uint a, uint b) {
    return a > b ? a - b : 0u;
}

static uint greater_of(uint a, uint b) {
    return a > b ? a : b;
}
