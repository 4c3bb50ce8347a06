// Mirrors core/src/accel/bounds.rs (`union`) and core/src/accel/extent.rs: floats that only have to be compared are compared
// by their bits, since some devices take the smallest numbers for 0.

// A finite float's bits as a number that is larger where the float is.
static uint ordered(uint bits) {
    return bits >> 31 == 1u ? ~bits : bits | 0x80000000u;
}

static uint unordered(uint number) {
    return number >> 31 == 1u ? number & 0x7fffffffu : ~number;
}

// Is one float less than another? 0 and -0 are equal.
static bool is_less(uint a, uint b) {
    return ((a | b) << 1) != 0u && ordered(a) < ordered(b);
}

// The smaller of two, or the larger; the second when they are equal.
static uint union_word(uint word, uint a, uint b) {
    return (word < 3u ? is_less(a, b) : is_less(b, a)) ? a : b;
}

// Word of a box: its lowest corner, then its highest.
static uint bounds_word(__global const Bounds *bounds, uint word) {
    return as_uint(word < 3u ? bounds->low[word] : bounds->high[word - 3u]);
}
