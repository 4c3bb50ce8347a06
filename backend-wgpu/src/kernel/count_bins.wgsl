// No mirror in core: grids are counted.

fn visit(bin: u32, index: u32) {
    atomicAdd(&bins[bin], 1u);
}
