// No mirror in core: what Rust's integers can do and WGSL's cannot.

fn umin(a: u32, b: u32) -> u32 {
    return select(b, a, a < b);
}

fn saturating_sub(a: u32, b: u32) -> u32 {
    return select(0u, a - b, a > b);
}
