// No mirror in core: integers of 64 bits, which Rust has and WGSL has not.

// A 64-bit integer in two's complement.
struct Wide {
    low: u32,
    high: u32,
}

fn wide_negated(a: Wide) -> Wide {
    let low = 0u - a.low;
    return Wide(low, ~a.high + select(0u, 1u, low == 0u));
}

fn wide_add(a: Wide, b: Wide) -> Wide {
    let low = a.low + b.low;
    return Wide(low, a.high + b.high + select(0u, 1u, low < a.low));
}

fn wide_sub(a: Wide, b: Wide) -> Wide {
    return Wide(a.low - b.low, a.high - b.high - select(0u, 1u, a.low < b.low));
}

fn magnitude(a: i32) -> u32 {
    return u32(select(a, 0 - a, a < 0));
}

fn wide_mul(a: i32, b: i32) -> Wide {
    let p = magnitude(a);
    let q = magnitude(b);
    let low = (p & 0xffffu) * (q & 0xffffu);
    let cross_p = (p >> 16u) * (q & 0xffffu);
    let cross_q = (p & 0xffffu) * (q >> 16u);
    let middle = (low >> 16u) + (cross_p & 0xffffu) + (cross_q & 0xffffu);
    let high = (p >> 16u) * (q >> 16u) + (cross_p >> 16u) + (cross_q >> 16u) + (middle >> 16u);
    let product = Wide((low & 0xffffu) | (middle << 16u), high);
    if (a < 0) != (b < 0) {
        return wide_negated(product);
    }
    return product;
}

// -1, 0 or 1.
fn wide_sign(a: Wide) -> i32 {
    if (a.high & 0x80000000u) != 0u {
        return -1;
    }
    return select(0, 1, (a.low | a.high) != 0u);
}

fn wide_abs(a: Wide) -> Wide {
    if (a.high & 0x80000000u) != 0u {
        return wide_negated(a);
    }
    return a;
}

fn wide_leading_zeros(a: Wide) -> u32 {
    return select(32u + countLeadingZeros(a.low), countLeadingZeros(a.high), a.high != 0u);
}

// The low word of `a` shifted right by less than 32.
fn wide_shifted(a: Wide, by: u32) -> u32 {
    return select((a.low >> by) | (a.high << ((32u - by) & 31u)), a.low, by == 0u);
}
