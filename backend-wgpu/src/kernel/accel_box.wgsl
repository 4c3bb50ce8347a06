// Mirrors core/src/accel/bounds.rs (`union`) and core/src/accel/extent.rs: floats that only have to be compared are compared
// by their bits, since some devices take the smallest numbers for 0.

// A finite float's bits as a number that is larger where the float is.
fn ordered(bits: u32) -> u32 {
    return select(bits | 0x80000000u, ~bits, (bits >> 31u) == 1u);
}

fn unordered(number: u32) -> u32 {
    return select(~number, number & 0x7fffffffu, (number >> 31u) == 1u);
}

// Is one float less than another? 0 and -0 are equal.
fn is_less(a: u32, b: u32) -> bool {
    return ((a | b) << 1u) != 0u && ordered(a) < ordered(b);
}

// The smaller of two, or the larger; the second when they are equal.
fn union_word(word: u32, a: u32, b: u32) -> u32 {
    if word < 3u {
        return select(b, a, is_less(a, b));
    }
    return select(b, a, is_less(b, a));
}

// Word of a box: its lowest corner, then its highest.
fn bounds_word(index: u32, word: u32) -> u32 {
    if word < 3u {
        return bitcast<u32>(boxes[index].low[word]);
    }
    return bitcast<u32>(boxes[index].high[word - 3u]);
}
