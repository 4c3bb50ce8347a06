// No mirror in core: grids are written into the list.

fn visit(bin: u32, index: u32) {
    let place = atomicAdd(&bins[bin], 1u);
    atomicStore(&bins[list_base() + place], index);
}
