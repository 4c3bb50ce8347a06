// No mirror in core: the draws that one dispatch of the fused stage works on.

struct Slice {
    // Its first draw, and how many it has at most; set by `arrange_draw`.
    first: u32,
    size: u32,
    // The first draw of the next slice.
    next: u32,
    // Set if the driver ended a loop early.
    truncated: u32,
}
